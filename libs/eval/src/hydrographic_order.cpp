#include "s2s/eval/hydrographic_order.h"

#include <algorithm>
#include <cmath>

namespace s2s::eval {

double totalVerticalUncertainty_m(const HydrographicOrder& order, double depth_m) {
  return std::hypot(order.a_m, order.b * std::max(0.0, depth_m));
}

}  // namespace s2s::eval
