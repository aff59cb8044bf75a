#pragma once

#include <string>

#include "s2s/calib/calibrator.h"

namespace s2s::calib {

/// Old, new, standard deviation and verdict of every parameter, as lines for people.
std::string reportText(const CalibrationResult& result);

/// The INI text with the estimated values of [mapper] in it; values that stayed nominal are left alone.
std::string calibratedIni(const std::string& text, const CalibrationResult& result);

}  // namespace s2s::calib
