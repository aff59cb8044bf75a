#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/opengl/stock_objects.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "s2s/obs/CObservationImagingSonar.h"

namespace s2s::obs {

namespace {

/// The ping as an 8-bit picture, rows = range bins, scaled so that the strongest sample is white.
mrpt::img::CImage fanTexture(const CObservationImagingSonar& ping) {
  mrpt::img::CImage image(static_cast<int>(ping.beamCount), static_cast<int>(ping.rangeCount), mrpt::img::CH_RGB);
  std::uint32_t strongest = 1;
  for (std::size_t bin = 0; bin < ping.rangeCount; ++bin)
    for (std::size_t beam = 0; beam < ping.beamCount; ++beam) strongest = std::max(strongest, ping.sample(bin, beam));
  for (unsigned bin = 0; bin < ping.rangeCount; ++bin)
    for (unsigned beam = 0; beam < ping.beamCount; ++beam) {
      const auto grey = static_cast<std::uint8_t>(255.0 * ping.sample(bin, beam) / strongest);
      std::uint8_t* pixel = image.ptr<std::uint8_t>(beam, bin);
      pixel[0] = pixel[1] = pixel[2] = grey;
    }
  return image;
}

mrpt::opengl::TTriangle::Vertex fanVertex(const CObservationImagingSonar& ping, std::size_t beam, double range_m) {
  mrpt::opengl::TTriangle::Vertex vertex;
  const double bearing = ping.bearings_rad[beam];
  vertex.xyzrgba.pt = {static_cast<float>(range_m * std::cos(bearing)), static_cast<float>(range_m * std::sin(bearing)),
                       0};
  vertex.uv.x = (static_cast<float>(beam) + 0.5f) / static_cast<float>(ping.beamCount);
  vertex.uv.y = static_cast<float>((range_m - ping.rangeOffset_m) / (ping.maxRange_m() - ping.rangeOffset_m));
  return vertex;
}

}  // namespace

void CObservationImagingSonar::getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const {
  o.clear();
  auto corner = mrpt::opengl::stock_objects::CornerXYZSimple(0.5f, 3.0f);
  corner->setPose(sensorPose);
  o.insert(corner);
  if (beamCount < 2 || rangeCount < 1) return;

  auto fan = mrpt::opengl::CSetOfTexturedTriangles::Create();
  for (std::size_t beam = 0; beam + 1 < beamCount; ++beam) {
    const auto near0 = fanVertex(*this, beam, rangeOffset_m), near1 = fanVertex(*this, beam + 1, rangeOffset_m);
    const auto far0 = fanVertex(*this, beam, maxRange_m()), far1 = fanVertex(*this, beam + 1, maxRange_m());
    for (const auto& corners : {std::array{near0, far0, far1}, std::array{near0, far1, near1}}) {
      mrpt::opengl::TTriangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle.vertices[i] = corners[i];
      triangle.computeNormals();
      fan->insertTriangle(triangle);
    }
  }
  fan->enableLight(false);
  fan->assignImage(fanTexture(*this));
  fan->setPose(sensorPose);
  o.insert(fan);
}

}  // namespace s2s::obs
