#include "scenes/obj_load.h"

#include <filesystem>
#include <map>
#include <new>
#include <utility>

#include "scenes/closed_mesh.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/obj/geometry.h"
#include "scenes/obj/library.h"
#include "scenes/obj/materials.h"
#include "scenes/obj/statements.h"
#include "scenes/place.h"

namespace pb {
namespace {

void addParts(const obj::Geometry& geometry, obj::Materials& materials, Scene& scene) {
  std::map<std::string, int> nodes;
  for (const obj::Part& part : geometry.parts()) {
    const auto mesh = finishMesh(geometry.meshOf(part));
    if (mesh->triangleCount() == 0) {
      scene.warnings.push_back(fmt::format("'{}' is left out: its triangles have no area", part.name));
      continue;
    }
    const auto [node, isNew] = nodes.try_emplace(part.name, static_cast<int>(scene.nodes.size()));
    if (isNew) scene.nodes.emplace_back().name = part.name;
    scene.instances.push_back({part.name, node->second, mesh, materials.indexOf(part.material, mesh->bounds)});
  }
  if (geometry.facesWithoutArea() > 0)
    scene.warnings.push_back(fmt::format("{} faces without area are left out", geometry.facesWithoutArea()));
  if (scene.instances.empty()) throwInputError("the file draws no triangle");
}

Scene buildScene(const std::filesystem::path& path, const std::string& text,
                 const std::optional<Environment>& environment) {
  obj::checkNumbers(text, obj::kObjNumbers);
  obj::checkFaces(text);
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  obj::MtlMaterials libraries = obj::readLibraries(text, folder);
  Scene scene;
  scene.name = path.stem().string();
  const obj::Geometry geometry(text, scene.name);
  obj::Materials materials(std::move(libraries), folder, scene);
  addParts(geometry, materials, scene);
  scene.environment = environment ? *environment : makeProceduralSky();
  if (!environment) scene.notes.emplace_back("no light and no environment in the file: added the procedural sky");
  finishScene(scene);
  warnOfOpenGlass(scene);
  return scene;
}

}  // namespace

Scene loadObj(const std::string& path, const std::optional<Environment>& environment) {
  const std::string text = readFile(path);
  return atPlace(path, [&] {
    try {
      return buildScene(path, text, environment);
    } catch (const std::bad_alloc&) {
      throwInputError("the scene doesn't fit into memory");
    }
  });
}

}  // namespace pb
