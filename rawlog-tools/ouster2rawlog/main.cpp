// ouster2rawlog: a capture of an Ouster LiDAR's packets as a rawlog of sweeps and IMU readings.

#include <iostream>

#include "command_line.h"
#include "ouster2rawlog/ouster_converter.h"

int main(int argc, char** argv) {
  using namespace s2s;
  CLI::App app(
      "Turns a network capture of an Ouster LiDAR into a rawlog of CObservationLidarSweep and CObservationIMU.",
      "ouster2rawlog");
  app.footer(
      "Example:\n  ouster2rawlog --pcap canal.pcap --metadata canal.json --pose \"0.4 0 1.9 0 0 0\" --output "
      "canal.rawlog");
  tools::ouster::OusterOptions ouster;
  tools::ConverterOptions options;
  options.label = "LIDAR";
  app.add_option("--pcap", ouster.capture, "capture of the sensor's UDP packets (pcap or pcapng)")
      ->required()
      ->type_name("FILE");
  app.add_option("--metadata", ouster.metadata, "the sensor's metadata, of the same recording")
      ->required()
      ->type_name("JSON");
  app.add_option("--imu-label", ouster.imuLabel, "sensor label of the IMU readings")
      ->capture_default_str()
      ->type_name("TEXT");
  app.add_option("--source", ouster.source, "address of the sensor, if the capture has several; else the first")
      ->type_name("ADDRESS");
  app.add_option("--lidar-port", ouster.lidarPort,
                 "UDP port of the LiDAR packets, if there are several; else the first")
      ->type_name("PORT");
  tools::addOutputOptions(app, options);
  tools::addSensorOptions(app, options);
  tools::addStartTimeOption(app, options, "the sensor's own UTC, or the capture's clock");
  return apps::run(app, argc, argv, [&] {
    tools::printReport(tools::ouster::convertOusterCapture(ouster, options, &std::cerr), options.output);
    return apps::kSuccess;
  });
}
