#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "calibration_problem.h"
#include "s2s/calib/evidence.h"

namespace s2s::calib {

/// Finds the ends of the horizontal sonar's aperture on a bed of known heights.
///
/// Pings of some seconds and beams of a sector are averaged over elevation, each sample at the elevation at which its
/// range meets the bed. An end is where such a profile crosses the middle between the levels on its own two sides. Both
/// ends are found in the same way, so what makes one appear further out does so to the other, and their middle is the
/// sonar's axis.
class ApertureAssociation {
 public:
  ApertureAssociation(const CalibrationEvidence& evidence, const CalibrationOptions& options)
      : evidence_(evidence), options_(options) {}

  /// One place at which an end meets the bed; several stand for a profile.
  struct End {
    UsedEcho used;
    core::TimeNs time = 0;
    double off_rad = 0;       ///< outward from where the present state has this end
    double rise_mPerRad = 1;  ///< height over the bed by elevation
  };

  /// @param known where the bed's height does not rest on the horizontal sonar alone
  void update(const CalibrationState& state, const SeabedGrid& grid, const SeabedGrid& known);

  const std::vector<End>& ends() const { return ends_; }
  std::size_t leftOut() const { return leftOut_; }  ///< profiles

 private:
  /// A group of beams of a ping that takes part in a profile.
  struct Member {
    const PingMotion* motion = nullptr;
    core::TimeNs time = 0;
    float bearing_rad = 0;
    std::vector<float> ranges_m;  ///< at which the bed is met, a value each kAnchorStep
  };
  struct Profile {
    std::vector<double> sum;  ///< of strengths by elevation, outward
    std::vector<Member> members;
  };
  struct Frame;
  void add(const AperturePing& ping, const PingMotion& motion, const Frame& frame);
  bool addStrip(const AperturePing& ping, const AperturePing::Strip& strip, Member member, float end,
                const Frame& frame, Profile& profile) const;
  void findEnd(const Profile& profile, float end, const Frame& frame);

  const CalibrationEvidence& evidence_;
  const CalibrationOptions& options_;
  std::vector<std::unique_ptr<PingMotion>> motions_;
  std::map<std::tuple<int, int, int>, Profile> profiles_;  ///< by block of time, sector, end
  std::vector<End> ends_;
  std::size_t leftOut_ = 0;
};

}  // namespace s2s::calib
