#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>

#include "ouster2rawlog/metadata.h"
#include "ouster_bytes.h"
#include "s2s/core/error.h"
#include "temp_folder.h"

using namespace s2s;
using testing::HasSubstr;
using tools::ouster::Metadata;
using tools::ouster::parseMetadata;

namespace {

/// The sectioned layout flattened to the one of firmware up to 2.x.
nlohmann::json flatLayout() {
  const auto sections = nlohmann::json::parse(test::ousterMetadataJson("LEGACY"));
  nlohmann::json flat;
  for (const auto* section : {"sensor_info", "config_params", "beam_intrinsics", "lidar_intrinsics", "imu_intrinsics"})
    flat.update(sections.at(section));
  flat["data_format"] = sections.at("lidar_data_format");
  return flat;
}

std::string faultOf(const nlohmann::json& json) {
  try {
    parseMetadata(json.dump(), "test.json");
  } catch (const core::InputError& e) {
    return e.fault();
  }
  return "";
}

void expectTestSensor(const Metadata& m) {
  EXPECT_EQ(m.model, "OS-1-4");
  EXPECT_EQ(m.serialNumber, "122");
  EXPECT_EQ(m.firmware, "v3.0.1");
  EXPECT_EQ(m.initializationId, 77u);
  EXPECT_EQ(m.rows, 4u);
  EXPECT_EQ(m.columns, 32u);
  EXPECT_EQ(m.columnsPerPacket, 8u);
  EXPECT_EQ(m.turnRate_hz, 10);
  EXPECT_EQ(m.lidarPort, 7502);
  EXPECT_THAT(m.beamAltitude_deg, testing::ElementsAre(15, 5, -5, -15));
  EXPECT_THAT(m.beamAzimuth_deg, testing::ElementsAre(3, 1, -1, -3));
  EXPECT_DOUBLE_EQ(m.beamOriginOffset_m, 0.016);
  EXPECT_DOUBLE_EQ(m.beamOriginHeight_m, 0.0025);
  EXPECT_TRUE(m.T_sensor_lidar.isApprox(core::isometryFromXyzYpr(0, 0, 0.03618, M_PI, 0, 0), 1e-12));
  EXPECT_TRUE(m.T_sensor_imu.isApprox(core::isometryFromXyzYpr(0.006253, -0.011775, 0.007645, 0, 0, 0), 1e-12));
  EXPECT_TRUE(m.assumed.empty());
}

}  // namespace

TEST(OusterMetadata, LayoutWithSections_IsRead) { expectTestSensor(test::ousterMetadata("RNG15_RFL8_NIR8")); }

TEST(OusterMetadata, FlatLayout_IsReadTheSame) { expectTestSensor(parseMetadata(flatLayout().dump(), "test.json")); }

TEST(OusterMetadata, FirstGenerationFile_GetsWhatItLacksAndSaysSo) {
  auto json = flatLayout();
  json.erase("data_format");
  json.erase("beam_to_lidar_transform");
  json.erase("imu_to_sensor_transform");
  json["lidar_mode"] = "512x20";
  const Metadata m = parseMetadata(json.dump(), "test.json");
  EXPECT_EQ(m.columns, 512u);
  EXPECT_EQ(m.turnRate_hz, 20);
  EXPECT_EQ(m.rows, 4u);
  EXPECT_EQ(m.columnsPerPacket, 16u);
  EXPECT_EQ(m.lidarProfile, "LEGACY");
  EXPECT_EQ(m.lastColumn, 511u);
  EXPECT_DOUBLE_EQ(m.beamOriginOffset_m, 0.015806);  // of the OS-1, by Ouster
  EXPECT_THAT(m.assumed, testing::UnorderedElementsAre(HasSubstr("beam_origin"), HasSubstr("imu_to_sensor")));
}

TEST(OusterMetadata, FusaProfile_HasFusaHeaders) {
  EXPECT_TRUE(test::ousterMetadata("FUSA_RNG15_RFL8_NIR8_DUAL").fusaHeader);
  EXPECT_FALSE(test::ousterMetadata("RNG15_RFL8_NIR8_DUAL").fusaHeader);
}

TEST(OusterMetadata, UnusableFiles_AreRefusedWithTheReason) {
  const auto changed = [](const char* key, const nlohmann::json& value) {
    auto json = flatLayout();
    json[key] = value;
    return faultOf(json);
  };
  EXPECT_THAT(changed("beam_altitude_angles", {1, 2, 3}), HasSubstr("3 beam altitudes"));
  EXPECT_THAT(changed("beam_altitude_angles", {0, 0, 0, 0}), HasSubstr("all beam altitudes are 0"));
  EXPECT_THAT(changed("beam_altitude_angles", "x"), HasSubstr("'beam_altitude_angles' is not a list"));
  EXPECT_THAT(changed("beam_azimuth_angles", nlohmann::json::parse("[[1],[2],[3],[4]]")), HasSubstr("solid-state"));
  EXPECT_THAT(changed("lidar_to_sensor_transform", std::vector<int>(16, 0)), HasSubstr("not a rigid transform"));
  EXPECT_THAT(changed("lidar_to_sensor_transform", {1, 2}), HasSubstr("has not 16 numbers"));
  EXPECT_THAT(changed("data_format", {{"columns_per_frame", 0}}), HasSubstr("impossible"));
  EXPECT_THAT(changed("data_format", {{"columns_per_frame", -5}}), HasSubstr("columns_per_frame"));
  EXPECT_THAT(changed("data_format", {{"column_window", {0, 99}}}), HasSubstr("column_window"));
  EXPECT_THAT(faultOf({{"hello", 1}}), HasSubstr("missing or impossible"));
  EXPECT_THROW(parseMetadata("not json", "x"), core::InputError);
  EXPECT_THROW(parseMetadata("[1, 2]", "x"), core::InputError);
  EXPECT_THROW(tools::ouster::loadMetadata("/nowhere/x.json"), core::InputError);
}
