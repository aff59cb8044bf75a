#include "s2s/products/wall_files.h"

#include "little_endian.h"
#include "s2s/core/atomic_file.h"

namespace s2s::products {

namespace {

std::string header(std::size_t count) {
  return "ply\nformat binary_little_endian 1.0\n"
         "comment Seabed-to-Sky; faces of walls; map frame, metres, z up; source 0 LiDAR, 1 sonar\n"
         "element vertex " +
         std::to_string(count) +
         "\nproperty double x\nproperty double y\nproperty double z\n"
         "property float nx\nproperty float ny\nproperty float nz\n"
         "property float offset\nproperty float sigma\nproperty uint count\nproperty uchar source\nend_header\n";
}

}  // namespace

std::vector<map::WallEstimator::Cell> wallCells(const map::WallEstimator& walls) {
  std::vector<map::WallEstimator::Cell> cells;
  walls.forEachCell([&](const map::WallEstimator::Cell& cell) { cells.push_back(cell); });
  return cells;
}

WallStatistics wallStatistics(const std::vector<map::WallEstimator::Cell>& cells, double cell_m) {
  WallStatistics statistics;
  for (const auto& cell : cells) (cell.bySonar ? statistics.sonarArea_m2 : statistics.lidarArea_m2) += cell_m * cell_m;
  return statistics;
}

void writeWallPly(const std::string& path, const std::vector<map::WallEstimator::Cell>& cells) {
  std::vector<char> bytes;
  for (const auto& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) appendBytes(bytes, cell.p_map[axis]);
    appendBytes(bytes, static_cast<float>(cell.outward_map.x()));
    appendBytes(bytes, static_cast<float>(cell.outward_map.y()));
    appendBytes(bytes, 0.0f);
    appendBytes(bytes, static_cast<float>(cell.offset_m));
    appendBytes(bytes, static_cast<float>(cell.sigma_m));
    appendBytes(bytes, cell.count);
    appendBytes(bytes, static_cast<std::uint8_t>(cell.bySonar ? 1 : 0));
  }
  core::AtomicFile file(path);
  file.stream() << header(cells.size());
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace s2s::products
