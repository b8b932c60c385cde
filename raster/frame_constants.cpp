#include "raster/frame_constants.h"

#include <cmath>
#include <glm/matrix.hpp>

#include "raster/proxy.h"

namespace pb {
namespace {

gpu::InstanceConstants constantsOf(const SnapshotInstance& instance, const Reflection& reflection) {
  return {.worldFromObject = instance.worldFromObject,
          .normalMatrix = glm::mat4(instance.normalMatrix),
          .values = {instance.uvScale, 0.0f, static_cast<float>(instance.source + 1), instance.mirrored ? -1.0f : 1.0f},
          .volume = {std::cbrt(std::abs(glm::determinant(glm::mat3(instance.worldFromObject)))),
                     reflection.secondWeight, 0.0f, 0.0f}};
}

// Replaces the buffer's contents, and the buffer if `count`, the number of values in it, changes.
template <class T>
void write(const gl::Functions& gl, const std::vector<T>& values, std::size_t& count, gl::Buffer& buffer) {
  if (buffer.id() == 0 || count != values.size()) buffer = gl::Buffer(gl, values.size() * sizeof(T));
  count = values.size();
  buffer.write(0, gl::bytesOf(values));
}

}  // namespace

void FrameConstants::uploadInstances(const std::vector<SnapshotInstance>& instances,
                                     const std::vector<Reflection>& reflections) {
  if (instances_.size() != instances.size())
    instances_ = UniformSlots<gpu::InstanceConstants>(context_, instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) instances_.set(i, constantsOf(instances[i], reflections[i]));
  instances_.upload();
}

void FrameConstants::uploadLights(const std::vector<shading::Light>& lights,
                                  const std::vector<shading::AreaLight>& areaLights) {
  write(gl_, lights, lightCount_, lights_);
  write(gl_, areaLights, areaLightCount_, areaLights_);
}

void FrameConstants::uploadPasses(const std::vector<gpu::PassConstants>& passes) {
  passes_ = passes;
  if (passSlots_.size() < passes.size()) passSlots_ = UniformSlots<gpu::PassConstants>(context_, passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) passSlots_.set(i, passes[i]);
  passSlots_.upload();
}

void FrameConstants::uploadProbes(const Snapshot& snapshot) {
  const std::vector<Probe>& probes = snapshot.probes;
  if (probes.empty()) return;
  if (probes_.size() != probes.size()) probes_ = UniformSlots<gpu::ProbeConstants>(context_, probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i) probes_.set(i, probeConstants(snapshot, probes[i]));
  probes_.upload();
}

void FrameConstants::bindLights() const {
  if (lightCount_ > 0) gl_.BindBufferBase(GL_UNIFORM_BUFFER, gpu::kLightBlock, lights_.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kManyLightsBlock, lights_.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kAreaLightBlock, areaLights_.id());
}

void FrameConstants::bindProbe(int block, int probe) const {
  if (probes_.size() > 0) probes_.bind(block, static_cast<std::size_t>(probe));
}

}  // namespace pb
