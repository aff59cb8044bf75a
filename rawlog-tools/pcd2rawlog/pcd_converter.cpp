#include "pcd2rawlog/pcd_converter.h"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "pcd2rawlog/pcd_file.h"
#include "s2s/core/error.h"
#include "s2s/obs/rawlog_writer.h"

namespace s2s::tools::pcd {

namespace fs = std::filesystem;

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The run of digits that begins at `i`, without leading zeros; `i` moves behind it.
std::string digitsAt(const std::string& text, std::size_t& i) {
  const std::size_t begin = i;
  while (i < text.size() && isDigit(text[i])) ++i;
  const std::size_t significant = std::min(text.find_first_not_of('0', begin), i);
  return text.substr(significant, i - significant);
}

bool naturallyBefore(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string left = digitsAt(a, i), right = digitsAt(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

mrpt::obs::CObservationPointCloud::Ptr toObservation(const PcdCloud& cloud, core::TimeNs time,
                                                     const ConverterOptions& options) {
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->setSize(cloud.x.size());
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    points->setPointFast(i, cloud.x[i], cloud.y[i], cloud.z[i]);
    points->setPointIntensity(i, cloud.intensity.empty() ? 0.0f : cloud.intensity[i]);
  }
  points->mark_as_modified();
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->timestamp = core::toMrptTime(time);
  observation->sensorLabel = options.label;
  observation->sensorPose = core::toPose(options.T_vehicle_sensor);
  observation->pointcloud = std::move(points);
  return observation;
}

void reportCloud(const PcdCloud& cloud, const std::string& file, ConversionReport& report) {
  report.addRead("scans");
  report.addRead("points", cloud.x.size());
  for (const auto& field : cloud.skippedFields)
    report.addSkipped("files' field '" + field + "': only x y z intensity are kept", file);
  if (cloud.notFinite > 0) report.addSkipped("points with a coordinate that is not finite", file, cloud.notFinite);
  if (cloud.hasViewpoint) report.addSkipped("files' VIEWPOINT: points are kept as they stand in the file", file);
  if (cloud.intensity.empty()) report.addNote("files without an intensity get 0");
}

}  // namespace

std::vector<std::string> listPcdFiles(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string extension = it->path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (extension == ".pcd") names.push_back(it->path().filename().string());
  }
  if (error)
    throw core::InputError("cannot read the folder: " + error.message(), folder, "give the folder of the PCD files");
  if (names.empty()) throw core::InputError("the folder has no .pcd file", folder, "give the folder of the PCD files");
  std::sort(names.begin(), names.end(), naturallyBefore);
  for (auto& name : names) name = (fs::path(folder) / name).string();
  return names;
}

ConversionReport convertPcdFolder(const std::string& folder, double rate_hz, const ConverterOptions& options) {
  if (!(rate_hz > 0) || !std::isfinite(rate_hz))
    throw core::ConfigError("the rate is not above 0", "--rate", "give the scans per second");
  const auto files = listPcdFiles(folder);
  const core::TimeNs start = options.startTime.value_or(kDefaultStartTime);
  ConversionReport report;
  if (!options.startTime) report.addNote("PCD files carry no time; the first scan is put at " + core::formatUtc(start));
  obs::RawlogWriter writer(options.output, {options.gzLevel, 0.0});
  for (std::size_t i = 0; i < files.size(); ++i) {
    const core::TimeNs time = start + core::durationNs(static_cast<double>(i) / rate_hz);
    try {
      const PcdCloud cloud = readPcd(files[i]);
      reportCloud(cloud, files[i], report);
      writer.write(toObservation(cloud, time, options));
    } catch (const core::InputError& e) {
      report.addSkipped("files that cannot be used: " + e.fault(), files[i]);
    }
  }
  if (writer.count() == 0)
    throw core::InputError("no file of the folder can be used: " + report.skipped().front().text,
                           report.skipped().front().firstPlace, "check that the files are PCD files");
  writer.close();
  return report;
}

}  // namespace s2s::tools::pcd
