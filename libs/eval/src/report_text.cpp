#include "s2s/eval/report_text.h"

#include <cmath>

#include "report_units.h"
#include "s2s/eval/text_table.h"

namespace s2s::eval {

namespace {

std::string percent(double share, int decimals = 1) { return fixed(100 * share, decimals); }

void addRelative(const std::string& name, const RelativeErrorOver& r, TextTable& table) {
  const std::string over = fixed(r.delta, r.delta == std::floor(r.delta) ? 0 : 2) + " " + r.unit;
  if (r.error.translation_m.count == 0)
    table.addRow({name, over, "0", "path too short"});
  else
    table.addRow({name, over, std::to_string(r.error.translation_m.count), fixed(r.error.translation_m.rmse, 4),
                  fixed(r.error.translation_m.mean, 4), fixed(kDegPerRad * r.error.rotation_rad.rmse, 4),
                  fixed(kDegPerRad * r.error.rotation_rad.mean, 4)});
}

std::string trajectoryText(const std::vector<TrajectoryReport>& trajectories) {
  TextTable absolute({"trajectory", "poses", "pairs", "path [m]", "ATE rmse [m]", "mean [m]", "median [m]", "max [m]",
                      "rotation rmse [deg]", "aligned by poses [deg]"});
  TextTable relative({"relative error (RPE)", "over", "pairs", "translation rmse [m]", "mean [m]",
                      "rotation rmse [deg]", "mean [deg]"});
  TextTable segments(
      {"segment error", "length [m]", "segments", "translation [%]", "rotation [deg/10 m]", "rotation [deg/100 m]"});
  for (const auto& t : trajectories) {
    const Summary& e = t.absolute.translation_m;
    absolute.addRow({t.name, std::to_string(t.poses), std::to_string(t.pairs), fixed(t.path_m, 1), fixed(e.rmse, 4),
                     fixed(e.mean, 4), fixed(e.median, 4), fixed(e.max, 4),
                     fixed(kDegPerRad * t.absolute.rotation_rad.rmse, 3),
                     fixed(kDegPerRad * t.rotationByPoses_rad.rmse, 3)});
    for (const auto& r : t.relative) addRelative(t.name, r, relative);
    for (const auto& s : t.segments) {
      if (s.count == 0)
        segments.addRow({t.name, fixed(s.length_m, 0), "0", "path too short"});
      else
        segments.addRow({t.name, fixed(s.length_m, 0), std::to_string(s.count), percent(s.translation_share, 3),
                         fixed(10 * kDegPerRad * s.rotation_radpm, 4), fixed(100 * kDegPerRad * s.rotation_radpm, 4)});
    }
  }
  return absolute.print() + '\n' + relative.print() + '\n' + segments.print();
}

std::string layersText(const TruthReport& report) {
  TextTable table({"layer to true surface", "points", "measured", "mean [m]", "median [m]", "95 % [m]", "<= 5 cm [%]",
                   "<= 10 cm [%]", "<= 20 cm [%]"});
  const auto addRow = [&](const std::string& name, const LayerDistance& d) {
    if (d.sampled == 0)
      table.addRow({name, "0", "0", "-", "-", "-", "-", "-", "-"});
    else
      table.addRow({name, std::to_string(d.points), std::to_string(d.sampled), fixed(d.distance_m.mean, 4),
                    fixed(d.distance_m.median, 4), fixed(d.distance_m.p95, 4), percent(d.within5cm),
                    percent(d.within10cm), percent(d.within20cm)});
  };
  for (const auto& [layer, d] : report.layers) addRow(map::layerName(layer), d);
  for (const auto& [name, d] : report.walls) addRow(name, d);
  return table.print();
}

std::string mediaText(const std::vector<MediumScore>& media) {
  TextTable table({"map and visible surface", "visible [m2]", "within", "precision [%]", "recall [%]", "F-score [%]"});
  for (const auto& m : media) {
    const auto row = [&](const char* within, double precision, double recall) {
      table.addRow({m.name, fixed(m.recall.area_m2, 0), within, percent(precision), percent(recall),
                    percent(fScore(precision, recall))});
    };
    row("5 cm", m.precision5cm, m.recall.within5cm);
    row("10 cm", m.precision10cm, m.recall.within10cm);
    row("20 cm", m.precision20cm, m.recall.within20cm);
  }
  return table.print();
}

std::string seabedText(const SeabedError& s) {
  TextTable heights({"seabed height", "cells", "bias [m]", "rmse [m]", "95 % [m]", "max [m]", "mean depth [m]",
                     "covered near path [%]", "within 2 sigma [%]"});
  heights.addRow({"map - truth", std::to_string(s.cells), fixed(s.bias_m, 4), fixed(s.rmse_m, 4), fixed(s.p95_m, 4),
                  fixed(s.max_m, 3), fixed(s.meanDepth_m, 2), percent(s.coverage), percent(s.withinTwoSigma)});
  TextTable orders({"cells within the TVU of IHO S-44 order", "a [m]", "b", "share [%]"});
  for (std::size_t i = 0; i < kHydrographicOrders.size(); ++i)
    orders.addRow({kHydrographicOrders[i].name, fixed(kHydrographicOrders[i].a_m, 2),
                   fixed(kHydrographicOrders[i].b, 4), percent(s.withinOrder[i])});
  std::string text = heights.print();
  if (s.withoutTruth > 0)
    text += std::to_string(s.withoutTruth) + " more cells have no true seabed under them and are not counted\n";
  return text + '\n' + orders.print();
}

std::string objectsText(const std::vector<ObjectPresence>& objects) {
  TextTable table({"object", "lidar", "stereo", "line_horizontal", "line_vertical", "nearer than seabed", "seen [m2]",
                   "covered [%]", "true height [m]", "mapped height [m]"});
  for (const auto& object : objects) {
    std::vector<std::string> row = {object.name};
    std::uint64_t own = 0;
    for (const auto count : object.near) row.push_back(std::to_string(count));
    for (const auto count : object.own) own += count;
    row.push_back(std::to_string(own));
    row.push_back(fixed(object.seenArea_m2, 2));
    row.push_back(object.seenArea_m2 > 0 ? fixed(100 * object.covered, 1) : "-");
    row.push_back(fixed(object.trueHeight_m, 2));
    row.push_back(fixed(object.mappedHeight_m, 2));
    table.addRow(std::move(row));
  }
  return "Points near each object's surface, and heights above the bare seabed\n" + table.print();
}

std::string interval(const MeanInterval& value) { return fixed(value.mean, 4) + " +- " + fixed(value.halfWidth, 4); }

}  // namespace

std::string toText(const TruthReport& report) {
  std::string text = trajectoryText(report.trajectories);
  const bool poses = report.mapAlignment == TrajectoryAlignment::Poses;
  text += std::string("\nThe map is brought into the world by the ") + (poses ? "poses" : "positions") +
          " of trajectory.tum alone.\n";
  text += layersText(report);
  if (!report.media.empty()) text += '\n' + mediaText(report.media);
  if (report.seabed) text += '\n' + seabedText(*report.seabed);
  if (!report.objects.empty()) text += '\n' + objectsText(report.objects);
  for (const auto& note : report.notes) text += "note: " + note + '\n';
  return text;
}

std::string toText(const ControlReport& report) {
  TextTable points({"control point", "error [m]", "dx [m]", "dy [m]", "dz [m]", "left out [m]"});
  for (const auto& p : report.points)
    points.addRow({p.id, fixed(p.error_m, 4), fixed(p.residual_m.x(), 4), fixed(p.residual_m.y(), 4),
                   fixed(p.residual_m.z(), 4), p.leaveOneOut_m ? fixed(*p.leaveOneOut_m, 4) : "-"});
  TextTable totals({"over " + std::to_string(report.points.size()) + " points", "mean +- 95 % [m]"});
  totals.addRow({"error after rigid alignment", interval(report.error_m)});
  totals.addRow({"leave-one-out error", report.leaveOneOut_m ? interval(*report.leaveOneOut_m) : "-"});
  totals.addRow({"rmse after rigid alignment", fixed(report.rmse_m, 4)});
  totals.addRow({"sigma of the control points", fixed(report.meanSigma_m, 4)});
  std::string text = points.print() + '\n' + totals.print();
  if (!report.leaveOneOut_m)
    text += "note: the leave-one-out error needs four points, of which no three others are collinear\n";
  for (const auto& id : report.notPicked) text += "note: control point " + id + " was not picked and takes no part\n";
  return text;
}

std::string toText(const WallReport& report) {
  TextTable clouds({"cloud", "points", "width [m]", "mean y [m]", "std y [m]", "KDE bandwidth [m]"});
  const auto row = [&](const char* name, const WallCloud& c) {
    clouds.addRow({name, std::to_string(c.points), fixed(c.width_m, 4), fixed(c.meanY_m, 4), fixed(c.stdY_m, 4),
                   fixed(c.bandwidth_m, 4)});
  };
  row("lidar", report.lidar);
  row("sonar", report.sonar);
  TextTable metrics({"metric", "value"});
  metrics.addRow({"sonar-lidar wall width difference [m]", fixed(report.widthDifference_m, 4)});
  metrics.addRow({"sonar-lidar offset in y [m]", fixed(report.offset_m, 4)});
  metrics.addRow({"average cosine similarity", fixed(report.cosineSimilarity, 4)});
  metrics.addRow({"Hellinger distance", fixed(report.hellinger, 4)});
  return "Wall of " + fixed(report.length_m, 2) + " m; its line was turned by " +
         fixed(kDegPerRad * report.turn_rad, 3) + " deg and shifted by " + fixed(report.shift_m, 3) +
         " m onto the LiDAR points.\n" + clouds.print() + '\n' + metrics.print();
}

std::string toText(const QualityReport& report) {
  TextTable layers({"layer", "points", "places", "mean map entropy [nat]", "plane sigma median [m]", "95 % [m]"});
  for (const auto& [layer, c] : report.crispness) {
    std::vector<std::string> row = {map::layerName(layer), std::to_string(report.points.at(layer)),
                                    std::to_string(c.evaluated)};
    if (c.evaluated > 0)
      row.insert(row.end(), {fixed(c.meanEntropy, 3), fixed(c.planeSigma_m.median, 4), fixed(c.planeSigma_m.p95, 4)});
    layers.addRow(std::move(row));
  }
  std::string text = layers.print();
  if (report.seabed) {
    const GridQuality& g = *report.seabed;
    TextTable grid(
        {"seabed grid", "area [m2]", "soundings/cell median", "sigma median [m]", "sigma 95 % [m]", "holidays"});
    grid.addRow({std::to_string(g.cells) + " cells", fixed(g.area_m2, 1), fixed(g.soundings.median, 0),
                 fixed(g.sigma_m.median, 3), fixed(g.sigma_m.p95, 3), std::to_string(g.holidays)});
    TextTable passes({"between passes", "cells", "differences", "mean [m]", "std [m]", "95 % [m]"});
    const PassDifference& p = g.passes;
    if (p.differences > 0)
      passes.addRow({"later - earlier", std::to_string(p.cells), std::to_string(p.differences), fixed(p.mean_m, 4),
                     fixed(p.std_m, 4), fixed(p.p95_m, 4)});
    else
      passes.addRow({"no cell was passed twice"});
    text += '\n' + grid.print() + '\n' + passes.print();
  }
  for (const auto& note : report.notes) text += "note: " + note + '\n';
  return text;
}

std::string toText(const std::vector<TargetPick>& picks) {
  TextTable table({"target", "bright points", "x [m]", "y [m]", "z [m]", "spread [m]"});
  for (const auto& pick : picks) {
    if (pick.found)
      table.addRow({pick.id, std::to_string(pick.points), fixed(pick.position.x(), 4), fixed(pick.position.y(), 4),
                    fixed(pick.position.z(), 4), fixed(pick.spread_m, 3)});
    else
      table.addRow({pick.id, std::to_string(pick.points), "not found"});
  }
  return table.print();
}

}  // namespace s2s::eval
