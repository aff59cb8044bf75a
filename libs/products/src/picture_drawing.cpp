#include "picture_drawing.h"

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "s2s/core/atomic_file.h"

namespace s2s::products {

namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.46;

}  // namespace

cv::Scalar toBgr(Rgb colour) { return {double(colour[2]), double(colour[1]), double(colour[0])}; }

void drawText(cv::Mat& image, const std::string& text, int x, int y, Align align, double size) {
  int baseLine = 0;
  const int width = cv::getTextSize(text, kFont, kFontScale * size, 1, &baseLine).width;
  if (align == Align::Centre) x -= width / 2;
  if (align == Align::Right) x -= width;
  cv::putText(image, text, {x, y}, kFont, kFontScale * size, toBgr(kInk), 1, cv::LINE_AA);
}

void drawColourBar(cv::Mat& image, const ColourRamp& ramp, const std::string& title, cv::Rect place, double zero,
                   double factor) {
  drawText(image, title, place.x, place.y - 7);
  for (int x = 0; x < place.width; ++x) {
    const double u = (x + 0.5) / place.width;
    const auto colour = toBgr(ramp.at(ramp.low() + u * (ramp.high() - ramp.low())));
    cv::line(image, {place.x + x, place.y}, {place.x + x, place.y + place.height - 1}, colour);
  }
  cv::rectangle(image, place, toBgr(kInk), 1);
  for (const double u : {0.0, 0.5, 1.0}) {
    const double value = factor * (ramp.low() + u * (ramp.high() - ramp.low()) - zero);
    drawText(image, stepText(value, 0.1), place.x + static_cast<int>(u * place.width), place.y + place.height + 16,
             Align::Centre);
  }
}

void drawScaleBar(cv::Mat& image, double pxPerMetre, int x, int y, int room_px) {
  const double length_m = roundStep(room_px / pxPerMetre);
  const int length_px = static_cast<int>(std::lround(length_m * pxPerMetre));
  cv::rectangle(image, cv::Rect(x, y, length_px / 2, 6), toBgr(kInk), cv::FILLED);
  cv::rectangle(image, cv::Rect(x, y, length_px, 6), toBgr(kInk), 1);
  drawText(image, stepText(length_m, length_m) + " m", x + length_px / 2, y - 7, Align::Centre);
}

int drawKey(cv::Mat& image, Rgb colour, const std::string& text, int x, int y) {
  cv::rectangle(image, cv::Rect(x, y - 9, 18, 9), toBgr(colour), cv::FILLED);
  drawText(image, text, x + 26, y);
  int baseLine = 0;
  return x + 26 + cv::getTextSize(text, kFont, kFontScale, 1, &baseLine).width + 24;
}

double roundStep(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0})
    if (factor * decade <= value) return factor * decade;
  return decade;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> out;
  for (auto i = static_cast<long long>(std::ceil(low / step)); static_cast<double>(i) * step <= high; ++i)
    out.push_back(static_cast<double>(i) * step);
  return out;
}

std::string stepText(double value, double step) {
  const int decimals = step >= 1 ? 0 : static_cast<int>(std::ceil(-std::log10(step)));
  const double unit = std::pow(10.0, -decimals);
  if (std::abs(value) < 0.5 * unit) value = 0;  // no "-0.0"
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::vector<unsigned char> encode(const cv::Mat& image, const std::string& extension) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9, cv::IMWRITE_JPEG_QUALITY, 90});
  return bytes;
}

void writePicture(const std::string& path, const cv::Mat& image) {
  const auto bytes = encode(image, ".png");
  core::AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace s2s::products
