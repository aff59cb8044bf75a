#include "command.h"
#include "s2s/eval/control_points.h"
#include "s2s/eval/map_folder.h"
#include "s2s/eval/report_json.h"
#include "s2s/eval/report_text.h"

namespace s2s::apps {

namespace {

class ControlCommand : public Command {
 public:
  explicit ControlCommand(CLI::App& app)
      : Command(app, "control", "Compare points picked in a map with surveyed control points") {
    parser().add_option("map", mapFolder_, "Output folder of seabed-sky-map")->required()->type_name("OUT");
    parser()
        .add_option("--points", pointsFile_, "Surveyed points, CSV with the header id,x,y,z,sigma [m]")
        ->required()
        ->type_name("CSV");
    parser()
        .add_option("--picks", picksFile_, "The same points as picked in the map, CSV with the header id,x,y,z [m]")
        ->required()
        ->type_name("CSV");
  }

  void run() override {
    const eval::MapFolder map(mapFolder_);  // refuses a folder that holds no map
    const eval::ControlReport report =
        eval::evaluateControlPoints(eval::readNamedPoints(pointsFile_), eval::readNamedPoints(picksFile_));
    finish(eval::toText(report), eval::toJson(report));
  }

 private:
  std::string mapFolder_, pointsFile_, picksFile_;
};

}  // namespace

std::unique_ptr<Command> makeControlCommand(CLI::App& app) { return std::make_unique<ControlCommand>(app); }

}  // namespace s2s::apps
