#include "s2s/products/trajectory_files.h"

#include <Eigen/SVD>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"

namespace s2s::products {

namespace {

constexpr const char* kRemedy = "check that this is a trajectory in the stated form";

/// Splits text lines into words and calls `take(words, "file:line")`; comments and empty lines are left out.
template <class Take>
void forEachLine(const std::string& path, const Take& take) {
  std::ifstream file(path);
  if (!file) throw core::InputError("cannot open the trajectory", path, "check the name and the access rights");
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.empty() || words.front().front() == '#') continue;
    take(words, path + ":" + std::to_string(number));
  }
}

double number(const std::string& word, const std::string& where) {
  double value = 0;
  const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end.ec != std::errc() || end.ptr != word.data() + word.size() || !std::isfinite(value))
    throw core::InputError("'" + word + "' is no number", where, kRemedy);
  return value;
}

/// Plain decimals exactly, to the nanosecond; anything else (exponents, negative times) through a double.
core::TimeNs time(const std::string& word, const std::string& where) {
  const auto dot = word.find('.');
  const std::string whole = word.substr(0, dot), fraction = dot == std::string::npos ? "" : word.substr(dot + 1);
  const bool plain =
      !whole.empty() && whole.size() <= 10 && (whole + fraction).find_first_not_of("0123456789") == std::string::npos;
  const double seconds = number(word, where);
  if (std::abs(seconds) > 9e9)
    throw core::InputError("'" + word + "' is no time in seconds", where, "give times in Unix seconds");
  if (!plain) return core::durationNs(seconds);
  core::TimeNs ns = 0;
  for (std::size_t i = 0; i < 9; ++i) ns = ns * 10 + (i < fraction.size() ? fraction[i] - '0' : 0);
  if (fraction.size() > 9 && fraction[9] >= '5') ++ns;
  return std::stoll(whole) * core::kNsPerSecond + ns;
}

}  // namespace

void writeTum(const std::string& path, const core::Trajectory& trajectory) {
  core::AtomicFile file(path);
  for (const auto& pose : trajectory.poses()) {
    const Eigen::Vector3d p = pose.T.translation();
    Eigen::Quaterniond q(pose.T.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    std::array<char, 256> line{};
    std::snprintf(line.data(), line.size(), "%s %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                  core::formatUnixTime(pose.time).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    file.stream() << line.data();
  }
  file.stream();
  file.commit();
}

core::Trajectory readTum(const std::string& path) {
  std::vector<core::TimedPose> poses;
  forEachLine(path, [&](const std::vector<std::string>& words, const std::string& where) {
    if (words.size() != 8)
      throw core::InputError(
          "a TUM line has 8 numbers (t x y z qx qy qz qw), this one has " + std::to_string(words.size()), where,
          kRemedy);
    std::array<double, 8> v{};
    for (std::size_t i = 1; i < 8; ++i) v[i] = number(words[i], where);
    Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    // Files with few decimals deviate by some 1e-3; anything more is another kind of data.
    if (std::abs(q.norm() - 1) > 0.05)
      throw core::InputError("the quaternion has length " + std::to_string(q.norm()) + " instead of 1", where, kRemedy);
    core::TimedPose pose;
    pose.time = time(words[0], where);
    pose.T.linear() = q.normalized().toRotationMatrix();
    pose.T.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
    poses.push_back(pose);
  });
  return core::Trajectory(std::move(poses));
}

void writeKitti(const std::string& path, const core::Trajectory& trajectory, const std::string& timesPath) {
  core::AtomicFile file(path);
  std::string times;
  for (const auto& pose : trajectory.poses()) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) {
        std::array<char, 48> text{};
        std::snprintf(text.data(), text.size(), "%s%.12e", row + column == 0 ? "" : " ", pose.T.matrix()(row, column));
        file.stream() << text.data();
      }
    file.stream() << '\n';
    times += core::formatUnixTime(pose.time) + "\n";
  }
  file.stream();
  file.commit();
  if (!timesPath.empty()) core::writeTextFile(timesPath, times);
}

std::vector<core::Isometry> readKitti(const std::string& path) {
  std::vector<core::Isometry> poses;
  forEachLine(path, [&](const std::vector<std::string>& words, const std::string& where) {
    if (words.size() != 12)
      throw core::InputError("a KITTI line has 12 numbers, this one has " + std::to_string(words.size()), where,
                             kRemedy);
    core::Isometry T = core::Isometry::Identity();
    for (int i = 0; i < 12; ++i) T.matrix()(i / 4, i % 4) = number(words[static_cast<std::size_t>(i)], where);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(T.linear(), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
    if (R.determinant() < 0 || (R - T.linear()).norm() > 0.05)
      throw core::InputError("the nine rotation numbers are no rotation", where, kRemedy);
    T.linear() = R;
    poses.push_back(T);
  });
  return poses;
}

}  // namespace s2s::products
