#include <filesystem>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/mrpt_network.h"

namespace s2s::graph {

namespace {

void writeUpperTriangle(std::ostream& out, const core::Matrix6& information) {
  for (int r = 0; r < 6; ++r)
    for (int c = r; c < 6; ++c) out << ' ' << information(r, c);
}

void writeTranslation(std::ostream& out, const core::Isometry& T) {
  for (const double value : T.translation()) out << ' ' << value;
}

void writeQuaternionPose(std::ostream& out, const core::Isometry& T) {
  writeTranslation(out, T);
  Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  for (const double value : q.coeffs()) out << ' ' << value;
}

void writeAnglePose(std::ostream& out, const core::Isometry& T) {
  const Eigen::Matrix3d R = T.linear();
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  writeTranslation(out, T);
  out << ' ' << roll << ' ' << pitch << ' ' << yaw;
}

core::Matrix6 toQuaternionPart(core::Matrix6 information) {
  information.topRightCorner<3, 3>() *= 2;
  information.bottomLeftCorner<3, 3>() *= 2;
  information.bottomRightCorner<3, 3>() *= 4;
  return information;
}

core::Matrix6 swapYawAndRoll(const core::Matrix6& information) {
  Eigen::PermutationMatrix<6> swap;
  swap.indices() << 0, 1, 2, 5, 4, 3;
  return swap * information * swap;
}

std::ostream& openExact(core::AtomicFile& file) {
  file.stream().precision(17);
  return file.stream();
}

void writeFixes(std::ostream& out, const PoseGraph& graph) {
  for (const auto& node : graph.nodes)
    if (node.fixed) out << "FIX " << node.id << '\n';
}

}  // namespace

void writeG2o(const std::string& path, const PoseGraph& graph, G2oRotation rotation) {
  core::AtomicFile file(path);
  std::ostream& out = openExact(file);
  for (const auto& node : graph.nodes) {
    out << "VERTEX_SE3:QUAT " << node.id;
    writeQuaternionPose(out, node.T_map_node);
    out << '\n';
  }
  writeFixes(out, graph);
  for (const auto& constraint : graph.constraints) {
    out << "EDGE_SE3:QUAT " << constraint.from << ' ' << constraint.to;
    writeQuaternionPose(out, constraint.T_from_to);
    writeUpperTriangle(
        out, rotation == G2oRotation::quaternion ? toQuaternionPart(constraint.information) : constraint.information);
    out << '\n';
  }
  file.commit();
}

void writeMrptGraph(const std::string& path, const PoseGraph& graph) {
  core::AtomicFile file(path);
  std::ostream& out = openExact(file);
  for (const auto& node : graph.nodes) {
    out << "VERTEX3 " << node.id;
    writeAnglePose(out, node.T_map_node);
    out << '\n';
  }
  writeFixes(out, graph);
  for (const auto& constraint : graph.constraints) {
    out << "EDGE3 " << constraint.from << ' ' << constraint.to;
    writeAnglePose(out, constraint.T_from_to);
    writeUpperTriangle(out, swapYawAndRoll(informationToMrpt(constraint.T_from_to, constraint.information)));
    out << '\n';
  }
  file.commit();
}

void writeGraph(const std::string& path, const PoseGraph& graph, G2oRotation rotation) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".g2o") return writeG2o(path, graph, rotation);
  if (extension == ".graph") return writeMrptGraph(path, graph);
  throw core::ConfigError("'" + extension + "' is no known extension of a pose graph", path, "use .g2o or .graph");
}

}  // namespace s2s::graph
