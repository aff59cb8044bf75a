#pragma once

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace s2s::core {

/// Rigid transforms are `Eigen::Isometry3d` in algorithms and `mrpt::poses::CPose3D` at MRPT's interfaces.
/// `T_a_b` takes coordinates in frame b to coordinates in frame a, so `T_a_c = T_a_b * T_b_c`.
using Isometry = Eigen::Isometry3d;
/// A pose covariance is that of the right perturbation T exp(d), d = (translation [m], rotation vector [rad]), both in
/// the body frame. MRPT's graphs hold the information in (x, y, z, yaw, pitch, roll): see s2s/graph/mrpt_network.h.
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Isometry toIsometry(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D toPose(const Isometry& T);

/// Translation in metres, then yaw, pitch, roll in radians (MRPT's order: R = Rz(yaw) Ry(pitch) Rx(roll)).
Isometry isometryFromXyzYpr(double x, double y, double z, double yaw, double pitch, double roll);

/// Rotation vector of R (axis times angle, in [0, pi]) and back, by the exponential map of SO(3).
Eigen::Vector3d logSo3(const Eigen::Matrix3d& R);
Eigen::Matrix3d expSo3(const Eigen::Vector3d& w);
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Right Jacobian of SO(3): exp(w + d) ~ exp(w) exp(J d).
Eigen::Matrix3d rightJacobianSo3(const Eigen::Vector3d& w);

/// Geodesic mix of two poses: rotation by slerp, translation linear; `u` in [0, 1] (extrapolates outside).
Isometry interpolate(const Isometry& T0, const Isometry& T1, double u);

/// Angle in radians between two rotations.
double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

}  // namespace s2s::core
