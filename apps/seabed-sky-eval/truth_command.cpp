#include "command.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"
#include "s2s/eval/truth_report.h"

namespace s2s::apps {

namespace {

class TruthCommand : public Command {
 public:
  explicit TruthCommand(CLI::App& app)
      : Command(app, "truth", "Compare a map with the truth of the simulated survey it was made from") {
    parser().add_option("map", mapFolder_, "Output folder of seabed-sky-map")->required()->type_name("OUT");
    parser().add_option("truth", truthFolder_, "Folder 'truth' of simulate-survey")->required()->type_name("TRUTH_DIR");
    parser()
        .add_option("--rpe-distances", options_.rpeDistances_m, "Path lengths of the relative pose error [m]")
        ->delimiter(',')
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--segments", options_.segmentLengths_m, "Lengths of the segment errors [m]")
        ->delimiter(',')
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--align-map", options_.mapAlignment,
                    "Bring the map into the world by the trajectory's 'poses' or its 'positions' only")
        ->transform(CLI::CheckedTransformer(std::map<std::string, eval::TrajectoryAlignment>{
            {"poses", eval::TrajectoryAlignment::Poses}, {"positions", eval::TrajectoryAlignment::Positions}}))
        ->type_name("poses|positions")
        ->default_str("poses");
    parser()
        .add_option("--max-points", options_.maxPointsPerLayer, "Measure at most this many points of a layer")
        ->check(CLI::Range(1U, 1'000'000'000U))
        ->capture_default_str();
    parser()
        .add_option("--coverage-radius", options_.seabed.coverageRadius_m,
                    "Seabed this near to the path ought to be mapped [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--object-reach", options_.objectReach_m, "Points this near to an object belong to it [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--object-pictures", options_.objectPictures,
                    "Write a picture of each object with the map's points into this folder")
        ->type_name("DIR");
  }

  void run() override {
    const eval::TruthReport report = eval::evaluateAgainstTruth(mapFolder_, truthFolder_, options_);
    finish(eval::toText(report), eval::toJson(report));
  }

 private:
  std::string mapFolder_, truthFolder_;
  eval::TruthOptions options_;
};

}  // namespace

std::unique_ptr<Command> makeTruthCommand(CLI::App& app) { return std::make_unique<TruthCommand>(app); }

}  // namespace s2s::apps
