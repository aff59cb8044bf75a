#include <gtest/gtest.h>

#include <cmath>

#include "s2s/map/scan.h"

namespace {

using namespace s2s::map;

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

}  // namespace
