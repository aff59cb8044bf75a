#include <gtest/gtest.h>

#include <cmath>

#include "s2s/map/scan.h"

namespace {

using namespace s2s::map;
using s2s::obs::BearingModel;

TEST(Scan, PackedPoint_KeepsThePlaceExactlyAndTheRestToElevenBits) {
  for (const float intensity : {0.0f, 0.37f, 1.0f, 255.0f, 2047.0f, 30000.0f}) {
    const ScanPoint back = unpack(pack({{12.345f, -0.001f, 88.8f}, intensity, 0.0234f}));
    EXPECT_EQ(back.p_vehicle, Eigen::Vector3f(12.345f, -0.001f, 88.8f));
    EXPECT_NEAR(back.intensity, intensity, intensity / 2048);  // half the step of an eleven-bit significand
    EXPECT_NEAR(back.sigma_m, 0.0234, 0.0234 / 2048);
  }
}

TEST(Scan, PackedIntensityBeyondHalfFloat_IsTheLargestOne) {
  EXPECT_EQ(unpack(pack({{}, 65535.0f, 0})).intensity, 65504.0f);
}

TEST(Scan, SigmaCode_NeverFlattersAndIsStable) {
  for (double sigma = 0.001; sigma < 20; sigma *= 1.013) {
    const double decoded = decodeSigma(encodeSigma(sigma));
    EXPECT_GE(decoded, sigma * (1 - 1e-6));
    EXPECT_LE(decoded, sigma * 1.04 * (1 + 1e-6));  // one step of the code
    EXPECT_EQ(encodeSigma(decoded), encodeSigma(sigma));
  }
  EXPECT_EQ(encodeSigma(std::nan("")), 0);
}

TEST(Scan, ArcPoint_MeasuresItsRangeAndBearingInBothModels) {
  for (double bearing = -1.1; bearing <= 1.1; bearing += 0.2)
    for (double elevation = -0.17; elevation <= 0.17; elevation += 0.05) {
      const Eigen::Vector3d azimuth = arcPoint(BearingModel::Azimuth, 7, bearing, elevation);
      EXPECT_NEAR(azimuth.norm(), 7, 1e-12);
      EXPECT_NEAR(std::atan2(azimuth.y(), azimuth.x()), bearing, 1e-12);
      const Eigen::Vector3d cone = arcPoint(BearingModel::Cone, 7, bearing, elevation);
      EXPECT_NEAR(cone.norm(), 7, 1e-12);
      EXPECT_NEAR(std::asin(cone.y() / cone.norm()), bearing, 1e-12);
      EXPECT_NEAR(std::asin(azimuth.z() / 7), elevation, 1e-12);
    }
}

}  // namespace
