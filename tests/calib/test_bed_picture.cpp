#include <gtest/gtest.h>

#include <random>

#include "bed_picture.h"
#include "world_texture.h"

namespace s2s::calib {
namespace {

constexpr int kTile = 40;  // pixels: 1.6 m

/// A picture of a square of 3 m, from samples at random places; each sees the bed `shift` away from where it is put.
BedPicture pictureOf(const Eigen::Vector2d& shift_m, double contrast, double noise, unsigned seed, double side_m = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, side_m);
  std::normal_distribution<double> speckle(0, noise);
  std::vector<BedPicture::Sample> samples;
  for (int k = 0; k < 30000; ++k) {
    const double x = place(random), y = place(random);
    samples.push_back(
        {static_cast<float>(x), static_cast<float>(y),
         static_cast<float>(contrast * test::textureAt(x - shift_m.x(), y - shift_m.y()) + speckle(random))});
  }
  BedPicture picture;
  picture.make(samples, {});
  return picture;
}

constexpr PictureTile kMiddle = {18, 18, kTile};

TEST(BedPicture, DisplacedTexture_IsFoundBelowAPixel) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0.113, -0.072), Eigen::Vector2d(0, 0), Eigen::Vector2d(-0.26, 0.19)}) {
    const auto match =
        matchPictures(pictureOf({0, 0}, 1, 0.7, 1), pictureOf(shift, 1, 0.7, 2), kMiddle, 0.4, TextureOptions());
    ASSERT_TRUE(match);
    // A parabola through samples a pixel (4 cm) apart is off by some hundredths of it, noise by as much.
    EXPECT_NEAR(match->displacement_m.x(), shift.x(), 0.006);
    EXPECT_NEAR(match->displacement_m.y(), shift.y(), 0.006);
    EXPECT_GT(match->correlation, 2 * match->next);
  }
}

TEST(BedPicture, NoTexture_IsNotTakenForAMatch) {
  const TextureOptions options;
  int accepted = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto match =
        matchPictures(pictureOf({0, 0}, 0, 1, 2 * seed), pictureOf({0, 0}, 0, 1, 2 * seed + 1), kMiddle, 0.4, options);
    if (match && match->correlation >= options.minCorrelation &&
        match->correlation >= options.minDistinctness * match->next)
      ++accepted;
  }
  EXPECT_EQ(accepted, 0);
}

TEST(BedPicture, DisplacedBeyondReach_IsNotFoundWhereItIsNot) {
  const TextureOptions options;
  const auto match = matchPictures(pictureOf({0, 0}, 1, 0.3, 1), pictureOf({0.5, 0}, 1, 0.3, 2), kMiddle, 0.2, options);
  EXPECT_TRUE(!match || match->correlation < options.minCorrelation);
}

TEST(BedPicture, TooLittleOverlap_TellsNothing) {
  const auto first = pictureOf({0, 0}, 1, 0.3, 1), second = pictureOf({0, 0}, 1, 0.3, 2, 0.8);
  EXPECT_FALSE(matchPictures(first, second, kMiddle, 0.2, {}));
  EXPECT_LT(knownShare(second, kMiddle), 0.1);
  EXPECT_GT(knownShare(first, kMiddle), 0.95);
  EXPECT_EQ(knownShare(first, {1000, 0, kTile}), 0);
}

TEST(BedPicture, NoSamples_IsEmpty) {
  BedPicture picture;
  picture.make({}, {});
  EXPECT_TRUE(picture.empty());
}

}  // namespace
}  // namespace s2s::calib
