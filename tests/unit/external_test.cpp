#include "bench/external.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bench/axes.h"
#include "bench/report.h"
#include "scenes/files.h"
#include "scenes/image_io.h"
#include "tests/error_message.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Suite suiteWith(const std::string& external) {
  return parseSuite("schema = 1\nname = \"s\"\n[[scene]]\nuse = \"builtin:mirrors\"\n[[external]]\n" + external,
                    "s.toml", "/suites");
}

TEST(ExternalTechnique, Command_IsReadWithPathsOfTheSuite) {
  const Suite suite = suiteWith(R"(
name = "engine"
command = ["./bin/engine", "--assets={suite}/assets", "{suite}", "$HOME; rm"]
timeout_s = 5
settings = { resolution = 64, quality = "high" }
)");
  ASSERT_EQ(suite.externals.size(), 1u);
  const ExternalTechnique& technique = suite.externals.front();
  EXPECT_EQ(technique.name, "engine");
  EXPECT_THAT(technique.command, ElementsAre("/suites/bin/engine", "--assets=/suites/assets", "/suites", "$HOME; rm"));
  EXPECT_EQ(technique.timeoutS, 5);
  const Json settings = Json::parse(technique.settings);
  EXPECT_EQ(settings.at("resolution"), 64);
  EXPECT_EQ(settings.at("quality"), "high");
}

TEST(ExternalTechnique, OfASuiteInTheCurrentFolder_WorksThere) {
  const Suite suite = parseSuite(
      "schema = 1\nname = \"s\"\n[[scene]]\nuse = \"builtin:mirrors\"\n[[external]]\nname = \"e\"\n"
      "command = [\"e\", \"{suite}/x\"]\n",
      "s.toml", "");
  EXPECT_EQ(suite.externals.front().command[1], (std::filesystem::current_path() / "x").string());
}

TEST(ExternalTechnique, OfTheNumbers_IsAllButTheTimeOut) {
  const std::string base = "name = \"engine\"\ncommand = [\"engine\"]\n";
  const std::string text = canonicalText(suiteWith(base));
  EXPECT_THAT(text, HasSubstr("external "));
  EXPECT_EQ(canonicalText(suiteWith(base + "timeout_s = 5\n")), text);
  EXPECT_NE(canonicalText(suiteWith(base + "settings = { resolution = 64 }\n")), text);
  EXPECT_NE(canonicalText(suiteWith("name = \"engine\"\ncommand = [\"engine\", \"-v\"]\n")), text);
}

TEST(ExternalTechnique, ThatIsMisstated_IsRefusedWithLineAndReason) {
  const std::pair<const char*, const char*> cases[] = {
      {"name = \"a b\"\ncommand = [\"x\"]", "s.toml:6: 'name' wants 1 to 40 letters"},
      {"name = \"a\"", "s.toml:5: external technique 'a' wants either 'command' or 'images'"},
      {"name = \"a\"\ncommand = [\"x\"]\nimages = \"a.exr\"", "wants either 'command' or 'images'"},
      {"name = \"a\"\ncommand = []", "s.toml:7: 'command' wants a program and its arguments"},
      {"name = \"a\"\ncommand = [1]", "'command' wants strings"},
      {"name = \"a\"\ncommand = [\"x\"]\ntimeout_s = 0", "'timeout_s' wants an integer from 1"},
      {"name = \"a\"\ncommand = [\"x\"]\nsettings = 3", "'settings' wants a table"},
      {"name = \"a\"\ncommand = [\"x\"]\ntiming = \"t.json\"",
       "'timing' belongs to an external technique with 'images'"},
      {"name = \"a\"\nimages = \"a.exr\"\ntimeout_s = 3",
       "'timeout_s' belongs to an external technique with 'command'"},
      {"name = \"a\"\nimages = \"{frme}.exr\"", "'images' knows {scene}, {camera}, {number}, {frame} and {frame:05}"},
      {"name = \"a\"\ncomand = [\"x\"]\nimages = \"a.exr\"", "'comand' is not known; nearest is 'command'"},
      {"name = \"a\"\ncommand = [\"x\"]\n[[external]]\nname = \"a\"\ncommand = [\"y\"]", "'a' stands twice"},
  };
  for (const auto& [external, message] : cases)
    EXPECT_THAT(messageOf([&] { suiteWith(external); }), HasSubstr(message)) << external;
}

TEST(ExternalTechnique, PictureFile_ReplacesPlaceholders) {
  const PictureName name{"mirrors", "Camera", 2, 7};
  EXPECT_EQ(pictureFile("a/{number}-{scene}-{camera}-{frame}.exr", name), "a/2-mirrors-Camera-7.exr");
  EXPECT_EQ(pictureFile("{frame:05}{frame:01}", name), "000077");
  EXPECT_EQ(pictureFile("{frame:5}{other}", name), "{frame:5}{other}");
  // What a placeholder stands for is no pattern.
  EXPECT_EQ(pictureFile("{scene}", {"{frame}", "", 0, 0}), "{frame}");
}

// A job of the scene's frames -1 (warm-up) and 3.
struct JobOfMirrors {
  TemporaryFolder folder;
  std::shared_ptr<const Scene> scene = loadScene("builtin:mirrors?count=2");
  ExternalTechnique technique;

  Json make() {
    technique.name = "engine";
    technique.settings = R"({"bounces": 2})";
    const auto snapshot = [&](int frame) { return makeSnapshot(scene, frame, "", 2.0); };
    return makeJob({technique,
                    {"mirrors", "Camera", 0, 0},
                    {64, 32, 2},
                    describe(Technique()),
                    {{-1, false, snapshot(0)}, {3, true, snapshot(3)}},
                    6},
                   "/job");
  }
};

TEST(ExternalJob, KeepsItsSchema) {
  const std::string schema = readFile(std::string(PROBEBENCH_SOURCE_DIR) + "/results/schema/job.schema.json");
  const Json job = JobOfMirrors().make();
  EXPECT_EQ(parseDocument(job.dump(), "job.json", {"job", "job_version", 1, schema}), job);
}

TEST(ExternalJob, SaysWhatIsWanted) {
  const Json job = JobOfMirrors().make();
  EXPECT_EQ(job["technique"]["settings"]["bounces"], 2);
  EXPECT_EQ(job["technique"]["axes"]["bounces"], "1");
  EXPECT_EQ(job["scene"]["file"], "/job/scene.glb");
  EXPECT_EQ(job["image"], Json::parse(R"({"width": 64, "height": 32, "samples": 4})"));
  EXPECT_EQ(job["frames"].size(), 2u);
  EXPECT_TRUE(job["frames"][0]["image"].is_null());
  EXPECT_EQ(job["frames"][1]["image"], "/job/3.exr");
  EXPECT_EQ(job["timing"], Json::parse(R"({"file": "/job/timing.json", "repetitions": 6})"));
}

// The camera of the scene: at (0, 2.2, 7.5), looking at (0, 0.85, 0), 45 degrees high, twice as wide as high.
TEST(ExternalJob, Matrices_TakeTheTargetToTheMiddleAndTheEdgeOfTheViewToTheEdge) {
  const Json job = JobOfMirrors().make();
  const auto matrix = [](const Json& json) {
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = json[static_cast<std::size_t>(i)].get<double>();
    return m;
  };
  const Json& frame = job["frames"][0];
  const glm::dmat4 clipFromWorld = matrix(job["camera"]["clip_from_camera"]) * matrix(frame["camera_from_world"]);
  const auto project = [&](const glm::dvec4& world) {
    const glm::dvec4 clip = clipFromWorld * world;
    return glm::dvec3(clip) / clip.w;
  };
  constexpr double kRounding = 1e-6;  // the view's vectors are floats
  EXPECT_NEAR(job["camera"]["vertical_fov"].get<double>(), std::numbers::pi / 4, kRounding);
  const glm::dvec3 target = project({0, 0.85, 0, 1});
  EXPECT_NEAR(target.x, 0.0, kRounding);
  EXPECT_NEAR(target.y, 0.0, kRounding);
  // Points at the upper right edge, at the near plane and very far away.
  const glm::dmat4 worldFromCamera = matrix(frame["world_from_camera"]);
  const double t = std::tan(std::numbers::pi / 8);
  const glm::dvec3 near = project(worldFromCamera * glm::dvec4(0.2 * t, 0.1 * t, -0.1, 1));
  EXPECT_NEAR(near.x, 1.0, 1e-5);
  EXPECT_NEAR(near.y, 1.0, 1e-5);
  EXPECT_NEAR(near.z, -1.0, 1e-5);
  EXPECT_NEAR(project(worldFromCamera * glm::dvec4(0, 0, -1e9, 1)).z, 1.0, 1e-5);
}

TEST(ExternalJob, Probes_NameTheirOwnersInTheFile) {
  const Json job = JobOfMirrors().make();
  const Json& probes = job["frames"][1]["probes"];
  ASSERT_EQ(probes.size(), 2u);
  EXPECT_EQ(probes[1]["owners"].size(), 1u);
  const Json& owner = probes[1]["owners"][0];
  EXPECT_EQ(owner["name"], "Mirror_1");
  EXPECT_EQ(owner["primitive"], 0);
  const auto scene = loadScene("builtin:mirrors?count=2");
  EXPECT_EQ(scene->nodes[owner["node"].get<std::size_t>()].name, "Mirror_1");
  EXPECT_NEAR(probes[1]["position"][1].get<double>(), 1.0, 1e-6);
}

TEST(ExternalTiming, GivesMedianIntervalAndRatioToItsOwnPlainFrames) {
  const TemporaryFolder folder;
  const std::string path = folder.file("timing.json");
  writeFileAtomically(
      path, R"({"timing_version": 1, "program": "engine", "frame_ms": [30, 10, 20, 12, 20, 28], "plain_ms": [4, 6]})");
  ReportedCost cost = readTiming(path);
  EXPECT_EQ(cost.program, "engine");
  EXPECT_EQ(cost.frames, 6);
  EXPECT_EQ(cost.frameMs, 20);
  EXPECT_EQ(cost.frameMsLow, 10);
  EXPECT_EQ(cost.frameMsHigh, 30);
  EXPECT_EQ(cost.plainMs, 5);
  EXPECT_EQ(cost.ratio(), 4);
  writeFileAtomically(path, R"({"timing_version": 1, "program": "engine", "frame_ms": [30]})");
  EXPECT_FALSE(readTiming(path).ratio().has_value());
}

TEST(ExternalTiming, ThatIsMalformed_IsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("timing.json");
  const std::pair<const char*, const char*> cases[] = {
      {"", "truncated"},
      {"{}", "has no 'timing_version'"},
      {R"({"timing_version": 2})", "this version of probebench reads 1"},
      {R"({"timing_version": 1, "program": "e", "frame_ms": []})", "/frame_ms"},
      {R"({"timing_version": 1, "program": "e", "frame_ms": [-1]})", "/frame_ms/0"},
      {R"({"timing_version": 1, "program": "e", "frame_ms": ["1"]})", "/frame_ms/0"},
      {R"({"timing_version": 1, "program": "e", "frame_ms": [1], "fps": 3})", "fps"},
  };
  for (const auto& [text, message] : cases) {
    writeFileAtomically(path, text);
    EXPECT_THAT(messageOf([&] { readTiming(path); }), HasSubstr(message)) << text;
  }
}

TEST(ExternalPicture, ThatCannotBeScored_IsRefused) {
  const TemporaryFolder folder;
  const ImageSettings image{16, 16, 1};
  const std::string exr = folder.file("a.exr");
  const auto message = [&](const std::string& path) { return messageOf([&] { readPicture(path, image, "engine"); }); };
  EXPECT_THAT(message(exr), HasSubstr("engine has no picture"));
  writeFileAtomically(exr, "no image");
  EXPECT_THAT(message(exr), HasSubstr("a.exr"));
  writeExr(exr, Image(16, 17));
  EXPECT_THAT(message(exr), HasSubstr("engine was to render 16x16 pixels"));
  Image picture(16, 16, glm::vec3(0.5f));
  writePng(folder.file("a.png"), picture);
  EXPECT_THAT(message(folder.file("a.png")), HasSubstr("has integers"));
  picture(3, 5).y = std::numeric_limits<float>::quiet_NaN();
  writeExr(exr, picture);
  EXPECT_THAT(message(exr), HasSubstr("pixel (3, 5)"));
  picture(3, 5).y = -0.25f;  // negative values are bad pictures, but they can be scored
  writeExr(exr, picture);
  EXPECT_EQ(readPicture(exr, image, "engine"), picture);
}

// The sample run with an external technique on its first scene.
Results resultsWithExternal() {
  Results results = samples::makeResults();
  CellResult cell = samples::makeCell("builtin:a", 0, "", "", 0.05);
  cell.technique = {{kExternalAxis, "engine"}};
  cell.counters.clear();
  cell.faceAgeFrames.clear();
  cell.reportedCost = ReportedCost{"engine 1.0", 7, 1.0 / 3.0, 0.25, 0.5, 0.125};
  results.cells.push_back(cell);
  cell.frame = 1;
  cell.reportedCost->plainMs.reset();
  results.cells.push_back(cell);
  return results;
}

TEST(ExternalResults, SurviveJson) {
  const Results results = resultsWithExternal();
  const std::string text = toJson(results);
  const Results read = resultsFromJson(text, "results.json");
  EXPECT_EQ(toJson(read), text);
  const std::size_t last = results.cells.size() - 1;
  EXPECT_EQ(read.cells[last].reportedCost, results.cells[last].reportedCost);
  EXPECT_EQ(read.cells[last - 1].reportedCost->ratio(), 8.0 / 3.0);
  EXPECT_FALSE(read.cells.front().reportedCost.has_value());
}

TEST(ExternalResults, HaveAColumnInCsvAndATableOfTheirOwn) {
  const Results results = resultsWithExternal();
  EXPECT_THAT(toCsv(results), HasSubstr(",engine,reported_cost,frame_ms,0.3333333333333333\n"));
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("### External techniques\n\n| external |"));
  EXPECT_THAT(report, HasSubstr("x its plain"));
  // The axes' tables are as they are without it.
  const std::string own = makeReport(samples::makeResults());
  const auto questions = [](const std::string& text) {
    const std::size_t start = text.find("## builtin:a");
    return text.substr(start, text.find("### All errors", start) - start);
  };
  EXPECT_EQ(questions(report), questions(own));
}

TEST(ExternalResults, Alone_MakeAReport) {
  Results results = resultsWithExternal();
  std::erase_if(results.cells, [](const CellResult& cell) { return cell.technique.front().first != kExternalAxis; });
  EXPECT_THAT(makeReport(results), HasSubstr("| engine"));
}

}  // namespace
}  // namespace pb
