#include "command.h"
#include "s2s/core/atomic_file.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"
#include "s2s/eval/target_picker.h"

namespace s2s::apps {

namespace {

class PickCommand : public Command {
 public:
  explicit PickCommand(CLI::App& app)
      : Command(app, "pick", "Find the middles of retro-reflective targets near given places, for 'control'") {
    parser().add_option("map", mapFolder_, "Output folder of seabed-sky-map")->required()->type_name("OUT");
    parser()
        .add_option(
            "--points", options_.pointsFile,
            "Where targets are expected, CSV with the header id,x,y,z [m]; in the map frame unless --truth is given")
        ->required()
        ->type_name("CSV");
    parser().add_option("--output", picksFile_, "Write the picks to this file")->required()->type_name("CSV");
    parser()
        .add_option("--truth", options_.truthFolder,
                    "Folder 'truth' of simulate-survey: the places are in its world frame")
        ->type_name("TRUTH_DIR");
    parser()
        .add_option("--search-radius", options_.picker.searchRadius_m, "How far from its place a target may be [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--target-radius", options_.picker.targetRadius_m, "Half the diagonal of a target [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--min-intensity", options_.picker.minIntensity, "Intensity of a retro-reflective return")
        ->capture_default_str();
    parser()
        .add_option("--min-points", options_.picker.minPoints, "Bright returns that make a target")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
  }

  void run() override {
    const auto picks = eval::pickTargets(mapFolder_, options_);
    core::writeTextFile(picksFile_, eval::picksCsv(picks));
    finish(eval::toText(picks), eval::toJson(picks));
  }

 private:
  std::string mapFolder_, picksFile_;
  eval::PickOptions options_;
};

}  // namespace

std::unique_ptr<Command> makePickCommand(CLI::App& app) { return std::make_unique<PickCommand>(app); }

}  // namespace s2s::apps
