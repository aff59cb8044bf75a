#include <Eigen/Eigenvalues>
#include <charconv>
#include <fstream>
#include <set>

#include "s2s/core/error.h"
#include "s2s/core/option_table.h"
#include "s2s/graph/graph_io.h"
#include "s2s/graph/mrpt_network.h"

namespace s2s::graph {

namespace {

/// Information of (t, vector part of the quaternion) to that of (t, rotation vector): the vector part is half of it.
core::Matrix6 fromQuaternionPart(core::Matrix6 information) {
  information.topRightCorner<3, 3>() *= 0.5;
  information.bottomLeftCorner<3, 3>() *= 0.5;
  information.bottomRightCorner<3, 3>() *= 0.25;
  return information;
}

class TextGraphReader {
 public:
  TextGraphReader(std::string path, G2oRotation rotation) : path_(std::move(path)), rotation_(rotation) {}
  GraphFile read();

 private:
  void readLine(const std::string& line);
  void readVertex(std::istringstream& words, bool quaternion);
  void readEdge(std::istringstream& words, bool quaternion);
  void readFix(std::istringstream& words);
  void applyFixes();

  std::int64_t readId(std::istringstream& words) const;
  double readNumber(std::istringstream& words, const char* what) const;
  core::Isometry readPose(std::istringstream& words, bool quaternion) const;
  core::Matrix6 readInformation(std::istringstream& words) const;
  void expectEnd(std::istringstream& words) const;
  void checkConstraintNodes(const std::map<std::int64_t, std::size_t>& index) const;
  [[noreturn]] void fail(const std::string& fault, const std::string& remedy, int line = 0) const;

  std::string path_;
  G2oRotation rotation_;
  GraphFile file_;
  std::vector<int> constraintLines_;
  std::map<std::int64_t, int> fixedIds_;  ///< id -> line
  std::set<std::int64_t> ids_;
  int line_ = 0;
};

void TextGraphReader::fail(const std::string& fault, const std::string& remedy, int line) const {
  throw core::InputError(fault, path_ + ":" + std::to_string(line ? line : line_), remedy);
}

GraphFile TextGraphReader::read() {
  std::ifstream stream(path_);
  if (!stream) throw core::InputError("the pose graph cannot be opened", path_, "check the name and its permissions");
  for (std::string line; std::getline(stream, line);) {
    ++line_;
    readLine(line);
  }
  if (stream.bad()) fail("the file cannot be read on", "check the disk");
  if (file_.graph.nodes.empty())
    fail("there is no pose in the file", "give a 3D pose graph with VERTEX_SE3:QUAT or VERTEX3 lines");
  applyFixes();
  return std::move(file_);
}

void TextGraphReader::readLine(const std::string& line) {
  std::istringstream words(line);
  std::string tag;
  if (!(words >> tag) || tag[0] == '#') return;
  if (tag == "VERTEX_SE3:QUAT") return readVertex(words, true);
  if (tag == "VERTEX3") return readVertex(words, false);
  if (tag == "EDGE_SE3:QUAT") return readEdge(words, true);
  if (tag == "EDGE3") return readEdge(words, false);
  if (tag == "FIX") return readFix(words);
  if (tag == "VERTEX_SE2" || tag == "VERTEX2" || tag == "EDGE_SE2" || tag == "EDGE2")
    fail("'" + tag + "' belongs to a 2D pose graph", "give a 3D one (VERTEX_SE3:QUAT, EDGE_SE3:QUAT)");
  ++file_.ignoredLines[tag];
}

std::int64_t TextGraphReader::readId(std::istringstream& words) const {
  std::string word;
  words >> word;
  std::int64_t id = -1;  // 64 bits: GTSAM's keys carry a letter in the highest byte
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), id);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || id < 0)
    fail("'" + word + "' is no node id", "give a whole number, at least 0");
  return id;
}

double TextGraphReader::readNumber(std::istringstream& words, const char* what) const {
  std::string word;
  if (!(words >> word)) fail(std::string("the line ends before ") + what, "complete the line");
  double number = 0;
  if (!core::parseDouble(word, number)) fail("'" + word + "' in " + what + " is no finite number", "correct it");
  return number;
}

core::Isometry TextGraphReader::readPose(std::istringstream& words, bool quaternion) const {
  Eigen::Vector3d t;
  for (double& value : t) value = readNumber(words, "x y z");
  if (!quaternion) {
    const double roll = readNumber(words, "roll pitch yaw");
    const double pitch = readNumber(words, "roll pitch yaw");
    return core::isometryFromXyzYpr(t.x(), t.y(), t.z(), readNumber(words, "roll pitch yaw"), pitch, roll);
  }
  Eigen::Quaterniond q;
  for (int i = 0; i < 4; ++i) q.coeffs()[i] = readNumber(words, "qx qy qz qw");
  if (std::abs(q.norm() - 1) > 1e-2)
    fail("the quaternion's length is " + core::printDouble(q.norm()), "give a unit quaternion in the order x y z w");
  core::Isometry T = core::Isometry::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = t;
  return T;
}

core::Matrix6 TextGraphReader::readInformation(std::istringstream& words) const {
  core::Matrix6 information;
  for (int r = 0; r < 6; ++r)
    for (int c = r; c < 6; ++c)
      information(r, c) = information(c, r) = readNumber(words, "the information matrix (21 numbers, upper triangle)");
  const Eigen::SelfAdjointEigenSolver<core::Matrix6> eigen(information, Eigen::EigenvaluesOnly);
  // Six printed digits leave eigenvalues of a singular matrix within 1e-5 of the largest.
  if (eigen.eigenvalues()[0] < -1e-5 * eigen.eigenvalues()[5])
    fail("the information matrix has the negative eigenvalue " + core::printDouble(eigen.eigenvalues()[0]),
         "give a positive semi-definite one");
  return information;
}

void TextGraphReader::expectEnd(std::istringstream& words) const {
  std::string word;
  if (words >> word) fail("'" + word + "' stands behind the line's last value", "remove it");
}

void TextGraphReader::readVertex(std::istringstream& words, bool quaternion) {
  PoseNode node;
  node.id = readId(words);
  node.T_map_node = readPose(words, quaternion);
  expectEnd(words);
  if (!ids_.insert(node.id).second)
    fail("node " + std::to_string(node.id) + " stands twice", "give every node an id of its own");
  file_.graph.nodes.push_back(node);
}

void TextGraphReader::readEdge(std::istringstream& words, bool quaternion) {
  PoseConstraint constraint;
  constraint.from = readId(words);
  constraint.to = readId(words);
  constraint.T_from_to = readPose(words, quaternion);
  const core::Matrix6 read = readInformation(words);
  expectEnd(words);
  if (quaternion) {
    constraint.information = rotation_ == G2oRotation::quaternion ? fromQuaternionPart(read) : read;
  } else {
    // EDGE3 orders the angles roll pitch yaw, MRPT's matrices yaw pitch roll.
    Eigen::PermutationMatrix<6> swap;
    swap.indices() << 0, 1, 2, 5, 4, 3;
    constraint.information = informationFromMrpt(constraint.T_from_to, swap * read * swap);
  }
  file_.graph.constraints.push_back(constraint);
  constraintLines_.push_back(line_);
}

void TextGraphReader::readFix(std::istringstream& words) {
  const std::int64_t id = readId(words);
  expectEnd(words);
  fixedIds_[id] = line_;
}

void TextGraphReader::applyFixes() {
  const auto index = nodeIndex(file_.graph, path_);
  for (const auto& [id, line] : fixedIds_) {
    const auto found = index.find(id);
    if (found == index.end()) fail("FIX names node " + std::to_string(id) + ", which has no pose", "add it", line);
    file_.graph.nodes[found->second].fixed = true;
  }
  checkConstraintNodes(index);
}

void TextGraphReader::checkConstraintNodes(const std::map<std::int64_t, std::size_t>& index) const {
  for (std::size_t c = 0; c < file_.graph.constraints.size(); ++c)
    for (const std::int64_t id : {file_.graph.constraints[c].from, file_.graph.constraints[c].to})
      if (index.count(id) == 0)
        fail("the constraint names node " + std::to_string(id) + ", which has no pose",
             "add a VERTEX line for it or remove the constraint", constraintLines_[c]);
}

}  // namespace

GraphFile readGraph(const std::string& path, G2oRotation rotation) { return TextGraphReader(path, rotation).read(); }

}  // namespace s2s::graph
