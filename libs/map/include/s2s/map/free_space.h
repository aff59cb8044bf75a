#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "s2s/core/transform.h"
#include "s2s/map/scan.h"
#include "s2s/map/sparse_grid.h"

namespace s2s::map {

/// What pings prove to be free of surfaces: everything within the aperture that is nearer than a beam's first return.
///
/// One ping proves little, since a dim surface in front may have given no echo above the threshold; so a place counts
/// as free only if several pings from different places say so. Pings nearer to each other than `kSpacing_m` look the
/// same way and count as one.
class FreeSpace {
 public:
  void clear();

  /// A ping with its returns; those nearer than `kSpacing_m` to the last one of the same layer are passed over.
  void add(const StoredLineScan& scan, const core::Isometry& T_map_sonar);

  /// True if at least `pings` of them see the place in front of their first return, by `margin_m` and three standard
  /// deviations of its range.
  bool isFree(const Eigen::Vector3d& p_map, double margin_m, int pings) const;

  std::size_t pingCount() const { return pings_.size(); }
  static constexpr double kSpacing_m = 0.3;

 private:
  static constexpr std::size_t kSectors = 128;
  struct Ping {
    Eigen::Matrix3f R_sonar_map = Eigen::Matrix3f::Identity();
    Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< of the sonar in the map
    float aperture_rad = 0, firstBearing_rad = 0, sector_rad = 0;
    obs::BearingModel model = obs::BearingModel::Azimuth;
    /// Up to where each sector is free, in centimetres; 0: not known.
    std::vector<std::uint16_t> free_cm;
  };
  struct Near {
    std::vector<std::uint32_t> pings;
  };

  bool isFreeFor(const Ping& ping, const Eigen::Vector3d& p_map, double margin_m) const;

  std::vector<Ping> pings_;
  SparseGrid<Near> nearby_{8.0};
  std::array<Eigen::Vector3d, kLayers.size()> last_m_{};
  std::array<bool, kLayers.size()> hasLast_{};
};

}  // namespace s2s::map
