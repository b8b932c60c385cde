// File names of a run's pictures, and how references to them are spelled.
#pragma once

#include <string>

#include "bench/external_technique.h"
#include "bench/plan.h"
#include "bench/runner.h"
#include "bench/suite.h"

namespace pb {

class PictureNames {
 public:
  // Both must outlive it.
  PictureNames(const Suite& suite, const Scenes& scenes) : suite_(suite), scenes_(scenes) {}

  // Without an extension.
  std::string ofFrame(const PlannedSequence& sequence, int frame) const;
  std::string ofReference(std::size_t scene, int frame) const;

  // By which the pictures of external techniques are known.
  PictureName external(std::size_t scene) const;

 private:
  std::string prefix(std::size_t scene, int frame) const;
  std::string ofTechnique(const PlannedSequence& sequence) const;

  const Suite& suite_;
  const Scenes& scenes_;
};

}  // namespace pb
