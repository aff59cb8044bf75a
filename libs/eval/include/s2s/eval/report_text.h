#pragma once

#include <string>

#include "s2s/eval/control_points.h"
#include "s2s/eval/quality_report.h"
#include "s2s/eval/target_picker.h"
#include "s2s/eval/truth_report.h"
#include "s2s/eval/wall_similarity.h"

namespace s2s::eval {

/// Reports as tables of text for people, units in the headers.
std::string toText(const TruthReport& report);
std::string toText(const ControlReport& report);
std::string toText(const WallReport& report);
std::string toText(const QualityReport& report);
std::string toText(const std::vector<TargetPick>& picks);

}  // namespace s2s::eval
