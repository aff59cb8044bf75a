#include "association.h"

#include <algorithm>
#include <cmath>

#include "ping_motion.h"
#include "s2s/core/error.h"

namespace s2s::calib {

namespace {

constexpr double kFirstSigma_m = 0.1;           // of ranges, before anything is known
constexpr double kLeastSigma_m = 0.02;          // no echo is better than a resolution cell
constexpr double kLeastTextureSigma_m = 0.004;  // a tenth of a pixel
constexpr double kFirstApertureSigma_rad = 0.02;
constexpr double kLeastApertureSigma_rad = 0.002;
constexpr double kNormOfTwo = 1.75;   // median length of a vector of two normal components, over that of one
constexpr double kLeastSlope = 0.15;  // metres of height per metre of range: echoes that graze the seabed count little
constexpr std::size_t kMinEchoes = 500;
constexpr double kWallReach_m = 0.6;  // an echo this near to a wall may be of it
constexpr double kWallFoot_m = 0.35;  // a wall's echoes this near to the bed may be of the bed
constexpr double kBedMargin_m = 0.1;  // the bed is not seen behind a wall by more than this
constexpr int kContactSteps = 16;     // elevations at which the nearest part of a wall is looked for
constexpr double kInside = 0.85;      // share of the aperture inside which its edge plays no part

std::size_t at(EvidenceKind kind) { return static_cast<std::size_t>(kind); }

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double leastSigma(std::size_t kind) {
  if (kind == at(EvidenceKind::Aperture)) return kLeastApertureSigma_rad;
  return kind == at(EvidenceKind::Texture) ? kLeastTextureSigma_m : kLeastSigma_m;
}

EvidenceKind seabedKind(const Echo& echo) {
  switch (echo.kind) {
    case EchoKind::NearEdge:
      return EvidenceKind::NearEdge;
    case EchoKind::FarEdge:
      return EvidenceKind::FarEdge;
    case EchoKind::Ridge:
      return EvidenceKind::WallEdge;
    case EchoKind::ApertureEnd:
      return EvidenceKind::Aperture;
    case EchoKind::Middle:
    case EchoKind::Band:
      break;
  }
  return EvidenceKind::Middle;
}

/// How far a place lies behind a wall, seen from the sonar; negative in front of it.
double behind(const WallPlane& wall, const Eigen::Vector3d& p_map, double side) {
  return side * (wall.normal.dot(p_map.head<2>()) - wall.offset_m);
}

/// Moves an echo to the elevation at which its arc reaches deepest into a wall: there it touches the wall, and its
/// range does to first order not depend on the elevation. False if that is at the aperture's edge.
template <class Depth>
bool touches(Echo& echo, const Depth& depth) {
  double deepest_m = -1e9;
  float best = 0;
  for (int step = 0; step <= kContactSteps; ++step) {
    echo.elevationShare = static_cast<float>(2.0 * step / kContactSteps - 1);
    const double depth_m = depth(echo);
    if (depth_m <= deepest_m) continue;
    deepest_m = depth_m;
    best = echo.elevationShare;
  }
  echo.elevationShare = best;
  return std::abs(best) <= kInside;
}

}  // namespace

Association::Association(const CalibrationEvidence& evidence, const CalibrationOptions& options)
    : evidence_(evidence), options_(options), aperture_(evidence, options), texture_(evidence, options) {
  std::size_t total = 0;
  for (const auto& ping : evidence_.pings) total += ping.echoes.size();
  stride_ = 1 + total / static_cast<std::size_t>(std::max(1, options_.maxEchoes));
  sigma_.fill(kFirstSigma_m);
  sigma_[at(EvidenceKind::Aperture)] = kFirstApertureSigma_rad;
}

void Association::update(const CalibrationState& state, SeabedGrid& grid, const RoundGates& gates) {
  motions_.clear();
  placeEchoes(state);
  fitGrid(grid);
  used_ = {};
  counts_.fill(0);
  leftOut_.fill(0);
  for (auto& spread : spreads_) spread.clear();
  associateEchoes(grid, gates.echo_m);
  if (gates.texture_m > 0 && options_.texture.enabled) findTexture(state, grid, gates.texture_m);
  if (gates.aperture && options_.aperture.enabled) findAperture(state, grid);
  rescale();
  if (gates.mirror) findDepth(state);
  if (used_.echoes.size() < kMinEchoes)
    throw core::InputError("only " + std::to_string(used_.echoes.size()) + " echoes of the seabed were found",
                           "calibration", "look at the pings with sonar-inspect; take a longer part of the survey");
}

CalibrationStatistics Association::statistics() const {
  CalibrationStatistics all;
  all.used = counts_;
  all.mirror = depth_;
  all.leftOut = leftOut_;
  all.sigma_m = sigma_;
  return all;
}

const PingMotion* Association::motionOf(core::TimeNs recorded, const SonarState& sonar) {
  const auto motion = pingMotionAt(evidence_.T_map_vehicle, recorded, sonar);
  if (!motion) return nullptr;
  motions_.push_back(std::make_unique<PingMotion>(*motion));
  return motions_.back().get();
}

int Association::blockOf(core::TimeNs time) const {
  const double since_s = core::secondsBetween(evidence_.T_map_vehicle.front().time, time);
  return std::max(0, static_cast<int>(since_s / options_.block_s));
}

void Association::placeEchoes(const CalibrationState& state) {
  echoes_.clear();
  std::array<std::size_t, 2> number{};
  for (const auto& ping : evidence_.pings) {
    if (number[static_cast<std::size_t>(ping.sonar)]++ % stride_ != 0) continue;
    UsedEcho common;
    common.motion = motionOf(ping.time, state[ping.sonar]);
    if (!common.motion) continue;
    common.sonar = ping.sonar;
    common.block = blockOf(ping.time);
    for (const Echo& echo : ping.echoes) placeEcho(echo, common, state);
  }
}

void Association::placeEcho(const Echo& echo, const UsedEcho& common, const CalibrationState& state) {
  if (echo.kind == EchoKind::FarEdge && std::abs(echo.bearing_rad) > options_.farEdgeBearing_rad) return;
  const SonarState& sonar = state[common.sonar];
  const auto place = [&](const Echo& e) {
    return echoPoint<double>(e, sonar, *common.motion, sonar.correction.data(), state.soundSpeed_mps);
  };
  PlacedEcho placed;
  placed.used = common;
  placed.used.echo = echo;
  placed.used.kind = seabedKind(echo);
  placed.p_map = place(echo);
  if (!placed.p_map.allFinite()) return;
  const bool atWall = placeAtWall(placed, state);
  if (!atWall && (echo.kind == EchoKind::Ridge || std::abs(echo.bearing_rad) > options_.maxBearing_rad)) return;
  Echo farther = placed.used.echo;
  farther.range_m += 1;
  placed.p_farther_map = place(farther);
  if (placed.used.echo.kind == EchoKind::Band) placed.other_map = place(otherPoint(placed.used.echo));
  echoes_.push_back(placed);
}

/// Whether the echo is of a wall or behind one; if of one, it is put where its arc touches the wall.
bool Association::placeAtWall(PlacedEcho& placed, const CalibrationState& state) const {
  if (!evidence_.wallAt || placed.used.echo.kind == EchoKind::FarEdge) return false;
  const SonarState& sonar = state[placed.used.sonar];
  const auto place = [&](const Echo& e) {
    return echoPoint<double>(e, sonar, *placed.used.motion, sonar.correction.data(), state.soundSpeed_mps);
  };
  Echo contact = placed.used.echo;
  contact.kind = EchoKind::Middle;
  if (placed.used.echo.kind != EchoKind::Middle) contact.elevationShare = 0;
  const Eigen::Vector3d centre_map = place(contact);
  const auto wall = evidence_.wallAt(centre_map.x(), centre_map.y());
  if (!wall) return false;
  const Eigen::Vector3d sonar_map = placed.used.motion->T_map_vehicle * sonar.corrected().translation();
  const double side = behind(*wall, sonar_map, 1) < 0 ? 1 : -1;
  const double depth_m = behind(*wall, placed.p_map, side);
  if (placed.used.echo.kind == EchoKind::NearEdge) {
    placed.mayBeSeabed =
        depth_m < kBedMargin_m;  // of first echoes only those that the wall does not hide are the bed's
    return !placed.mayBeSeabed;
  }
  if (placed.used.echo.kind == EchoKind::Ridge &&
      !touches(contact, [&](const Echo& e) { return behind(*wall, place(e), side); }))
    return false;
  placed.p_map = place(contact);
  if (std::abs(behind(*wall, placed.p_map, side)) > kWallReach_m) return false;
  placed.used.echo = contact;
  placed.used.kind = placed.used.sonar == SonarId::Vertical ? EvidenceKind::WallBand : EvidenceKind::WallEdge;
  placed.mayBeSeabed = false;
  placed.used.wall = WallPlane{side * wall->normal, side * wall->offset_m};
  return true;
}

void Association::fitGrid(SeabedGrid& grid) const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(echoes_.size());
  for (const auto& placed : echoes_)
    if (placed.mayBeSeabed) {
      points.push_back(placed.p_map);
      if (placed.other_map) points.push_back(*placed.other_map);
    }
  grid.fit(points, options_.minCellEchoes);
}

bool Association::associateWithWall(PlacedEcho& placed, const SeabedGrid& grid, double gate_m) {
  const double gap_m = behind(*placed.used.wall, placed.p_map, 1);
  const Eigen::Vector2d inFront = placed.p_map.head<2>() - (gap_m + kWallReach_m) * placed.used.wall->normal;
  const auto foot = grid.at(inFront.x(), inFront.y());
  const bool isWall = foot && placed.p_map.z() > foot->height_m + kWallFoot_m;
  const Eigen::Vector3d ray = placed.p_farther_map - placed.p_map;
  const double slope = std::abs(placed.used.wall->normal.dot(ray.head<2>()));
  if (!isWall || std::abs(gap_m) > std::min(gate_m, kWallReach_m) || slope < 2 * kLeastSlope) return false;
  spreads_[at(placed.used.kind)].push_back(std::abs(gap_m) / slope);
  placed.used.weight_perM = 1 / (sigma_[at(placed.used.kind)] * slope);
  return true;
}

/// How far a band's other point is above the bed. Nothing where there is no bed or both points share some of it.
std::optional<double> Association::gapOfOther(PlacedEcho& placed, const SeabedGrid& grid) const {
  const Eigen::Vector3d& p = *placed.other_map;
  const auto seabed = grid.at(p.x(), p.y());
  if (!seabed) return {};
  const auto cell = grid.cellOf(placed.p_map.x(), placed.p_map.y());
  placed.used.otherCell = grid.cellOf(p.x(), p.y());
  if (std::abs(cell.x - placed.used.otherCell.x) < 2 && std::abs(cell.y - placed.used.otherCell.y) < 2) return {};
  return p.z() - seabed->height_m;
}

void Association::associateEchoes(const SeabedGrid& grid, double gate_m) {
  for (PlacedEcho& placed : echoes_) {
    const auto kind = at(placed.used.kind);
    if (placed.used.wall) {
      const bool isWall = associateWithWall(placed, grid, gate_m);
      ++(isWall ? counts_ : leftOut_)[kind];
      if (isWall) used_.echoes.push_back(placed.used);
      continue;
    }
    const auto seabed = placed.mayBeSeabed ? grid.at(placed.p_map.x(), placed.p_map.y()) : std::nullopt;
    double gap_m = seabed ? placed.p_map.z() - seabed->height_m : 0;
    const auto other_m = seabed && placed.other_map ? gapOfOther(placed, grid) : std::nullopt;
    if (other_m) gap_m = 0.5 * (gap_m + *other_m);
    const Eigen::Vector3d ray = placed.p_farther_map - placed.p_map;
    const double slope = seabed ? std::abs(ray.z() - seabed->slope.dot(ray.head<2>())) : 0;
    if (!seabed || (placed.other_map && !other_m) || std::abs(gap_m) > gate_m || slope < kLeastSlope) {
      ++leftOut_[kind];
      continue;
    }
    ++counts_[kind];
    spreads_[kind].push_back(std::abs(gap_m) / slope);
    placed.used.cell = grid.cellOf(placed.p_map.x(), placed.p_map.y());
    placed.used.weight_perM = 1 / (sigma_[kind] * slope);
    used_.echoes.push_back(placed.used);
  }
}

void Association::findDepth(const CalibrationState& state) {
  if (!evidence_.waterHeight_m) return;
  const SonarState& sonar = state[SonarId::Vertical];
  depth_ = mirrorDepth(evidence_.mirror, sonar, state.soundSpeed_mps, evidence_.T_map_vehicle, *evidence_.waterHeight_m,
                       options_.mirror);
  if (depth_) used_.verticalZ_m = sonar.correction[kZ] + depth_->higher_m;
}

void Association::findTexture(const CalibrationState& state, SeabedGrid& grid, double reach_m) {
  texture_.update(state, grid, reach_m);
  used_.texture = texture_.used();
  counts_[at(EvidenceKind::Texture)] = used_.texture.size();
  leftOut_[at(EvidenceKind::Texture)] = texture_.leftOut();
  for (UsedTexture& used : used_.texture) {
    spreads_[at(EvidenceKind::Texture)].push_back(used.apart_m / kNormOfTwo);
    used.residual.weight_perM = 1 / sigma_[at(EvidenceKind::Texture)];
  }
}

/// Ends of the aperture, on the bed as far as the vertical sonar has seen it: where that depends on the horizontal one
/// alone, it is wherever this one's mounting puts it.
void Association::findAperture(const CalibrationState& state, const SeabedGrid& grid) {
  SeabedGrid seenByVertical(options_.cell_m);
  std::vector<Eigen::Vector3d> points;
  for (const auto& placed : echoes_) {
    if (placed.used.sonar != SonarId::Vertical || !placed.mayBeSeabed) continue;
    points.push_back(placed.p_map);
    if (placed.other_map) points.push_back(*placed.other_map);
  }
  seenByVertical.fit(points, options_.minCellEchoes);
  aperture_.update(state, grid, seenByVertical);
  const auto kind = at(EvidenceKind::Aperture);
  leftOut_[kind] = aperture_.leftOut();
  for (ApertureAssociation::End end : aperture_.ends()) {
    ++counts_[kind];
    spreads_[kind].push_back(std::abs(end.off_rad));
    end.used.block = blockOf(end.time);
    end.used.weight_perM = 1 / (sigma_[kind] * end.rise_mPerRad);
    used_.echoes.push_back(end.used);
  }
}

/// Weights by the spread that the evidence has around its surfaces now.
void Association::rescale() {
  std::array<double, kEvidenceKinds> factor{};
  for (std::size_t kind = 0; kind < kEvidenceKinds; ++kind) {
    const double old = sigma_[kind];
    if (!spreads_[kind].empty()) sigma_[kind] = std::max(leastSigma(kind), 1.4826 * median(spreads_[kind]));
    factor[kind] = old / sigma_[kind];
  }
  for (UsedEcho& used : used_.echoes) used.weight_perM *= factor[at(used.kind)];
  for (UsedTexture& used : used_.texture) used.residual.weight_perM *= factor[at(EvidenceKind::Texture)];
}

}  // namespace s2s::calib
