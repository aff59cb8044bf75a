#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "s2s/graph/acoustic_submap.h"
#include "s2s/graph/sonar_factors.h"
#include "s2s/map/line_scan_resolver.h"
#include "s2s/mapper/messages.h"

namespace s2s::mapper {

/// Puts what the sonars see along each few metres of path together, for the pose graph.
///
/// Elevations of the horizontal sonar's line-scans are decided by what both sonars saw on the same piece of path only.
/// The map knows more, but what it learnt on earlier passes would make the new points agree with the old ones. Returns
/// within the other sonar's aperture are left out: they are the echoes that the stereo points are made of.
class AcousticSubmaps {
 public:
  AcousticSubmaps(const graph::SonarFactorOptions& options, const map::ResolverOptions& resolver);

  /// Takes a scan, in about the order of time (the sonars' scans may be some tenths of a second apart).
  /// @return the submap that ends before this scan, if one does
  std::optional<graph::AcousticSubmap> add(const SonarScan& scan);
  /// The last submap, if the vessel went far enough for one.
  std::optional<graph::AcousticSubmap> finish();

 private:
  bool isComplete(const SonarScan& next) const;
  std::optional<graph::AcousticSubmap> build();
  void addStereo(const core::Isometry& T_middle_odom, graph::AcousticSubmap& submap) const;
  void addSwath(const core::Isometry& T_middle_odom, graph::AcousticSubmap& submap);

  graph::SonarFactorOptions options_;
  map::ResolverOptions resolverOptions_;
  std::vector<SonarScan> scans_;
};

}  // namespace s2s::mapper
