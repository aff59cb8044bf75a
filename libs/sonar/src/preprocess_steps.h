#pragma once

#include <opencv2/core.hpp>
#include <vector>

/// Kernels of the preprocessing chain. Images are CV_8U or CV_32F, rows = range bins, columns = beams; each works in
/// place.
namespace s2s::sonar::steps {

/// Subtracts from each row its lower quantile (the value of rank floor(q (n - 1))), clamped at 0.
void subtractRowQuantile(cv::Mat& image, double quantile);

/// Subtracts from each row its mean (rounded for 8-bit images), clamped at 0.
void subtractRowMean(cv::Mat& image);

/// Clears pixels below `level` times the image's maximum in the columns with `columns[i] != 0`.
void clearWeakPixels(cv::Mat& image, const std::vector<char>& columns, double level);

/// Otsu's threshold over 256 classes between 0 and the maximum (for 8 bit: the grey levels themselves).
double otsuThreshold(const cv::Mat& image);

/// Clears all pixels that are not above the threshold.
void clearUpTo(cv::Mat& image, double threshold);

/// Maps minimum..quantile of the non-zero pixels to 0..255 and converts to CV_8U.
void normaliseTo8Bit(cv::Mat& image, double quantile);

}  // namespace s2s::sonar::steps
