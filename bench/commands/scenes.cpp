#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/commands/commands.h"
#include "scenes/builtin.h"
#include "scenes/describe.h"
#include "scenes/error.h"
#include "scenes/gltf_save.h"
#include "scenes/scene.h"

namespace pb {
namespace {

int listScenes() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const BuiltinScene& scene : builtinScenes())
    rows.emplace_back("builtin:" + scene.name,
                      scene.description + (scene.parameters.empty() ? "" : " Parameters: " + scene.parameters));
  fmt::print("{}", printList(rows));
  return 0;
}

int printScene(const std::string& reference) {
  fmt::print("{}", describe(*loadScene(reference)));
  return 0;
}

int exportScene(const std::string& reference, const std::string& output) {
  // Importers tell the two kinds of glTF files apart by their names.
  if (!output.ends_with(".glb")) throwInputError("-o wants a file named .glb, got '{}'", output);
  saveGlb(*loadScene(reference), output);
  return 0;
}

}  // namespace

void addScenesCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* scenes = app.add_subcommand("scenes", "what there is to render");
  scenes->require_subcommand(1);
  scenes->add_subcommand("list", "built-in scenes")->callback([&action] { action = listScenes; });

  const auto reference = std::make_shared<std::string>();
  const auto output = std::make_shared<std::string>();
  CLI::App* info = scenes->add_subcommand("info", "load a scene and print what was found and what was ignored");
  info->add_option("SCENE", *reference, "a .gltf, .glb or .obj file, or builtin:NAME")->required();
  info->callback([&action, reference] { action = [reference] { return printScene(*reference); }; });

  CLI::App* save = scenes->add_subcommand("export", "write a scene as a .glb file");
  save->add_option("SCENE", *reference, "a .gltf, .glb or .obj file, or builtin:NAME")->required();
  save->add_option("-o", *output, "the .glb file")->required();
  save->callback(
      [&action, reference, output] { action = [reference, output] { return exportScene(*reference, *output); }; });
}

}  // namespace pb
