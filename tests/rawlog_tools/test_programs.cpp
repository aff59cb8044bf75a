// The programs themselves: exit codes, help, and that nothing is left behind by a failure.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>

#include "oculus_bytes.h"
#include "s2s/obs/rawlog_reader.h"
#include "temp_folder.h"

using namespace s2s;
using testing::HasSubstr;

namespace {

struct Run {
  int exitCode = -1;
  std::string text;  ///< stdout and stderr
};

Run run(const std::string& arguments) {
  Run result;
  FILE* pipe = popen((std::string(S2S_BIN_DIR) + "/" + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return result;
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) result.text.append(buffer, n);
  const int status = pclose(pipe);
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

class Program : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(Program, Help_HasAnExampleAndEndsWell) {
  const auto result = run(GetParam() + " --help");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_THAT(result.text, HasSubstr("Example:\n  " + GetParam() + " "));
  EXPECT_THAT(result.text, HasSubstr("--output"));
}

TEST_P(Program, NoArguments_IsWrongUsage) { EXPECT_EQ(run(GetParam()).exitCode, 2); }

TEST_P(Program, UnknownOption_IsWrongUsage) { EXPECT_EQ(run(GetParam() + " --nonsense 3").exitCode, 2); }

INSTANTIATE_TEST_SUITE_P(Tools, Program,
                         testing::Values("ouster2rawlog", "oculus2rawlog", "pcd2rawlog", "rawlog-merge"),
                         [](const auto& tool) {
                           std::string name = tool.param;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

TEST(Programs, ConvertAndMerge_WorkTogether) {
  test::TempFolder folder;
  test::OculusPing ping;
  test::writeBytes(folder.file("a.raw"), test::oculusMessage(ping));
  const auto converted = run("oculus2rawlog --input " + folder.file("a.raw") + " --output " + folder.file("a.rawlog") +
                             " --start-time 2024-12-05T12:00:00Z --pose \"-1 0 0 0 45 0\" --label SONAR --gz 1");
  EXPECT_EQ(converted.exitCode, 0) << converted.text;
  EXPECT_THAT(converted.text, HasSubstr("read     1 pings"));
  const auto merged =
      run("rawlog-merge " + folder.file("a.rawlog") + " " + folder.file("a.rawlog") +
          " --offset 2=0.5 --offset 1=-1 --label SONAR=S --pose \"S=0 0 7 0 0 0\" --output " + folder.file("m.rawlog"));
  EXPECT_EQ(merged.exitCode, 0) << merged.text;
  obs::RawlogReader reader(folder.file("m.rawlog"));
  const auto first = reader.next(), second = reader.next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(core::fromMrptTime(first->timestamp), 1'733'399'999'000'000'000);
  EXPECT_EQ(core::fromMrptTime(second->timestamp), 1'733'400'000'500'000'000);
  EXPECT_EQ(first->sensorLabel, "S");
}

TEST(Programs, WrongPoseOrTime_IsWrongUsageWithTheRemedy) {
  const auto pose = run("pcd2rawlog --input /nowhere --rate 10 --output x.rawlog --pose \"1 2 3\"");
  EXPECT_EQ(pose.exitCode, 2);
  EXPECT_THAT(pose.text, HasSubstr("six numbers"));
  EXPECT_EQ(run("pcd2rawlog --input /nowhere --rate 10 --output x.rawlog --start-time soon").exitCode, 2);
  EXPECT_EQ(run("rawlog-merge a.rawlog --output x.rawlog --offset 0.5").exitCode, 2);
}

TEST(Programs, UnusableInput_EndsWith3AndLeavesNothing) {
  test::TempFolder folder;
  test::writeBytes(folder.file("letter"), "this is a letter");
  const std::string letter = folder.file("letter"), output = " --output " + folder.file("x.rawlog");
  EXPECT_EQ(run("pcd2rawlog --rate 10 --input " + folder.path() + output).exitCode, 3);
  EXPECT_EQ(run("oculus2rawlog --input " + letter + output).exitCode, 3);
  EXPECT_EQ(run("ouster2rawlog --pcap " + letter + " --metadata " + letter + output).exitCode, 3);
  EXPECT_EQ(run("rawlog-merge " + letter + output).exitCode, 3);
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(Programs, UnwritableOutput_EndsWith4) {
  test::TempFolder folder;
  test::writeBytes(folder.file("a.raw"), test::oculusMessage({}));
  EXPECT_EQ(run("oculus2rawlog --input " + folder.file("a.raw") + " --output " + folder.file("a.raw") + "/x").exitCode,
            4);
}
