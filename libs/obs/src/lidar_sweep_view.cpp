#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>

#include "s2s/obs/CObservationLidarSweep.h"
#include "s2s/obs/sweep_projector.h"

namespace s2s::obs {

void CObservationLidarSweep::getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const {
  o.clear();
  auto corner = mrpt::opengl::stock_objects::CornerXYZSimple(1.0f, 3.0f);
  corner->setPose(sensorPose);
  o.insert(corner);
  if (echoes.empty() || pixelCount() == 0) return;

  SweepProjector projector;
  projector.prepare(*this);
  auto cloud = mrpt::opengl::CPointCloudColoured::Create();
  for (const Echo& echo : echoes)
    for (std::size_t row = 0; row < rowCount; ++row)
      for (std::size_t column = 0; column < columnCount; ++column) {
        const std::uint32_t range = echo.range[row * columnCount + column];
        if (range == 0 || !isColumnValid(column)) continue;
        const Eigen::Vector3f p = projector.point(row, column, range);
        cloud->push_back(p.x(), p.y(), p.z(), 1, 1, 1);
      }
  cloud->setPointSize(2.0f);
  cloud->recolorizeByCoordinate(-3.0f, 15.0f, 2);
  cloud->setPose(sensorPose);
  o.insert(cloud);
}

}  // namespace s2s::obs
