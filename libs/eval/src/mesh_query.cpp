#include "s2s/eval/mesh_query.h"

#include <embree3/rtcore.h>
#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace s2s::eval {

struct MeshQuery::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< subtracted before going to single precision
  double top_m = 0;                                  ///< above the whole mesh, relative to the origin

  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

struct Corners {
  const Eigen::Vector3d &a, &b, &c;
};

Corners cornersOf(const products::PlyMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

struct NearestSearch {
  const products::PlyMesh& mesh;
  Eigen::Vector3d p;
  double best_m;
  std::size_t triangle = 0;
  bool found = false;
};

/// Called by Embree for each triangle that may lie within the current radius.
bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearestSearch*>(arguments->userPtr);
  const Corners corners = cornersOf(search.mesh, arguments->primID);
  const double distance_m = (search.p - closestPointOnTriangle(search.p, corners.a, corners.b, corners.c)).norm();
  if (distance_m > search.best_m) return false;
  search.best_m = distance_m;
  search.triangle = arguments->primID;
  search.found = true;
  // Single precision boxes are rounded; the slack keeps them from hiding a triangle that is nearer by less than that.
  arguments->query->radius = static_cast<float>(distance_m * (1 + 1e-5) + 1e-4);
  return true;
}

void fillBuffers(RTCGeometry geometry, const products::PlyMesh& mesh, const Eigen::Vector3d& origin) {
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  for (const auto& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k] - origin[k]);
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) *indices++ = vertex;
}

}  // namespace

Eigen::Vector3d closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c) {
  // Voronoi regions of corners, edges and face, by barycentric signs (Ericson, Real-Time Collision Detection, 5.1.5).
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

MeshQuery::MeshQuery(products::PlyMesh mesh) : mesh_(std::move(mesh)), embree_(std::make_unique<Embree>()) {
  ASSERT_(!mesh_.triangles.empty());
  Eigen::Vector3d low = mesh_.vertices.front(), high = low;
  for (const auto& v : mesh_.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  embree_->origin = 0.5 * (low + high);
  embree_->top_m = 0.5 * (high.z() - low.z()) + 1;
  embree_->device = rtcNewDevice("threads=1");
  ASSERTMSG_(embree_->device != nullptr, "Embree cannot be initialised on this machine");
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  fillBuffers(geometry, mesh_, embree_->origin);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
}

MeshQuery::~MeshQuery() = default;

std::optional<MeshQuery::Nearest> MeshQuery::nearest(const Eigen::Vector3d& p, double maxDistance_m) const {
  NearestSearch search{mesh_, p, maxDistance_m};
  const Eigen::Vector3f local = (p - embree_->origin).cast<float>();
  RTCPointQuery query{};
  query.x = local.x();
  query.y = local.y();
  query.z = local.z();
  query.radius = static_cast<float>(maxDistance_m * (1 + 1e-5) + 1e-4);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->scene, &query, &context, visitTriangle, &search);
  if (!search.found) return std::nullopt;
  return Nearest{search.best_m, search.triangle};
}

std::optional<double> MeshQuery::topHeight_m(double x, double y) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit hit{};
  hit.ray.org_x = static_cast<float>(x - embree_->origin.x());
  hit.ray.org_y = static_cast<float>(y - embree_->origin.y());
  hit.ray.org_z = static_cast<float>(embree_->top_m);
  hit.ray.dir_z = -1;
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = ~0U;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Corners corners = cornersOf(mesh_, hit.hit.primID);
  const double u = hit.hit.u, v = hit.hit.v;
  return (1 - u - v) * corners.a.z() + u * corners.b.z() + v * corners.c.z();
}

bool MeshQuery::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  constexpr double kSkin_m = 0.005;  // surfaces that the ends lie on do not count
  const double length_m = (to - from).norm();
  if (length_m <= 2 * kSkin_m) return false;
  const Eigen::Vector3f origin = (from - embree_->origin).cast<float>();
  const Eigen::Vector3f direction = ((to - from) / length_m).cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = static_cast<float>(kSkin_m);
  ray.tfar = static_cast<float>(length_m - kSkin_m);
  ray.mask = ~0U;
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;  // Embree sets it to minus infinity at a hit
}

}  // namespace s2s::eval
