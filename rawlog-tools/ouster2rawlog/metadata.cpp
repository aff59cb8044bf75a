#include "ouster2rawlog/metadata.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "s2s/core/error.h"

namespace s2s::tools::ouster {

namespace {

using Json = nlohmann::json;

constexpr double kMetresPerMillimetre = 1e-3;

class MetadataParser {
 public:
  MetadataParser(const Json& json, std::string name) : json_(json), name_(std::move(name)) {}

  Metadata parse() {
    parseIdentity();
    parseFormat();
    parseBeams();
    parseTransforms();
    return metadata_;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw core::InputError(what, name_, "give the metadata JSON that belongs to the capture");
  }

  /// A value of the sectioned layout, or else of the flat one; null if neither has it.
  const Json* find(const char* section, const char* key) const {
    if (const auto part = json_.find(section); part != json_.end() && part->is_object())
      if (const auto value = part->find(key); value != part->end() && !value->is_null()) return &*value;
    const auto value = json_.find(key);
    return value != json_.end() && !value->is_null() ? &*value : nullptr;
  }

  const Json* findFormat(const char* key) const {
    const Json* value = find("lidar_data_format", key);
    return value ? value : find("data_format", key);
  }

  std::string text(const char* section, const char* key) const {
    const Json* value = find(section, key);
    return value && value->is_string() ? value->get<std::string>() : "";
  }

  std::optional<std::uint32_t> number(const Json* value, const char* key) const {
    if (!value) return std::nullopt;
    if (!value->is_number_integer() || value->get<std::int64_t>() < 0 || value->get<std::int64_t>() > 0xffffffffLL)
      refuse(std::string("'") + key + "' is not a usable number");
    return value->get<std::uint32_t>();
  }

  std::vector<double> numbers(const Json* value, const char* key) const {
    if (!value) return {};
    if (!value->is_array()) refuse(std::string("'") + key + "' is not a list of numbers");
    std::vector<double> result;
    for (const auto& item : *value) {
      if (item.is_array()) refuse(std::string("'") + key + "' is a table: solid-state sensors are not supported");
      if (!item.is_number()) refuse(std::string("'") + key + "' is not a list of numbers");
      result.push_back(item.get<double>());
    }
    return result;
  }

  void parseIdentity() {
    metadata_.model = text("sensor_info", "prod_line");
    metadata_.serialNumber = text("sensor_info", "prod_sn");
    metadata_.firmware = text("sensor_info", "build_rev");
    metadata_.initializationId = number(find("sensor_info", "initialization_id"), "initialization_id");
    metadata_.timestampMode = text("config_params", "timestamp_mode");
    metadata_.lidarPort = port("udp_port_lidar");
    metadata_.imuPort = port("udp_port_imu");
  }

  std::optional<std::uint16_t> port(const char* key) const {
    const auto value = number(find("config_params", key), key);
    if (!value || *value == 0 || *value > 65535) return std::nullopt;
    return static_cast<std::uint16_t>(*value);
  }

  void parseFormat() {
    metadata_.beamAltitude_deg = numbers(find("beam_intrinsics", "beam_altitude_angles"), "beam_altitude_angles");
    unsigned modeColumns = 0;
    double rate_hz = 0;
    const std::string mode = text("config_params", "lidar_mode");
    const bool hasMode = std::sscanf(mode.c_str(), "%ux%lf", &modeColumns, &rate_hz) == 2 && rate_hz > 0;
    if (hasMode)
      metadata_.turnRate_hz = rate_hz;
    else
      assume("no lidar_mode: 10 turns a second");

    metadata_.rows = number(findFormat("pixels_per_column"), "pixels_per_column")
                         .value_or(static_cast<std::uint32_t>(metadata_.beamAltitude_deg.size()));
    metadata_.columns = number(findFormat("columns_per_frame"), "columns_per_frame").value_or(modeColumns);
    metadata_.columnsPerPacket = number(findFormat("columns_per_packet"), "columns_per_packet").value_or(16);
    if (metadata_.rows == 0 || metadata_.rows > 4096 || metadata_.columns == 0 || metadata_.columns > 65536 ||
        metadata_.columnsPerPacket == 0 || metadata_.columnsPerPacket > metadata_.columns)
      refuse("rows, columns or columns a packet are missing or impossible");

    if (const Json* value = findFormat("udp_profile_lidar"); value && value->is_string())
      metadata_.lidarProfile = value->get<std::string>();
    const Json* header = findFormat("header_type");
    metadata_.fusaHeader = header ? *header == "FUSA" : metadata_.lidarProfile == "FUSA_RNG15_RFL8_NIR8_DUAL";
    parseWindow();
  }

  void parseWindow() {
    const auto window = numbers(findFormat("column_window"), "column_window");
    metadata_.lastColumn = metadata_.columns - 1;
    if (window.empty()) return;
    for (const double column : window)
      if (window.size() != 2 || !(column >= 0 && column < metadata_.columns)) refuse("'column_window' is impossible");
    metadata_.firstColumn = static_cast<std::uint32_t>(window[0]);
    metadata_.lastColumn = static_cast<std::uint32_t>(window[1]);
  }

  void parseBeams() {
    metadata_.beamAzimuth_deg = numbers(find("beam_intrinsics", "beam_azimuth_angles"), "beam_azimuth_angles");
    if (metadata_.beamAltitude_deg.size() != metadata_.rows || metadata_.beamAzimuth_deg.size() != metadata_.rows)
      refuse(std::to_string(metadata_.beamAltitude_deg.size()) + " beam altitudes and " +
             std::to_string(metadata_.beamAzimuth_deg.size()) + " beam azimuths for " + std::to_string(metadata_.rows) +
             " pixels a column");
    const bool allZero = std::all_of(metadata_.beamAltitude_deg.begin(), metadata_.beamAltitude_deg.end(),
                                     [](double angle) { return angle == 0; });
    if (allZero && metadata_.rows > 1) refuse("all beam altitudes are 0: the file was never filled in");

    const auto beamToLidar = numbers(find("beam_intrinsics", "beam_to_lidar_transform"), "beam_to_lidar_transform");
    const Json* offset = find("beam_intrinsics", "lidar_origin_to_beam_origin_mm");
    if (beamToLidar.size() == 16) {
      metadata_.beamOriginOffset_m = kMetresPerMillimetre * beamToLidar[3];
      metadata_.beamOriginHeight_m = kMetresPerMillimetre * beamToLidar[11];
    } else if (offset && offset->is_number()) {
      metadata_.beamOriginOffset_m = kMetresPerMillimetre * offset->get<double>();
    } else {
      metadata_.beamOriginOffset_m = kMetresPerMillimetre * usualBeamOriginOffset_mm();
      assume("no lidar_origin_to_beam_origin_mm: that of the product line");
    }
  }

  /// Ouster's own values for files that do not tell (Ouster SDK).
  double usualBeamOriginOffset_mm() const {
    if (metadata_.model.rfind("OS-0-", 0) == 0) return 27.67;
    if (metadata_.model.rfind("OS-1-", 0) == 0) return 15.806;
    if (metadata_.model.rfind("OS-2-", 0) == 0) return 13.762;
    return 12.163;  // first generation
  }

  void parseTransforms() {
    metadata_.T_sensor_lidar = transform("lidar_intrinsics", "lidar_to_sensor_transform",
                                         {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1});
    metadata_.T_sensor_imu = transform("imu_intrinsics", "imu_to_sensor_transform",
                                       {1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1});
  }

  /// 16 numbers, row after row, translation in millimetres.
  core::Isometry transform(const char* section, const char* key, const std::vector<double>& usual) {
    auto values = numbers(find(section, key), key);
    if (values.empty()) {
      assume(std::string("no ") + key + ": that of the OS-1");
      values = usual;
    }
    if (values.size() != 16) refuse(std::string("'") + key + "' has not 16 numbers");
    core::Isometry T = core::Isometry::Identity();
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(values.data());
    T.linear() = matrix.topLeftCorner<3, 3>();
    T.translation() = kMetresPerMillimetre * matrix.topRightCorner<3, 1>();
    const Eigen::Matrix3d R = T.linear();
    // A rotation to the three or four digits that such files give.
    if (!(R.transpose() * R).isApprox(Eigen::Matrix3d::Identity(), 1e-3) || R.determinant() < 0)
      refuse(std::string("'") + key + "' is not a rigid transform");
    T.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    return T;
  }

  void assume(const std::string& what) { metadata_.assumed.push_back(what); }

  const Json& json_;
  std::string name_;
  Metadata metadata_;
};

}  // namespace

Metadata parseMetadata(const std::string& text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    throw core::InputError("this is no JSON", name, "give the metadata JSON that belongs to the capture");
  return MetadataParser(json, name).parse();
}

Metadata loadMetadata(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.is_open() || file.bad())
    throw core::InputError("cannot read the metadata", path, "check the path given with --metadata");
  return parseMetadata(text, path);
}

}  // namespace s2s::tools::ouster
