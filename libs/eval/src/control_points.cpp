#include "s2s/eval/control_points.h"

#include <cmath>
#include <map>
#include <set>

#include "s2s/core/error.h"
#include "s2s/eval/alignment.h"
#include "s2s/eval/csv.h"

namespace s2s::eval {

namespace {

/// Picks and the control points of the same id, in the order of the control points.
struct Pairs {
  std::vector<NamedPoint> control;
  std::vector<Eigen::Vector3d> world, map;
  std::vector<std::string> notPicked;
};

Pairs pairById(const std::vector<NamedPoint>& control, const std::vector<NamedPoint>& picks) {
  std::map<std::string, Eigen::Vector3d> pickOf;
  for (const auto& pick : picks) pickOf.emplace(pick.id, pick.position);
  Pairs pairs;
  for (const auto& point : control) {
    const auto pick = pickOf.find(point.id);
    if (pick == pickOf.end()) {
      pairs.notPicked.push_back(point.id);
      continue;
    }
    pairs.control.push_back(point);
    pairs.world.push_back(point.position);
    pairs.map.push_back(pick->second);
    pickOf.erase(pick);
  }
  if (!pickOf.empty())
    throw core::InputError("the pick '" + pickOf.begin()->first + "' has no control point of that id", "",
                           "use the same ids in both files, or remove the pick");
  return pairs;
}

PointAlignment alignOrRefuse(const Pairs& pairs) {
  PointAlignment alignment = alignPoints(pairs.map, pairs.world);
  if (alignment.status == AlignmentStatus::TooFewPoints)
    throw core::InputError("only " + std::to_string(pairs.map.size()) +
                               " of the control points were picked, and fewer than three do not fix a rotation",
                           "", "pick at least three points, four or more for a leave-one-out error");
  if (alignment.status == AlignmentStatus::Collinear)
    throw core::InputError("the points lie on one line, so the rotation about it is not determined (they are " +
                               std::to_string(alignment.offLine_m) + " m rms off the line, along " +
                               std::to_string(alignment.alongLine_m) + " m rms)",
                           "", "add a point that stands well off the line of the others");
  return alignment;
}

/// Error of point `left` under the alignment of all others; nothing if those do not determine one.
std::optional<double> leaveOneOutError(const Pairs& pairs, std::size_t left) {
  std::vector<Eigen::Vector3d> map = pairs.map, world = pairs.world;
  map.erase(map.begin() + static_cast<std::ptrdiff_t>(left));
  world.erase(world.begin() + static_cast<std::ptrdiff_t>(left));
  const PointAlignment alignment = alignPoints(map, world);
  if (alignment.status != AlignmentStatus::Ok) return std::nullopt;
  return (alignment.T_target_source * pairs.map[left] - pairs.world[left]).norm();
}

}  // namespace

std::vector<NamedPoint> readNamedPoints(const std::string& path) {
  const CsvTable table = CsvTable::load(path, {"id", "x", "y", "z"});
  std::vector<NamedPoint> points;
  std::set<std::string> ids;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    NamedPoint point;
    point.id = table.text(row, "id");
    point.position = {table.number(row, "x"), table.number(row, "y"), table.number(row, "z")};
    if (table.hasColumn("sigma")) point.sigma_m = table.number(row, "sigma");
    if (!ids.insert(point.id).second)
      throw core::InputError("the id '" + point.id + "' stands twice", table.where(row), "keep one row for each id");
    points.push_back(std::move(point));
  }
  return points;
}

ControlReport evaluateControlPoints(const std::vector<NamedPoint>& control, const std::vector<NamedPoint>& picks) {
  const Pairs pairs = pairById(control, picks);
  const PointAlignment alignment = alignOrRefuse(pairs);
  ControlReport report;
  report.T_world_map = alignment.T_target_source;
  report.notPicked = pairs.notPicked;
  report.rmse_m = alignment.rmse_m;
  report.offLine_m = alignment.offLine_m;
  std::vector<double> errors_m, leaveOneOut_m;
  for (std::size_t i = 0; i < pairs.map.size(); ++i) {
    ControlPointError point;
    point.id = pairs.control[i].id;
    point.residual_m = alignment.T_target_source * pairs.map[i] - pairs.world[i];
    point.error_m = point.residual_m.norm();
    point.leaveOneOut_m = leaveOneOutError(pairs, i);
    errors_m.push_back(point.error_m);
    if (point.leaveOneOut_m) leaveOneOut_m.push_back(*point.leaveOneOut_m);
    report.meanSigma_m += pairs.control[i].sigma_m / static_cast<double>(pairs.map.size());
    report.points.push_back(std::move(point));
  }
  report.error_m = meanInterval95(errors_m);
  if (leaveOneOut_m.size() >= 2) report.leaveOneOut_m = meanInterval95(leaveOneOut_m);
  return report;
}

}  // namespace s2s::eval
