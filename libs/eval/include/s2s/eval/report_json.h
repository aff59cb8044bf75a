#pragma once

#include <nlohmann/json.hpp>

#include "s2s/eval/control_points.h"
#include "s2s/eval/quality_report.h"
#include "s2s/eval/target_picker.h"
#include "s2s/eval/truth_report.h"
#include "s2s/eval/wall_similarity.h"

namespace s2s::eval {

/// Reports as JSON; the keys carry their units and are explained in share/docs/evaluation.md. A figure that does not
/// exist is null.
nlohmann::ordered_json toJson(const TruthReport& report);
nlohmann::ordered_json toJson(const ControlReport& report);
nlohmann::ordered_json toJson(const WallReport& report);
nlohmann::ordered_json toJson(const QualityReport& report);
nlohmann::ordered_json toJson(const std::vector<TargetPick>& picks);

}  // namespace s2s::eval
