#include "s2s/core/ini_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "s2s/core/error.h"
#include "temp_folder.h"

using namespace s2s;
using core::IniFile;
using testing::HasSubstr;

namespace {

std::string valueOf(const std::string& line) {
  return IniFile::parse("[s]\n" + line + "\n", "t.ini").read("s", "key")->value;
}

core::ConfigError errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const core::ConfigError& e) {
    return e;
  }
  ADD_FAILURE() << "no ConfigError";
  return {"", "", ""};
}

core::ConfigError parseErrorOf(const std::string& text) {
  return errorOf([&] { IniFile::parse(text, "t.ini"); });
}

}  // namespace

TEST(IniFile, Comments_EndValuesOnlyAfterABlank) {
  EXPECT_EQ(valueOf("key = true ; note"), "true");
  EXPECT_EQ(valueOf("key = true # note"), "true");
  EXPECT_EQ(valueOf("key = true // note"), "true");
  EXPECT_EQ(valueOf("key = http://x;y#z"), "http://x;y#z");
}

TEST(IniFile, CommentAndBlankLines_AreIgnored) { EXPECT_EQ(valueOf("# a\n; b\n// c\n\n  \t\nkey = 1"), "1"); }

TEST(IniFile, WindowsLineEnds_AreNoPartOfValues) {
  const auto ini = IniFile::parse("[s]\r\nkey = 1\r\n", "t.ini");
  EXPECT_EQ(ini.section("s").at("key").value, "1");
}

TEST(IniFile, ValueWithEqualsSign_StaysWhole) { EXPECT_EQ(valueOf("key = a = b"), "a = b"); }

TEST(IniFile, EmptyValue_IsEmptyNotAbsent) { EXPECT_EQ(valueOf("key ="), ""); }

TEST(IniFile, AbsentKey_ReadsAsNothing) {
  auto ini = IniFile::parse("[s]\n", "t.ini");
  EXPECT_FALSE(ini.read("s", "key").has_value());
  EXPECT_FALSE(ini.read("other", "key").has_value());
}

TEST(IniFile, MissingFile_ThrowsWithItsPath) {
  const auto error = errorOf([] { IniFile::load("/nowhere/x.ini"); });
  EXPECT_THAT(error.where(), HasSubstr("/nowhere/x.ini"));
}

TEST(IniFile, Folder_Throws) {
  test::TempFolder folder;
  EXPECT_THROW(IniFile::load(folder.path()), core::ConfigError);
}

TEST(IniFile, UnclosedSection_ThrowsWithLineNumber) { EXPECT_EQ(parseErrorOf("\n[s\nkey = 1").where(), "t.ini:2"); }

TEST(IniFile, EmptySectionName_Throws) { EXPECT_EQ(parseErrorOf("[]").where(), "t.ini:1"); }

TEST(IniFile, RepeatedSection_Throws) { EXPECT_EQ(parseErrorOf("[s]\n[t]\n[s]\n").where(), "t.ini:3"); }

TEST(IniFile, RepeatedKey_Throws) { EXPECT_EQ(parseErrorOf("[s]\na = 1\na = 2\n").where(), "t.ini:3"); }

TEST(IniFile, LineWithoutEquals_Throws) { EXPECT_EQ(parseErrorOf("[s]\nnonsense\n").where(), "t.ini:2"); }

TEST(IniFile, LineWithoutKey_Throws) { EXPECT_EQ(parseErrorOf("[s]\n= 3\n").where(), "t.ini:2"); }

TEST(IniFile, KeyBeforeAnySection_Throws) { EXPECT_EQ(parseErrorOf("a = 1\n").where(), "t.ini:1"); }

TEST(IniFile, UndeclaredKey_IsRejectedWithTheNearestOne) {
  auto ini = IniFile::parse("[odometry]\nvoxel_sise_m = 1\n", "t.ini");
  ini.declare("odometry", {"voxel_size_m", "threads"});
  const auto error = errorOf([&] { ini.rejectUnread(); });
  EXPECT_EQ(error.where(), "t.ini:2 [odometry] voxel_sise_m");
  EXPECT_THAT(error.remedy(), HasSubstr("'voxel_size_m'"));
}

TEST(IniFile, UndeclaredSection_IsRejectedWithTheNearestOne) {
  auto ini = IniFile::parse("[odometri]\n", "t.ini");
  ini.declare("odometry", {});
  ini.declare("graph", {});
  EXPECT_THAT(errorOf([&] { ini.rejectUnread(); }).remedy(), HasSubstr("'odometry'"));
}

TEST(IniFile, KeyFarFromAllKnownOnes_ListsThem) {
  auto ini = IniFile::parse("[s]\nbanana = 1\n", "t.ini");
  ini.declare("s", {"threads", "window_s"});
  EXPECT_THAT(errorOf([&] { ini.rejectUnread(); }).remedy(), HasSubstr("threads, window_s"));
}

TEST(IniFile, AllKeysReadOrDeclared_NothingIsRejected) {
  auto ini = IniFile::parse("[s]\na = 1\nb = 2\n", "t.ini");
  ini.read("s", "a");
  ini.declare("s", {"b"});
  EXPECT_NO_THROW(ini.rejectUnread());
}

TEST(IniFile, RejectUnreadOfAPrefix_LeavesOtherSectionsAlone) {
  auto ini = IniFile::parse("[mapper]\nthreads = 1\n[sonar.cfar]\ngain = 2\n", "t.ini");
  ini.declare("sonar.cfar", {"gain"});
  EXPECT_NO_THROW(ini.rejectUnread("sonar"));
  ini.set("sonar.cfar", "gian", "3");
  EXPECT_EQ(errorOf([&] { ini.rejectUnread("sonar"); }).where(), "t.ini [sonar.cfar] gian");
}

TEST(IniFile, Set_ReplacesAndAdds) {
  auto ini = IniFile::parse("[s]\na = 1\n", "t.ini");
  ini.set("s", "a", "2");
  ini.set("new", "b", "3");
  EXPECT_EQ(ini.read("s", "a")->value, "2");
  EXPECT_EQ(ini.read("new", "b")->value, "3");
}

TEST(IniFile, SectionsStartingWith_AreSortedAndFiltered) {
  const auto ini = IniFile::parse("[sonar.vertical]\n[map]\n[sonar.horizontal]\n", "t.ini");
  EXPECT_THAT(ini.sectionsStartingWith("sonar."), testing::ElementsAre("sonar.horizontal", "sonar.vertical"));
}

TEST(NearestWord, NothingNear_IsEmpty) { EXPECT_EQ(core::nearestWord("banana", {"threads", "window"}), ""); }
