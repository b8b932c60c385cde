// Faults planted on purpose, to see whether the gate catches them (bench/selftest_gate.h). No technique: nothing else
// plants one, and what is planted shows in no key of a cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/gl/context.h"
#include "raster/gpu_structs.h"
#include "raster/refresh.h"
#include "raster/renderer.h"

namespace pb {

class ProbeMaps;

enum class FaultKind {
  none,
  swappedFaces,    // +X and -X of every capture show what the other one should
  halfTexelShift,  // captured surfaces stand half a texel to the right
  noDepthBuffer,   // captures are drawn in the order of the draws
  staleFace,       // one face is captured in the first frame only
  doubleGamma,     // captures are encoded by a display's gamma as if they were not linear
  droppedBounce,   // one bounce iteration less
  wrongOwner,      // a capture leaves out another probe's owner in place of its own
  energy,          // captures have `amount` times their radiance
  moreDraws        // `amount` times the draws; the additional ones change no pixel
};

struct Fault {
  FaultKind kind = FaultKind::none;
  double amount = 1;
};

// In every sequence of the device that is made from then on, and until it is replaced.
void plantFault(RasterDevice& device, const Fault& fault);

bool isFaultPlanted(RasterDevice& device);

// What the renderer asks at the places where faults are planted; without one, all of these do nothing.
class PlantedFault {
 public:
  PlantedFault() = default;
  explicit PlantedFault(const Fault& fault) : fault_(fault) {}

  bool isPlanted() const { return fault_.kind != FaultKind::none; }

  Technique techniqueOf(Technique technique) const;
  void changePasses(std::vector<gpu::PassConstants>& ofProbes) const;  // by capturePass() - 1
  void changeDue(std::vector<ProbeFace>& due, std::int64_t frame) const;
  void changeMaps(ProbeMaps& maps, const std::vector<ProbeFace>& captured, const std::vector<float>& nears) const;
  int hiddenProbe(int probe, std::size_t probes) const;

  // How many times more a pass makes the first of its draws.
  std::size_t repeatedDraws(std::size_t draws);

  // While it lives, captures have no depth buffer if that is the fault.
  class Depth {
   public:
    Depth(const PlantedFault& fault, const gl::Functions& gl);
    ~Depth();
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;

   private:
    const gl::Functions* gl_;  // null: nothing is changed
  };

 private:
  Fault fault_;
  double owedDraws_ = 0;
};

}  // namespace pb
