// What shaders read of a frame: transforms of instances, lights, the views of passes, and where probes and their
// proxies are.
#pragma once

#include <vector>

#include "raster/gpu_structs.h"
#include "raster/reflection.h"
#include "raster/uniform_slots.h"

namespace pb {

class FrameConstants {
 public:
  explicit FrameConstants(gl::Context& context) : context_(context), gl_(context.functions()) {}

  void uploadInstances(const std::vector<SnapshotInstance>& instances, const std::vector<Reflection>& reflections);
  void uploadLights(const std::vector<shading::Light>& lights, const std::vector<shading::AreaLight>& areaLights);
  void uploadPasses(const std::vector<gpu::PassConstants>& passes);
  // Only for lookups that read them.
  void uploadProbes(const Snapshot& snapshot);

  const UniformSlots<gpu::InstanceConstants>& instances() const { return instances_; }
  const gpu::PassConstants& pass(std::size_t pass) const { return passes_[pass]; }

  void bindLights() const;
  void bindPass(std::size_t pass) const { passSlots_.bind(gpu::kPassBlock, pass); }
  // Nothing if no probes were uploaded.
  void bindProbe(int block, int probe) const;

 private:
  gl::Context& context_;
  const gl::Functions& gl_;
  std::vector<gpu::PassConstants> passes_;
  UniformSlots<gpu::InstanceConstants> instances_;
  UniformSlots<gpu::PassConstants> passSlots_;
  UniformSlots<gpu::ProbeConstants> probes_;
  std::size_t lightCount_ = 0;
  std::size_t areaLightCount_ = 0;
  gl::Buffer lights_;
  gl::Buffer areaLights_;
};

}  // namespace pb
