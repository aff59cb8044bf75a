#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace s2s::sim {

/// A Gaussian pit (scour, negative height) or mound on the seabed.
struct SeabedFeature {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double radius_m = 2;  ///< standard deviation of the bell
  double height_m = -0.5;
};

struct SeabedOptions {
  double height_m = -3.5;         ///< mean height at the origin; the water surface is 0
  double slopeX = 0, slopeY = 0;  ///< rise over run
  double channelDepth_m = 0;      ///< additional depth along the line y = 0 ...
  double channelHalfWidth_m = 8;  ///< ... falling off as a bell of this width
  double rippleHeight_m = 0;      ///< crest to trough
  double rippleLength_m = 1;
  double rippleDirection_rad = 0;  ///< direction of the ripples' travel
  double roughness_m = 0;          ///< standard deviation of the large-scale relief
  double roughnessLength_m = 4;    ///< its largest wavelength; four octaves
};

/// Height of the seabed as a function of position: slope, channel, ripples, fractal relief, pits and mounds.
class SeabedField {
 public:
  SeabedField() = default;
  SeabedField(const SeabedOptions& options, std::vector<SeabedFeature> features, std::uint64_t seed)
      : options_(options), features_(std::move(features)), seed_(seed) {}

  /// World height in metres, positive up.
  double height_m(double x, double y) const;

 private:
  SeabedOptions options_;
  std::vector<SeabedFeature> features_;
  std::uint64_t seed_ = 0;
};

/// Fractal value noise with zero mean and about unit standard deviation: `octaves` layers, each of half the wavelength
/// and half the amplitude of the one before; the first has wavelength 1.
double fractalNoise(std::uint64_t key, double x, double y, int octaves);

}  // namespace s2s::sim
