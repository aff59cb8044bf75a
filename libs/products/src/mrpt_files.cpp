#include "s2s/products/mrpt_files.h"

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <mrpt/serialization/archiveFrom_std_streams.h>

#include <algorithm>

#include "s2s/core/atomic_file.h"
#include "s2s/core/error.h"

namespace s2s::products {

namespace {

/// As `saveToFile` of MRPT's classes, but not compressed, which their readers accept: they do not notice when closing
/// the gz stream fails, and compressing takes ten times as long as all the rest.
void writeObject(const std::string& path, const mrpt::serialization::CSerializable& object) {
  core::AtomicFile file(path);
  auto archive = mrpt::serialization::archiveFrom<std::ostream>(file.stream());
  try {
    archive << object;
  } catch (const std::exception&) {  // its text is MRPT's call stack
    throw core::OutputError("writing failed", path, "check that the disk has room");
  }
  file.commit();
}

mrpt::opengl::CSetOfLines::Ptr pathLines(const core::Trajectory& trajectory) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("trajectory");
  lines->setColor_u8(0xe0, 0x4b, 0x2f, 0xff);
  lines->setLineWidth(2);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Eigen::Vector3d a = trajectory.poses()[i - 1].T.translation(), b = trajectory.poses()[i].T.translation();
    lines->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }
  return lines;
}

mrpt::opengl::CPointCloud::Ptr dots(const core::Trajectory& keyframes) {
  auto cloud = mrpt::opengl::CPointCloud::Create();
  cloud->setName("keyframes");
  cloud->setColor_u8(0x20, 0x20, 0x20, 0xff);
  cloud->setPointSize(5);
  for (const auto& pose : keyframes.poses()) {
    const Eigen::Vector3f p = pose.T.translation().cast<float>();
    cloud->insertPoint(p.x(), p.y(), p.z());
  }
  return cloud;
}

mrpt::opengl::CGridPlaneXY::Ptr waterGrid(const core::Trajectory& trajectory, double waterHeight_m) {
  Eigen::AlignedBox3d box(Eigen::Vector3d::Zero());
  for (const auto& pose : trajectory.poses()) box.extend(Eigen::Vector3d(pose.T.translation()));
  const auto edge = [](double value, double outward) {
    return static_cast<float>(10 * std::round((value + outward) / 10));
  };
  auto grid =
      mrpt::opengl::CGridPlaneXY::Create(edge(box.min().x(), -15), edge(box.max().x(), 15), edge(box.min().y(), -15),
                                         edge(box.max().y(), 15), static_cast<float>(waterHeight_m), 10.0F);
  grid->setName("water surface, 10 m");
  grid->setColor_u8(0x80, 0xa0, 0xc0, 0x60);
  return grid;
}

}  // namespace

SceneBuilder::SceneBuilder(const MapColours& colours, std::uint64_t stride) : colours_(colours), stride_(stride) {
  for (const auto layer : map::kLayers) {
    auto& cloud = clouds_[static_cast<std::size_t>(layer)];
    cloud = mrpt::opengl::CPointCloudColoured::Create();
    cloud->setName(map::layerName(layer));
    cloud->setPointSize(layer == map::Layer::Lidar ? 1.5F : 2.5F);
  }
}

void SceneBuilder::add(const map::MapPoint& point) {
  if (offered_++ % stride_ != 0) return;
  ++kept_;
  const Rgb c = (point.layer == map::Layer::Lidar ? colours_.lidar : colours_.sonar).at(point.p_map.z());
  const Eigen::Vector3f p = point.p_map.cast<float>();
  constexpr float kFull = 255;
  clouds_[static_cast<std::size_t>(point.layer)]->push_back(p.x(), p.y(), p.z(), static_cast<float>(c[0]) / kFull,
                                                            static_cast<float>(c[1]) / kFull,
                                                            static_cast<float>(c[2]) / kFull);
}

void SceneBuilder::write(const std::string& path, const core::Trajectory& trajectory, const core::Trajectory& keyframes,
                         std::optional<double> waterHeight_m) {
  mrpt::opengl::COpenGLScene scene;
  for (const auto& cloud : clouds_)
    if (!cloud->empty()) scene.insert(cloud);
  scene.insert(pathLines(trajectory));
  if (!keyframes.empty()) scene.insert(dots(keyframes));
  if (waterHeight_m) scene.insert(waterGrid(trajectory, *waterHeight_m));
  auto frame = mrpt::opengl::stock_objects::CornerXYZ(2.0F);
  frame->setName("map");
  scene.insert(frame);
  writeObject(path, scene);
}

SimpleMapBuilder::SimpleMapBuilder(const core::Trajectory& keyframes, std::uint64_t stride)
    : keyframes_(keyframes), points_vehicle_(keyframes.size()), stride_(stride) {
  for (const auto& pose : keyframes_.poses()) T_vehicle_map_.push_back(pose.T.inverse());
}

void SimpleMapBuilder::add(const map::MapPoint& point) {
  if (offered_++ % stride_ != 0 || keyframes_.empty()) return;
  const auto& poses = keyframes_.poses();
  auto after = std::lower_bound(poses.begin(), poses.end(), point.time,
                                [](const core::TimedPose& pose, core::TimeNs time) { return pose.time < time; });
  if (after == poses.end() ||
      (after != poses.begin() && point.time - std::prev(after)->time < after->time - point.time))
    --after;
  const auto i = static_cast<std::size_t>(after - poses.begin());
  points_vehicle_[i].push_back((T_vehicle_map_[i] * point.p_map).cast<float>());
}

void SimpleMapBuilder::write(const std::string& path) const {
  mrpt::maps::CSimpleMap map;
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    auto cloud = mrpt::maps::CSimplePointsMap::Create();
    cloud->reserve(points_vehicle_[i].size());
    for (const auto& p : points_vehicle_[i]) cloud->insertPointFast(p.x(), p.y(), p.z());
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->timestamp = core::toMrptTime(keyframes_.poses()[i].time);
    observation->sensorLabel = "MAP";
    observation->pointcloud = cloud;
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    const mrpt::poses::CPose3DPDFGaussian pose(core::toPose(keyframes_.poses()[i].T));
    map.insert(pose, frame);
  }
  writeObject(path, map);
}

}  // namespace s2s::products
