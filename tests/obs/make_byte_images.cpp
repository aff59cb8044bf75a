// make_byte_images DIR: writes one small rawlog a class, in the class's present version, as tests/data keeps them.

#include <iostream>
#include <string>

#include "s2s/obs/rawlog_writer.h"
#include "sample_observations.h"

namespace {

void write(const std::string& path, const mrpt::obs::CObservation::Ptr& observation) {
  s2s::obs::RawlogWriter writer(path);
  writer.write(observation);
  writer.close();
  std::cout << path << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_byte_images DIR\n";
    return 2;
  }
  const std::string folder = argv[1];
  write(folder + "/imaging_sonar.rawlog", s2s::test::samplePing());
  write(folder + "/lidar_sweep.rawlog", s2s::test::sampleSweep());
  return 0;
}
