#include "s2s/eval/report_json.h"

#include <cmath>

#include "report_units.h"

namespace s2s::eval {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json toJson(const Summary& s, double scale = 1) {
  return {{"count", s.count},     {"rmse", scale * s.rmse}, {"mean", scale * s.mean}, {"median", scale * s.median},
          {"std", scale * s.std}, {"p95", scale * s.p95},   {"min", scale * s.min},   {"max", scale * s.max}};
}

Json transform(const core::Isometry& T) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i) rows.push_back({T.matrix()(i, 0), T.matrix()(i, 1), T.matrix()(i, 2), T.matrix()(i, 3)});
  return rows;
}

Json toJson(const TrajectoryReport& t) {
  Json json = {{"poses", t.poses},
               {"pairs", t.pairs},
               {"path_m", t.path_m},
               {"ate_m", toJson(t.absolute.translation_m)},
               {"ape_rotation_deg", toJson(t.absolute.rotation_rad, kDegPerRad)},
               {"rotation_pose_aligned_deg", toJson(t.rotationByPoses_rad, kDegPerRad)},
               {"rpe", Json::array()},
               {"segments", Json::array()}};
  for (const auto& r : t.relative)
    if (r.error.translation_m.count > 0)
      json["rpe"].push_back({{"delta", r.delta},
                             {"unit", r.unit},
                             {"translation_m", toJson(r.error.translation_m)},
                             {"rotation_deg", toJson(r.error.rotation_rad, kDegPerRad)}});
  for (const auto& s : t.segments)
    if (s.count > 0)
      json["segments"].push_back({{"length_m", s.length_m},
                                  {"count", s.count},
                                  {"translation_percent", 100 * s.translation_share},
                                  {"rotation_deg_per_10m", 10 * kDegPerRad * s.rotation_radpm},
                                  {"rotation_deg_per_100m", 100 * kDegPerRad * s.rotation_radpm}});
  return json;
}

Json toJson(const LayerDistance& layer) {
  Json json = toJson(layer.distance_m);
  json.erase("count");
  Json result = {{"points", layer.points}, {"sampled", layer.sampled}, {"distance_m", std::move(json)}};
  result["within_5cm"] = layer.within5cm;
  result["within_10cm"] = layer.within10cm;
  result["within_20cm"] = layer.within20cm;
  return result;
}

Json toJson(const MediumScore& m) {
  const auto score = [](double precision, double recall) {
    return Json{{"precision", precision}, {"recall", recall}, {"f_score", fScore(precision, recall)}};
  };
  return {{"visible_area_m2", m.recall.area_m2},
          {"at_5cm", score(m.precision5cm, m.recall.within5cm)},
          {"at_10cm", score(m.precision10cm, m.recall.within10cm)},
          {"at_20cm", score(m.precision20cm, m.recall.within20cm)}};
}

Json toJson(const SeabedError& s) {
  Json orders;
  for (std::size_t i = 0; i < kHydrographicOrders.size(); ++i) orders[kHydrographicOrders[i].name] = s.withinOrder[i];
  return {{"cells", s.cells},          {"cells_without_truth", s.withoutTruth},
          {"bias_m", s.bias_m},        {"rmse_m", s.rmse_m},
          {"std_m", s.std_m},          {"p95_m", s.p95_m},
          {"max_m", s.max_m},          {"mean_depth_m", s.meanDepth_m},
          {"within_order", orders},    {"within_two_sigma", s.withinTwoSigma},
          {"true_cells", s.trueCells}, {"coverage", s.coverage}};
}

Json toJson(const ObjectPresence& object) {
  Json near, own;
  for (const map::Layer layer : map::kLayers) {
    near[map::layerName(layer)] = object.near[static_cast<std::size_t>(layer)];
    own[map::layerName(layer)] = object.own[static_cast<std::size_t>(layer)];
  }
  return {{"name", object.name},
          {"points_near", near},
          {"points_nearer_than_seabed", own},
          {"seen_area_m2", object.seenArea_m2},
          {"covered", object.seenArea_m2 > 0 ? Json(object.covered) : Json(nullptr)},
          {"true_height_m", number(object.trueHeight_m)},
          {"mapped_height_m", number(object.mappedHeight_m)}};
}

Json toJson(const MeanInterval& interval) {
  return {{"mean", number(interval.mean)}, {"ci95_half_width", number(interval.halfWidth)}};
}

Json toJson(const WallCloud& cloud) {
  return {{"points", cloud.points},  {"width_m", cloud.width_m},         {"mean_y_m", cloud.meanY_m},
          {"std_y_m", cloud.stdY_m}, {"bandwidth_m", cloud.bandwidth_m}, {"density_per_m", cloud.density}};
}

}  // namespace

Json toJson(const TruthReport& report) {
  Json json;
  for (const auto& t : report.trajectories) json[t.name.substr(0, t.name.find('.'))] = toJson(t);
  json["map_alignment"] = report.mapAlignment == TrajectoryAlignment::Poses ? "poses" : "positions";
  json["T_world_map"] = transform(report.T_world_map);
  json["layers"] = Json::object();
  for (const auto& [layer, distance] : report.layers) json["layers"][map::layerName(layer)] = toJson(distance);
  for (const auto& [name, distance] : report.walls) json["layers"][name] = toJson(distance);
  for (const auto& medium : report.media) json[medium.name] = toJson(medium);
  json["seabed"] = report.seabed ? toJson(*report.seabed) : Json(nullptr);
  json["objects"] = Json::array();
  for (const auto& object : report.objects) json["objects"].push_back(toJson(object));
  json["notes"] = report.notes;
  return json;
}

Json toJson(const ControlReport& report) {
  Json json = {{"error_m", toJson(report.error_m)},
               {"rmse_m", report.rmse_m},
               {"leave_one_out_m", report.leaveOneOut_m ? toJson(*report.leaveOneOut_m) : Json(nullptr)},
               {"mean_control_sigma_m", report.meanSigma_m},
               {"off_line_m", report.offLine_m},
               {"points", Json::array()},
               {"not_picked", report.notPicked},
               {"T_world_map", transform(report.T_world_map)}};
  for (const auto& point : report.points)
    json["points"].push_back({{"id", point.id},
                              {"error_m", point.error_m},
                              {"residual_m", numbers(point.residual_m)},
                              {"leave_one_out_m", point.leaveOneOut_m ? Json(*point.leaveOneOut_m) : Json(nullptr)}});
  return json;
}

Json toJson(const WallReport& report) {
  return {{"length_m", report.length_m},
          {"turn_deg", kDegPerRad * report.turn_rad},
          {"shift_m", report.shift_m},
          {"lidar", toJson(report.lidar)},
          {"sonar", toJson(report.sonar)},
          {"width_difference_m", report.widthDifference_m},
          {"offset_m", report.offset_m},
          {"cosine_similarity", report.cosineSimilarity},
          {"hellinger", report.hellinger},
          {"y_m", report.y_m},
          {"T_wall_map", transform(report.T_wall_map)}};
}

Json toJson(const QualityReport& report) {
  Json json = {{"layers", Json::object()}, {"seabed", nullptr}, {"notes", report.notes}};
  for (const auto& [layer, crispness] : report.crispness)
    json["layers"][map::layerName(layer)] = {
        {"points", report.points.at(layer)},
        {"places", crispness.evaluated},
        {"mean_map_entropy", crispness.evaluated > 0 ? Json(crispness.meanEntropy) : Json(nullptr)},
        {"plane_sigma_m", toJson(crispness.planeSigma_m)}};
  if (!report.seabed) return json;
  const GridQuality& grid = *report.seabed;
  json["seabed"] = {{"cells", grid.cells},
                    {"area_m2", grid.area_m2},
                    {"soundings_per_cell", toJson(grid.soundings)},
                    {"sigma_m", toJson(grid.sigma_m)},
                    {"holidays", grid.holidays},
                    {"passes",
                     {{"cells", grid.passes.cells},
                      {"differences", grid.passes.differences},
                      {"mean_m", grid.passes.mean_m},
                      {"std_m", grid.passes.std_m},
                      {"p95_m", grid.passes.p95_m}}}};
  return json;
}

Json toJson(const std::vector<TargetPick>& picks) {
  Json json = Json::array();
  for (const auto& pick : picks)
    json.push_back({{"id", pick.id},
                    {"found", pick.found},
                    {"points", pick.points},
                    {"position_m", numbers(pick.position)},
                    {"spread_m", pick.spread_m}});
  return json;
}

}  // namespace s2s::eval
