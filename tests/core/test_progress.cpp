#include "s2s/core/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

using namespace s2s;

TEST(Progress, NullStream_KeepsSilent) {
  core::Progress progress(nullptr, "work", 10, "s");
  EXPECT_NO_THROW(progress.update(5));
}

TEST(Progress, ManyUpdatesOffTerminal_PrintAtMostOneLineATenth) {
  std::ostringstream out;
  {
    core::Progress progress(&out, "mapping", 1000, "s", std::chrono::milliseconds(0));
    for (int i = 0; i <= 1000; ++i) progress.update(i);
  }
  const std::string text = out.str();
  if (text.find('\r') != std::string::npos) GTEST_SKIP() << "stderr is a terminal: the line is redrawn in place";
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_THAT(text, testing::HasSubstr("mapping: 100 %"));
  EXPECT_THAT(text, testing::HasSubstr("x real time"));
}

TEST(Progress, QuickWorkOffTerminal_PrintsNothing) {
  std::ostringstream out;
  {
    core::Progress progress(&out, "mapping", 1000, "s", std::chrono::hours(1));
    for (int i = 0; i <= 1000; ++i) progress.update(i);
  }
  if (out.str().find('\r') != std::string::npos) GTEST_SKIP() << "stderr is a terminal: the line is redrawn in place";
  EXPECT_EQ(out.str(), "");
}
