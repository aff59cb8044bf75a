#pragma once

#include <array>
#include <string>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::calib {

/// Which of the two sonars; also the index into arrays.
enum class SonarId : std::uint8_t { Horizontal = 0, Vertical = 1 };
constexpr std::array<SonarId, 2> kSonars = {SonarId::Horizontal, SonarId::Vertical};
const char* sonarName(SonarId id);

/// What is estimated of one sonar, as corrections to the nominal values, in this order.
enum SonarParameter : int {
  kX = 0,  ///< [m] of the mounting, along the vehicle's axes
  kY = 1,
  kZ = 2,
  kRotX = 3,        ///< [rad] rotation vector in the sonar's frame, from the right: about the central beam,
  kRotY = 4,        ///< about the imaging plane's other axis (moves the plane up and down),
  kRotZ = 5,        ///< about the plane's normal (turns the bearings)
  kTime = 6,        ///< [s] recorded time less true time
  kNear = 7,        ///< [rad] how far the aperture reaches beyond half its nominal width, on the near edge of the band;
                    ///< of an upright plane: elevation of the middle of its aperture
  kFar = 8,         ///< [rad] the same on the far edge
  kNearBend = 9,    ///< [rad] more of it at a bearing of one radian, growing with the bearing's square, near edge
  kFarBend = 10,    ///< [rad] the same on the far edge
  kRange = 11,      ///< [m] measured less true range
  kScale = 12,      ///< share of the range by which it is measured too long, beyond what the sound speed explains
  kRangeTilt = 13,  ///< [m/rad] range error that grows with bearing
  kRangeBend = 14,  ///< [m/rad^2] and with its square
  kTextureTilt = 15,  ///< [m/rad] how much higher the bed is that texture shows, growing with elevation: presumably
                      ///< crests count for more at grazing incidence
  kWidth = 16,        ///< [rad] how far the ends of the aperture, from averaged profiles, lie beyond its nominal width
  kWidthBend = 17,    ///< [rad] more of it at a bearing of one radian, growing with the bearing's square
  kAxis = 18,         ///< [rad] elevation of their middle
};
constexpr int kSonarParameters = 19;
/// Those before this one are wanted; the rest are nuisances.
constexpr int kWantedSonarParameters = 7;
using SonarVector = std::array<double, kSonarParameters>;

/// One sonar: what is known of it, and its present estimate.
struct SonarState {
  core::Isometry T_vehicle_sonar = core::Isometry::Identity();  ///< nominal
  double timeOffset_s = 0;                                      ///< nominal
  double aperture_rad = 0;
  obs::BearingModel model = obs::BearingModel::Azimuth;
  double deviceSoundSpeed_mps = 0;  ///< by which the device turned time into range
  SonarVector correction{};

  /// T_vehicle_sonar with the correction in it.
  core::Isometry corrected() const;
  double correctedTimeOffset_s() const { return timeOffset_s + correction[kTime]; }
};

/// Everything that is estimated, seabed apart.
struct CalibrationState {
  std::array<SonarState, 2> sonars;
  double soundSpeed_mps = 1480;
  double nominalSoundSpeed_mps = 1480;

  SonarState& operator[](SonarId id) { return sonars[static_cast<std::size_t>(id)]; }
  const SonarState& operator[](SonarId id) const { return sonars[static_cast<std::size_t>(id)]; }
};

}  // namespace s2s::calib
