// How CSeabedSkyMap is seen and saved.

#include <mrpt/img/color_maps.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"
#include "s2s/map/CSeabedSkyMap.h"

namespace s2s::map {

namespace {

struct Colour {
  float r = 0, g = 0, b = 0;
};

Colour mixed(const Colour& low, const Colour& high, float share) {
  return {low.r + share * (high.r - low.r), low.g + share * (high.g - low.g), low.b + share * (high.b - low.b)};
}

/// Above water by height from dark to light ochre; below, one hue a kind of sonar data, darker with depth.
Colour colourOf(Layer layer, float share) {
  switch (layer) {
    case Layer::Lidar:
      return mixed({0.25f, 0.28f, 0.30f}, {0.95f, 0.90f, 0.75f}, share);
    case Layer::Stereo:
      return mixed({0.55f, 0.15f, 0.05f}, {1.0f, 0.60f, 0.20f}, share);
    case Layer::LineHorizontal:
      return mixed({0.05f, 0.15f, 0.45f}, {0.30f, 0.80f, 0.95f}, share);
    case Layer::LineVertical:
      return mixed({0.05f, 0.30f, 0.15f}, {0.45f, 0.95f, 0.40f}, share);
  }
  return {};
}

void writeLayerText(const CSeabedSkyMap& map, Layer layer, const std::string& path) {
  core::AtomicFile file(path);
  auto& out = file.stream();
  out << "% x_m y_m z_m intensity sigma_m time_s\n";
  map.forEachPoint(layer, [&out](const MapPoint& point) {
    char line[160];
    std::snprintf(line, sizeof line, "%.4f %.4f %.4f %g %.4f ", point.p_map.x(), point.p_map.y(), point.p_map.z(),
                  static_cast<double>(point.intensity), static_cast<double>(point.sigma_m));
    out << line << core::formatUnixTime(point.time) << '\n';
  });
  file.commit();
}

}  // namespace

void CSeabedSkyMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const {
  if (!genericMapParams.enableSaveAs3DObject) return;
  const auto limit = static_cast<std::size_t>(std::max(1, options_.view.maxPoints));
  const std::size_t step = (pointCount() + limit - 1) / limit;
  for (const Layer layer : kLayers) {
    const auto box = boundingBox(layer);
    if (!box) continue;
    auto cloud = mrpt::opengl::CPointCloudColoured::Create();
    cloud->setName(layerName(layer));
    cloud->setPointSize(static_cast<float>(options_.view.pointSize));
    cloud->reserve(pointCount(layer) / step + 1);
    const double scale = 1.0 / std::max(1e-3, box->max.z - box->min.z);
    std::size_t number = 0;
    forEachPoint(layer, [&](const MapPoint& point) {
      if (number++ % step != 0) return;
      const Eigen::Vector3f p = point.p_map.cast<float>();
      const Colour c = colourOf(layer, static_cast<float>((point.p_map.z() - box->min.z) * scale));
      cloud->push_back(p.x(), p.y(), p.z(), c.r, c.g, c.b);
    });
    out.insert(cloud);
  }
}

void CSeabedSkyMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  for (const Layer layer : kLayers)
    if (pointCount(layer) != 0) writeLayerText(*this, layer, prefix + "_" + layerName(layer) + ".txt");
  if (!genericMapParams.enableSaveAs3DObject) return;
  mrpt::opengl::COpenGLScene scene;
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  getVisualizationInto(*objects);
  scene.insert(objects);
  core::AtomicFile file(prefix + ".3Dscene");
  if (!scene.saveToFile(file.temporaryPath()))
    throw core::OutputError("cannot write the 3D scene", prefix + ".3Dscene", "check the folder and the free space");
  file.commit();
}

}  // namespace s2s::map
