#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "bench/commands/commands.h"
#include "bench/shell_word.h"
#include "bench/suite.h"
#include "bench/suite_init.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

int init(const std::string& reference, const std::string& output) {
  const fs::path path(output);
  if (path.extension() != ".toml") throwInputError("-o wants a file named .toml, got '{}'", output);
  if (fs::exists(path)) throwInputError("'{}' exists and is left as it is, choose another -o", output);
  const std::string folder = path.parent_path().empty() ? "." : path.parent_path().string();
  if (!fs::is_directory(folder)) throwInputError("there is no folder '{}' for '{}'", folder, output);
  const std::shared_ptr<const Scene> scene = loadScene(reference);
  for (const std::string& warning : scene->warnings) fmt::print(stderr, "warning: {}: {}\n", scene->name, warning);
  const std::string text = makeSuiteText(path.stem().string(), sceneFromFolder(reference, folder), traitsOf(scene));
  parseSuite(text, output, path.parent_path().string());  // what is written can be read
  writeFileAtomically(output, text);
  fmt::print("{}", text);
  fmt::print(stderr, "next: probebench run {} --dry-run\n", shellWord(output));
  return 0;
}

}  // namespace

void addInitCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("init", "write a suite for a scene");
  const auto scene = std::make_shared<std::string>();
  const auto output = std::make_shared<std::string>();
  command->add_option("SCENE", *scene, "a .gltf, .glb or .obj file, or builtin:NAME")->required();
  command->add_option("-o", *output, "the .toml file, which must not exist")->required();
  command->callback([&action, scene, output] { action = [scene, output] { return init(*scene, *output); }; });
}

}  // namespace pb
