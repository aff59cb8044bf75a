#include "s2s/core/option_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "s2s/core/error.h"

using namespace s2s;
using testing::HasSubstr;

namespace {

enum class Colour { Red, Green };

struct Options {
  double size_m = 0.5;
  int count = 3;
  bool on = true;
  std::string name = "x y";
  double angle_rad = M_PI / 4;
  core::Isometry T_vehicle_sensor = core::isometryFromXyzYpr(1, -2, 0.25, 0.5, -0.25, 1.5);
  std::vector<double> list = {1, 0.1, -3e-7};
  Colour colour = Colour::Green;
};

core::OptionTable optionTable(Options& o) {
  core::OptionTable table;
  table.add("size_m", o.size_m, "a size", core::positive())
      .add("count", o.count, "a count", {1, 10})
      .add("on", o.on, "a switch")
      .add("name", o.name, "a name")
      .addDegrees("angle_deg", o.angle_rad, "an angle", {-90, 90})
      .addPose("pose", o.T_vehicle_sensor, "a pose")
      .addList("list", o.list, "numbers")
      .addChoice<Colour>("colour", o.colour, {{"red", Colour::Red}, {"green", Colour::Green}}, "a colour");
  return table;
}

Options loaded(const std::string& lines) {
  Options o;
  auto ini = core::IniFile::parse("[s]\n" + lines + "\n", "t.ini");
  optionTable(o).load(ini, "s");
  ini.rejectUnread();
  return o;
}

core::ConfigError refusal(const std::string& line) {
  try {
    loaded(line);
  } catch (const core::ConfigError& e) {
    return e;
  }
  ADD_FAILURE() << "'" << line << "' was accepted";
  return {"", "", ""};
}

}  // namespace

TEST(OptionTable, AbsentKeys_KeepDefaults) {
  const Options o = loaded("");
  EXPECT_EQ(o.size_m, 0.5);
  EXPECT_EQ(o.colour, Colour::Green);
}

TEST(OptionTable, PresentKeys_AreLoaded) {
  const Options o =
      loaded("size_m = +2.5e-1\ncount = 10\non = no\nname = a b\nangle_deg = -90\nlist = 4 5\ncolour = red");
  EXPECT_EQ(o.size_m, 0.25);
  EXPECT_EQ(o.count, 10);
  EXPECT_FALSE(o.on);
  EXPECT_EQ(o.name, "a b");
  EXPECT_DOUBLE_EQ(o.angle_rad, -M_PI / 2);
  EXPECT_THAT(o.list, testing::ElementsAre(4, 5));
  EXPECT_EQ(o.colour, Colour::Red);
}

TEST(OptionTable, PrintedSection_ReadsBackTheSame) {
  Options changed;
  changed.size_m = 0.1 + 0.2;  // needs 17 digits
  changed.colour = Colour::Red;
  auto ini = core::IniFile::parse(optionTable(changed).print("s"), "t.ini");
  Options again;
  again.list = {};
  again.name = "";
  again.angle_rad = 0;
  again.T_vehicle_sensor.setIdentity();
  optionTable(again).load(ini, "s");
  EXPECT_EQ(again.size_m, changed.size_m);
  EXPECT_EQ(again.name, changed.name);
  EXPECT_EQ(again.list, changed.list);
  EXPECT_EQ(again.colour, changed.colour);
  // Angles are printed to nine decimals of a degree, 2e-11 rad.
  EXPECT_NEAR(again.angle_rad, changed.angle_rad, 2e-11);
  EXPECT_TRUE(again.T_vehicle_sensor.isApprox(changed.T_vehicle_sensor, 1e-10));
}

TEST(OptionTable, RoundDegrees_PrintWithoutNoise) {
  Options o;
  EXPECT_THAT(optionTable(o).print("s"), HasSubstr("angle_deg = 45\n"));
}

TEST(OptionTable, NumberWithTail_IsRefusedNamingPlaceValueAndRule) {
  const auto error = refusal("size_m = 3.5abc");
  EXPECT_THAT(error.fault(), HasSubstr("'3.5abc'"));
  EXPECT_EQ(error.where(), "t.ini:2 [s] size_m");
  EXPECT_THAT(error.remedy(), HasSubstr("above 0"));
}

TEST(OptionTable, ValuesOutOfRange_AreRefused) {
  refusal("size_m = 0");
  refusal("count = 11");
  refusal("angle_deg = 90.1");
}

TEST(OptionTable, ThingsThatAreNoValue_AreRefused) {
  for (const char* line :
       {"size_m =", "size_m = nan", "size_m = inf", "size_m = +-1", "size_m = +", "count = 1e1", "count = 2.0",
        "count = 99999999999", "on = maybe", "pose = 1 2 3 4 5", "pose = 1 2 3 4 5 6 7", "list = 1 x", "colour = blue"})
    refusal(line);
}

TEST(OptionTable, MisspelledKey_IsRejected) { EXPECT_THAT(refusal("cuont = 3").remedy(), HasSubstr("'count'")); }

TEST(OptionTable, RefusedValue_LeavesTheVariable) {
  Options o;
  auto ini = core::IniFile::parse("[s]\ncount = 99\n", "t.ini");
  EXPECT_THROW(optionTable(o).load(ini, "s"), core::ConfigError);
  EXPECT_EQ(o.count, 3);
}

TEST(OptionTable, Pose_IsMetresAndDegreesYawPitchRoll) {
  const Options o = loaded("pose = 1 2 3 90 0 0");
  // Yaw of 90 degrees takes x to y.
  EXPECT_TRUE((o.T_vehicle_sensor * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

TEST(ParseBool, WordsOfBothKinds_AreKnown) {
  for (const char* yes : {"true", "yes", "on", "1"}) {
    bool value = false;
    EXPECT_TRUE(core::parseBool(yes, value) && value) << yes;
  }
  for (const char* no : {"false", "no", "off", "0"}) {
    bool value = true;
    EXPECT_TRUE(core::parseBool(no, value) && !value) << no;
  }
}
