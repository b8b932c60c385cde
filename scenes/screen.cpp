#include "scenes/screen.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace pb {

Texture renderScreen(const Screen& screen, double timeSeconds) {
  const double loops = timeSeconds / static_cast<double>(screen.periodSeconds) + static_cast<double>(screen.phase);
  const auto turn = static_cast<float>(glm::two_pi<double>() * (loops - std::floor(loops)));
  const float aspect = static_cast<float>(screen.widthPx) / static_cast<float>(screen.heightPx);
  ImageRgba texels(screen.widthPx, screen.heightPx);
  tbb::parallel_for(0, screen.heightPx, [&](int y) {
    for (int x = 0; x < screen.widthPx; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(screen.widthPx),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(screen.heightPx));
      texels(x, y) = glm::vec4(shading::screenRadiance(screen.program, uv, aspect, turn), 1.0f);
    }
  });
  return makeTexture(screen.name, std::move(texels));
}

void showScreen(Material& material, int screen, glm::vec3 scale) {
  material.screen = screen;
  material.constants.emission = glm::vec4(scale, material.constants.emission.w);
  shading::TextureSlot& slot = material.constants.emissionSlot;
  slot.offset.w = 1.0f;
  slot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterLinear, shading::kFilterLinearMipLinear};
}

}  // namespace pb
