#include "scenes/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scenes/snapshot.h"

namespace pb {
namespace {

std::string text(const glm::vec3& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z); }

std::string counts(const Scene& scene) {
  std::set<const Mesh*> meshes;
  std::size_t triangles = 0;
  for (const Instance& instance : scene.instances) {
    meshes.insert(instance.mesh.get());
    triangles += instance.mesh->triangleCount();
  }
  return fmt::format(
      "meshes     {}\ninstances  {} with {} triangles\nmaterials  {}\ntextures   {}\nlights     {}\ntracks     {}\n",
      meshes.size(), scene.instances.size(), triangles, scene.materials.size(), scene.textures.size(),
      scene.lights.size(), scene.tracks.size());
}

std::string duration(const Scene& scene) {
  if (scene.durationSeconds <= 0.0) return "duration   0 s, nothing moves\n";
  return fmt::format("duration   {:.4g} s at {:.4g} frames/s\n", scene.durationSeconds, scene.framesPerSecond);
}

std::string deformations(const Scene& scene) {
  std::string lines;
  for (const Instance& instance : scene.instances) {
    if (!deforms(scene, instance)) continue;
    const Node& node = scene.nodes[static_cast<std::size_t>(instance.node)];
    std::vector<std::string> parts;
    if (!instance.mesh->targets.empty())
      parts.push_back(fmt::format("{} morph targets", instance.mesh->targets.size()));
    if (node.wave) parts.push_back(fmt::format("a wave of {:.4g} s", node.wave->periodSeconds));
    if (node.skin >= 0 && !instance.mesh->joints.empty())
      parts.push_back(
          fmt::format("a skin of {} joints", scene.skins[static_cast<std::size_t>(node.skin)].joints.size()));
    lines += fmt::format("deforming  '{}': {}\n", instance.name, fmt::join(parts, ", "));
  }
  return lines;
}

std::string bounds(const Scene& scene) {
  Bounds all;
  for (const WorldMesh& m : worldMeshes(scene, 0.0)) all.include(transformed(m.mesh->bounds, m.worldFromObject));
  return all.empty() ? "bounds     empty\n" : fmt::format("bounds     {} to {} m\n", text(all.lower), text(all.upper));
}

std::string room(const Scene& scene) {
  if (!scene.room) return "";
  return fmt::format("room       {} to {} m\n", text(scene.room->lower), text(scene.room->upper));
}

std::string cameras(const Scene& scene) {
  std::string lines;
  for (const Camera& camera : scene.cameras)
    lines += fmt::format("camera     '{}', vertical field of view {:.4g} degrees\n", camera.name,
                         glm::degrees(camera.verticalFov));
  return lines;
}

std::string reasonFor(const Material& material) {
  const glm::vec4& f = material.constants.factors;
  if (material.constants.kind.x == shading::kSurfaceGlass) return fmt::format("transmission {:.3g}", f.w);
  return fmt::format("metallic {:.3g}, roughness {:.3g}{}", f.x, f.y,
                     material.metallicRoughnessTexture >= 0 ? " times its texture" : "");
}

std::string placeOf(const std::optional<ProbeSettings>& probe) {
  if (probe && !probe->enabled) return "no probe: switched off in the node's extras";
  const std::string place = probe && probe->position ? "probe at " + text(*probe->position) + " of the node"
                                                     : "probe at the centre of the bounds";
  return probe && probe->box ? place + ", its box " + text(probe->box->lower) + " to " + text(probe->box->upper)
                             : place;
}

std::string probes(const Scene& scene) {
  std::string lines;
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[static_cast<std::size_t>(instance.material)];
    if (!material.isSpecularDominant && !ownsProbe(scene, instance)) continue;
    lines += fmt::format("reflective '{}', material '{}' ({}): {}{}\n", instance.name, material.name,
                         reasonFor(material), placeOf(scene.nodes[static_cast<std::size_t>(instance.node)].probe),
                         material.isSpecularDominant ? "" : ", as the node's extras want");
  }
  return lines.empty() ? "reflective nothing, so there are no probes\n" : lines;
}

std::string shadows(const Scene& scene) {
  return fmt::format("shadows    {}\n", scene.castsShadows ? "traced" : "none");
}

std::string environments(const Scene& scene) {
  std::string lines;
  for (std::size_t i = 0; i <= scene.environmentChanges.size(); ++i) {
    const Environment& e = scene.environmentAt(i);
    const std::string from =
        i == 0 ? "" : fmt::format(" from {:.4g} s on", scene.environmentChanges[i - 1].timeSeconds);
    const std::string kind =
        e.sky.toGlow.w > 0.5f ? fmt::format("cube map of 6 x {0} x {0} texels", e.faces.front().width()) : "gradient";
    lines += fmt::format("environment '{}'{}, {}, mean ambient radiance {}\n", e.name, from, kind,
                         text(glm::vec3(e.ambient.constant)));
  }
  return lines;
}

std::string sentences(const char* kind, const std::vector<std::string>& list) {
  std::string lines;
  for (const std::string& sentence : list) lines += fmt::format("{} {}\n", kind, sentence);
  return lines;
}

}  // namespace

std::string describe(const Scene& scene) {
  return fmt::format("scene      {}\n", scene.name) + counts(scene) + duration(scene) + deformations(scene) +
         bounds(scene) + room(scene) + cameras(scene) + probes(scene) + environments(scene) + shadows(scene) +
         sentences("note:", scene.notes) + sentences("warning:", scene.warnings);
}

}  // namespace pb
