#include "s2s/sim/ray_caster.h"

#include <embree3/rtcore.h>

#include <cstring>
#include <stdexcept>

namespace s2s::sim {

struct RayCaster::Embree {
  Embree() : device(rtcNewDevice("threads=2")), scene(device ? rtcNewScene(device) : nullptr) {
    if (!scene) throw std::runtime_error("Embree gives no ray-casting device");
  }
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  void add(const TriangleMesh& mesh, std::uint32_t id) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Eigen::Vector3f), mesh.vertices.size());
    std::memcpy(vertices, mesh.vertices.data()->data(), mesh.vertices.size() * sizeof(Eigen::Vector3f));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(std::uint32_t), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data()->data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  RTCDevice device;
  RTCScene scene;
};

namespace {

void fill(RTCRayHit& r, const Ray& ray) {
  r.ray.org_x = ray.origin.x();
  r.ray.org_y = ray.origin.y();
  r.ray.org_z = ray.origin.z();
  r.ray.dir_x = ray.direction.x();
  r.ray.dir_y = ray.direction.y();
  r.ray.dir_z = ray.direction.z();
  r.ray.tnear = 1e-3f;
  r.ray.tfar = ray.maxRange_m;
  r.ray.time = 0;
  r.ray.mask = 0xffffffffu;
  r.ray.flags = 0;
  r.ray.id = 0;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

RayHit resultOf(const RTCRayHit& r) {
  RayHit hit;
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.object = r.hit.geomID;
  hit.range_m = r.ray.tfar;
  hit.normal = Eigen::Vector3f(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z).normalized();
  if (hit.normal.dot(Eigen::Vector3f(r.ray.dir_x, r.ray.dir_y, r.ray.dir_z)) > 0) hit.normal = -hit.normal;
  return hit;
}

}  // namespace

RayCaster::RayCaster(const std::vector<SceneObject>& objects) : embree_(std::make_unique<Embree>()) {
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!objects[i].mesh.empty()) embree_->add(objects[i].mesh, static_cast<std::uint32_t>(i));
  rtcCommitScene(embree_->scene);
}

RayCaster::~RayCaster() = default;

void RayCaster::cast(const std::vector<Ray>& rays, std::vector<RayHit>& hits) const {
  constexpr std::size_t kBatch = 256;
  RTCRayHit batch[kBatch];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  hits.resize(rays.size());
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::size_t n = std::min(kBatch, rays.size() - begin);
    for (std::size_t i = 0; i < n; ++i) fill(batch[i], rays[begin + i]);
    rtcIntersect1M(embree_->scene, &context, batch, static_cast<unsigned>(n), sizeof(RTCRayHit));
    for (std::size_t i = 0; i < n; ++i) hits[begin + i] = resultOf(batch[i]);
  }
}

RayHit RayCaster::cast(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit r;
  fill(r, ray);
  rtcIntersect1(embree_->scene, &context, &r);
  return resultOf(r);
}

}  // namespace s2s::sim
