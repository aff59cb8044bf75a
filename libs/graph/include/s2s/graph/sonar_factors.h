#pragma once

namespace s2s::graph {

/// Registration of one acoustic submap to another.
struct AcousticRegistrationOptions {
  double voxel_m = 0.2;       ///< thinning of both submaps
  int normalNeighbours = 16;  ///< target points that define a plane: as wide as the noise needs, narrower than ripples
  double coarsePartner_m = 0.8;  ///< largest distance of partners in the first iterations
  double finePartner_m = 0.3;    ///< and in the last
  int maxIterations = 30;
  double lossWidth = 2.5;      ///< width of the robust weight (Geman-McClure) in standard deviations
  double leastSigma_m = 0.02;  ///< no point is believed better than this
  int minPoints = 80;          ///< of the source that lie where the target has points
  double minOverlap = 0.6;     ///< share of these that find a partner
  double maxChi2 = 3.0;        ///< largest mean square of the residuals over their variances
  /// This many times what the noise of the normals pretends to know is taken off the information; see
  /// odometry::removePretended.
  double degeneracyRatio = 3;
  /// More directions (of six) without information than this, and the seabed tells too little. A flat one hides three.
  int maxDegenerate = 3;
  /// Points that count as one independent measurement: those of a ping share its errors.
  double correlatedPoints = 20;
  /// Standard deviations added to a factor's covariance, in the source's axes: errors that submaps share. Those along
  /// the seabed and of the heading are wide: where the odometry holds at all it knows these better than swaths do.
  double floorHorizontal_m = 3.0, floorHeight_m = 0.03;
  double floorTilt_rad = 0.01, floorYaw_rad = 0.5;
  /// Where the odometry leaves more room than half of it, the registration starts from several places so far apart, and
  /// a seabed that fits in two of them (ripples) is refused.
  double startSpacing_m = 0.5;
  double ambiguousRatio = 1.3;  ///< a second fit whose cost is below this times the best one's is as good
};

/// Factors between places that the sonars saw twice.
struct SonarFactorOptions {
  bool enabled = true;
  double submap_m = 3.0;         ///< path that makes up a submap; each point is in one submap only
  double maxSubmap_s = 15.0;     ///< a slower vessel's submap ends after this
  double minTravel_m = 15.0;     ///< path between the two submaps of a factor
  double radius_m = 15.0;        ///< largest distance of two submaps
  double cell_m = 0.5;           ///< edge of the cells in which overlap is measured
  double minOverlap_m2 = 4.0;    ///< smallest common area
  int passes = 2;                ///< earlier passes that a submap is registered to
  double joined_m = 4.0;         ///< path on either side of an earlier submap whose points join it as target
  double correlatedFactors = 4;  ///< neighbouring factors that count as one: what swaths get wrong lasts
  /// How far away the odometry remembers the seabed. Until the vessel has been further away, the odometry itself has
  /// compared stereo points with the earlier ones, and a factor must not count them again. 0: it does not use them.
  double odometryMemory_m = 50.0;
  AcousticRegistrationOptions registration;
};

}  // namespace s2s::graph
