#pragma once

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "s2s/core/trajectory.h"
#include "s2s/map/map_point.h"
#include "s2s/products/colour_ramp.h"

namespace s2s::products {

/// Gathers map points into an MRPT scene: a coloured cloud a layer (named after it), the path, the frame of the map and
/// a grid on the water surface, if there is one. It holds only stock MRPT classes, so that SceneViewer3D needs no
/// plugin.
class SceneBuilder {
 public:
  /// @param stride only every stride-th point is kept
  SceneBuilder(const MapColours& colours, std::uint64_t stride);

  void add(const map::MapPoint& point);
  std::uint64_t kept() const { return kept_; }

  /// @param keyframes drawn as dots
  /// @param waterHeight_m in the map frame; no water surface is drawn when it is not known
  /// @throws core::OutputError
  void write(const std::string& path, const core::Trajectory& trajectory, const core::Trajectory& keyframes,
             std::optional<double> waterHeight_m);

 private:
  MapColours colours_;
  std::uint64_t stride_, offered_ = 0, kept_ = 0;
  std::array<mrpt::opengl::CPointCloudColoured::Ptr, map::kLayers.size()> clouds_;
};

/// Gathers map points into an MRPT `CSimpleMap`: at each keyframe an `mrpt::obs::CObservationPointCloud` of the points
/// measured nearest to it in time, in the vehicle's frame, label "MAP".
class SimpleMapBuilder {
 public:
  /// @param keyframes T_map_vehicle; without any, no point is kept
  SimpleMapBuilder(const core::Trajectory& keyframes, std::uint64_t stride);

  void add(const map::MapPoint& point);

  /// @throws core::OutputError
  void write(const std::string& path) const;

 private:
  core::Trajectory keyframes_;
  std::vector<core::Isometry> T_vehicle_map_;
  std::vector<std::vector<Eigen::Vector3f>> points_vehicle_;
  std::uint64_t stride_, offered_ = 0;
};

/// Largest share that keeps `count` points within `limit`: every how many-th to keep.
inline std::uint64_t strideFor(std::uint64_t count, std::uint64_t limit) {
  return count <= limit ? 1 : (count + limit - 1) / limit;
}

}  // namespace s2s::products
