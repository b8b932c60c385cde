#include "raster/fault.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "raster/device.h"
#include "raster/probe_maps.h"

namespace pb {
namespace {

// Clip x of a point is dot(d, right) / |right|^2, its w is dot(d, forward): shading::clipFromWorldPosition(). With a
// unit `right` + k `forward` in the place of right / |right|^2, x / w grows by k; half a texel is 1 / width of [-1, 1].
void shiftByHalfTexel(gpu::PassConstants& pass) {
  const float k = 1.0f / pass.image.x;
  const glm::vec3 row = glm::vec3(pass.view.right) + k * glm::vec3(pass.view.forward);
  pass.view.right = glm::vec4(row / glm::dot(row, row), pass.view.right.w);
}

}  // namespace

void plantFault(RasterDevice& device, const Fault& fault) { device.impl().fault = PlantedFault(fault); }

bool isFaultPlanted(RasterDevice& device) { return device.impl().fault.isPlanted(); }

Technique PlantedFault::techniqueOf(Technique technique) const {
  if (fault_.kind == FaultKind::droppedBounce) technique.bounces = std::max(1, technique.bounces - 1);
  return technique;
}

void PlantedFault::changePasses(std::vector<gpu::PassConstants>& ofProbes) const {
  if (fault_.kind == FaultKind::swappedFaces)
    for (std::size_t first = 0; first < ofProbes.size(); first += 6)
      std::swap(ofProbes[first].view, ofProbes[first + 1].view);
  if (fault_.kind == FaultKind::halfTexelShift) std::ranges::for_each(ofProbes, shiftByHalfTexel);
}

void PlantedFault::changeDue(std::vector<ProbeFace>& due, std::int64_t frame) const {
  if (fault_.kind == FaultKind::staleFace && frame > 0)
    std::erase_if(due, [](const ProbeFace& f) { return f.face == 0; });
}

void PlantedFault::changeMaps(ProbeMaps& maps, const std::vector<ProbeFace>& captured,
                              const std::vector<float>& nears) const {
  if (fault_.kind != FaultKind::doubleGamma && fault_.kind != FaultKind::energy) return;
  const auto change = [&](float radiance) {
    return fault_.kind == FaultKind::doubleGamma ? shading::srgbEncode(radiance)
                                                 : radiance * static_cast<float>(fault_.amount);
  };
  for (std::size_t i = 0; i < captured.size();) {
    const int probe = captured[i].probe;
    std::array<Image, 6> faces = maps.read(probe, 0);
    for (; i < captured.size() && captured[i].probe == probe; ++i)
      for (glm::vec3& texel : faces[static_cast<std::size_t>(captured[i].face)])
        texel = {change(texel.x), change(texel.y), change(texel.z)};
    maps.write(probe, faces, {}, nears[static_cast<std::size_t>(probe)]);
  }
}

int PlantedFault::hiddenProbe(int probe, std::size_t probes) const {
  return fault_.kind == FaultKind::wrongOwner && probe >= 0 ? (probe + 1) % static_cast<int>(probes) : probe;
}

// The share is kept over the passes, most of which have few draws.
std::size_t PlantedFault::repeatedDraws(std::size_t draws) {
  if (fault_.kind != FaultKind::moreDraws) return 0;
  owedDraws_ += (fault_.amount - 1) * static_cast<double>(draws);
  const std::size_t repeated = std::min(draws, static_cast<std::size_t>(owedDraws_));
  owedDraws_ -= static_cast<double>(repeated);
  return repeated;
}

PlantedFault::Depth::Depth(const PlantedFault& fault, const gl::Functions& gl)
    : gl_(fault.fault_.kind == FaultKind::noDepthBuffer ? &gl : nullptr) {
  if (gl_ != nullptr) gl_->Disable(GL_DEPTH_TEST);
}

PlantedFault::Depth::~Depth() {
  if (gl_ != nullptr) gl_->Enable(GL_DEPTH_TEST);
}

}  // namespace pb
