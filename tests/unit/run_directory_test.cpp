#include "bench/run_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

const RunIdentity kQuick{"quick", "f1"};

CellResult cellOfFrame(int frame) {
  CellResult cell;
  // Assigned literals warn falsely here (GCC bug 105651).
  cell.scene = std::string("scene");
  cell.camera = std::string("camera");
  cell.frame = frame;
  cell.technique = {{"resolution", "64"}};
  return cell;
}

void expectRefused(const fs::path& folder, const RunIdentity& identity, bool resume, const std::string& part) {
  try {
    RunDirectory(folder, identity, resume);
    FAIL() << "not refused: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

TEST(RunDirectory, OfSomebodyElse_IsRefusedUntouched) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.file("thesis.txt"), "years of work");
  expectRefused(folder.path(), kQuick, false, "was not made by probebench");
  expectRefused(folder.path(), kQuick, true, "was not made by probebench");
  EXPECT_EQ(readFile(folder.file("thesis.txt")), "years of work");
  EXPECT_FALSE(fs::exists(folder.file("run.json")));
}

TEST(RunDirectory, WithAForeignRunJson_IsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"not JSON", "[1]", "{\"suite\": 3}"}) {
    writeFileAtomically(folder.file("run.json"), text);
    expectRefused(folder.path(), kQuick, false, "was not written by probebench");
  }
}

TEST(RunDirectory, OfAnotherSuite_IsRefusedUntouched) {
  const TemporaryFolder folder;
  RunDirectory(folder.path(), {"large", "f"}, false).append(cellOfFrame(0));
  expectRefused(folder.path(), kQuick, false, "holds a run of suite 'large'");
  EXPECT_TRUE(fs::exists(folder.file("journal.jsonl")));
}

TEST(RunDirectory, ThatAnotherRunWritesTo_IsRefusedUntilThatOneEnds) {
  const TemporaryFolder folder;
  {
    RunDirectory first(folder.path(), kQuick, false);
    first.append(cellOfFrame(0));
    for (const bool resume : {false, true}) EXPECT_THROW(RunDirectory(folder.path(), kQuick, resume), Error) << resume;
    first.append(cellOfFrame(1));
  }
  EXPECT_EQ(RunDirectory(folder.path(), kQuick, true).finishedCells().size(), 2u);
}

TEST(RunDirectory, WithoutResume_RemovesTheEarlierRunAndNothingElse) {
  const TemporaryFolder folder;
  RunDirectory(folder.path(), kQuick, false).append(cellOfFrame(0));
  writeFileAtomically(folder.file("notes.txt"), "mine");
  writeFileAtomically((folder.path() / "images" / "old.png").string(), "x");
  const RunDirectory again(folder.path(), {"quick", "f2"}, false);
  EXPECT_TRUE(again.finishedCells().empty());
  EXPECT_FALSE(fs::exists(folder.file("journal.jsonl")));
  EXPECT_TRUE(fs::is_empty(again.imagesFolder()));
  EXPECT_EQ(readFile(folder.file("notes.txt")), "mine");
}

TEST(RunDirectory, WithResume_HasTheFinishedCells) {
  const TemporaryFolder folder;
  {
    RunDirectory directory(folder.path(), kQuick, false);
    directory.append(cellOfFrame(0));
    directory.append(cellOfFrame(3));
  }
  const RunDirectory resumed(folder.path(), kQuick, true);
  ASSERT_EQ(resumed.finishedCells().size(), 2u);
  EXPECT_EQ(resumed.finishedCells()[1].key(), cellOfFrame(3).key());
}

TEST(RunDirectory, LineTornByAKill_IsDroppedAndTheJournalGoesOnAfterIt) {
  const TemporaryFolder folder;
  RunDirectory(folder.path(), kQuick, false).append(cellOfFrame(0));
  std::ofstream(folder.file("journal.jsonl"), std::ios::app) << "{\"scene\": \"a\", \"cam";
  {
    RunDirectory resumed(folder.path(), kQuick, true);
    EXPECT_EQ(resumed.finishedCells().size(), 1u);
    resumed.append(cellOfFrame(1));
  }
  EXPECT_EQ(RunDirectory(folder.path(), kQuick, true).finishedCells().size(), 2u);
}

TEST(RunDirectory, ResumedWithOtherSettings_IsRefused) {
  const TemporaryFolder folder;
  RunDirectory(folder.path(), kQuick, false).append(cellOfFrame(0));
  expectRefused(folder.path(), {"quick", "f2"}, true, "--resume wants the same");
}

TEST(RunDirectory, DamagedJournal_IsRefusedByLine) {
  const TemporaryFolder folder;
  RunDirectory(folder.path(), kQuick, false).append(cellOfFrame(0));
  std::ofstream(folder.file("journal.jsonl"), std::ios::app) << "garbage\n";
  expectRefused(folder.path(), kQuick, true, "journal.jsonl:2");
}

TEST(RunDirectory, WhereAFileStands_IsAnEnvironmentError) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.file("file"), "x");
  try {
    RunDirectory(folder.file("file"), kQuick, false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
  }
}

}  // namespace
}  // namespace pb
