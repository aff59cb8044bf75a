#pragma once

#include <string>

#include "s2s/core/transform.h"
#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::sim {

enum class BeamSpacing {
  UniformSine,  ///< uniform in the sine of the bearing, as a straight array's beams are (Oculus)
  UniformAngle  ///< uniform in the bearing (BlueView)
};

enum class ElevationPattern {
  Rectangle,  ///< one inside the aperture, nothing outside: the textbook's wedge
  Sinc,       ///< a uniform line element across the plane whose -3 dB width is the aperture, with side lobes
  Shaped      ///< a shaded element: flat inside the aperture, steep at its edge, low side lobes
};

/// What electronics and the other sonar add; levels are in dB over the receiver's noise.
struct SonarArtefacts {
  bool rowLeak = true;      ///< a share of each row's power appears on all its beams: side-lobe floor, coupling
  double rowLeak_db = -38;  ///< of the row's mean
  bool ringDown = true;     ///< the transducer's own ringing
  double ringDown_db = 55, ringDownDecay_dbPerM = 120;
  bool banding = true;  ///< gain steps between groups of rows
  int bandRows = 32;
  double bandSigma_db = 0.6;
  bool streaks = true;  ///< noise over groups of neighbouring beams in single rows
  double streaksPerPing = 25, streakBeams = 30, streak_db = 8;
  bool centreHaze = false;  ///< weak noise over the central beams at all ranges
  double centreHaze_db = 6, centreWidth_rad = 5 * M_PI / 180;
  bool crossTalk = true;  ///< the other sonar's transmission, in this share of the pings in which it falls
  double crossTalkShare = 0.15, crossTalk_db = 22;
  double otherRate_hz = 0, otherOffset_s = 0;  ///< the other sonar's schedule; set by the simulator
};

/// One imaging sonar: device, mounting and physics. Defaults: Oculus M750d at 750 kHz.
struct SonarOptions {
  bool enabled = true;
  std::string label = "SONAR_HORIZONTAL";
  std::string model = "Oculus M750d";
  core::Isometry T_vehicle_sensor = core::isometryFromXyzYpr(-1.10, 0, -0.45, 0, M_PI / 4, 0);  ///< nominal
  double rate_hz = 15;
  double startOffset_s = 0.013;  ///< of the first ping after the survey's start

  // Geometry
  int beamCount = 512;
  double fan_rad = 130 * M_PI / 180;
  BeamSpacing spacing = BeamSpacing::UniformSine;
  double aperture_rad = 20 * M_PI / 180;
  obs::BearingModel bearingModel = obs::BearingModel::Azimuth;
  int rangeCount = 700;
  double maxRange_m = 10;

  // Resolution of the casting
  int elevationRays = 64;  ///< per beam, over the pattern's extent

  // Beam patterns
  ElevationPattern elevationPattern = ElevationPattern::Shaped;
  double elevationSideLobe_db = -20;        ///< one way, for the shaped pattern
  double beamWidth_rad = 1.0 * M_PI / 180;  ///< -3 dB width of a beam in bearing at the fan's centre
  double taper = 0.75;          ///< shading of the array, 1: none (-13 dB side lobes), 0.54: Hamming (-43 dB)
  bool beamPattern = true;      ///< false: beams are infinitely narrow
  double pulseLength_m = 0.03;  ///< -6 dB length of the pulse in range after matched filtering; 0: none

  // Active sonar equation
  double frequency_hz = 750e3;
  double sourceLevel_db = 195;      ///< re 1 uPa at 1 m
  double absorption_dbPerM = 0.17;  ///< one way
  bool spreading = true, absorption = true;
  bool texture = true;                           ///< patches of the world that scatter more or less than their material
  double texture_db = 3, textureLength_m = 0.2;  ///< standard deviation and largest wavelength
  bool volume = true;                            ///< backscatter of the water itself
  double volumeBackscatter_db = -88;             ///< per cubic metre
  bool multipath = true;                         ///< echoes by way of the water surface
  double surfaceLoss_db = 3;                     ///< of the surface, a bounce
  double noiseLevel_db = 80;                     ///< of a pixel, after beam forming and matched filtering
  bool noise = true;
  bool speckle = true;
  int looks = 1;            ///< independent looks whose powers are averaged
  double blanking_m = 0.3;  ///< nothing is recorded nearer than this

  // Receiver
  double gain_db = -138;               ///< amplitude of 1 after this gain is full scale
  double tvgSpreading_db = 30;         ///< per decade of range
  double tvgAbsorption_dbPerM = 0.34;  ///< two way
  double gamma = 0.5;                  ///< sample = full scale * amplitude^gamma, as the device compresses

  SonarArtefacts artefacts;

  // What differs between the world and the device's belief
  double soundSpeed_mps = 1480;         ///< the true one
  double soundSpeedAssumed_mps = 1480;  ///< by which the device turns time into range
};

/// A BlueView M900-2250 at 2250 kHz, mounted below and beside the horizontal sonar and rolled by 90 degrees.
SonarOptions verticalSonarDefaults();

}  // namespace s2s::sim
