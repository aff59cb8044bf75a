#pragma once

#include <vector>

namespace s2s::odometry {

/// Which returns of a sweep are looked at.
struct ScanOptions {
  double minRange_m = 1.0;
  double maxRange_m = 150.0;
  /// Every n-th row and column of an organised sweep, or every n-th point of a cloud; 0: as `maxPoints` asks.
  int rowStride = 0;
  int columnStride = 0;
  int maxPoints = 10000;  ///< returns of a sweep that are looked at when the strides are automatic
  /// Box of the vessel itself in its own frame: x, y, z of the least corner, then of the greatest [m]; empty: none.
  std::vector<double> hullBox;
};

/// Error model and limits of the IMU. Densities are continuous-time: a sample of rate f has density * sqrt(f).
struct ImuOptions {
  double gyroNoise_radps_rthz = 1.0e-3;
  double accelNoise_mps2_rthz = 1.0e-2;
  double gyroBiasWalk_radps2_rthz = 2.0e-5;
  double accelBiasWalk_mps3_rthz = 2.0e-4;
  double gyroBiasSigma_radps = 0.01;
  double accelBiasSigma_mps2 = 0.1;
  double gravity_mps2 = 9.81;
  /// Estimate how much later the IMU's time stamps are than the LiDAR's, and how the IMU is turned against what its
  /// mounting says; with the standard deviations to be expected. Both are allowed for, and told when they matter.
  bool estimateTimeOffset = true;
  double timeOffsetSigma_s = 0.02;
  bool estimateMounting = true;
  double mountingSigma_rad = 0.01;
  double maxGap_s = 0.1;  ///< longer silence is bridged with constant velocity and turn rate
};

/// What the vehicle may do where no IMU says what it does: white linear and angular acceleration.
struct MotionOptions {
  double acceleration_mps2_rthz = 0.8;
  double angularAcceleration_radps2_rthz = 0.3;
  double initialSpeedSigma_mps = 3.0;
  double initialTurnRateSigma_radps = 0.2;
};

/// The map of planes that scans are registered to.
struct PlaneMapOptions {
  double voxel_m = 0.4;  ///< edge of the finest voxels; each level above doubles it
  int levels = 3;
  int minPoints = 6;             ///< for a plane
  int maxPoints = 100;           ///< a voxel with this many points is settled and takes no more
  double maxThickness_m = 0.06;  ///< standard deviation across a plane; thicker voxels are left to finer levels
  double radius_m = 200.0;       ///< voxels further from the vehicle are forgotten
  double shapeShare = 0.2;       ///< of a plane's thickness that is shape: more points do not average it out
};

/// Scan-to-map registration.
struct RegistrationOptions {
  double scanVoxel_m = 0.6;        ///< one point in each such cube is registered
  double mapVoxel_m = 0.15;        ///< one point in each such cube enters the map
  double rangeSigma_m = 0.02;      ///< noise of a range
  double angleSigma_rad = 0.5e-3;  ///< noise of a direction; footprint and surface roughness included
  int maxIterations = 12;
  int minMatches = 20;
  double gateSigma = 3.5;  ///< matches further off than this many standard deviations are left out
  double stopTranslation_m = 5.0e-4;
  double stopRotation_rad = 2.0e-5;
  /// This many times what the noise of the map's normals pretends to know is taken off the scan's information; a
  /// direction about which nothing remains is degenerate.
  double degeneracyRatio = 3.0;
  /// Residuals of neighbouring points are not independent: the information counts as that of N / this many.
  double correlation = 4.0;
};

/// Knowledge that the vehicle floats. Where down is, an IMU tells; without one, it is learnt from the heights of the
/// places that the vehicle floats at. Whether there is water, and
/// how high, is not the odometry's alone to know: `rejectBelow`, `height_m` and `margin_m` are set by the application.
struct WaterOptions {
  /// Soft knowledge that the vehicle stays near one height, which may itself change slowly. Between vertical quays
  /// nothing that a LiDAR sees tells the height, and an accelerometer alone loses it within seconds.
  bool heavePrior = true;
  /// Most that the standard deviation of the vehicle's origin about that height may be; the heave itself is learnt.
  double heaveSigma_m = 0.1;
  double heaveTime_s = 1.0;         ///< over which one heave is correlated with the next
  double leanSigma_rad = 0.05;      ///< of the vehicle's z axis about up; only used without an IMU
  double levelWalk_m_rts = 2.0e-3;  ///< random walk of that height: tide, load
  /// Soft knowledge that a displacement hull goes ahead, slowly, and hardly sideways: what keeps the speed bounded over
  /// open water. Standard deviations about zero of the velocity ahead and across.
  bool velocityPrior = true;
  double speedSigma_mps = 2.0;
  double driftSigma_mps = 0.5;  ///< leeway, current, slip in turns
  double speedTime_s = 10.0;    ///< over which one speed is correlated with the next
  double giveUpSigma = 3.0;     ///< if the height stays this far off, the water is taken to have moved (a lock)
  bool rejectBelow = false;     ///< leave out returns below the surface
  double height_m = 0.0;        ///< height of the surface in the vehicle's frame, at rest
  double margin_m = 0.3;        ///< returns this little above the surface are left out, too
};

/// Registration of what the sonars see to a map of its own, after the LiDAR's. Over open water it alone tells how the
/// vehicle moves. Motions that neither sees are left to the IMU.
struct SeabedOptions {
  bool enabled = true;
  /// One level: at a coarser one ripples would pass for a flat seabed, and it is they that tell the motion. The planes'
  /// thickness is the noise of the acoustic points.
  PlaneMapOptions map{0.4, 1, 12, 300, 0.12, 40.0, 0.02};
  double pointVoxel_m = 0.1;   ///< one point in each such cube is used
  double leastSigma_m = 0.04;  ///< no acoustic point is believed better than this
  int minMatches = 40;
  /// Points of one ping share more errors than those of a sweep, and the map was made from the pings just before, at
  /// poses with nearly the same error: a whole scan counts for about one residual.
  double correlation = 300.0;
};

/// Use of the IMU.
enum class ImuUse {
  automatic,  ///< use it if samples come before or within the first second of scans
  never
};

/// All of the odometry.
struct OdometryOptions {
  ImuUse imuUse = ImuUse::automatic;
  /// This much of the record is looked at before the first pose: some of the short waves of sheltered waters, so that
  /// the mean of their accelerations is small.
  double initialisation_s = 6.0;
  double maxImuDelay_s = 0.5;  ///< a scan is not held back longer than this for missing IMU samples
  ScanOptions scan;
  ImuOptions imu;
  MotionOptions motion;
  PlaneMapOptions map;
  RegistrationOptions registration;
  WaterOptions water;
  SeabedOptions seabed;
};

}  // namespace s2s::odometry
