#include "core/relief/occlusion/ray_scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cstring>
#include <utility>

namespace dubsar {

struct RayDevice::Impl {
  RTCDevice device = nullptr;
  RTCBuffer vertices = nullptr;
  std::size_t vertex_count = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (vertices) rtcReleaseBuffer(vertices);
    if (device) rtcReleaseDevice(device);
  }
};

struct RayScene::Impl {
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }
};

namespace {

tl::unexpected<Error> device_error(RTCDevice device, std::string_view what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_CANCELLED) return cancelled_error();
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    return fail(ErrorKind::kTryAgain, "occlusion: not enough memory to {}: close programs or use a coarser volume",
                what);
  return fail(code == RTC_ERROR_UNSUPPORTED_CPU ? ErrorKind::kUnavailable : ErrorKind::kInternal,
              "occlusion: Embree could not {} (error {})", what, static_cast<int>(code));
}

bool keep_building(void* progress, double /*fraction*/) { return !static_cast<Progress*>(progress)->cancelled(); }

}  // namespace

RayDevice::RayDevice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayDevice::~RayDevice() = default;
RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayScene::~RayScene() = default;

Result<std::unique_ptr<RayDevice>> RayDevice::create(std::span<const glm::vec3> positions, int threads) {
  auto impl = std::make_unique<Impl>();
  impl->device = rtcNewDevice(fmt::format("threads={}", threads).c_str());
  if (!impl->device) return device_error(nullptr, "start");
  // Embree reads 16 bytes at each vertex: one more than there are.
  impl->vertices = rtcNewBuffer(impl->device, (positions.size() + 1) * sizeof(glm::vec3) + 16);
  if (!impl->vertices) return device_error(impl->device, "hold the vertices");
  void* data = rtcGetBufferData(impl->vertices);
  if (!positions.empty()) std::memcpy(data, positions.data(), positions.size_bytes());
  impl->vertex_count = positions.size();
  return std::unique_ptr<RayDevice>(new RayDevice(std::move(impl)));
}

Result<std::unique_ptr<RayScene>> RayScene::build(RayDevice& device, std::span<const Triangle> triangles,
                                                  Progress& progress) {
  static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
  const RayDevice::Impl& from = device.impl();
  auto impl = std::make_unique<Impl>();
  impl->scene = rtcNewScene(from.device);
  if (!impl->scene) return device_error(from.device, "make a scene");
  rtcSetSceneFlags(impl->scene, RTC_SCENE_FLAG_ROBUST);
  if (!triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(from.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, from.vertices, 0, sizeof(glm::vec3),
                         from.vertex_count);
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                            triangles.size());
    if (!indices) {
      rtcReleaseGeometry(geometry);
      return device_error(from.device, "hold the triangles");
    }
    std::memcpy(indices, triangles.data(), triangles.size_bytes());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcSetSceneProgressMonitorFunction(impl->scene, keep_building, &progress);
  rtcCommitScene(impl->scene);
  rtcSetSceneProgressMonitorFunction(impl->scene, nullptr, nullptr);
  if (progress.cancelled()) return cancelled_error();
  if (const RTCError code = rtcGetDeviceError(from.device); code != RTC_ERROR_NONE) {
    if (code == RTC_ERROR_OUT_OF_MEMORY)
      return fail(ErrorKind::kTryAgain, "occlusion: not enough memory for the ray tree of {} triangles",
                  triangles.size());
    return fail(ErrorKind::kInternal, "occlusion: Embree could not build the ray tree (error {})",
                static_cast<int>(code));
  }
  return std::unique_ptr<RayScene>(new RayScene(std::move(impl)));
}

void RayScene::intersect(RayPacket& packet) const noexcept {
  constexpr std::size_t kRays = RayPacket::kRays;
  alignas(64) RTCRayHit16 rays;
  alignas(64) int valid[kRays];
  for (std::size_t i = 0; i < kRays; ++i) {
    valid[i] = packet.active[i] ? -1 : 0;
    rays.ray.org_x[i] = packet.origin_x[i];
    rays.ray.org_y[i] = packet.origin_y[i];
    rays.ray.org_z[i] = packet.origin_z[i];
    rays.ray.dir_x[i] = packet.direction_x[i];
    rays.ray.dir_y[i] = packet.direction_y[i];
    rays.ray.dir_z[i] = packet.direction_z[i];
    rays.ray.tnear[i] = 0.0f;
    rays.ray.tfar[i] = packet.distance[i];
    rays.ray.time[i] = 0.0f;
    rays.ray.mask[i] = ~0u;
    rays.ray.id[i] = static_cast<unsigned>(i);
    rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;  // with sorted packets 1.4 times as fast as without
  rtcIntersect16(valid, impl_->scene, &context, &rays);
  for (std::size_t i = 0; i < kRays; ++i) {
    packet.hit[i] = packet.active[i] && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    packet.distance[i] = rays.ray.tfar[i];
    packet.from_behind[i] = packet.hit[i] && rays.hit.Ng_x[i] * packet.direction_x[i] +
                                                     rays.hit.Ng_y[i] * packet.direction_y[i] +
                                                     rays.hit.Ng_z[i] * packet.direction_z[i] >
                                                 0.0f;
  }
}

}  // namespace dubsar
