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

/// At this distance along an arc from where it meets a seabed, it has left it.
constexpr double kClear_m = 0.35;

/// How far from a wall's face the seabed at its foot is looked for.
constexpr double kFootReach_m = 2.0;

/// A place on an arc, decided.
struct Decision {
  double elevation_rad = 0;
  double halfSpread_rad = 0;  ///< standard deviation of the elevation
  double offSurface_m = 0;    ///< standard deviation across the arc, beside that of the range
  double misfit = 0;          ///< distance from the surface in standard deviations
  double interval_m = 0;      ///< length of the part of the arc it may lie on, if ambiguous
  ElevationSource source = ElevationSource::Ambiguous;
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

/// Elevations at which a sonar's aperture ends, `beyond` the nominal ones.
struct Aperture {
  double low_rad = 0, high_rad = 0;
  double sigma_rad = 0;  ///< how well the ends are known, sharpness of the edge not counted

  explicit Aperture(const StoredLineScan& scan)
      : low_rad(-0.5 * scan.verticalAperture_rad), high_rad(0.5 * scan.verticalAperture_rad) {}
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
Decision contact(const Arc& arc, const std::vector<Gap>& gaps, std::size_t least, double relief_m) {
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
    decision.offSurface_m = relief_m;
  decision.misfit = std::abs(gaps[least].distance_m) / gaps[least].sigma_m;
  return decision;
}

/// Where a ridge lies on a wall, whose range is that of the middle of all that its beam sees of the wall: where the gap
/// is the mean of the known ones. Of two such places it is the one nearer to the middle of the known arc.
std::optional<Decision> middleContact(const Arc& arc, const std::vector<Gap>& gaps, double relief_m) {
  double count = 0, distance_m = 0, sigma_m = 0, middle_rad = 0;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (!gaps[i].known) continue;
    // Each place speaks for half a step at either side; at the arc's ends one of these is outside the aperture.
    const double weight = i == 0 || i + 1 == gaps.size() ? 0.5 : 1.0;
    count += weight;
    distance_m += weight * gaps[i].distance_m;
    sigma_m += weight * gaps[i].sigma_m;
    middle_rad += weight * arc.elevation_rad[i];
  }
  if (count == 0) return std::nullopt;
  distance_m /= count;
  middle_rad /= count;
  Decision decision;
  decision.offSurface_m = relief_m;
  decision.misfit = std::abs(distance_m) / (sigma_m / count);
  double nearest_rad = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (!gaps[i].known) continue;
    double place_rad = arc.elevation_rad[i];
    const double here = gaps[i].distance_m - distance_m;
    if (i + 1 < gaps.size() && gaps[i + 1].known) {
      const double next = gaps[i + 1].distance_m - distance_m;
      if (here * next > 0) continue;
      if (here != next) place_rad += here / (here - next) * (arc.elevation_rad[i + 1] - arc.elevation_rad[i]);
    } else if (i > 0 && gaps[i - 1].known) {
      continue;
    }
    if (std::abs(place_rad - middle_rad) >= nearest_rad) continue;
    nearest_rad = std::abs(place_rad - middle_rad);
    decision.elevation_rad = place_rad;
  }
  return decision;
}

/// Where the arc comes out of the surface above `least`, or below it: the crossing nearest to it.
std::optional<Decision> crossing(const Arc& arc, const std::vector<Gap>& gaps, std::size_t least) {
  const auto meet = [&](std::size_t inside, std::size_t outside) {
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
      return meet(least + step - 1, least + step);
    if (step <= least && gaps[least - step].known && gaps[least - step + 1].known && gaps[least - step].distance_m > 0)
      return meet(least - step + 1, least - step);
  }
  return std::nullopt;
}

/// Elevation of the lowest point of the arc within the aperture, in closed form.
///
/// The arc is a circle, centre + radius (in_plane cos psi + z_axis sin psi); its height is least where psi points down.
double lowestElevation(const StoredLineScan& scan, const Aperture& aperture, const core::Isometry& T_map_sonar,
                       double bearing_rad) {
  const bool isCone = scan.bearingModel == obs::BearingModel::Cone;
  const Eigen::Vector3d inPlane(isCone ? 1 : std::cos(bearing_rad), isCone ? 0 : std::sin(bearing_rad), 0);
  const double up_inPlane = T_map_sonar.linear().row(2).dot(inPlane), up_z = T_map_sonar.linear()(2, 2);
  const double psi = std::atan2(-up_z, -up_inPlane);
  const double elevation = isCone ? std::asin(std::abs(std::cos(bearing_rad)) * std::sin(psi)) : psi;
  if (std::abs(psi) <= M_PI / 2 && elevation >= aperture.low_rad && elevation <= aperture.high_rad) return elevation;
  // Height is monotonic over the aperture then: one of its edges is the lowest.
  return up_z > 0 ? aperture.low_rad : aperture.high_rad;
}

/// Anywhere between two elevations, most likely at `place_rad`.
Decision between(double low_rad, double high_rad, double place_rad, double range_m) {
  const double below = place_rad - low_rad, above = high_rad - place_rad;
  Decision decision;
  decision.elevation_rad = place_rad;
  // Root mean square distance from there of a place evenly distributed over the interval.
  decision.halfSpread_rad = std::sqrt((std::pow(below, 3) + std::pow(above, 3)) / (3 * std::max(1e-9, below + above)));
  decision.interval_m = range_m * (high_rad - low_rad);
  return decision;
}

double pointSigma(const PackedReturn& r, double bearingSigma_rad, const Decision& decision) {
  const double range = r.range_m, along = range * decision.halfSpread_rad, across = range * bearingSigma_rad;
  const double radial = std::hypot(decodeSigma(r.rangeSigmaCode), decision.offSurface_m);
  return std::sqrt(radial * radial + std::max(along * along, across * across));
}

void apply(const Decision& decision, double bearingSigma_rad, PackedReturn& r) {
  r.elevation = static_cast<std::int16_t>(std::lround(decision.elevation_rad / kElevationStep_rad));
  r.source = decision.source;
  r.sigmaCode = encodeSigma(pointSigma(r, bearingSigma_rad, decision));
  r.intervalCode = encodeSigma(decision.interval_m);
}

/// Decides the returns of one ping; keeps the buffers between them.
class PingResolver {
 public:
  struct Evidence {
    const SurfaceEvidence& seabed;  ///< by others than this sonar
    const SurfaceEvidence& own;     ///< by this sonar too
    const SurfaceEvidence& walls;
    const FreeSpace* free;  ///< null: not asked
  };

  PingResolver(const Evidence& evidence, const ResolverOptions& options, const Aperture& aperture,
               const StoredLineScan& scan, const core::Isometry& T_map_vehicle)
      : evidence_(evidence),
        options_(options),
        aperture_(aperture),
        scan_(scan),
        T_map_sonar_(T_map_vehicle * scan.T_vehicle_sonar) {
    const auto steps = static_cast<std::size_t>(std::max(3, options.arcSteps));
    arc_.elevation_rad.resize(steps);
    arc_.p_map.resize(steps);
    seabedGaps_.resize(steps);
    wallGaps_.resize(steps);
    for (std::size_t i = 0; i < steps; ++i)
      arc_.elevation_rad[i] = aperture.low_rad + (aperture.high_rad - aperture.low_rad) * static_cast<double>(i) /
                                                     static_cast<double>(steps - 1);
  }

  Decision decide(const PackedReturn& r) {
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) arc_.p_map[i] = placeOf(r, arc_.elevation_rad[i]);
    const double rangeSigma_m = decodeSigma(r.rangeSigmaCode);
    if (r.order > 0) {
      const auto wall = r.isRidge ? meetWallInTheMiddle(rangeSigma_m) : meetWall(rangeSigma_m);
      return wall ? *wall : between(arc_.elevation_rad.front(), arc_.elevation_rad.back(), 0, r.range_m);
    }
    const std::optional<Decision> seabed = meetSeabed(rangeSigma_m);
    const double lowest_rad = lowestElevation(scan_, aperture_, T_map_sonar_, r.bearing_rad);
    if (!seabed && isOwnSeabed(r, lowest_rad, rangeSigma_m)) return lowestPoint(lowest_rad);
    const std::optional<Decision> wall = meetWall(rangeSigma_m);
    if (seabed && wall) return seabed->misfit <= wall->misfit ? *seabed : *wall;
    if (seabed) return *seabed;
    if (wall && wall->misfit <= 1 && !isFree(placeOf(r, wall->elevation_rad))) return *wall;
    if (!evidence_.free) return between(arc_.elevation_rad.front(), arc_.elevation_rad.back(), lowest_rad, r.range_m);
    return notFree(r, lowest_rad);
  }

 private:
  Eigen::Vector3d placeOf(const PackedReturn& r, double elevation_rad) const {
    return T_map_sonar_ * sonar::pointAt({r.range_m, r.bearing_rad, elevation_rad}, scan_.bearingModel);
  }

  bool isFree(const Eigen::Vector3d& p_map) const {
    return evidence_.free && evidence_.free->isFree(p_map, options_.freeMargin_m, options_.freePings);
  }

  bool isAtEdge(double elevation_rad) const {
    return std::min(elevation_rad - aperture_.low_rad, aperture_.high_rad - elevation_rad) < options_.edgeSigma_rad;
  }

  /// Other arcs of this sonar have met the seabed there, and nowhere else along this arc. The latter matters at the
  /// edge of the aperture: the lowest points of arcs that all met one thing higher up make a slope, too, but it is as
  /// steep as the arcs themselves.
  bool isOwnSeabed(const PackedReturn& r, double lowest_rad, double rangeSigma_m) const {
    const Eigen::Vector3d p_map = placeOf(r, lowest_rad);
    const auto own = evidence_.own.seabedAt(p_map.x(), p_map.y());
    if (!own || std::abs(p_map.z() - own->height_m) > options_.gate * gapSigma(own->sigma_m, rangeSigma_m))
      return false;
    if (!isAtEdge(lowest_rad)) return true;
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) {
      const Eigen::Vector3d& p = arc_.p_map[i];
      if (r.range_m * std::abs(arc_.elevation_rad[i] - lowest_rad) < kClear_m) continue;
      const auto seabed = evidence_.own.seabedAt(p.x(), p.y());
      if (seabed && p.z() - seabed->height_m < 2 * options_.surfaceRoughness_m) return false;
    }
    return true;
  }

  Decision lowestPoint(double lowest_rad) const {
    Decision decision;
    decision.elevation_rad = lowest_rad;
    decision.source = ElevationSource::LowestPoint;
    decision.offSurface_m = options_.relief_m;
    if (isAtEdge(lowest_rad)) decision.halfSpread_rad = std::hypot(options_.edgeSigma_rad, aperture_.sigma_rad);
    return decision;
  }

  /// What other pings leave of the arc: the place nearest to the lowest point.
  Decision notFree(const PackedReturn& r, double lowest_rad) const {
    std::size_t first = arc_.p_map.size(), last = 0;
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) {
      if (isFree(arc_.p_map[i])) continue;
      first = std::min(first, i);
      last = i;
    }
    if (first > last) {  // a contradiction: all is said to be free
      first = 0;
      last = arc_.p_map.size() - 1;
    }
    const double low = arc_.elevation_rad[first], high = arc_.elevation_rad[last];
    if (r.range_m * (high - low) > options_.resolvedLength_m)
      return between(low, high, std::clamp(lowest_rad, low, high), r.range_m);
    // Half a step at either side is not known either.
    const double half_rad = 0.5 * (arc_.elevation_rad[1] - arc_.elevation_rad[0]);
    Decision decision = between(low - half_rad, high + half_rad, 0.5 * (low + high), r.range_m);
    decision.source = ElevationSource::FreeSpace;
    return decision;
  }

  double gapSigma(double surfaceSigma_m, double rangeSigma_m) const {
    return std::sqrt(surfaceSigma_m * surfaceSigma_m + rangeSigma_m * rangeSigma_m +
                     options_.surfaceRoughness_m * options_.surfaceRoughness_m);
  }

  std::optional<Decision> meetSeabed(double rangeSigma_m) {
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) {
      const Eigen::Vector3d& p = arc_.p_map[i];
      const auto seabed = evidence_.seabed.seabedAt(p.x(), p.y());
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
      decision = contact(arc_, seabedGaps_, *least, options_.relief_m);
    else
      decision = crossing(arc_, seabedGaps_, *least);
    if (decision) decision->source = ElevationSource::Seabed;
    return decision;
  }

  std::optional<Decision> meetWall(double rangeSigma_m) {
    if (evidence_.walls.wallCount() == 0) return std::nullopt;
    const double below_m = options_.surfaceRoughness_m;
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i)
      wallGaps_[i] = wallGap(arc_.p_map[i], rangeSigma_m, options_.gate, below_m);
    const auto least = leastGap(wallGaps_);
    if (!least) return std::nullopt;
    // An arc that goes through the wall proves that there is none at that depth, so there is no crossing here.
    if (std::abs(wallGaps_[*least].distance_m) > options_.gate * wallGaps_[*least].sigma_m) return std::nullopt;
    Decision decision = contact(arc_, wallGaps_, *least, std::hypot(options_.relief_m, wallSigma_m_));
    decision.source = ElevationSource::Wall;
    return decision;
  }

  /// The same for the ridge of a wall behind the seabed.
  std::optional<Decision> meetWallInTheMiddle(double rangeSigma_m) {
    if (evidence_.walls.wallCount() == 0) return std::nullopt;
    for (std::size_t i = 0; i < arc_.p_map.size(); ++i) wallGaps_[i] = wallGap(arc_.p_map[i], rangeSigma_m, 0, 0);
    auto decision = middleContact(arc_, wallGaps_, std::hypot(options_.relief_m, wallSigma_m_));
    if (!decision || decision->misfit > options_.gate) return std::nullopt;
    decision->source = ElevationSource::Wall;
    return decision;
  }

  /// @param seabedSigmas, below_m  how far below the known seabed the wall may still be met
  Gap wallGap(const Eigen::Vector3d& p, double rangeSigma_m, double seabedSigmas, double below_m) {
    const auto wall = evidence_.walls.wallNear(p.x(), p.y());
    Gap gap;
    // Walls go on below what was seen of them, not above, and end at the seabed.
    if (!wall || p.z() > wall->top_m + options_.wallCell_m) return gap;
    const double side = wall->normal.dot(T_map_sonar_.translation().head<2>()) < wall->offset_m ? -1 : 1;
    if (isBelowSeabed(p, side * wall->normal, seabedSigmas, below_m)) return gap;
    gap.known = true;
    gap.distance_m = side * (wall->normal.dot(p.head<2>()) - wall->offset_m);
    gap.sigma_m = gapSigma(wall->sigma_m, rangeSigma_m);
    wallSigma_m_ = wall->sigma_m;
    return gap;
  }

  /// Below the nearest known seabed in front of a wall's face.
  bool isBelowSeabed(const Eigen::Vector3d& p, const Eigen::Vector2d& outward, double sigmas, double below_m) const {
    const double step_m = 2 * options_.cell_m;
    for (int i = 0; i * step_m <= kFootReach_m; ++i) {
      const Eigen::Vector2d at = p.head<2>() + i * step_m * outward;
      if (const auto seabed = evidence_.own.seabedAt(at.x(), at.y()))
        return p.z() < seabed->height_m - sigmas * seabed->sigma_m - below_m;
    }
    return false;
  }

  const Evidence evidence_;
  const ResolverOptions& options_;
  const Aperture aperture_;
  const StoredLineScan& scan_;
  const core::Isometry T_map_sonar_;
  Arc arc_;
  std::vector<Gap> seabedGaps_, wallGaps_;
  double wallSigma_m_ = 0;  // of the wall met last
};

/// How far beyond the nominal end of the aperture, on the side of `sign`, a return's arc meets the known seabed coming
/// from the free side; nothing if it does not, if it meets it flatly, or if a seabed higher up is nearer.
std::optional<double> seabedBeyond(const SurfaceEvidence& seabed, const StoredLineScan& scan, const PackedReturn& r,
                                   const core::Isometry& T_map_sonar, double sign) {
  constexpr double kStep_rad = 0.02;
  constexpr double kLeastSlope = 0.25;  // of the arc against the seabed
  const double end_rad = 0.5 * scan.verticalAperture_rad;
  const auto gap = [&](double beyond_rad) -> std::optional<double> {
    const Eigen::Vector3d p =
        T_map_sonar *
        sonar::pointAt({r.range_m, r.bearing_rad, sign * std::min(end_rad + beyond_rad, M_PI / 2)}, scan.bearingModel);
    const auto known = seabed.seabedAt(p.x(), p.y());
    return known ? std::optional<double>(p.z() - known->height_m) : std::nullopt;
  };
  for (const double further : {0.0, 0.5})
    if (const auto above = gap((further - 1) * end_rad); above && *above <= 0) return std::nullopt;
  std::optional<double> last = gap(-ApertureEnd::kReach_rad);
  for (double at = -ApertureEnd::kReach_rad + kStep_rad; last && *last > 0; at += kStep_rad) {
    if (at > ApertureEnd::kReach_rad + kStep_rad) return std::nullopt;
    const auto here = gap(at);
    if (here && *here <= 0) {
      if (*last - *here < kLeastSlope * kStep_rad * r.range_m) return std::nullopt;
      return at - kStep_rad + kStep_rad * *last / (*last - *here);
    }
    last = here;
  }
  return std::nullopt;
}

}  // namespace

void LineScanResolver::reset(const ResolverOptions& options) {
  options_ = options;
  walls_.reset(options);
  profiles_.reset(options);
  swaths_.reset(options);
  free_.clear();
  ends_.fill(ApertureEnd(options.endSigma_rad));
  endsHere_ = SparseGrid<Ends>(kEndCell_m);
}

void LineScanResolver::addStereoPoint(const Eigen::Vector3d& p_map, double sigma_m) {
  profiles_.addSeabedPoint(p_map, sigma_m);
  swaths_.addSeabedPoint(p_map, sigma_m);
  walls_.addWallPoint(p_map);
}

void LineScanResolver::observeEnds(const StoredLineScan& scan, const core::Isometry& T_map_vehicle) {
  constexpr double kSpacing_m = 0.1;  // pings nearer to each other tell the same
  constexpr double kAtEnd_rad = 1e-6;
  if (scan.pose.layer != Layer::LineHorizontal || options_.endSigma_rad <= 0) return;
  const core::Isometry T_map_sonar = T_map_vehicle * scan.T_vehicle_sonar;
  const bool isFirst = ends_[0].pings() + ends_[1].pings() == 0;
  if (!isFirst && (T_map_sonar.translation() - lastObserved_m_).norm() < kSpacing_m) return;
  lastObserved_m_ = T_map_sonar.translation();
  const Aperture nominal(scan);
  std::array<std::vector<double>, 2> beyond_rad;
  for (const PackedReturn& r : scan.returns) {
    if (r.order > 0) continue;
    const double lowest_rad = lowestElevation(scan, nominal, T_map_sonar, r.bearing_rad);
    if (std::min(lowest_rad - nominal.low_rad, nominal.high_rad - lowest_rad) > kAtEnd_rad) continue;
    const bool isHigh = lowest_rad > 0;
    if (const auto beyond = seabedBeyond(profiles_, scan, r, T_map_sonar, isHigh ? 1 : -1))
      beyond_rad[isHigh ? 1 : 0].push_back(*beyond);
  }
  const std::int32_t ix = endsHere_.index(lastObserved_m_.x()), iy = endsHere_.index(lastObserved_m_.y());
  for (std::size_t side = 0; side < ends_.size(); ++side) {
    if (beyond_rad[side].empty()) continue;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        ApertureEnd& here = endsHere_.at(ix + dx, iy + dy)[side];
        if (here.pings() == 0) here = ApertureEnd(options_.edgeSigma_rad);
        here.addPing(beyond_rad[side]);
      }
    ends_[side].addPing(std::move(beyond_rad[side]));
  }
}

void LineScanResolver::addLineScan(const StoredLineScan& scan, const core::Isometry& T_map_vehicle) {
  const core::Isometry T_map_sonar = T_map_vehicle * scan.T_vehicle_sonar;
  const bool isVertical = scan.pose.layer == Layer::LineVertical;
  free_.add(scan, T_map_sonar);
  for (const PackedReturn& r : scan.returns) {
    if (r.order > 0) continue;
    const Eigen::Vector3d p_map = T_map_sonar * pointOf(r, scan.bearingModel);
    // A surface touches the arc tangentially, so that a wrong elevation moves the point along the surface: only range
    // and bearing count for the surface's height.
    const double sigma_m = std::hypot(decodeSigma(r.rangeSigmaCode), r.range_m * scan.bearingSigma_rad);
    if (isVertical) walls_.addWallPoint(p_map);
    if (r.source != ElevationSource::Wall) (isVertical ? profiles_ : swaths_).addSeabedPoint(p_map, sigma_m);
  }
}

void LineScanResolver::resolve(StoredLineScan& scan, const core::Isometry& T_map_vehicle, Pass pass) const {
  const bool isVertical = scan.pose.layer == Layer::LineVertical;
  const SurfaceEvidence &others = isVertical ? swaths_ : profiles_, &own = isVertical ? profiles_ : swaths_;
  Aperture aperture(scan);
  if (scan.pose.layer == Layer::LineHorizontal) {
    const Eigen::Vector3d origin = T_map_vehicle * scan.T_vehicle_sonar.translation();
    SparseGrid<Ends>::Hint hint;
    const Ends* here = endsHere_.find(endsHere_.index(origin.x()), endsHere_.index(origin.y()), hint);
    const auto beyond = [&](std::size_t side) {
      const double survey_rad = ends_[side].beyond_rad();
      return here ? (*here)[side].beyond_rad(survey_rad) : survey_rad;
    };
    aperture.low_rad -= beyond(0);
    aperture.high_rad += beyond(1);
    for (const ApertureEnd& end : ends_)
      if (end.pings() > 0) aperture.sigma_rad = std::max(aperture.sigma_rad, end.sigma_rad());
  }
  PingResolver ping({others, own, walls_, pass == Pass::Final ? &free_ : nullptr}, options_, aperture, scan,
                    T_map_vehicle);
  for (PackedReturn& r : scan.returns) apply(ping.decide(r), scan.bearingSigma_rad, r);
}

void LineScanResolver::setZero(StoredLineScan& scan) {
  Decision zero;
  zero.source = ElevationSource::Zero;
  zero.halfSpread_rad = scan.verticalAperture_rad / std::sqrt(12.0);
  for (PackedReturn& r : scan.returns) apply(zero, scan.bearingSigma_rad, r);
}

}  // namespace s2s::map
