#include "s2s/sonar/sonar_device.h"

namespace s2s::sonar {

DeviceOptions horizontalDefaults() {
  DeviceOptions options;
  // Beyond the paper, whose edge is 0 and false: where the bed meets the aperture's edge at a grazing angle its echo is
  // dim and mostly speckle, and the wall's stands behind it.
  options.leadingEdge.speckleWindow_rad = 2.0 * M_PI / 180.0;
  options.leadingEdge.ridges = true;
  options.leadingEdge.ridgeWindow_rad = 2.5 * M_PI / 180.0;
  return options;
}

DeviceOptions verticalDefaults() {
  DeviceOptions options;
  options.preprocess = blueViewPreprocess();
  options.leadingEdge.threshold = 130;
  options.leadingEdge.bearingSigma_rad = options.features.bearingSigma_rad = 0.12 * M_PI / 180.0;
  options.cfar.referenceCells = 24;
  options.cfar.minIntensity = 130;
  return options;
}

SonarDevice::SonarDevice(const DeviceOptions& options)
    : options_(options), preprocessor_(options.preprocess), cfar_(options.cfar) {}

ProcessedPing SonarDevice::process(const obs::CObservationImagingSonar& ping) const {
  ProcessedPing processed;
  processed.image = preprocessor_.process(ping);
  processed.geometry = geometryOf(ping);
  processed.lineScan = findLeadingEdge(processed.image, processed.geometry, options_.leadingEdge);
  return processed;
}

}  // namespace s2s::sonar
