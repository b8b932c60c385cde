#include "reference/embree_scene.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>

#include "reference/embree_packets.h"
#include "reference/embree_rays.h"
#include "reference/renderer.h"
#include "scenes/error.h"

namespace pb {
namespace {

template <auto Release>
struct Releaser {
  template <class T>
  void operator()(T* object) const {
    Release(object);
  }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<rtcReleaseGeometry>>;

const char* errorName(RTCError error) {
  switch (error) {
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU";
    default:
      return "unknown error";
  }
}

// Embree reports by state, not by return value; a null device asks for the error of creating one.
void throwOnError(RTCDevice device, const char* place) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throwEnvironmentError("Embree must not fail, got '{}' in {}", errorName(error), place);
}

DeviceHandle makeDevice() {
  // Configuration files in the user's or the current directory must not change a picture.
  DeviceHandle device(rtcNewDevice("ignore_config_files=1"));
  if (!device) throwOnError(nullptr, "rtcNewDevice");
  return device;
}

// What the intersection filter needs to know about an instance.
struct Facing {
  bool mirrored;       // the transform turns counter-clockwise triangles into clockwise ones
  bool backFacesSeen;  // double-sided or glass
  bool opaque;         // by the material's alpha mode
};

// Embree's normal is (v1 - v0) x (v2 - v0), which points outwards unless the transform mirrors.
bool comesFromOutside(const Facing& facing, const glm::vec3& direction, const glm::vec3& normal) {
  return (glm::dot(direction, normal) < 0.0f) != facing.mirrored;
}

struct Query : QueryContext {
  const HiddenInstances* hidden;
  bool metTransparent = false;

  bool hides(unsigned instance) const { return !hidden->empty() && (*hidden)[instance] != 0; }
};

// Decides about each candidate by itself, so that the order in which Embree finds them doesn't matter.
void rejectUnseen(const RTCFilterFunctionNArguments* args) {
  assert(args->N == 1);
  const auto& query = *static_cast<const Query*>(args->context);
  const auto& facing = *static_cast<const Facing*>(args->geometryUserPtr);
  const unsigned instance = RTCHitN_geomID(args->hit, 1, 0);
  const glm::vec3 direction(RTCRayN_dir_x(args->ray, 1, 0), RTCRayN_dir_y(args->ray, 1, 0),
                            RTCRayN_dir_z(args->ray, 1, 0));
  const glm::vec3 normal(RTCHitN_Ng_x(args->hit, 1, 0), RTCHitN_Ng_y(args->hit, 1, 0), RTCHitN_Ng_z(args->hit, 1, 0));
  const bool seen = facing.backFacesSeen || comesFromOutside(facing, direction, normal);
  if (query.hides(instance) || !seen) args->valid[0] = 0;
}

// As rejectUnseen(), and goes on behind surfaces that may be transparent.
void rejectTransparent(const RTCFilterFunctionNArguments* args) {
  rejectUnseen(args);
  if (args->valid[0] == 0 || static_cast<const Facing*>(args->geometryUserPtr)->opaque) return;
  static_cast<Query*>(args->context)->metTransparent = true;
  args->valid[0] = 0;
}

// A null filter lets every candidate through.
void intersectNearest(RTCScene scene, Query& query, RTCFilterFunctionN filter, RTCRayHit& rayHit) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &rayHit, &arguments);
#else
  rtcInitIntersectContext(&query);
  query.filter = filter;
  rtcIntersect1(scene, &query, &rayHit);
#endif
}

// Embree writes -infinity to tfar if something is hit.
void findOccluder(RTCScene scene, Query& query, RTCFilterFunctionN filter, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcInitIntersectContext(&query);
  query.filter = filter;
  rtcOccluded1(scene, &query, &ray);
#endif
}

// In float, as the raster's vertex shader does it.
std::vector<glm::vec3> worldPositions(const SnapshotInstance& instance) {
  std::vector<glm::vec3> positions;
  positions.reserve(instance.mesh->positions.size() + 1);
  for (const glm::vec3& p : instance.mesh->positions)
    positions.emplace_back(instance.worldFromObject * glm::vec4(p, 1.0f));
  // Embree loads 16 bytes a vertex: the last one needs something behind it.
  positions.emplace_back(0.0f);
  return positions;
}

}  // namespace

struct EmbreeScene::Impl {
  explicit Impl(const Snapshot& snapshot_)
      : snapshot(snapshot_), device(makeDevice()), scene(rtcNewScene(device.get())) {
    // Robust: rays must not slip through the edges that triangles share, where the raster leaves no holes either. At
    // exactly a vertex one in a hundred still does.
    rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | kFilterOfQuery));
    facings.reserve(snapshot.instances.size());  // Embree keeps pointers to the entries
    for (std::size_t i = 0; i < snapshot.instances.size(); ++i) attach(static_cast<unsigned>(i));
    // Embree's builder splits its work by the number of threads, and with it the tree: one thread keeps the order of
    // traversal, and so the winner among equally near hits, the same everywhere.
    tbb::task_arena(1).execute([&] { rtcJoinCommitScene(scene.get()); });
    throwOnError(device.get(), "building the acceleration structure");
  }

  void attach(unsigned index) {
    const SnapshotInstance& instance = snapshot.instances[index];
    const Material& material = snapshot.materialOf(instance);
    const Mesh& mesh = *instance.mesh;
    const bool glass = material.constants.kind.x == shading::kSurfaceGlass;
    facings.push_back({.mirrored = instance.mirrored,
                       .backFacesSeen = material.doubleSided || glass,
                       .opaque = material.constants.alpha.x == shading::kAlphaOpaque});
    positions.push_back(worldPositions(instance));
    if (mesh.indices.empty()) return;

    GeometryHandle geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    throwOnError(device.get(), "rtcNewGeometry");
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.back().data(), 0,
                               sizeof(glm::vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               3 * sizeof(std::uint32_t), mesh.triangleCount());
    rtcSetGeometryUserData(geometry.get(), &facings.back());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene.get(), geometry.get(), index);
    throwOnError(device.get(), "attaching a mesh");
  }

  // By the direction that it is seen from.
  bool isSeen(const Ray& ray, const RTCHit& hit) const {
    const Facing& facing = facings[hit.geomID];
    return facing.backFacesSeen || comesFromOutside(facing, ray.direction, {hit.Ng_x, hit.Ng_y, hit.Ng_z});
  }

  const Snapshot& snapshot;
  std::vector<std::vector<glm::vec3>> positions;  // by instance; Embree reads them in place
  std::vector<Facing> facings;
  DeviceHandle device;
  SceneHandle scene;
};

EmbreeScene::EmbreeScene(const Snapshot& snapshot) : impl_(std::make_unique<Impl>(snapshot)) {}
EmbreeScene::~EmbreeScene() = default;

// Nearly always the nearest triangle of all is seen, and is then the nearest of those that are: asking about each
// candidate in the traversal costs more than asking about the one found, and seldom anew.
std::optional<Hit> EmbreeScene::intersect(const Ray& ray, const HiddenInstances& hidden) const {
  assert(hidden.empty() || hidden.size() == impl_->facings.size());
  Query query;
  query.hidden = &hidden;
  const auto nearest = [&](RTCFilterFunctionN filter) {
    RTCRayHit found = makeRayHit(ray);
    intersectNearest(impl_->scene.get(), query, filter, found);
    return found;
  };
  RTCRayHit r = nearest(hidden.empty() ? nullptr : rejectUnseen);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  if (hidden.empty() && !impl_->isSeen(ray, r.hit)) {
    r = nearest(rejectUnseen);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  }

  const glm::vec3 normal = shading::safeNormalize({r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z});
  return Hit{.instance = static_cast<int>(r.hit.geomID),
             .triangle = r.hit.primID,
             .t = r.ray.tfar,
             .barycentrics = {r.hit.u, r.hit.v},
             .geometricNormal = glm::dot(normal, ray.direction) < 0.0f ? normal : -normal,
             .entering = comesFromOutside(impl_->facings[r.hit.geomID], ray.direction, normal)};
}

Occlusion EmbreeScene::occlusion(const Ray& ray, float tFar, const HiddenInstances& hidden) const {
  assert(hidden.empty() || hidden.size() == impl_->facings.size());
  Query query;
  query.hidden = &hidden;
  RTCRay r = makeRay(ray, tFar);
  findOccluder(impl_->scene.get(), query, rejectTransparent, r);
  if (r.tfar < 0.0f) return Occlusion::full;
  return query.metTransparent ? Occlusion::transparent : Occlusion::none;
}

double EmbreeScene::secondsToIntersect(std::span<const Ray> rays, int width, bool coherent) const {
  return pb::secondsToIntersect(impl_->scene.get(), rays, width, coherent);
}

std::array<glm::vec3, 3> EmbreeScene::triangle(int instance, std::uint32_t index) const {
  const std::vector<std::uint32_t>& indices =
      impl_->snapshot.instances[static_cast<std::size_t>(instance)].mesh->indices;
  const std::vector<glm::vec3>& positions = impl_->positions[static_cast<std::size_t>(instance)];
  const std::size_t first = std::size_t{3} * index;
  return {positions[indices[first]], positions[indices[first + 1]], positions[indices[first + 2]]};
}

std::string embreeVersion() {
  const DeviceHandle device = makeDevice();
  const auto property = [&](RTCDeviceProperty p) { return rtcGetDeviceProperty(device.get(), p); };
  return fmt::format("{}.{}.{}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                     property(RTC_DEVICE_PROPERTY_VERSION_MINOR), property(RTC_DEVICE_PROPERTY_VERSION_PATCH));
}

}  // namespace pb
