#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "s2s/products/colour_ramp.h"

namespace s2s::products {

/// Inks of all pictures.
constexpr Rgb kPaper = {255, 255, 255}, kInk = {45, 48, 54}, kFaint = {222, 226, 230}, kPathColour = {214, 48, 40},
              kWaterColour = {70, 140, 200};

enum class Align { Left, Centre, Right };

cv::Scalar toBgr(Rgb colour);

/// Text with its base line at y; x as `align` says.
void drawText(cv::Mat& image, const std::string& text, int x, int y, Align align = Align::Left, double size = 1);

/// A horizontal bar of the ramp with a title above and three labels below. A label is `factor * value`, so that depths
/// can be shown of heights.
void drawColourBar(cv::Mat& image, const ColourRamp& ramp, const std::string& title, cv::Rect place, double zero,
                   double factor);

/// A bar of a round number of metres, at most `room_px` long, with its length written above.
void drawScaleBar(cv::Mat& image, double pxPerMetre, int x, int y, int room_px);

/// A line (no width) or a filled square with a text beside it; returns the x behind it.
int drawKey(cv::Mat& image, Rgb colour, const std::string& text, int x, int y);

/// 1, 2 or 5 times a power of ten, the largest not above `value`.
double roundStep(double value);

/// The multiples of `step` within [low, high].
std::vector<double> ticks(double low, double high, double step);

/// "0.5", "12": no more decimals than a step of that size needs.
std::string stepText(double value, double step);

/// Compressed picture; `extension` is ".png" or ".jpg".
std::vector<unsigned char> encode(const cv::Mat& image, const std::string& extension);

/// Writes an encoded picture as a file of its own.
/// @throws core::OutputError
void writePicture(const std::string& path, const cv::Mat& image);

}  // namespace s2s::products
