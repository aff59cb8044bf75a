#include "pcd2rawlog/pcd_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "byte_writer.h"
#include "pcd2rawlog/lzf.h"
#include "s2s/core/error.h"
#include "temp_folder.h"

using namespace s2s;
using testing::ElementsAre;
using testing::HasSubstr;
using tools::pcd::PcdCloud;

namespace {

PcdCloud read(const std::string& bytes) {
  test::TempFolder folder;
  test::writeBytes(folder.file("a.pcd"), bytes);
  return tools::pcd::readPcd(folder.file("a.pcd"));
}

std::string faultOf(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const core::InputError& e) {
    return e.fault();
  }
  return "";
}

std::string header(const std::string& fields, const std::string& sizes, const std::string& types, std::size_t points,
                   const std::string& data) {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n";
}

const std::string kXyzi = header("x y z intensity", "4 4 4 4", "F F F F", 2, "ascii");

}  // namespace

TEST(Pcd, AsciiPoints_AreRead) {
  const auto cloud = read(kXyzi + "1 2 3 0.5\n-1.5e1 0 4 7\n");
  EXPECT_THAT(cloud.x, ElementsAre(1, -15));
  EXPECT_THAT(cloud.y, ElementsAre(2, 0));
  EXPECT_THAT(cloud.z, ElementsAre(3, 4));
  EXPECT_THAT(cloud.intensity, ElementsAre(0.5f, 7));
  EXPECT_TRUE(cloud.skippedFields.empty());
  EXPECT_FALSE(cloud.hasViewpoint);
}

TEST(Pcd, AsciiWithWindowsLineEndsAndBlankLines_IsRead) {
  std::string text = kXyzi + "1 2 3 4\n\n 5 6 7 8 \n";
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  EXPECT_THAT(read(text).x, ElementsAre(1, 5));
}

TEST(Pcd, PointsWithNaN_AreLeftOutAndCounted) {
  const auto cloud = read(kXyzi + "nan nan nan 1\n1 2 3 nan\n");
  EXPECT_EQ(cloud.notFinite, 1u);
  EXPECT_THAT(cloud.x, ElementsAre(1));
  EXPECT_THAT(cloud.intensity, ElementsAre(0));
}

TEST(Pcd, BinaryOfMixedTypes_IsReadAndOtherFieldsNamed) {
  test::ByteWriter data;
  for (int i = 0; i < 2; ++i) {
    data.add(static_cast<std::uint16_t>(i)).add(double{10.0 + i}).add(float{20.0f}).add(std::int16_t{-30});
    data.add(std::uint8_t{200}).add(float{1}).add(float{2}).add(float{3});
  }
  std::string head = header("ring x y z intensity normal", "2 8 4 2 1 4", "U F F I U F", 2, "binary");
  head.insert(head.find("WIDTH"), "COUNT 1 1 1 1 1 3\n");
  const auto cloud = read(head + data.bytes());
  EXPECT_THAT(cloud.x, ElementsAre(10, 11));
  EXPECT_THAT(cloud.y, ElementsAre(20, 20));
  EXPECT_THAT(cloud.z, ElementsAre(-30, -30));
  EXPECT_THAT(cloud.intensity, ElementsAre(200, 200));
  EXPECT_THAT(cloud.skippedFields, ElementsAre("ring", "normal"));
}

TEST(Pcd, BinaryCompressed_IsFieldAfterField) {
  // x = 1 2, y = 3 4, z = 5 6: 24 literal bytes in one LZF run.
  test::ByteWriter fields;
  for (const float value : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) fields.add(value);
  test::ByteWriter data;
  data.add(25u).add(24u).add(std::uint8_t{23}).add(fields.bytes());
  const auto cloud = read(header("x y z", "4 4 4", "F F F", 2, "binary_compressed") + data.bytes());
  EXPECT_THAT(cloud.x, ElementsAre(1, 2));
  EXPECT_THAT(cloud.y, ElementsAre(3, 4));
  EXPECT_THAT(cloud.z, ElementsAre(5, 6));
  EXPECT_TRUE(cloud.intensity.empty());
}

TEST(Pcd, Viewpoint_IsTold) {
  std::string text = kXyzi + "1 2 3 4\n5 6 7 8\n";
  text.replace(text.find("0 0 0 1"), 7, "0 0 1 1");
  EXPECT_TRUE(read(text).hasViewpoint);
}

TEST(Pcd, UnusableFiles_AreRefusedWithTheReason) {
  EXPECT_THAT(faultOf(""), HasSubstr("no DATA line"));
  EXPECT_THAT(faultOf("hello\nworld\n"), HasSubstr("'hello' is unknown"));
  EXPECT_THAT(faultOf(header("x y", "4 4", "F F", 1, "ascii") + "1 2\n"), HasSubstr("no field 'z'"));
  EXPECT_THAT(faultOf(header("x y z", "4 4", "F F F", 1, "ascii") + "1 2 3\n"), HasSubstr("SIZE has not one value"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 3", "F F F", 1, "ascii") + "1 2 3\n"), HasSubstr("SIZE 3"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 4", "F F Q", 1, "ascii") + "1 2 3\n"), HasSubstr("TYPE Q"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 2", "F F F", 1, "ascii") + "1 2 3\n"),
              HasSubstr("field 'z' has an impossible"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 4", "F F F", 1, "zipped") + "1 2 3\n"), HasSubstr("'zipped'"));
  EXPECT_THAT(faultOf(kXyzi + "1 2 3 4\n"), HasSubstr("ends after 1 of 2 points"));
  EXPECT_THAT(faultOf(kXyzi + "1 2 3 4\n1 2 x 4\n"), HasSubstr("point 1 does not parse"));
  EXPECT_THAT(faultOf(kXyzi + "1 2 3 4\n1 2 3\n"), HasSubstr("point 1 does not parse"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 4", "F F F", 9, "binary") + "1234"), HasSubstr("ends early"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 4", "F F F", 999999999999, "binary")), HasSubstr("not a usable number"));
  EXPECT_THAT(faultOf(header("x y z", "4 4 4", "F F F", 1, "binary_compressed") + "12345678"), HasSubstr("compressed"));
  // Compressed data that unpack to another size than the points take.
  EXPECT_THAT(
      faultOf(header("x y z", "4 4 4", "F F F", 9, "binary_compressed") + std::string("\3\0\0\0\2\0\0\0\1ab", 11)),
      HasSubstr("compressed data are damaged"));
  EXPECT_THROW(tools::pcd::readPcd("/nowhere/a.pcd"), core::InputError);
}

TEST(Lzf, BackReferences_RepeatWhatWasWritten) {
  using tools::pcd::lzfDecompress;
  const std::string abc(
      "\x02"
      "abc",
      4);
  // Length 4 (control 2 << 5) at distance 3: "abca".
  EXPECT_EQ(lzfDecompress(abc + std::string("\x40\x02", 2), 7), "abcabca");
  // Long form: length 7 + 10 + 2 = 19 at distance 1.
  EXPECT_EQ(lzfDecompress(abc + std::string("\xe0\x0a\x00", 3), 22), "abc" + std::string(19, 'c'));
}

TEST(Lzf, DamagedBlocks_AreRefused) {
  using tools::pcd::lzfDecompress;
  EXPECT_FALSE(lzfDecompress(std::string("\x05"
                                         "ab",
                                         3),
                             6)
                   .has_value());  // literals missing
  EXPECT_FALSE(lzfDecompress(std::string("\x00"
                                         "a\x40\x05",
                                         4),
                             5)
                   .has_value());  // before the beginning
  EXPECT_FALSE(lzfDecompress(std::string("\x00"
                                         "a\xe0",
                                         3),
                             9)
                   .has_value());  // ends within a reference
  EXPECT_FALSE(lzfDecompress(std::string("\x01"
                                         "ab",
                                         3),
                             3)
                   .has_value());  // too short
  EXPECT_FALSE(lzfDecompress(std::string("\x01"
                                         "ab",
                                         3),
                             1)
                   .has_value());  // too long
}
