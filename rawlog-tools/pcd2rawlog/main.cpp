// pcd2rawlog: a folder of PCD scans as a rawlog of point clouds.

#include "command_line.h"
#include "pcd2rawlog/pcd_converter.h"

int main(int argc, char** argv) {
  using namespace s2s;
  CLI::App app("Turns a folder of PCD scans into a rawlog of CObservationPointCloud, in natural order of the names.",
               "pcd2rawlog");
  app.footer("Example:\n  pcd2rawlog --input scans --rate 10 --pose \"0 0 1.73 0 0 0\" --output scans.rawlog");
  std::string folder;
  double rate_hz = 10;
  tools::ConverterOptions options;
  options.label = "LIDAR";
  app.add_option("--input", folder, "folder of .pcd files (ascii, binary or binary_compressed)")
      ->required()
      ->type_name("DIR");
  app.add_option("--rate", rate_hz, "scans per second")->required()->check(CLI::PositiveNumber)->type_name("HZ");
  tools::addOutputOptions(app, options);
  tools::addSensorOptions(app, options);
  tools::addStartTimeOption(app, options, "2000-01-01T00:00:00Z");
  return apps::run(app, argc, argv, [&] {
    tools::printReport(tools::pcd::convertPcdFolder(folder, rate_hz, options), options.output);
    return apps::kSuccess;
  });
}
