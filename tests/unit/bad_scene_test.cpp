// Every damaged file of tests/data/bad-input (made by its make.py) is refused in one sentence that names it; the odd
// ones, named warn-*, load with a warning.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenes/error.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
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

std::string refusalOf(auto function) {
  try {
    function();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Failure::input);
    return e.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

TEST(WorldTransform, BeyondTheBound_IsRefusedNamingTheNode) {
  EXPECT_THAT(refusalOf([] { loadScene(pathOf("node-scales-multiply-too-large.gltf")); }),
              AllOf(HasSubstr("node 'product'"), HasSubstr("has 1e+14 at 0 s")));
  // The first node of the chain whose product is too large.
  EXPECT_THAT(refusalOf([] { loadScene(pathOf("node-scales-multiply-to-infinity.gltf")); }),
              HasSubstr("node 'link 1'"));
  EXPECT_THAT(refusalOf([] { loadScene(pathOf("animation-scale-too-large.gltf")); }),
              AllOf(HasSubstr("node 'triangle'"), HasSubstr("1e+10")));
  EXPECT_THAT(refusalOf([] { loadScene(pathOf("animation-scale-nan.gltf")); }),
              AllOf(HasSubstr("node 'triangle'"), HasSubstr("nan")));
}

TEST(WorldTransform, ThatCollapses_IsWarnedAboutNamingTheNode) {
  const auto scene = loadScene(pathOf("warn-node-scaled-to-nothing.gltf"));
  EXPECT_THAT(scene->warnings, ElementsAre("node 'product' is scaled to nothing at the start: its mesh is not seen"));
}

// Two animated scales, each within the bound, whose product is not in frame 30.
TEST(WorldTransform, ThatGrowsBeyondTheBound_IsRefusedAtThatFrame) {
  auto scene = std::make_shared<Scene>();
  scene->name = "growing";
  scene->nodes.resize(2);
  scene->nodes[0].name = "outer";
  scene->nodes[1].name = "inner";
  scene->nodes[1].parent = 0;
  for (const int node : {0, 1})
    scene->tracks.push_back(
        {node, TrackTarget::scale, Interpolation::linear, {0.0f, 2.0f}, {glm::vec4(1.0f), glm::vec4(1e8f)}, {}});
  finishScene(*scene);
  EXPECT_NE(makeSnapshot(scene, 0, "", 1.0), nullptr);
  EXPECT_THAT(refusalOf([&] { makeSnapshot(scene, 30, "", 1.0); }),
              AllOf(HasSubstr("node 'inner' of scene 'growing'"), HasSubstr("at 1 s")));
}

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
