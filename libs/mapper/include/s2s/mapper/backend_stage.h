#pragma once

#include <functional>

#include "s2s/graph/graph_slam.h"
#include "s2s/map/CSeabedSkyMap.h"
#include "s2s/mapper/acoustic_submaps.h"
#include "s2s/mapper/messages.h"

namespace s2s::mapper {

/// Last stage: the pose graph and the map that hangs on it. Keyframes and sonar scans may come in any interleaving.
class BackendStage {
 public:
  BackendStage(const graph::GraphSlamOptions& graphOptions, const map::MapOptions& mapOptions,
               std::unique_ptr<graph::PriorMap> prior = nullptr);

  void addKeyframe(const KeyframeData& keyframe);
  void addSonarScan(const SonarScan& scan);
  void addGnss(const graph::GnssFix& fix) { graph_.addGnss(fix); }
  /// Optimises with all that is known, moves the map and decides the line-scans' elevations anew.
  void finish();

  const graph::GraphSlam& graph() const { return graph_; }
  const map::CSeabedSkyMap& map() const { return map_; }

 private:
  void moveMap();

  graph::GraphSlam graph_;
  AcousticSubmaps submaps_;
  map::CSeabedSkyMap map_;
};

}  // namespace s2s::mapper
