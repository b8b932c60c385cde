#include "bench/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pb {

std::vector<Check> certifyControl(RasterDevice& device);
std::vector<Check> certifyCubeFaces(RasterDevice& device);
std::vector<Check> certifyFacingMirrors(RasterDevice& device);
std::vector<Check> certifyFresnel(RasterDevice& device);
std::vector<Check> certifyGlass(RasterDevice& device);
std::vector<Check> certifyMicrofacets(RasterDevice& device);
std::vector<Check> certifyMirrorBall(RasterDevice& device);
std::vector<Check> certifyProbeCentre(RasterDevice& device);
std::vector<Check> certifyRoughMetal(RasterDevice& device);
std::vector<Check> certifyWhiteFurnace(RasterDevice& device);

const std::vector<Certificate>& certificates() {
  static const std::vector<Certificate> table = {
      {"control", "A scene without specular surfaces must be the same picture in both renderers.", certifyControl},
      {"cube faces",
       "A room coloured by position: every texel of the six faces and the 12 edges between them is known.",
       certifyCubeFaces},
      {"probe centre", "Rays that leave the probe's centre see the cube map exactly, up to bilinear interpolation.",
       certifyProbeCentre},
      {"facing mirrors", "Two parallel mirrors that glow: radiance is a geometric series, one term a reflection.",
       certifyFacingMirrors},
      {"mirror ball", "A mirror sphere under a sky that is linear in the direction's height.", certifyMirrorBall},
      {"white furnace", "Perfect mirrors of any shape under a constant environment of 1 show 1.", certifyWhiteFurnace},
      {"reflectance", "Fresnel's equations at angles with closed forms and in complex arithmetic; sRGB codes.",
       certifyFresnel},
      {"microfacets", "Integrals of the GGX lobe, its table, its sampler, against a second spelling.",
       certifyMicrofacets},
      {"rough metal", "A rough white metal in a constant environment of 1 shows the lobe's directional albedo.",
       certifyRoughMetal},
      {"glass", "Slab, ball, absorbing slab, thin wall and prism: geometrical optics.", certifyGlass},
  };
  return table;
}

bool Check::passed() const { return std::abs(measured - expected) <= tolerance; }

bool allPassed(const std::vector<Check>& checks) {
  return std::ranges::all_of(checks, [](const Check& check) { return !check.binding || check.passed(); });
}

std::string summary(const std::vector<Check>& checks) {
  const auto failed = std::ranges::find_if(checks, [](const Check& check) { return check.binding && !check.passed(); });
  if (failed == checks.end()) return "passed";
  return fmt::format("{} ({}): {} is {:.4g}, expected {:.4g} within {:.4g}", failed->name, failed->subject,
                     failed->quantity, failed->measured, failed->expected, failed->tolerance);
}

std::string toMarkdown(const std::vector<Check>& checks) {
  std::string table =
      "| check | subject | quantity | measured | expected | tolerance | verdict |\n| --- | --- | --- | ---: | ---: | "
      "---: | --- |\n";
  for (const Check& c : checks)
    table += fmt::format("| {} | {} | {} | {:.6g} | {:.6g} | {:.3g} | {} |\n", c.name, c.subject, c.quantity,
                         c.measured, c.expected, c.tolerance,
                         !c.binding   ? "printed"
                         : c.passed() ? "pass"
                                      : "FAIL");
  return table;
}

}  // namespace pb
