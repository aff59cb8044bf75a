#include "s2s/core/transform.h"

#include <algorithm>
#include <cmath>

namespace s2s::core {

Isometry toIsometry(const mrpt::poses::CPose3D& pose) {
  Isometry T = Isometry::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) T.linear()(r, c) = pose.getRotationMatrix()(r, c);
  T.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return T;
}

mrpt::poses::CPose3D toPose(const Isometry& T) {
  mrpt::math::CMatrixDouble33 R;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) R(r, c) = T.linear()(r, c);
  mrpt::math::CMatrixDouble31 t;
  for (int r = 0; r < 3; ++r) t(r, 0) = T.translation()[r];
  return mrpt::poses::CPose3D(R, t);
}

Isometry isometryFromXyzYpr(double x, double y, double z, double yaw, double pitch, double roll) {
  Isometry T = Isometry::Identity();
  T.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

Eigen::Vector3d logSo3(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sinHalf = q.vec().norm();
  if (sinHalf < 1e-10) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sinHalf, q.w()) / sinHalf);
}

Eigen::Matrix3d expSo3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const double half = 0.5 * angle;
  const double sinc = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(half) / angle;
  return Eigen::Quaterniond(std::cos(half), sinc * w.x(), sinc * w.y(), sinc * w.z()).normalized().toRotationMatrix();
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Eigen::Matrix3d rightJacobianSo3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d S = skew(w);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * S + S * S / 6.0;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / a2 * S +
         (angle - std::sin(angle)) / (a2 * angle) * S * S;
}

Isometry interpolate(const Isometry& T0, const Isometry& T1, double u) {
  Isometry T = Isometry::Identity();
  const Eigen::Matrix3d R0 = T0.linear();
  T.linear() = R0 * expSo3(u * logSo3(R0.transpose() * T1.linear()));
  T.translation() = (1.0 - u) * T0.translation() + u * T1.translation();
  return T;
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) { return logSo3(a.transpose() * b).norm(); }

}  // namespace s2s::core
