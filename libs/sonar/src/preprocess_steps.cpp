#include "preprocess_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace s2s::sonar::steps {

namespace {

using Histogram = std::array<std::uint32_t, 256>;

/// Four interleaved tables: equal neighbours would otherwise wait for each other's increment.
Histogram countLevels(const std::uint8_t* pixels, std::size_t count) {
  std::array<Histogram, 4> tables{};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    ++tables[0][pixels[i]];
    ++tables[1][pixels[i + 1]];
    ++tables[2][pixels[i + 2]];
    ++tables[3][pixels[i + 3]];
  }
  for (; i < count; ++i) ++tables[0][pixels[i]];
  for (std::size_t level = 0; level < 256; ++level)
    tables[0][level] += tables[1][level] + tables[2][level] + tables[3][level];
  return tables[0];
}

std::uint8_t rowQuantile8(const std::uint8_t* row, std::size_t count, std::size_t rank) {
  std::array<std::uint16_t, 256> even{}, odd{};
  std::size_t i = 0;
  for (; i + 2 <= count; i += 2) {
    ++even[row[i]];
    ++odd[row[i + 1]];
  }
  if (i < count) ++even[row[i]];
  std::size_t seen = 0;
  for (std::size_t level = 0; level < 256; ++level) {
    seen += even[level] + odd[level];
    if (seen > rank) return static_cast<std::uint8_t>(level);
  }
  return 255;
}

float rowQuantileF(const float* row, std::size_t count, std::size_t rank, std::vector<float>& scratch) {
  scratch.assign(row, row + count);
  std::nth_element(scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(rank), scratch.end());
  return scratch[rank];
}

void subtract8(std::uint8_t* row, std::size_t count, std::uint8_t value) {
  for (std::size_t i = 0; i < count; ++i) row[i] = static_cast<std::uint8_t>(std::max(row[i], value) - value);
}

void subtractF(float* row, std::size_t count, float value) {
  for (std::size_t i = 0; i < count; ++i) row[i] = std::max(row[i] - value, 0.0f);
}

double maximumOf(const cv::Mat& image) {
  double maximum = 0;
  cv::minMaxIdx(image, nullptr, &maximum);
  return maximum;
}

/// Histogram of 256 classes between 0 and `maximum`.
Histogram countClasses(const cv::Mat& image, double maximum) {
  if (image.depth() == CV_8U) return countLevels(image.ptr<std::uint8_t>(), image.total());
  Histogram histogram{};
  const float scale = maximum > 0 ? static_cast<float>(255.999 / maximum) : 0.0f;
  const float* pixels = image.ptr<float>();
  const std::size_t count = image.total();
  for (std::size_t i = 0; i < count; ++i)
    ++histogram[static_cast<std::size_t>(std::clamp(pixels[i] * scale, 0.0f, 255.0f))];
  return histogram;
}

/// The class that splits the histogram with the largest variance between the two sides.
std::size_t otsuClass(const Histogram& histogram) {
  double total = 0, totalSum = 0;
  for (std::size_t level = 0; level < 256; ++level) {
    total += histogram[level];
    totalSum += static_cast<double>(level) * histogram[level];
  }
  double weight = 0, sum = 0, best = -1;
  std::size_t bestLevel = 0;
  for (std::size_t level = 0; level < 255; ++level) {
    weight += histogram[level];
    sum += static_cast<double>(level) * histogram[level];
    if (weight == 0 || weight == total) continue;
    const double difference = sum / weight - (totalSum - sum) / (total - weight);
    const double between = weight * (total - weight) * difference * difference;
    if (between <= best) continue;
    best = between;
    bestLevel = level;
  }
  return bestLevel;
}

/// Value of a quantile of the pixels above 0; `maximum` if the quantile is 1 or no pixel is above 0.
double quantileOfNonZero(const cv::Mat& image, double quantile, double maximum) {
  if (quantile >= 1 || maximum <= 0) return maximum;
  const Histogram histogram = countClasses(image, maximum);
  const double total = static_cast<double>(image.total()) - histogram[0];
  double seen = 0;
  for (std::size_t level = 1; level < 256; ++level) {
    seen += histogram[level];
    if (seen >= quantile * total)
      return image.depth() == CV_8U ? static_cast<double>(level) : maximum * static_cast<double>(level + 1) / 256.0;
  }
  return maximum;
}

}  // namespace

void subtractRowQuantile(cv::Mat& image, double quantile) {
  const auto count = static_cast<std::size_t>(image.cols);
  const auto rank = static_cast<std::size_t>(std::floor(quantile * static_cast<double>(count - 1)));
  std::vector<float> scratch;
  for (int r = 0; r < image.rows; ++r) {
    if (image.depth() == CV_8U) {
      auto* row = image.ptr<std::uint8_t>(r);
      subtract8(row, count, rowQuantile8(row, count, rank));
    } else {
      auto* row = image.ptr<float>(r);
      subtractF(row, count, rowQuantileF(row, count, rank, scratch));
    }
  }
}

void subtractRowMean(cv::Mat& image) {
  const auto count = static_cast<std::size_t>(image.cols);
  for (int r = 0; r < image.rows; ++r) {
    if (image.depth() == CV_8U) {
      auto* row = image.ptr<std::uint8_t>(r);
      std::uint32_t sum = 0;
      for (std::size_t i = 0; i < count; ++i) sum += row[i];
      subtract8(row, count, static_cast<std::uint8_t>((sum + count / 2) / count));
    } else {
      auto* row = image.ptr<float>(r);
      double sum = 0;
      for (std::size_t i = 0; i < count; ++i) sum += row[i];
      subtractF(row, count, static_cast<float>(sum / static_cast<double>(count)));
    }
  }
}

void clearWeakPixels(cv::Mat& image, const std::vector<char>& columns, double level) {
  const double threshold = level * maximumOf(image);
  std::vector<int> chosen;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] != 0) chosen.push_back(static_cast<int>(i));
  for (int r = 0; r < image.rows; ++r)
    for (const int c : chosen) {
      if (image.depth() == CV_8U) {
        if (image.at<std::uint8_t>(r, c) < threshold) image.at<std::uint8_t>(r, c) = 0;
      } else if (static_cast<double>(image.at<float>(r, c)) < threshold) {
        image.at<float>(r, c) = 0;
      }
    }
}

double otsuThreshold(const cv::Mat& image) {
  const double maximum = maximumOf(image);
  const auto split = static_cast<double>(otsuClass(countClasses(image, maximum)));
  return image.depth() == CV_8U ? split : maximum * (split + 1) / 256.0;
}

void clearUpTo(cv::Mat& image, double threshold) {
  const std::size_t count = image.total();
  if (image.depth() == CV_8U) {
    const auto limit = static_cast<std::uint8_t>(std::clamp(std::floor(threshold), 0.0, 255.0));
    auto* pixels = image.ptr<std::uint8_t>();
    for (std::size_t i = 0; i < count; ++i) pixels[i] = pixels[i] > limit ? pixels[i] : 0;
    return;
  }
  auto* pixels = image.ptr<float>();
  const auto limit = static_cast<float>(threshold);
  for (std::size_t i = 0; i < count; ++i) pixels[i] = pixels[i] > limit ? pixels[i] : 0.0f;
}

void normaliseTo8Bit(cv::Mat& image, double quantile) {
  double minimum = 0, maximum = 0;
  cv::minMaxIdx(image, &minimum, &maximum);
  const double top = std::max(quantileOfNonZero(image, quantile, maximum), minimum);
  const double scale = top > minimum ? 255.0 / (top - minimum) : 0.0;
  if (image.depth() == CV_8U) {
    std::array<std::uint8_t, 256> table{};
    for (std::size_t level = 0; level < 256; ++level)
      table[level] = cv::saturate_cast<std::uint8_t>((static_cast<double>(level) - minimum) * scale);
    auto* pixels = image.ptr<std::uint8_t>();
    const std::size_t count = image.total();
    for (std::size_t i = 0; i < count; ++i) pixels[i] = table[pixels[i]];
    return;
  }
  cv::Mat out;
  image.convertTo(out, CV_8U, scale, -minimum * scale);
  image = out;
}

}  // namespace s2s::sonar::steps
