#include "command.h"
#include "s2s/eval/quality_report.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"

namespace s2s::apps {

namespace {

class QualityCommand : public Command {
 public:
  explicit QualityCommand(CLI::App& app)
      : Command(app, "quality", "Measure a map by itself: crispness, density, agreement of passes") {
    parser().add_option("map", mapFolder_, "Output folder of seabed-sky-map")->required()->type_name("OUT");
    parser()
        .add_option("--radius", options_.entropyRadius_m, "Neighbourhood of the map entropy [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    parser()
        .add_option("--places", options_.places, "Take the entropy at about this many points of a layer")
        ->check(CLI::Range(1U, 100'000'000U))
        ->capture_default_str();
    parser()
        .add_option("--pass-gap", options_.passes.gap_s, "Soundings further apart in time are of different passes [s]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
  }

  void run() override {
    const eval::QualityReport report = eval::evaluateQuality(mapFolder_, options_);
    finish(eval::toText(report), eval::toJson(report));
  }

 private:
  std::string mapFolder_;
  eval::QualityOptions options_;
};

}  // namespace

std::unique_ptr<Command> makeQualityCommand(CLI::App& app) { return std::make_unique<QualityCommand>(app); }

}  // namespace s2s::apps
