#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace s2s::products {

/// A point of a PLY file. A property that the file lacks is zero.
struct PlyPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< metres, in the file's frame
  float intensity = 0;
  float sigma_m = 0;
  double time_s = 0;  ///< Unix seconds
  int layer = 0;
  int source = 0;  ///< of `walls.ply`: 0 LiDAR, 1 sonar
};

/// A point cloud or a triangle mesh.
struct PlyMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< polygons are cut into fans; empty for a cloud
  std::vector<std::int32_t> object;                     ///< of each triangle; empty if the faces have no such property
};

/// Reads the vertices of a PLY file one after the other: ASCII, binary little-endian or big-endian, any number type,
/// any further properties. Returns how many there were.
/// @throws core::InputError with file and line or byte if it is missing, no PLY file, damaged or cut short
std::size_t forEachPlyPoint(const std::string& path, const std::function<void(const PlyPoint&)>& visit);

/// All vertices at once.
std::vector<PlyPoint> readPlyPoints(const std::string& path);

/// Vertices and faces (`vertex_indices` or `vertex_index`, further face properties are allowed; `object` is kept).
/// @throws core::InputError as above, or if a face names a vertex that does not exist
PlyMesh readPlyMesh(const std::string& path);

}  // namespace s2s::products
