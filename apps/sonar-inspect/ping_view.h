#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>

#include "s2s/sonar/ping_geometry.h"

namespace s2s::inspect {

/// A colour picture of a ping and where its pixels lie on it, so that stages can draw over it.
///
/// The sonar is at the bottom, far is up; port (positive bearings) is on the left.
struct PingView {
  cv::Mat picture;                                              ///< BGR
  std::function<cv::Point2d(double bin, double beam)> toPixel;  ///< pixel centre of a range bin and beam
};

/// Range bins over beams, as the device gives them. Float images are scaled by their maximum.
PingView polarView(const cv::Mat& image, const sonar::PingGeometry& geometry);

/// The imaging plane to scale, with range rings and bearings every 15 degrees.
PingView cartesianView(const cv::Mat& image, const sonar::PingGeometry& geometry);

/// A colour of its own for each small number.
cv::Scalar colorOf(int index);

void drawDot(PingView& view, double bin, double beam, const cv::Scalar& color, int radius = 1);
/// One line of text in the top left corner.
void drawTitle(cv::Mat& picture, const std::string& text);
/// Both pictures beside each other, at the bottom of a common height.
cv::Mat sideBySide(const cv::Mat& left, const cv::Mat& right);

}  // namespace s2s::inspect
