#pragma once

namespace s2s::eval {

constexpr double kDegPerRad = 57.295779513082321;

}  // namespace s2s::eval
