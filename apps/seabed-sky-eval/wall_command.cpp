#include <optional>

#include "command.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"
#include "s2s/eval/wall_report.h"

namespace s2s::apps {

namespace {

class WallCommand : public Command {
 public:
  explicit WallCommand(CLI::App& app)
      : Command(app, "wall", "Compare a wall as the LiDAR and as the sonars map it, by the paper's four metrics") {
    parser().add_option("map", mapFolder_, "Output folder of seabed-sky-map")->required()->type_name("OUT");
    parser().add_option("--from", from_, "One end of the wall, x,y [m, map frame]")->delimiter(',')->required();
    parser().add_option("--to", to_, "The other end, x,y [m, map frame]")->delimiter(',')->required();
    parser()
        .add_option("--half-width", options_.wall.halfWidth_m, "Points this near to the line belong to the wall [m]")
        ->required()
        ->check(CLI::PositiveNumber);
    parser()
        .add_option("--layers", layers_, "Sonar layers that take part: stereo, line_horizontal, line_vertical")
        ->delimiter(',')
        ->check(CLI::IsMember({"stereo", "line_horizontal", "line_vertical"}))
        ->capture_default_str();
    parser().add_option("--water-height", options_.waterHeight_m,
                        "Height of the water surface [m, map frame]; by default that of summary.json");
    parser()
        .add_option("--sonar-max-depth", options_.sonarMaxDepth_m,
                    "Leave out sonar points deeper than this, such as the seabed before the wall [m]")
        ->check(CLI::PositiveNumber);
    parser()
        .add_option("--truth", options_.truthFolder,
                    "Folder 'truth' of simulate-survey: the ends are then in its world frame")
        ->type_name("TRUTH_DIR");
    parser().add_flag("--no-refine", asGiven_, "Take the line as given, do not turn it onto the LiDAR points");
    parser().add_flag("--cosine-3d", options_.wall.cosineIn3d, "Cosine similarity of x, y, z instead of x, y");
    parser()
        .add_option("--bins", options_.wall.bins, "Places at which the densities are compared")
        ->check(CLI::Range(2, 100000))
        ->capture_default_str();
  }

  void run() override {
    options_.wall.from_m = {from_[0], from_[1]};
    options_.wall.to_m = {to_[0], to_[1]};
    options_.wall.refine = !asGiven_;
    options_.sonarLayers.clear();
    for (const map::Layer layer : map::kLayers)
      if (std::find(layers_.begin(), layers_.end(), map::layerName(layer)) != layers_.end())
        options_.sonarLayers.push_back(layer);
    const eval::WallReport report = eval::evaluateWall(mapFolder_, options_);
    finish(eval::toText(report), eval::toJson(report));
  }

 private:
  std::string mapFolder_;
  std::array<double, 2> from_{}, to_{};
  bool asGiven_ = false;
  std::vector<std::string> layers_ = {"stereo", "line_horizontal", "line_vertical"};
  eval::WallReportOptions options_;
};

}  // namespace

std::unique_ptr<Command> makeWallCommand(CLI::App& app) { return std::make_unique<WallCommand>(app); }

}  // namespace s2s::apps
