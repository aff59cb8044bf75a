#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "error_text.h"
#include "s2s/core/error.h"
#include "s2s/products/ply_reader.h"
#include "s2s/products/ply_writer.h"
#include "temp_folder.h"

namespace s2s::products {
namespace {

using test::errorText;
using test::readBytes;
using test::TempFolder;
using test::writeBytes;
using testing::HasSubstr;

map::MapPoint point(double x, double y, double z, float intensity, float sigma, core::TimeNs time, map::Layer layer) {
  map::MapPoint p;
  p.p_map = {x, y, z};
  p.intensity = intensity;
  p.sigma_m = sigma;
  p.time = time;
  p.layer = layer;
  return p;
}

/// Bytes of a number, appended.
template <class Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

TEST(Ply, WrittenPoints_ReadBackExactly) {
  const TempFolder folder;
  const std::vector<map::MapPoint> points = {
      point(512345.678912, -4321.000000123, 12.5, 200.5F, 0.03F, 1'733'400'000'123'456'789, map::Layer::Lidar),
      point(-1e-9, 0, -3.25, 0, 0.5F, 1'733'400'001'000'000'000, map::Layer::LineVertical)};
  PlyPointWriter writer(folder.file("a.ply"), PlyPointWriter::Columns::WithLayer);
  for (const auto& p : points) writer.add(p);
  writer.finish();
  const auto back = readPlyPoints(folder.file("a.ply"));
  ASSERT_EQ(back.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(back[i].p, points[i].p_map);
    EXPECT_EQ(back[i].intensity, points[i].intensity);
    EXPECT_EQ(back[i].sigma_m, points[i].sigma_m);
    // A double holds today's Unix time to 2.4e-7 s.
    EXPECT_NEAR(back[i].time_s - 1733400000.0, 1e-9 * static_cast<double>(points[i].time - 1'733'400'000'000'000'000),
                2.4e-7);
    EXPECT_EQ(back[i].layer, static_cast<int>(points[i].layer));
  }
}

TEST(Ply, ManyPoints_HeaderCountAndFileSizeAgree) {
  const TempFolder folder;
  constexpr int kCount = 123'457;  // several times the writer's buffer
  PlyPointWriter writer(folder.file("many.ply"));
  for (int i = 0; i < kCount; ++i) writer.add(point(i, 2 * i, -i, 1, 2, i, map::Layer::Stereo));
  writer.finish();
  const std::string bytes = readBytes(folder.file("many.ply"));
  EXPECT_THAT(bytes.substr(0, 400), HasSubstr("element vertex 123457\n"));
  // 3 doubles, 2 floats and a double a point, as the header says.
  EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + kCount * 44U);
  int next = 0;
  forEachPlyPoint(folder.file("many.ply"), [&](const PlyPoint& p) {
    EXPECT_EQ(p.p, Eigen::Vector3d(next, 2 * next, -next));
    ++next;
  });
  EXPECT_EQ(next, kCount);
}

TEST(Ply, NoPoints_GivesAValidEmptyFile) {
  const TempFolder folder;
  PlyPointWriter(folder.file("none.ply")).finish();
  EXPECT_TRUE(readPlyPoints(folder.file("none.ply")).empty());
}

TEST(Ply, WriterDroppedBeforeFinish_LeavesNoFile) {
  const TempFolder folder;
  { PlyPointWriter(folder.file("half.ply")).add(map::MapPoint{}); }
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(Ply, FolderIsAFile_IsAnOutputError) {
  const TempFolder folder;
  writeBytes(folder.file("taken"), "x");
  EXPECT_THROW(PlyPointWriter(folder.file("taken/a.ply")), core::OutputError);
}

TEST(Ply, BinaryMeshWithObjects_KeepsThemPerTriangle) {
  const TempFolder folder;
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment a square and a triangle\nelement vertex 5\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\n"
      "property int object\nend_header\n";
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 2.F}) put(bytes, v);
  put(bytes, std::uint8_t{4});
  for (const int index : {0, 1, 2, 3}) put(bytes, index);
  put(bytes, 7);
  put(bytes, std::uint8_t{3});
  for (const int index : {0, 1, 4}) put(bytes, index);
  put(bytes, -2);
  writeBytes(folder.file("mesh.ply"), bytes);
  const PlyMesh mesh = readPlyMesh(folder.file("mesh.ply"));
  ASSERT_EQ(mesh.vertices.size(), 5U);
  EXPECT_EQ(mesh.vertices[4], Eigen::Vector3d(0, 0, 2));
  const std::vector<std::array<std::uint32_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}};
  EXPECT_EQ(mesh.triangles, expected);
  EXPECT_EQ(mesh.object, (std::vector<std::int32_t>{7, 7, -2}));
}

TEST(Ply, AsciiWithUnknownElementsAndWindowsLines_IsRead) {
  const TempFolder folder;
  writeBytes(folder.file("a.ply"),
             "ply\r\nformat ascii 1.0\r\nobj_info made by hand\r\nelement camera 1\r\nproperty list uchar float k\r\n"
             "element vertex 2\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\nproperty uchar red\r\n"
             "element face 1\r\nproperty list uchar uint vertex_index\r\nend_header\r\n"
             "2 1.5 2.5\r\n1e-3 -2 3 255\r\n4 5 6 0\r\n3 0 1 0\r\n");
  const PlyMesh mesh = readPlyMesh(folder.file("a.ply"));
  ASSERT_EQ(mesh.vertices.size(), 2U);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0.001, -2, 3));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_TRUE(mesh.object.empty());
  EXPECT_EQ(readPlyPoints(folder.file("a.ply"))[1].p, Eigen::Vector3d(4, 5, 6));
}

TEST(Ply, BigEndian_IsRead) {
  const TempFolder folder;
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty short y\nproperty double z\n"
      "end_header\n";
  bytes += std::string("\x3f\x80\x00\x00\xff\xfe\x40\x08\x00\x00\x00\x00\x00\x00", 14);  // 1.0f, -2, 3.0
  writeBytes(folder.file("b.ply"), bytes);
  EXPECT_EQ(readPlyPoints(folder.file("b.ply")).at(0).p, Eigen::Vector3d(1, -2, 3));
}

struct BadPly {
  const char* name;
  std::string content;
  const char* fault;
  const char* place;
};

class PlyRefused : public testing::TestWithParam<BadPly> {};

TEST_P(PlyRefused, DamagedFile_NamesFaultAndPlace) {
  const TempFolder folder;
  writeBytes(folder.file("bad.ply"), GetParam().content);
  const std::string text = errorText<core::InputError>([&] { readPlyMesh(folder.file("bad.ply")); });
  EXPECT_THAT(text, HasSubstr(GetParam().fault));
  EXPECT_THAT(text, HasSubstr(std::string("bad.ply") + GetParam().place));
}

const std::string kAscii =  // NOLINT(cert-err58-cpp)
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kBinary =  // NOLINT(cert-err58-cpp)
    "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "end_header\n";

INSTANTIATE_TEST_SUITE_P(
    Faults, PlyRefused,
    testing::Values(
        BadPly{"NoPly", "# .PCD v0.7\n", "no PLY file", ":2"},
        BadPly{"EndlessHeader", "ply\nformat ascii 1.0\n", "no end", ":3"},
        BadPly{"UnknownType", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n", "quad", ":5"},
        BadPly{"BadCount", "ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "count", ":4"},
        BadPly{"NoCoordinates", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
               "no x, y and z", ":6"},
        BadPly{"AsciiShort", kAscii + "end_header\n1 2 3\n4 5", "cut short", ":8"},
        BadPly{"AsciiText", kAscii + "end_header\n1 2 3\n4 five 6\n", "'five' is no number", ":9"},
        BadPly{"BinaryShort", kBinary + std::string(20, '\0'), "promises 2", " byte "},
        BadPly{"HugeCount",
               "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999999\nproperty float x\n"
               "property float y\nproperty float z\nend_header\n",
               "cut short", " byte "},
        BadPly{"IndexOutside",
               kAscii + "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n4 5 6\n3 0 1 2\n",
               "names vertex 2 of 2", ":1"},
        BadPly{"ListTooLong",
               kAscii + "element face 1\nproperty list int int vertex_indices\nend_header\n1 2 3\n4 5 6\n-3 0 1 1\n",
               "impossible length", ":1"}),
    [](const auto& fault) { return fault.param.name; });

TEST(Ply, MissingFile_IsAnInputError) {
  EXPECT_THAT(errorText<core::InputError>([] { readPlyMesh("/nowhere/x.ply"); }), HasSubstr("/nowhere/x.ply"));
}

}  // namespace
}  // namespace s2s::products
