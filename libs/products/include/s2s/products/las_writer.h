#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "s2s/core/atomic_file.h"
#include "s2s/map/map_point.h"

namespace s2s::products {

/// What has to be known of the points before the first is written.
struct LasFrame {
  /// Subtracted from the coordinates, which are then stored as whole millimetres in 32 bits; near the data's middle.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  /// Factor from a layer's intensity to the 16 bits of LAS, by map::Layer (see `lasIntensityFactor`).
  std::array<double, 4> intensityFactor = {1, 1, 1, 1};
  /// Goes into the header as the day of creation, so that the same survey gives the same bytes.
  core::TimeNs surveyTime = 0;
};

/// LAS spreads the sensor's dynamic range over 16 bits: 65535 for intensities up to 1, 65535/255 up to 255, else 1.
double lasIntensityFactor(double largestIntensity);

/// Writes map points as ASPRS LAS 1.4-R15, point format 6 with one extra value a point, one at a time.
///
/// Scale 0.001 m; local engineering reference as WKT; GPS time is adjusted standard GPS time (UTC with the leap seconds
/// of its day); classification 1 (unclassified) for LiDAR and 40 (bathymetric point) for the sonar layers; user data
/// holds the map::Layer; the extra bytes `sigma` (float, metres) the standard deviation of the position.
class LasWriter {
 public:
  static constexpr double kScale_m = 0.001;

  /// @throws core::OutputError if the file cannot be opened
  LasWriter(const std::string& path, const LasFrame& frame);

  /// A point that is not finite or more than 2147 km from the offset has no place in the format: it is left out and
  /// `false` returned.
  bool add(const map::MapPoint& point);
  std::uint64_t count() const { return count_; }

  /// Writes the header with count and bounds, and gives the file its name.
  /// @throws core::OutputError if writing failed
  void finish();

 private:
  std::vector<char> header() const;
  void flush();

  core::AtomicFile file_;
  LasFrame frame_;
  std::string wkt_;
  std::uint64_t count_ = 0;
  Eigen::Array<std::int32_t, 3, 1> min_, max_;
  std::vector<char> buffer_;
};

}  // namespace s2s::products
