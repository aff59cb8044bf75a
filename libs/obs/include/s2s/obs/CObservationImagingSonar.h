#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <string>
#include <vector>

namespace s2s::obs {

/// What the bearing of a beam measures for a return at p = (x, y, z) in the sonar's frame.
enum class BearingModel : std::uint8_t {
  Azimuth = 0,  ///< a half-plane of constant azimuth: tan(bearing) = y / x (the paper's model)
  Cone = 1      ///< the cone around the array's axis that a straight array measures: sin(bearing) = y / |p|
};

/// One ping of a forward-looking imaging sonar: a beam-range image.
///
/// Frame: x along the central beam, the imaging plane is xy, bearings are positive toward +y (to port for a sonar
/// mounted upright). A vertically mounted sonar is the same device rolled by 90 degrees in its `sensorPose`.
/// Returns come from anywhere within the vertical aperture, +-`verticalAperture_rad`/2 around the imaging plane.
///
/// `timestamp` is the time of transmission (UTC). `sensorPose` is T_vehicle_sensor.
class CObservationImagingSonar : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(CObservationImagingSonar, s2s::obs)

 public:
  std::string sensorModel;  ///< e.g. "Oculus M750d"; free text
  mrpt::poses::CPose3D sensorPose;

  std::uint32_t beamCount = 0;
  std::uint32_t rangeCount = 0;
  std::uint8_t bytesPerSample = 1;  ///< 1, 2, 3 or 4, little-endian
  /// The echo strengths as the device gave them: `rangeCount` rows of `beamCount` samples.
  std::vector<std::uint8_t> samples;
  /// Gain of each row as the device gave it; empty, or `rangeCount` values.
  std::vector<std::uint32_t> rowGains;

  std::vector<float> bearings_rad;  ///< one a beam, strictly monotonic (rising or falling)
  double rangeOffset_m = 0;         ///< range of the near edge of the first range bin
  double rangeResolution_m = 0;     ///< length of a range bin
  double verticalAperture_rad = 0;  ///< full opening angle across the imaging plane
  BearingModel bearingModel = BearingModel::Azimuth;
  double soundSpeed_mps = 0;  ///< the sound speed by which the device turned time into range; 0 if unknown
  double frequency_hz = 0;    ///< 0 if unknown
  double gain_percent = -1;   ///< receiver gain setting; negative if unknown
  std::uint32_t pingId = 0;   ///< the device's own counter; 0 if it has none
  double deviceTime_s = -1;   ///< the device's own clock; negative if it gave none

  /// Range of the centre of a bin, in metres.
  double binRange_m(std::size_t bin) const {
    return rangeOffset_m + (static_cast<double>(bin) + 0.5) * rangeResolution_m;
  }
  double maxRange_m() const { return rangeOffset_m + rangeCount * rangeResolution_m; }

  /// The sample at a range bin and beam. No bounds check.
  std::uint32_t sample(std::size_t bin, std::size_t beam) const;
  /// Largest value a sample can take.
  std::uint32_t maxSample() const;

  /// @throws core::InputError naming the first field whose size or value contradicts the others
  void checkConsistent() const;

  void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensorPose; }
  void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensorPose = pose; }
  void getDescriptionAsText(std::ostream& o) const override;

  /// One line a ping: the geometry, then each beam's range of strongest echo (m).
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  std::string exportTxtDataRow() const override;

  /// The ping as a textured fan in its imaging plane, in the vehicle's frame.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const override;
};

}  // namespace s2s::obs
