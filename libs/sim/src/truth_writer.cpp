#include "s2s/sim/truth_writer.h"

#include <cstdio>

#include "s2s/core/atomic_file.h"
#include "s2s/core/option_table.h"

namespace s2s::sim {

using core::AtomicFile;
using core::Isometry;

namespace {

constexpr double kControlPointSigma_m = 0.011;  // of RTK points as in the paper

void writeTrajectory(const std::string& path, const SimulationOptions& o, const VesselMotion& motion,
                     double duration_s) {
  AtomicFile file(path);
  std::ofstream& out = file.stream();
  out << "# t x y z qx qy qz qw (T_world_vehicle, Unix seconds)\n";
  const auto samples = static_cast<std::int64_t>(duration_s * 100);
  for (std::int64_t i = 0; i <= samples; ++i) {
    const Isometry T = motion.pose(0.01 * static_cast<double>(i));
    const Eigen::Quaterniond q(T.linear());
    const Eigen::Vector3d p = T.translation();
    char line[256];
    std::snprintf(line, sizeof line, " %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                  q.w());
    out << core::formatUnixTime(o.startTime + i * (core::kNsPerSecond / 100)) << line;
  }
  file.commit();
}

template <class T>
void put(std::ofstream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void writeMesh(const std::string& path, const Scene& scene) {
  std::size_t vertices = 0, triangles = 0;
  for (const SceneObject& object : scene.objects) {
    vertices += object.mesh.vertices.size();
    triangles += object.mesh.triangles.size();
  }
  AtomicFile file(path);
  std::ofstream& out = file.stream();
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << triangles
      << "\nproperty list uchar int vertex_indices\nproperty int object\nend_header\n";
  for (const SceneObject& object : scene.objects)
    for (const auto& v : object.mesh.vertices) out.write(reinterpret_cast<const char*>(v.data()), 3 * sizeof(float));
  std::int32_t base = 0;
  for (std::size_t id = 0; id < scene.objects.size(); ++id) {
    for (const auto& t : scene.objects[id].mesh.triangles) {
      put(out, std::uint8_t{3});
      for (const std::uint32_t corner : t) put(out, base + static_cast<std::int32_t>(corner));
      put(out, static_cast<std::int32_t>(id));
    }
    base += static_cast<std::int32_t>(scene.objects[id].mesh.vertices.size());
  }
  file.commit();
}

void writeObjects(const std::string& path, const Scene& scene) {
  std::string text = "id,name,kind,material\n";
  for (std::size_t id = 0; id < scene.objects.size(); ++id) {
    const SceneObject& object = scene.objects[id];
    text += std::to_string(id) + "," + object.name + "," + kindName(object.kind) + "," +
            scene.materials[object.material].name + "\n";
  }
  core::writeTextFile(path, text);
}

void writeExtrinsics(const std::string& path, const SimulationOptions& o) {
  std::string text =
      "// True mountings T_vehicle_sensor: x y z [m] yaw pitch roll [deg], and how far recorded times are late [s]\n";
  const auto add = [&text](const std::string& label, const Isometry& T, const SensorFaults& faults) {
    text += "\n[" + label + "]\npose = " + core::printPose(T) +
            "\ntime_offset_s = " + core::printDouble(faults.timeOffset_s) + "\n";
  };
  add(o.lidar.label, o.lidar.T_vehicle_sensor * o.mountingErrors.lidar, o.faults.lidar);
  add(o.imu.label, o.imu.T_vehicle_imu, o.faults.imu);
  add(o.sonarHorizontal.label, o.sonarHorizontal.T_vehicle_sensor * o.mountingErrors.sonarHorizontal,
      o.faults.sonarHorizontal);
  add(o.sonarVertical.label, o.sonarVertical.T_vehicle_sensor * o.mountingErrors.sonarVertical, o.faults.sonarVertical);
  add(o.gnss.label, o.gnss.T_vehicle_antenna, o.faults.gnss);
  core::writeTextFile(path, text);
}

/// Heights of the bare seabed under the survey as an ESRI ASCII grid, which GDAL and every GIS reads.
void writeSeabedGrid(const std::string& path, const Scene& scene, const VesselMotion& motion, double duration_s) {
  constexpr double kCell_m = 0.25, kMargin_m = 12;
  Eigen::AlignedBox2d box;
  for (int i = 0; 0.5 * i <= duration_s; ++i) box.extend(Eigen::Vector2d(motion.pose(0.5 * i).translation().head<2>()));
  const Eigen::Vector2d min = ((box.min().array() - kMargin_m) / kCell_m).floor() * kCell_m;
  const Eigen::Vector2d max = ((box.max().array() + kMargin_m) / kCell_m).ceil() * kCell_m;
  const auto columns = static_cast<int>(std::lround((max.x() - min.x()) / kCell_m));
  const auto rows = static_cast<int>(std::lround((max.y() - min.y()) / kCell_m));
  AtomicFile file(path);
  std::ofstream& out = file.stream();
  out << "ncols " << columns << "\nnrows " << rows << "\nxllcorner " << min.x() << "\nyllcorner " << min.y()
      << "\ncellsize " << kCell_m << "\nNODATA_value -9999\n";
  for (int row = rows - 1; row >= 0; --row) {  // the format starts in the north
    for (int column = 0; column < columns; ++column) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3f ",
                    scene.seabed.height_m(min.x() + (column + 0.5) * kCell_m, min.y() + (row + 0.5) * kCell_m));
      out << text;
    }
    out << '\n';
  }
  file.commit();
}

/// The vessel's parts in its own frame, with a hand's breadth around them.
Eigen::AlignedBox3d vesselBox(const Scene& scene) {
  constexpr double kMargin_m = 0.1;
  Eigen::AlignedBox3d box;
  for (const SceneObject& part : scene.vesselParts)
    for (const auto& v : part.mesh.vertices) box.extend(v.cast<double>());
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin_m);
  return {box.min() - margin, box.max() + margin};
}

std::string printBox(const Eigen::AlignedBox3d& box) {
  std::string text;
  for (const Eigen::Vector3d& corner : {box.min(), box.max()})
    for (int axis = 0; axis < 3; ++axis)
      text += (text.empty() ? "" : " ") + core::printDouble(std::round(100 * corner[axis]) / 100);
  return text;
}

void writeControlPoints(const std::string& path, const Scene& scene, std::uint64_t seed) {
  Random random(seed, 0x637074);
  std::string text = "id,x,y,z,sigma\n";
  for (const ControlPoint& c : scene.controlPoints) {
    text += c.id;
    for (int axis = 0; axis < 3; ++axis)
      text += "," +
              core::printDouble(std::round(1e4 * (c.position_m[axis] + kControlPointSigma_m * random.normal())) / 1e4);
    text += "," + core::printDouble(kControlPointSigma_m) + "\n";
  }
  core::writeTextFile(path, text);
}

}  // namespace

void writeTruth(const std::string& folder, const Scene& scene, const SimulationOptions& o, const VesselMotion& motion,
                double duration_s) {
  writeTrajectory(folder + "/trajectory.tum", o, motion, duration_s);
  writeMesh(folder + "/world.ply", scene);
  writeObjects(folder + "/objects.csv", scene);
  writeSeabedGrid(folder + "/seabed.asc", scene, motion, duration_s);
  writeExtrinsics(folder + "/extrinsics.ini", o);
  writeControlPoints(folder + "/control_points.csv", scene, o.seed);
}

void writeSurveyIni(const std::string& path, const Scene& scene, const SimulationOptions& o) {
  std::string text =
      "// What a surveyor knows of the vessel that surveyed '" + scene.name +
      "': labels and nominal mountings.\n"
      "// Poses are T_vehicle_sensor: x y z [m] yaw pitch roll [deg]; vehicle: x forward, y left, z up,\n"
      "// origin on the waterline.\n\n[mapper]\n";
  const auto add = [&text](const std::string& sensor, const std::string& label, const Isometry& T) {
    text += "label_" + sensor + " = " + label + "\npose_" + sensor + " = " + core::printPose(T) + "\n";
  };
  add("lidar", o.lidar.label, o.lidar.T_vehicle_sensor);
  add("imu", o.imu.label, o.imu.T_vehicle_imu);
  add("sonar_horizontal", o.sonarHorizontal.label, o.sonarHorizontal.T_vehicle_sensor);
  add("sonar_vertical", o.sonarVertical.label, o.sonarVertical.T_vehicle_sensor);
  add("gnss", o.gnss.label, o.gnss.T_vehicle_antenna);
  if (!scene.vesselParts.empty())
    text += "\n[odometry]\n// Box around the vessel's own parts, as a tape measure gives it.\nhull_box = " +
            printBox(vesselBox(scene)) + "\n";
  core::writeTextFile(path, text);
}

}  // namespace s2s::sim
