#include "bench/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/scene.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

ReferenceRequest smallRequest(int frame = 0) {
  static const std::shared_ptr<const Scene> scene = loadScene("builtin:teapot");
  ReferenceRequest request{makeSnapshot(scene, frame, "", 2.0), 16, 8, {}};
  request.settings.spp = 4;
  return request;
}

// Values that no renderer would make, different in every batch, channel and pixel.
ReferenceImage numberedImage() {
  ReferenceImage image;
  for (int batch = 0; batch < 4; ++batch) {
    Image values(16, 8);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (int channel = 0; channel < 3; ++channel)
        values[i][channel] =
            1000.0f * static_cast<float>(batch) + 3.0f * static_cast<float>(i) + 0.1f * static_cast<float>(channel);
    image.batches.push_back(std::move(values));
  }
  image.raysTraced = 12345678901;
  return image;
}

fs::path fileEndingIn(const fs::path& folder, const std::string& suffix) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().string().ends_with(suffix)) return entry.path();
  return {};
}

TEST(ReferenceStore, GivesBackTheBatchesBitForBit) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path() / "made" / "on-demand");
  std::string warning;
  EXPECT_FALSE(store.load(smallRequest(), warning).has_value());
  store.save(smallRequest(), numberedImage());
  const std::optional<ReferenceImage> loaded = store.load(smallRequest(), warning);
  ASSERT_TRUE(loaded.has_value()) << warning;
  EXPECT_EQ(loaded->batches, numberedImage().batches);
  EXPECT_EQ(loaded->raysTraced, numberedImage().raysTraced);
  EXPECT_EQ(warning, "");
}

TEST(ReferenceStore, KeyChangesWithEverythingThatChangesThePicture) {
  std::set<std::string> keys;
  const auto add = [&](const ReferenceRequest& request) {
    return keys.insert(ReferenceStore::describe(request)).second;
  };
  const ReferenceRequest base = smallRequest();
  EXPECT_TRUE(add(base));
  EXPECT_FALSE(add(smallRequest()));  // the same scene loaded and evaluated again
  EXPECT_TRUE(add(smallRequest(3)));
  std::vector<ReferenceRequest> changed(11, base);
  changed[0].widthPx = 32;
  changed[1].heightPx = 32;
  changed[2].settings.samplesPerAxis = 1;
  changed[3].settings.spp = 8;
  changed[4].settings.depth = 2;
  changed[5].settings.seed = 2;
  changed[6].settings.hiddenInstances = {0};
  changed[7].settings.sampling = Sampling::independent;
  changed[8].refinement = Refinement{1, {1e-5, 64}, {}};
  changed[9].refinement = Refinement{2, {1e-5, 64}, {}};
  changed[10].refinement = Refinement{1, {2e-5, 128}, {}};
  for (const ReferenceRequest& request : changed) EXPECT_TRUE(add(request)) << ReferenceStore::describe(request);
}

TEST(ReferenceStore, DamagedEntries_AreAbsentWithAWarning) {
  for (const char* suffix : {".exr", ".json"}) {
    const TemporaryFolder folder;
    const ReferenceStore store(folder.path());
    store.save(smallRequest(), numberedImage());
    const fs::path file = fileEndingIn(folder.path(), suffix);
    ASSERT_FALSE(file.empty());
    fs::resize_file(file, fs::file_size(file) / 2);
    std::string warning;
    EXPECT_FALSE(store.load(smallRequest(), warning).has_value()) << suffix;
    EXPECT_THAT(warning, testing::HasSubstr("is rendered anew")) << suffix;
    EXPECT_THAT(warning, testing::Not(testing::HasSubstr("\n"))) << suffix;
  }
}

TEST(ReferenceStore, AFlippedBit_IsNoticed) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  store.save(smallRequest(), numberedImage());
  const fs::path file = fileEndingIn(folder.path(), ".exr");
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(fs::file_size(file)) - 5);
  const int byte = stream.peek();
  stream.seekp(static_cast<std::streamoff>(fs::file_size(file)) - 5);
  stream.put(static_cast<char>(byte ^ 1));
  stream.close();
  std::string warning;
  EXPECT_FALSE(store.load(smallRequest(), warning).has_value());
  EXPECT_THAT(warning, testing::HasSubstr("checksum"));
}

TEST(ReferenceStore, AnImageWithoutItsRecord_IsAbsent) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  store.save(smallRequest(), numberedImage());
  fs::remove(fileEndingIn(folder.path(), ".json"));
  std::string warning;
  EXPECT_FALSE(store.load(smallRequest(), warning).has_value());
}

TEST(ReferenceStore, InAFolderThatCantBeMade_IsAnEnvironmentError) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const ReferenceStore store(folder.path() / "file" / "store");
  try {
    store.save(smallRequest(), numberedImage());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::HasSubstr("--store"));
  }
}

}  // namespace
}  // namespace pb
