// oculus2rawlog: the byte stream of an Oculus imaging sonar as a rawlog of pings.

#include <cmath>
#include <iostream>
#include <string>

#include "command_line.h"
#include "oculus2rawlog/oculus_converter.h"

int main(int argc, char** argv) {
  using namespace s2s;
  CLI::App app("Turns the bytes that an Oculus imaging sonar sends over TCP into a rawlog of CObservationImagingSonar.",
               "oculus2rawlog");
  app.footer(
      "Example:\n  oculus2rawlog --input sonar.raw --start-time 2024-12-05T12:00:00Z --label SONAR_HORIZONTAL \\\n"
      "                --pose \"-2 0 -0.5 0 45 0\" --output sonar.rawlog");
  tools::oculus::OculusOptions oculus;
  tools::ConverterOptions options;
  options.label = "SONAR_HORIZONTAL";
  double aperture_deg = 20;
  std::string bearingModel = "azimuth";
  app.add_option("--input", oculus.input, "file with the sonar's bytes (TCP port 52100)")
      ->required()
      ->type_name("FILE");
  app.add_option("--aperture-deg", aperture_deg, "vertical aperture of the device, full angle in degrees")
      ->check(CLI::Range(0.1, 180.0))
      ->capture_default_str()
      ->type_name("DEG");
  app.add_option("--bearing-model", bearingModel,
                 "what a bearing measures: azimuth in the imaging plane, or the cone around a straight array")
      ->check(CLI::IsMember({"azimuth", "cone"}))
      ->capture_default_str()
      ->type_name("");
  app.add_option("--model", oculus.model, "name of the device, for the record")
      ->capture_default_str()
      ->type_name("TEXT");
  tools::addOutputOptions(app, options);
  tools::addSensorOptions(app, options);
  tools::addStartTimeOption(app, options, "2000-01-01T00:00:00Z");
  return apps::run(app, argc, argv, [&] {
    oculus.bearingModel = bearingModel == "cone" ? obs::BearingModel::Cone : obs::BearingModel::Azimuth;
    oculus.verticalAperture_rad = aperture_deg * M_PI / 180.0;
    tools::printReport(tools::oculus::convertOculusStream(oculus, options, &std::cerr), options.output);
    return apps::kSuccess;
  });
}
