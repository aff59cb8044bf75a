#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stack>

#include "s2s/products/report_page.h"

namespace s2s::products {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<unsigned char> bytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Base64, TestVectorsOfRfc4648) {
  EXPECT_EQ(toBase64(bytes("")), "");
  EXPECT_EQ(toBase64(bytes("f")), "Zg==");
  EXPECT_EQ(toBase64(bytes("fo")), "Zm8=");
  EXPECT_EQ(toBase64(bytes("foo")), "Zm9v");
  EXPECT_EQ(toBase64(bytes("foobar")), "Zm9vYmFy");
  EXPECT_EQ(toBase64({0xff, 0xfe, 0xfd}), "//79");
}

ReportContent sample() {
  ReportContent content;
  content.summary.inputs = {"/data/a&b<c>.rawlog"};
  content.summary.startTime = 1'733'400'000'000'000'000;
  content.summary.points = {1'234'567, 0, 0, 0};
  content.summary.warnings = {"<script>alert(1)</script>"};
  content.summary.effectiveIni = "[mapper]\nkey = \"<x>\"\n";
  content.seabed.cells = 10;
  content.seabed.soundings = 100;
  content.seabed.minHeight_m = -4.5;
  content.seabed.maxHeight_m = -2.25;
  content.pictures = {{"Title & more", "caption", "image/png", {1, 2, 3}}};
  content.files = {{"lidar.ply", 1'500'000}, {"unknown.xyz", 12}};
  return content;
}

TEST(ReportPage, TextFromOutside_IsEscaped) {
  const std::string page = reportPage(sample());
  EXPECT_THAT(page, HasSubstr("a&amp;b&lt;c&gt;.rawlog"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("key = &quot;&lt;x&gt;&quot;"));
  EXPECT_THAT(page, HasSubstr("Title &amp; more"));
}

TEST(ReportPage, DistrustedGnss_StandsWithItsTimes) {
  ReportContent content = sample();
  EXPECT_THAT(reportPage(content), Not(HasSubstr("GNSS")));
  content.summary.gnss.emplace();
  content.summary.gnss->state = "distrusted";
  content.summary.gnss->distrusted = true;
  content.summary.gnss->spans = {{1'733'400'030'000'000'000, 1'733'400'060'000'000'000, 31, 48.25}};
  const std::string page = reportPage(content);
  EXPECT_THAT(page, HasSubstr("took no part"));
  EXPECT_THAT(page, HasSubstr("2024-12-05T12:00:30.000Z"));
  EXPECT_THAT(page, HasSubstr("48.2 m"));
}

TEST(ReportPage, NeedsNothingFromOutside) {
  const std::string page = reportPage(sample());
  for (const char* reference : {"http:", "https:", "src=\"/", "<link", "url(", "@import"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,AQID"));
}

TEST(ReportPage, FiguresStandWithTheirUnits) {
  ReportContent content = sample();
  content.summary.waterHeight_m = 0;
  const std::string page = reportPage(content);
  EXPECT_THAT(page, HasSubstr("1&#8239;234&#8239;567"));
  EXPECT_THAT(page, HasSubstr("2.25 &ndash; 4.50"));  // depths below a water height of zero
  EXPECT_THAT(page, HasSubstr("1.5 MB"));
  EXPECT_THAT(page, HasSubstr("unknown.xyz"));
}

TEST(ReportPage, NothingToReport_SaysNone) { EXPECT_THAT(reportPage({}), HasSubstr("<p>None.</p>")); }

TEST(ReportPage, Elements_AreClosedInOrder) {
  const std::string page = reportPage(sample());
  std::stack<std::string> open;
  const std::string afterStyle = page.substr(page.find("</style>") + 8);
  for (std::size_t i = afterStyle.find("<body>"); i != std::string::npos; i = afterStyle.find('<', i + 1)) {
    const std::size_t end = afterStyle.find_first_of(" >", i);
    const std::string name = afterStyle.substr(i + 1, end - i - 1);
    if (name == "img") continue;
    if (name[0] != '/') {
      open.push(name);
      continue;
    }
    if (name == "/html") break;
    ASSERT_FALSE(open.empty()) << name;
    EXPECT_EQ("/" + open.top(), name);
    open.pop();
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace
}  // namespace s2s::products
