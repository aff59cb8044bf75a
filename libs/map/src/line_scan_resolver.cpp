#include "s2s/map/line_scan_resolver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::map {

namespace {

/// How well the heights of neighbouring places are known against each other; better than against the map.
constexpr double kReliefSigma_m = 0.02;

/// A point within this many standard deviations of the seabed's general level may be one of the seabed.
constexpr double kLevelGate = 2.0;

/// A place on an arc, decided.
struct Decision {
  double elevation_rad = 0;
  double halfSpread_rad = 0;  ///< standard deviation of the elevation
  double offSurface_m = 0;    ///< standard deviation across the arc, beside that of the range
  double misfit = 0;          ///< distance from the surface in standard deviations
  ElevationSource source = ElevationSource::LowestPoint;
};

/// Signed distance of an arc's places from one surface, positive on the free side; nothing where it is not known.
struct Gap {
  double distance_m = 0;
  double sigma_m = 0;
  bool known = false;
};

/// The places tried on one arc, from the lower end of the aperture to the upper.
struct Arc {
  std::vector<double> elevation_rad;
  std::vector<Eigen::Vector3d> p_map;
};

/// Index of the least known gap; nothing if none is known.
std::optional<std::size_t> leastGap(const std::vector<Gap>& gaps) {
  std::optional<std::size_t> least;
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (gaps[i].known && (!least || gaps[i].distance_m < gaps[*least].distance_m)) least = i;
  return least;
}

/// Where the surface touches the arc, `least` being the place with the least gap.
///
/// Inside the aperture the arc is tangent to the surface, and the mean of the places that fit as well is steadier than
/// the least one. At the aperture's edge it is the edge itself.
Decision contact(const Arc& arc, const std::vector<Gap>& gaps, std::size_t least) {
  const double limit = gaps[least].distance_m + gaps[least].sigma_m;
  std::size_t first = least, last = least;
  while (first > 0 && gaps[first - 1].known && gaps[first - 1].distance_m <= limit) --first;
  while (last + 1 < gaps.size() && gaps[last + 1].known && gaps[last + 1].distance_m <= limit) ++last;
  // Places that reach one edge are cut off there: their mean would be pulled inward.
  const bool isCutOff = (first == 0) != (last + 1 == gaps.size());
  const bool atEdge = isCutOff && (least == 0 || least + 1 == gaps.size());
  double weights = 0, sum_rad = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double excess = (gaps[i].distance_m - gaps[least].distance_m) / kReliefSigma_m;
    const double weight = std::exp(-0.5 * excess * excess);
    weights += weight;
    sum_rad += weight * arc.elevation_rad[i];
  }
  Decision decision;
  decision.elevation_rad = isCutOff ? arc.elevation_rad[least] : sum_rad / weights;
  // Along a tangent the point stays on the surface, whichever of the places is right.
  if (atEdge)
    decision.halfSpread_rad = (arc.elevation_rad[last] - arc.elevation_rad[first]) / std::sqrt(12.0);
  else
    decision.offSurface_m = gaps[least].sigma_m;
  decision.misfit = std::abs(gaps[least].distance_m) / gaps[least].sigma_m;
  return decision;
}

/// Where the arc comes out of the surface above `least`, or below it: the crossing nearest to it.
std::optional<Decision> crossing(const Arc& arc, const std::vector<Gap>& gaps, std::size_t least) {
  const auto between = [&](std::size_t inside, std::size_t outside) {
    const double a = gaps[inside].distance_m, b = gaps[outside].distance_m;
    const double slope = (b - a) / (arc.elevation_rad[outside] - arc.elevation_rad[inside]);
    Decision decision;
    decision.elevation_rad = arc.elevation_rad[inside] - a / slope;
    decision.halfSpread_rad = gaps[inside].sigma_m / std::abs(slope);
    return decision;
  };
  const std::size_t reach = std::max(least, gaps.size() - 1 - least);
  for (std::size_t step = 1; step <= reach; ++step) {
    if (least + step < gaps.size() && gaps[least + step].known && gaps[least + step - 1].known &&
        gaps[least + step].distance_m > 0)
      return between(least + step - 1, least + step);
    if (step <= least && gaps[least - step].known && gaps[least - step + 1].known && gaps[least - step].distance_m > 0)
      return between(least - step + 1, least - step);
  }
  return std::nullopt;
}

/// Elevation of the lowest point of the arc within the aperture, in closed form.
///
/// The arc is a circle, centre + radius (in_plane cos psi + z_axis sin psi); its height is least where psi points down.
double lowestElevation(const StoredLineScan& scan, const core::Isometry& T_map_sonar, double bearing_rad) {
  const bool isCone = scan.bearingModel == obs::BearingModel::Cone;
  const Eigen::Vector3d inPlane(isCone ? 1 : std::cos(bearing_rad), isCone ? 0 : std::sin(bearing_rad), 0);
  const double up_inPlane = T_map_sonar.linear().row(2).dot(inPlane), up_z = T_map_sonar.linear()(2, 2);
  const double psi = std::atan2(-up_z, -up_inPlane);
  const double half = 0.5 * scan.verticalAperture_rad;
  const double elevation = isCone ? std::asin(std::abs(std::cos(bearing_rad)) * std::sin(psi)) : psi;
  if (std::abs(psi) <= M_PI / 2 && std::abs(elevation) <= half) return elevation;
  // Height is monotonic over the aperture then: one of its edges is the lowest.
  return up_z > 0 ? -half : half;
}

/// Nothing known: the lowest point, which may be off by all of the aperture in the directions there are.
Decision lowestPoint(const Arc& arc, double lowest_rad) {
  const double below = lowest_rad - arc.elevation_rad.front();
  const double above = arc.elevation_rad.back() - lowest_rad;
  Decision decision;
  decision.elevation_rad = lowest_rad;
  // Root mean square distance from there of a place evenly distributed over the aperture.
  decision.halfSpread_rad = std::sqrt((std::pow(below, 3) + std::pow(above, 3)) / (3 * std::max(1e-9, below + above)));
  return decision;
}

double pointSigma(const PackedReturn& r, double bearingSigma_rad, const Decision& decision) {
  const double range = r.range_m, along = range * decision.halfSpread_rad, across = range * bearingSigma_rad;
  const double radial = std::hypot(fromHalf(r.rangeSigmaHalf), decision.offSurface_m);
  return std::sqrt(radial * radial + std::max(along * along, across * across));
}

void apply(const Decision& decision, double bearingSigma_rad, PackedReturn& r) {
  r.elevation = static_cast<std::int16_t>(std::lround(decision.elevation_rad / kElevationStep_rad));
  r.source = decision.source;
  r.sigmaCode = encodeSigma(pointSigma(r, bearingSigma_rad, decision));
}

/// Decides the returns of one ping; keeps the buffers between them.
class PingResolver {
 public:
  PingResolver(const SurfaceEvidence& seabed, const SurfaceEvidence& walls, const ResolverOptions& options,
               const StoredLineScan& scan, const core::Isometry& T_map_vehicle)
      : seabed_(seabed),
        walls_(walls),
        options_(options),
        scan_(scan),
        T_map_sonar_(T_map_vehicle * scan.T_vehicle_sonar) {
    const auto steps = static_cast<std::size_t>(std::max(3, options.arcSteps));
    arc_.elevation_rad.resize(steps);
    arc_.p_map.resize(steps);
    seabedGaps_.resize(steps);
    wallGaps_.resize(steps);
    for (std::size_t i = 0; i < steps; ++i)
      arc_.elevation_rad[i] =
          scan.verticalAperture_rad * (static_cast<double>(i) / static_cast<double>(steps - 1) - 0.5);
  }

  Decision decide(const PackedReturn& r) {
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i)
      arc_.p_map[i] =
          T_map_sonar_ * sonar::pointAt({r.range_m, r.bearing_rad, arc_.elevation_rad[i]}, scan_.bearingModel);
    const double rangeSigma = fromHalf(r.rangeSigmaHalf);
    const std::optional<Decision> seabed = meetSeabed(rangeSigma), wall = meetWall(rangeSigma);
    if (seabed && wall) return seabed->misfit <= wall->misfit ? *seabed : *wall;
    if (seabed) return *seabed;
    const Decision lowest = lowestPoint(arc_, lowestElevation(scan_, T_map_sonar_, r.bearing_rad));
    return wall && isWallLikelier(*wall, lowest, r) ? *wall : lowest;
  }

 private:
  /// Where the seabed in front of a wall is met first, the arc often ends just short of the wall. So a wall is believed
  /// only if the lowest point does not lie at the seabed's general level; where that is unknown, only a close touch.
  bool isWallLikelier(const Decision& wall, const Decision& lowest, const PackedReturn& r) const {
    const Eigen::Vector3d p_map =
        T_map_sonar_ * sonar::pointAt({r.range_m, r.bearing_rad, lowest.elevation_rad}, scan_.bearingModel);
    const auto level = seabed_.levelNear(p_map.x(), p_map.y());
    if (!level) return wall.misfit <= 1;
    const double sigma_m = gapSigma(level->sigma_m, fromHalf(r.rangeSigmaHalf));
    return p_map.z() - level->height_m > kLevelGate * sigma_m;
  }

  double gapSigma(double surfaceSigma_m, double rangeSigma_m) const {
    return std::sqrt(surfaceSigma_m * surfaceSigma_m + rangeSigma_m * rangeSigma_m +
                     options_.surfaceRoughness_m * options_.surfaceRoughness_m);
  }

  std::optional<Decision> meetSeabed(double rangeSigma_m) {
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) {
      const Eigen::Vector3d& p = arc_.p_map[i];
      const auto seabed = seabed_.seabedAt(p.x(), p.y());
      seabedGaps_[i].known = seabed.has_value();
      if (!seabed) continue;
      seabedGaps_[i].distance_m = p.z() - seabed->height_m;
      seabedGaps_[i].sigma_m = gapSigma(seabed->sigma_m, rangeSigma_m);
    }
    const auto least = leastGap(seabedGaps_);
    if (!least) return std::nullopt;
    const Gap& gap = seabedGaps_[*least];
    if (gap.distance_m > options_.gate * gap.sigma_m) return std::nullopt;
    std::optional<Decision> decision;
    if (gap.distance_m >= -options_.gate * gap.sigma_m)
      decision = contact(arc_, seabedGaps_, *least);
    else
      decision = crossing(arc_, seabedGaps_, *least);
    if (decision) decision->source = ElevationSource::Seabed;
    return decision;
  }

  std::optional<Decision> meetWall(double rangeSigma_m) {
    if (walls_.wallCount() == 0) return std::nullopt;
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) wallGaps_[i] = wallGap(arc_.p_map[i], rangeSigma_m);
    const auto least = leastGap(wallGaps_);
    if (!least) return std::nullopt;
    // An arc that goes through the wall proves that there is none at that depth, so there is no crossing here.
    if (std::abs(wallGaps_[*least].distance_m) > options_.gate * wallGaps_[*least].sigma_m) return std::nullopt;
    Decision decision = contact(arc_, wallGaps_, *least);
    decision.source = ElevationSource::Wall;
    return decision;
  }

  Gap wallGap(const Eigen::Vector3d& p, double rangeSigma_m) const {
    const auto wall = walls_.wallNear(p.x(), p.y());
    Gap gap;
    // Walls go on below what was seen of them, not above.
    if (!wall || p.z() > wall->top_m + options_.wallCell_m) return gap;
    gap.known = true;
    gap.distance_m = wall->normal.dot(p.head<2>()) - wall->offset_m;
    if (wall->normal.dot(T_map_sonar_.translation().head<2>()) < wall->offset_m) gap.distance_m = -gap.distance_m;
    gap.sigma_m = gapSigma(wall->sigma_m, rangeSigma_m);
    return gap;
  }

  const SurfaceEvidence& seabed_;
  const SurfaceEvidence& walls_;
  const ResolverOptions& options_;
  const StoredLineScan& scan_;
  const core::Isometry T_map_sonar_;
  Arc arc_;
  std::vector<Gap> seabedGaps_, wallGaps_;
};

}  // namespace

void LineScanResolver::reset(const ResolverOptions& options) {
  options_ = options;
  walls_.reset(options);
  profiles_.reset(options);
  swaths_.reset(options);
}

void LineScanResolver::addStereoPoint(const Eigen::Vector3d& p_map, double sigma_m) {
  profiles_.addSeabedPoint(p_map, sigma_m);
  swaths_.addSeabedPoint(p_map, sigma_m);
  walls_.addWallPoint(p_map);
}

void LineScanResolver::addLineScan(const StoredLineScan& scan, const core::Isometry& T_map_vehicle) {
  const core::Isometry T_map_sonar = T_map_vehicle * scan.T_vehicle_sonar;
  const bool isVertical = scan.pose.layer == Layer::LineVertical;
  for (const PackedReturn& r : scan.returns) {
    const Eigen::Vector3d p_map = T_map_sonar * pointOf(r, scan.bearingModel);
    // A surface touches the arc tangentially, so that a wrong elevation moves the point along the surface: only range
    // and bearing count for the surface's height.
    const double sigma_m = std::hypot(fromHalf(r.rangeSigmaHalf), r.range_m * scan.bearingSigma_rad);
    if (isVertical) walls_.addWallPoint(p_map);
    if (r.source != ElevationSource::Wall) (isVertical ? profiles_ : swaths_).addSeabedPoint(p_map, sigma_m);
  }
}

void LineScanResolver::resolve(StoredLineScan& scan, const core::Isometry& T_map_vehicle) const {
  const SurfaceEvidence& seabed = scan.pose.layer == Layer::LineVertical ? swaths_ : profiles_;
  PingResolver ping(seabed, walls_, options_, scan, T_map_vehicle);
  for (PackedReturn& r : scan.returns) apply(ping.decide(r), scan.bearingSigma_rad, r);
}

void LineScanResolver::setZero(StoredLineScan& scan) {
  Decision zero;
  zero.source = ElevationSource::Zero;
  zero.halfSpread_rad = scan.verticalAperture_rad / std::sqrt(12.0);
  for (PackedReturn& r : scan.returns) apply(zero, scan.bearingSigma_rad, r);
}

}  // namespace s2s::map
