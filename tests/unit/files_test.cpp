#include "scenes/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/error.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }
  std::size_t fileCount() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  TemporaryFolder folder_;
};

Failure failureOf(auto function) {
  try {
    function();
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return Failure::verdict;
}

TEST(TemporaryFolders, AreFresh_AndGoWithAllThatIsInThem) {
  fs::path path;
  {
    const TemporaryFolder folder, other;
    path = folder.path();
    EXPECT_NE(path, other.path());
    EXPECT_TRUE(fs::is_empty(path));
    fs::create_directory(path / "inner");
    writeFileAtomically(folder.file("inner/file"), "");
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(Files, WrittenBytes_AreReadBack) {
  const std::string bytes("a\0b\r\n\xff", 6);
  writeFileAtomically(path("file"), bytes);
  EXPECT_EQ(readFile(path("file")), bytes);
  writeFileAtomically(path("file"), "");
  EXPECT_EQ(readFile(path("file")), "");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Files, LongerThanOneChunk_AreReadWhole) {
  const std::string bytes(300001, 'x');
  writeFileAtomically(path("file"), bytes);
  EXPECT_EQ(readFile(path("file")), bytes);
}

TEST_F(Files, FailedWrite_LeavesTheOldFileAndNothingElse) {
  fs::create_directory(path("folder"));
  EXPECT_EQ(failureOf([&] { writeFileAtomically(path("folder"), "new"); }), Failure::environment);
  EXPECT_EQ(failureOf([&] { writeFileAtomically(path("absent/file"), "new"); }), Failure::environment);
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Files, FullDevice_IsAnEnvironmentError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  EXPECT_EQ(failureOf([] { writeFileAtomically("/dev/full", "text"); }), Failure::environment);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, SymbolicLink_StaysAndItsTargetIsReplaced) {
  writeFileAtomically(path("target"), "old");
  fs::create_symlink(path("target"), path("link"));
  writeFileAtomically(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(readFile(path("target")), "new");
}

TEST_F(Files, UnreadableFile_IsNamedWithTheReason) {
  EXPECT_EQ(failureOf([&] { readFile(path("absent")); }), Failure::input);
  EXPECT_EQ(failureOf([&] { readFile(folder_.path().string()); }), Failure::input);
  try {
    readFile(path("absent"));
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "can't read '" + path("absent") + "': No such file or directory");
  }
}

}  // namespace
}  // namespace pb
