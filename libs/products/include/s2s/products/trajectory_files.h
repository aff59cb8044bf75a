#pragma once

#include <string>
#include <vector>

#include "s2s/core/trajectory.h"

namespace s2s::products {

/// TUM form: a line `t x y z qx qy qz qw` a pose, t in Unix seconds with nine decimals, metres, unit quaternion with
/// qw >= 0; lines starting with '#' are comments. Times survive exactly, positions to 1 nm.
/// @throws core::OutputError
void writeTum(const std::string& path, const core::Trajectory& trajectory);

/// Reads TUM files of any origin: more or fewer decimals, exponents, quaternions that are not quite of unit length.
/// Poses may come in any order.
/// @throws core::InputError with file and line
core::Trajectory readTum(const std::string& path);

/// KITTI form: the twelve numbers of the upper three rows of the 4x4 matrix a line, no times; those go into
/// `timesPath`, one Unix time in seconds a line, when it is not empty.
/// @throws core::OutputError
void writeKitti(const std::string& path, const core::Trajectory& trajectory, const std::string& timesPath = "");

/// The poses of a KITTI file in the file's order; rotations are brought back to orthonormal.
/// @throws core::InputError with file and line
std::vector<core::Isometry> readKitti(const std::string& path);

}  // namespace s2s::products
