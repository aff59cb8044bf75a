#include "kitti_scans.h"

#include <cstring>
#include <fstream>

namespace s2s::odometry::kitti {

std::vector<Eigen::Vector3f> readBinaryPcd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::size_t count = 0, floats = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    if (key == "FIELDS")
      while (words >> word) ++floats;
    if (key == "POINTS") words >> count;
    if (key == "DATA") break;
  }
  std::vector<float> values(count * floats);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  if (!file) return {};
  std::vector<Eigen::Vector3f> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(&values[i * floats]);
  return points;
}

std::vector<core::Isometry> readPoses(const std::string& path) {
  std::ifstream file(path);
  std::vector<core::Isometry> poses;
  core::Isometry T = core::Isometry::Identity();
  while (true) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) file >> T.matrix()(r, c);
    if (!file) return poses;
    poses.push_back(T);
  }
}

}  // namespace s2s::odometry::kitti
