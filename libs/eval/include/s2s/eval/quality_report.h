#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "s2s/eval/map_entropy.h"
#include "s2s/eval/pass_difference.h"
#include "s2s/map/map_point.h"

namespace s2s::eval {

struct QualityOptions {
  double entropyRadius_m = 0.3;
  std::size_t places = 20000;  ///< of each layer, where the entropy is taken
  PassDifferenceOptions passes;
};

/// The seabed grid by itself.
struct GridQuality {
  std::size_t cells = 0;
  double area_m2 = 0;
  Summary soundings;         ///< in a cell
  Summary sigma_m;           ///< stated by the grid
  std::size_t holidays = 0;  ///< empty cells with a height in at least five of their eight neighbours
  PassDifference passes;
};

/// What a map says about its own quality, where there is no truth.
struct QualityReport {
  std::map<map::Layer, std::uint64_t> points;
  std::map<map::Layer, CloudCrispness> crispness;
  std::optional<GridQuality> seabed;
  std::vector<std::string> notes;  ///< what could not be measured, and why
};

/// @throws core::InputError if the folder or a file in it cannot be used
QualityReport evaluateQuality(const std::string& mapFolder, const QualityOptions& options);

}  // namespace s2s::eval
