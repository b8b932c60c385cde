#include "reference/embree_packets.h"

#include <array>
#include <cassert>
#include <cstddef>
#include <ctime>
#include <type_traits>
#include <vector>

namespace pb {
namespace {

// The packet's lane `lane` is made that ray.
template <class Packet>
void setLane(Packet& packet, std::size_t lane, const RTCRayHit& ray) {
  if constexpr (std::is_same_v<Packet, RTCRayHit>) {
    packet = ray;
  } else {
    packet.ray.org_x[lane] = ray.ray.org_x;
    packet.ray.org_y[lane] = ray.ray.org_y;
    packet.ray.org_z[lane] = ray.ray.org_z;
    packet.ray.dir_x[lane] = ray.ray.dir_x;
    packet.ray.dir_y[lane] = ray.ray.dir_y;
    packet.ray.dir_z[lane] = ray.ray.dir_z;
    packet.ray.tnear[lane] = ray.ray.tnear;
    packet.ray.tfar[lane] = ray.ray.tfar;
    packet.ray.mask[lane] = ray.ray.mask;
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

#if RTC_VERSION_MAJOR >= 4
void intersectPacket(const int*, RTCScene scene, RTCIntersectArguments* arguments, RTCRayHit& packet) {
  rtcIntersect1(scene, &packet, arguments);
}
void intersectPacket(const int* valid, RTCScene scene, RTCIntersectArguments* arguments, RTCRayHit8& packet) {
  rtcIntersect8(valid, scene, &packet, arguments);
}
void intersectPacket(const int* valid, RTCScene scene, RTCIntersectArguments* arguments, RTCRayHit16& packet) {
  rtcIntersect16(valid, scene, &packet, arguments);
}
#else
void intersectPacket(const int*, RTCScene scene, QueryContext* context, RTCRayHit& packet) {
  rtcIntersect1(scene, context, &packet);
}
void intersectPacket(const int* valid, RTCScene scene, QueryContext* context, RTCRayHit8& packet) {
  rtcIntersect8(valid, scene, context, &packet);
}
void intersectPacket(const int* valid, RTCScene scene, QueryContext* context, RTCRayHit16& packet) {
  rtcIntersect16(valid, scene, context, &packet);
}
#endif

double threadSeconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <std::size_t Width, class Packet>
double secondsOfPackets(RTCScene scene, std::span<const Ray> rays, bool coherent) {
  std::vector<Packet> packets(rays.size() / Width);  // the last ones that fill no packet are left out
  for (std::size_t i = 0; i < packets.size() * Width; ++i) setLane(packets[i / Width], i % Width, makeRayHit(rays[i]));
  alignas(64) std::array<int, 16> valid;
  valid.fill(-1);
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments settings;
  rtcInitIntersectArguments(&settings);
  if (coherent) settings.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  QueryContext settings;
  rtcInitIntersectContext(&settings);
  if (coherent) settings.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  const double start = threadSeconds();
  for (Packet& packet : packets) intersectPacket(valid.data(), scene, &settings, packet);
  return threadSeconds() - start;
}

}  // namespace

double secondsToIntersect(RTCScene scene, std::span<const Ray> rays, int width, bool coherent) {
  switch (width) {
    case 1:
      return secondsOfPackets<1, RTCRayHit>(scene, rays, coherent);
    case 8:
      return secondsOfPackets<8, RTCRayHit8>(scene, rays, coherent);
    default:
      assert(width == 16);
      return secondsOfPackets<16, RTCRayHit16>(scene, rays, coherent);
  }
}

}  // namespace pb
