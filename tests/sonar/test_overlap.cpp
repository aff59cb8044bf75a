#include <gtest/gtest.h>

#include "s2s/sonar/overlap.h"
#include "synthetic_pings.h"

namespace s2s::sonar {
namespace {

TEST(Overlap, EveryPixelWithACommonPoint_IsKept) {
  const auto h = geometryOf(test::emptyPing()), v = geometryOf(test::emptyPing(256, 700, 45 * test::kDeg));
  const core::Isometry T_h_v = core::isometryFromXyzYpr(0.1, 0.3, 0.2, 0.1, -0.05, M_PI / 2 + 0.1);
  const auto overlap = findOverlap(h, v, T_h_v.inverse());
  std::size_t common = 0, kept = 0;
  for (int beam = 0; beam < 512; beam += 5)
    for (int bin = 0; bin < 700; bin += 11) {
      bool seen = false;
      for (double e = -10; e <= 10; e += 0.5)
        seen = seen ||
               isInView(v, T_h_v.inverse() *
                               pointAt({h.range_m(bin), h.bearings_rad[static_cast<std::size_t>(beam)], e * test::kDeg},
                                       h.bearingModel));
      common += seen ? 1 : 0;
      kept += overlap.contains(beam, bin) ? 1 : 0;
      EXPECT_TRUE(!seen || overlap.contains(beam, bin)) << beam << " " << bin;
    }
  EXPECT_GT(common, 100u);
  EXPECT_LT(kept, 2 * common);  // trimmed, not kept whole
}

TEST(Overlap, CrossedSonars_ShareTheApertureWindow) {
  // Side by side at one place, the horizontal sonar shares the beams within the vertical one's 20 degree aperture.
  const auto h = geometryOf(test::emptyPing()), v = geometryOf(test::emptyPing(256, 700, 45 * test::kDeg));
  const core::Isometry T_v_h = core::isometryFromXyzYpr(0, 0, 0, 0, 0, -M_PI / 2);
  const auto& region = findOverlap(h, v, T_v_h).region;
  // Ten degrees and at most two grid steps of a degree.
  EXPECT_NEAR(h.bearings_rad[static_cast<std::size_t>(region.firstBeam)] / test::kDeg, -11, 1.3);
  EXPECT_NEAR(h.bearings_rad[static_cast<std::size_t>(region.endBeam - 1)] / test::kDeg, 11, 1.3);
}

TEST(Overlap, SonarsBackToBack_ShareNothing) {
  const auto g = geometryOf(test::emptyPing(256, 700, 45 * test::kDeg));
  EXPECT_TRUE(findOverlap(g, g, core::isometryFromXyzYpr(0, 0, 0, M_PI, 0, M_PI / 2)).region.empty());
}

TEST(Overlap, SonarOfOneBeam_SharesWhatTheOtherSeesOfIt) {
  const auto one = geometryOf(test::emptyPing(1)), fan = geometryOf(test::emptyPing());
  for (const auto& overlap :
       {findOverlap(one, fan, core::Isometry::Identity()), findOverlap(fan, one, core::Isometry::Identity())})
    EXPECT_LE(overlap.region.endBeam, static_cast<int>(overlap.bins.size()));
  EXPECT_EQ(findOverlap(one, fan, core::Isometry::Identity()).region.endBeam, 1);
}

TEST(Overlap, EmptyGeometry_SharesNothing) {
  EXPECT_TRUE(findOverlap({}, {}, core::Isometry::Identity()).region.empty());
}

}  // namespace
}  // namespace s2s::sonar
