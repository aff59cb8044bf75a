#pragma once

#include <cmath>
#include <fstream>
#include <random>

#include "s2s/core/trajectory.h"
#include "s2s/products/grid_files.h"
#include "s2s/products/ply_writer.h"
#include "s2s/products/trajectory_files.h"
#include "scratch_folder.h"
#include "test_meshes.h"

namespace s2s::eval {

/// A small true world and a map of it made from the truth itself, written as the two folders that `truth` compares:
/// a sloping seabed of 40 m x 40 m, a quay along y = 20 that stands on it, and a box of 1 m x 2 m x 0.6 m on the
/// seabed. The map's frame is turned and shifted against the world's.
class SampleSurvey {
 public:
  static constexpr int kSeabed = 0, kQuay = 1, kBox = 2;

  explicit SampleSurvey(const ScratchFolder& folder) : folder_(folder) {
    addTerrain(mesh_, -20, 20, -20, 20, 1, seabedHeight, kSeabed);
    addBox(mesh_, {-20, 20, -6}, {20, 22, 3}, kQuay);
    addBox(mesh_, {4, 4, seabedHeight(4, 4) - 0.5}, {5, 6, kBoxTop}, kBox);
  }

  static double seabedHeight(double x, double) { return -4 + 0.02 * x; }
  static constexpr double kBoxTop = -3.3;
  static core::Isometry T_map_world() { return core::isometryFromXyzYpr(130, -45, -0.7, 2.2, 0, 0); }

  std::string truth() const { return folder_.path("truth"); }
  std::string out() const { return folder_.path("out"); }

  void writeTruth() const {
    folder_.write("truth/objects.csv",
                  "id,name,kind,material\n0,bed,seabed,sand\n1,quay,wall,stone\n2,chest,object,steel\n");
    products::writeTum(folder_.path("truth/trajectory.tum"), path(0.01));
    writeMesh(folder_.path("truth/world.ply"));
  }

  /// The whole map: trajectories, two layers on the true surfaces moved by `shift_m` upwards, seabed grid.
  void writeMap(double shift_m) const {
    core::Trajectory trajectory;
    const core::Trajectory world = path(0.1);
    for (const auto& pose : world.poses()) trajectory.append(pose.time, T_map_world() * pose.T);
    folder_.write("out/summary.json", "{\"water_height_m\": -0.7}");
    products::writeTum(folder_.path("out/trajectory.tum"), trajectory);
    products::writeTum(folder_.path("out/odometry.tum"), trajectory);
    writeLayers(shift_m);
    writeGrid(shift_m);
  }

 private:
  /// An eight of 10 m half length at about 1 m/s, rolling a little.
  static core::Trajectory path(double step_s) {
    core::Trajectory trajectory;
    for (int i = 0; i * step_s <= 60; ++i) {
      const double t = i * step_s, phase = 2 * M_PI * t / 60;
      trajectory.append(
          1'733'400'000 * core::kNsPerSecond + core::durationNs(t),
          core::isometryFromXyzYpr(10 * std::sin(phase), 5 * std::sin(2 * phase), 0, phase, 0, 0.05 * std::sin(t)));
    }
    return trajectory;
  }

  void writeMesh(const std::string& path) const {
    std::ofstream out(path);
    out.precision(12);
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh_.vertices.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh_.triangles.size()
        << "\nproperty list uchar int vertex_indices\nproperty int object\nend_header\n";
    for (const auto& v : mesh_.vertices) out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      out << "3 " << mesh_.triangles[i][0] << ' ' << mesh_.triangles[i][1] << ' ' << mesh_.triangles[i][2] << ' '
          << mesh_.object[i] << '\n';
  }

  void writeLayers(double shift_m) const {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    products::PlyPointWriter lidar(folder_.path("out/lidar.ply")), stereo(folder_.path("out/stereo.ply"));
    products::PlyPointWriter line(folder_.path("out/line_horizontal.ply"));
    const auto add = [&](products::PlyPointWriter& writer, double x, double y, double z) {
      map::MapPoint point;
      point.p_map = T_map_world() * Eigen::Vector3d(x, y, z + shift_m);
      writer.add(point);
    };
    for (int i = 0; i < 4000; ++i) {
      const double x = -20 + 40 * unit(random), y = -19 + 38 * unit(random);
      add(lidar, x, 20, 0.2 + 2 * unit(random));
      add(line, x, 20, -3 + 2 * unit(random));
      const bool onBox = x > 4 && x < 5 && y > 4 && y < 6;
      add(stereo, x, y, onBox ? kBoxTop : seabedHeight(x, y));
    }
    for (int i = 0; i < 50; ++i) add(stereo, 4.02 + 0.96 * unit(random), 4.02 + 1.96 * unit(random), kBoxTop);
    lidar.finish();
    stereo.finish();
    line.finish();
  }

  /// Cells whose middle lies on the bare seabed, all but 2 m along the edges and 1.5 m about the box.
  void writeGrid(double shift_m) const {
    products::HeightGrid grid(70, -105, 0.5, 240, 240);
    const core::Isometry T_world_map = T_map_world().inverse();
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const Eigen::Vector2d centre = grid.centre(column, row);
        const Eigen::Vector3d p = T_world_map * Eigen::Vector3d(centre.x(), centre.y(), 0);
        if (std::abs(p.x()) > 18 || std::abs(p.y()) > 18) continue;
        if (p.x() > 2.5 && p.x() < 6.5 && p.y() > 2.5 && p.y() < 7.5) continue;
        const std::size_t index = grid.index(column, row);
        grid.height_m[index] =
            static_cast<float>(seabedHeight(p.x(), p.y()) + shift_m + T_map_world().translation().z());
        grid.sigma_m[index] = 0.06F;
        grid.count[index] = 9;
      }
    products::writeGeoTiff(folder_.path("out/seabed.tif"), grid);
  }

  const ScratchFolder& folder_;
  products::PlyMesh mesh_;
};

}  // namespace s2s::eval
