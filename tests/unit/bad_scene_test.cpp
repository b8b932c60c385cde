// Every damaged file of tests/data/bad-input (made by its make.py) is refused in one sentence that names it; the odd
// ones, named warn-*, load with a warning.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/error.h"
#include "scenes/scene.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> sceneFiles() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(PROBEBENCH_SOURCE_DIR "/tests/data/bad-input"))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::string pathOf(const std::string& name) { return PROBEBENCH_SOURCE_DIR "/tests/data/bad-input/" + name; }

class BadScene : public ::testing::TestWithParam<std::string> {};

TEST_P(BadScene, IsRefusedInOneSentence_OrLoadsWithAWarning) {
  const std::string& name = GetParam();
  const bool odd = name.starts_with("warn-");
  try {
    const auto scene = loadScene(pathOf(name));
    EXPECT_TRUE(odd) << "was loaded";
    EXPECT_FALSE(scene->warnings.empty());
  } catch (const Error& e) {
    EXPECT_FALSE(odd) << e.what();
    EXPECT_EQ(e.kind(), Failure::input);
    EXPECT_THAT(e.what(), HasSubstr(name));
    EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadScene, ::testing::ValuesIn(sceneFiles()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(BadSceneCorpus, HasAtLeastFortyFiles) { EXPECT_GE(sceneFiles().size(), 40U); }

TEST(SceneReference, ThatIsWrong_IsRefusedNamingTheValue) {
  const std::string odd = pathOf("warn-skin.gltf");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "name"},
      {"/nonexistent/scene.glb", "/nonexistent/scene.glb"},
      {PROBEBENCH_SOURCE_DIR "/tests", "/tests"},
      {"mirrors", "did you mean 'builtin:mirrors'?"},
      {"mirrors?count=3", "did you mean 'builtin:mirrors?count=3'?"},
      {"builtin:miror", "nearest is 'mirrors'"},
      {odd + "?mirror=triangel", "nearest is 'triangle'"},
      {odd + "?miror=all", "nearest is 'mirror'"},
      {odd + "?environment=/nonexistent.exr", "/nonexistent.exr"},
      {odd + "?environment=" + odd, "warn-skin.gltf"},
  };
  for (const auto& [reference, inMessage] : cases) {
    try {
      loadScene(reference);
      ADD_FAILURE() << reference << " was loaded";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Failure::input);
      EXPECT_THAT(e.what(), HasSubstr(inMessage));
    }
  }
}

}  // namespace
}  // namespace pb
