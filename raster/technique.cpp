#include "raster/technique.h"

#include "scenes/error.h"
#include "scenes/shading/shading.h"

namespace pb {

glm::vec4 fresnelLaw(const Spec& fresnel) {
  const std::vector<std::string> known = {"exact", "schlick", "ratio"};
  SpecReader reader(fresnel, "fresnel");
  glm::vec4 law(shading::kFresnelExact, 0.0f, 0.0f, 0.0f);
  if (fresnel.name == "ratio")
    law = {shading::kFresnelRatio, reader.number("bias", 0.0, 1.0, 0.0), reader.number("scale", 0.0, 10.0, 1.0),
           reader.number("power", 0.0, 100.0, 5.0)};
  else if (fresnel.name == "schlick")
    law.x = shading::kFresnelSchlick;
  else if (fresnel.name != "exact")
    throwInputError("fresnel {}", unknownMessage(fresnel.name, known));
  reader.finish();
  return law;
}

}  // namespace pb
