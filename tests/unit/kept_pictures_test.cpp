// Pictures that are kept in a run's folder are taken from there, and nothing is rendered again.
#include "bench/kept_pictures.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "bench/attribution_runner.h"
#include "bench/error_runner.h"
#include "scenes/files.h"
#include "scenes/image_io.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using testing::Contains;
using testing::Gt;
using testing::Pair;
using testing::SizeIs;

// The captures of the first two are equal, so are the pictures of a moving teapot's mirror in the first frame.
constexpr char kSuite[] = R"(
schema = 1
name = "kept"
image = { size = [32, 18], samples = 4 }
reference = { spp = 2 }
cost = { repetitions = 0 }
technique = { resolution = 16 }
[[scene]]
use = "builtin:teapot"
frames = [0, 4]
[grid]
bounces = [1, 2]
refresh = ["every-frame", "static"]
[attribution]
cells = "static"
frames = "all"
resolution = 32
)";

class KeptPicturesOfRuns : public RasterTest {
 protected:
  void SetUp() override {
    RasterTest::SetUp();
    if (IsSkipped()) return;
    suite_ = parseSuite(kSuite, "test", "");
    scenes_ = loadScenes(suite_);
    plan_ = makePlan(suite_);
  }

  RunContext context(RunDirectory& directory) {
    return {suite_, scenes_, plan_, device(), store_, directory, progress_};
  }

  std::string folder(const char* name) const { return folder_.file(name); }

  // Cells and attributions as they stand in results.
  static std::string textOf(const RunOutcome& outcome) {
    std::string text;
    for (const CellResult& cell : outcome.cells) text += toJson(cell) + '\n';
    for (const Attribution& attribution : outcome.attribution) text += toJson(attribution) + '\n';
    return text;
  }

  // All of it white, so that what is scored can be told from what would be rendered.
  void whiten(const RunDirectory& directory, const std::string& file) {
    const std::string path = (directory.folder() / file).string();
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    writeExr(path, Image(suite_.image.widthPx, suite_.image.heightPx, glm::vec3(7.0f)));
  }

  TemporaryFolder folder_;
  ReferenceStore store_{folder_.path() / "store"};
  Suite suite_;
  Scenes scenes_;
  Plan plan_;
  Progress progress_;
};
INSTANTIATE_TEST_SUITE_P(Backends, KeptPicturesOfRuns, kBackends, nameOfBackend);

TEST(KeptPicture, ComesBackInEveryBit) {
  const TemporaryFolder folder;
  const RunDirectory directory(folder.path() / "run", {"suite", ""}, false);
  Image image(4, 3);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = glm::vec3(std::pow(0.1f, static_cast<float>(i)));
  image[0] = {std::numeric_limits<float>::denorm_min(), -0.0f, std::numeric_limits<float>::max()};
  image[1] = {std::numeric_limits<float>::infinity(), -1.0f / 3.0f, std::numeric_limits<float>::min()};
  keepPicture(directory, "picture", image);
  const Image read = readPictureOf(directory, {}, "picture");
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(std::memcmp(read.data(), image.data(), image.size() * sizeof(image[0])), 0);
}

TEST_P(KeptPicturesOfRuns, GiveTheRunThatRendersThem) {
  RunDirectory plain(folder("plain"), {"kept", ""}, false);
  const RunOutcome expected = runPlan(context(plain));
  ASSERT_THAT(expected.attribution, SizeIs(4));
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  {
    const RunContext run = context(directory);
    KeptPictures kept(run);
    renderAndKeep(context(directory), kept);
  }
  EXPECT_EQ(textOf(runPlan(context(directory))), textOf(expected));
}

TEST_P(KeptPicturesOfRuns, AreScoredInPlaceOfRenderedOnes) {
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  const RunContext run = context(directory);
  KeptPictures kept(run);
  renderAndKeep(context(directory), kept);
  EXPECT_THAT(directory.keptCells(), SizeIs(8));
  for (const CellResult& cell : directory.keptCells()) whiten(directory, cell.pictures.rendered);
  for (const CellResult& cell : runPlan(context(directory)).cells) EXPECT_GT(cell.metrics.sums.mse, 30.0) << cell.key();
}

// As far as it came: what is kept counts, what is not is rendered.
TEST_P(KeptPicturesOfRuns, OfAKilledRun_AreGoneOnWith) {
  {
    RunDirectory directory(folder("run"), {"kept", ""}, false);
    const RunContext run = context(directory);
    KeptPictures kept(run);
    Plan first = plan_;
    first.sequences.resize(2);
    const RunContext part{suite_, scenes_, first, device(), store_, directory, progress_};
    renderAndKeep(part, kept);
    for (const CellResult& cell : directory.keptCells()) whiten(directory, cell.pictures.rendered);
  }
  RunDirectory directory(folder("run"), {"kept", ""}, true);
  EXPECT_THAT(directory.keptCells(), SizeIs(4));
  const RunContext run = context(directory);
  KeptPictures kept(run);
  renderAndKeep(context(directory), kept);
  EXPECT_THAT(directory.keptCells(), SizeIs(8));
  const RunOutcome outcome = runPlan(context(directory));
  for (std::size_t i = 0; i < outcome.cells.size(); ++i)
    EXPECT_EQ(outcome.cells[i].metrics.sums.mse > 30.0, i < 4) << outcome.cells[i].key();
}

// Killed after a picture was written and before its cell was: the next program's picture is the one that counts.
TEST_P(KeptPicturesOfRuns, ThatNoCellTellsOf_AreWrittenAnew) {
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  const PlannedSequence& sequence = plan_.sequences.front();
  const int frame = sequence.frames.front();
  const std::string name = PictureNames(suite_, scenes_).ofFrame(sequence, frame);
  keepPicture(directory, name, Image(suite_.image.widthPx, suite_.image.heightPx, glm::vec3(7.0f)));
  const RunContext run = context(directory);
  KeptPictures kept(run);
  EXPECT_EQ(kept.find(sequence, frame), nullptr);
  const Image black(suite_.image.widthPx, suite_.image.heightPx, glm::vec3(0.0f));
  kept.keep(sequence, {black, makeCell(suite_, sequence, frame)});
  EXPECT_EQ(kept.read(sequence, frame).image, black);
}

TEST_P(KeptPicturesOfRuns, ThatAreDamaged_AreNamedWithAWayOut) {
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  const RunContext run = context(directory);
  KeptPictures kept(run);
  const PlannedSequence& sequence = plan_.sequences.front();
  const int frame = sequence.frames.front();
  kept.keep(sequence, {Image(16, 16), makeCell(suite_, sequence, frame)});
  const std::string path = (directory.folder() / kept.find(sequence, frame)->pictures.rendered).string();
  writeFileAtomically(path, readFile(path).substr(0, 100));
  EXPECT_THAT(messageOf([&] { kept.read(sequence, frame); }),
              testing::HasSubstr("a run without --resume renders it again"));
}

// The picture of a frame that the run doesn't keep in the end is there until its attribution is done.
TEST_P(KeptPicturesOfRuns, OfAttributedFrames_AreNotRenderedAgain) {
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  FinishedCells finished;
  measureErrors(context(directory), finished, {});
  std::vector<CellResult> cells;
  for (const auto& [key, cell] : finished) cells.push_back(cell);
  const PictureNames names(suite_, scenes_);
  for (const PlannedSequence& sequence : plan_.sequences)
    for (const int frame : sequence.attributedFrames)
      whiten(directory, (frame == 4 ? "images/" : "kept/") + names.ofFrame(sequence, frame) + ".exr");
  const std::vector<Attribution> attributions = attribute(context(directory), cells);
  ASSERT_THAT(attributions, SizeIs(4));
  for (const Attribution& attribution : attributions) {
    EXPECT_EQ(attribution.steps.back().step, "stale");
    EXPECT_THAT(attribution.steps.back().metrics, Contains(Pair("mse", Gt(30.0))));
  }
}

TEST_P(KeptPicturesOfRuns, AreGoneInTheEnd) {
  RunDirectory directory(folder("run"), {"kept", ""}, false);
  Results results;
  results.cells = runPlan(context(directory)).cells;
  EXPECT_TRUE(std::filesystem::exists(directory.keptFolder()));
  directory.finish(results, "");
  EXPECT_FALSE(std::filesystem::exists(directory.keptFolder()));
}

}  // namespace
}  // namespace pb
