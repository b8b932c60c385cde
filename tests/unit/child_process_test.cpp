#include "bench/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

using namespace std::chrono_literals;
using End = ChildResult::End;
using testing::HasSubstr;

const std::atomic<bool> kGoOn{false};

ChildResult runShell(const std::string& script, const std::string& folder = "/", std::chrono::seconds timeout = 60s,
                     const std::atomic<bool>& stop = kGoOn) {
  return runChild({"/bin/sh", "-c", script}, folder, timeout, stop);
}

// The process is gone, or a zombie that nobody of ours has to reap.
bool hasEnded(int pid) {
  if (::kill(pid, 0) != 0) return true;
  const std::string status = readFile("/proc/" + std::to_string(pid) + "/stat");
  return status.substr(status.rfind(')') + 2, 1) == "Z";
}

bool endsSoon(int pid) {
  for (int i = 0; i < 200 && !hasEnded(pid); ++i) std::this_thread::sleep_for(10ms);
  return hasEnded(pid);
}

TEST(ChildProcess, TellsItsExitCodeAndWhatItSaid) {
  const ChildResult result = runShell("echo out; echo why >&2; exit 7");
  EXPECT_EQ(result.end, End::exited);
  EXPECT_EQ(result.code, 7);
  EXPECT_EQ(result.lastWords, "why\n");
}

TEST(ChildProcess, KeepsTheEndOfALongSpeech) {
  const ChildResult result = runShell("seq 1 100000 >&2; echo the end >&2");
  EXPECT_EQ(result.code, 0);
  EXPECT_LE(result.lastWords.size(), kMaxLastWords);
  EXPECT_TRUE(result.lastWords.ends_with("100000\nthe end\n"));
}

TEST(ChildProcess, WorksInItsFolderAndHasNothingToRead) {
  const TemporaryFolder folder;
  const ChildResult result = runShell("cat; pwd >&2", folder.path().string());
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.lastWords, folder.path().string() + "\n");
}

TEST(ChildProcess, EndedByASignal_SaysWhich) {
  const ChildResult result = runShell("kill -SEGV $$");
  EXPECT_EQ(result.end, End::killedBySignal);
  EXPECT_EQ(result.code, SIGSEGV);
}

TEST(ChildProcess, ThatTakesTooLong_IsKilledWithAllThatItStarted) {
  const TemporaryFolder folder;
  // Deaf to the polite request.
  const ChildResult result =
      runShell("trap '' TERM; sleep 600 & echo $! > pid; while true; do sleep 1; done", folder.path().string(), 1s);
  EXPECT_EQ(result.end, End::timedOut);
  EXPECT_TRUE(endsSoon(std::stoi(readFile(folder.file("pid")))));
}

TEST(ChildProcess, ThatIsToStop_IsKilledWithAllThatItStarted) {
  const TemporaryFolder folder;
  std::atomic<bool> stop{false};
  std::jthread stopper([&] {
    while (!std::filesystem::exists(folder.file("pid.done"))) std::this_thread::sleep_for(5ms);
    stop = true;
  });
  const ChildResult result =
      runShell("sleep 600 & echo $! > pid; mv pid pid.done; wait", folder.path().string(), 60s, stop);
  EXPECT_EQ(result.end, End::stopped);
  EXPECT_TRUE(endsSoon(std::stoi(readFile(folder.file("pid.done")))));
}

TEST(ChildProcess, ThatEnds_LeavesNothingRunning) {
  const TemporaryFolder folder;
  const ChildResult result = runShell("sleep 600 & echo $! > pid", folder.path().string());
  EXPECT_EQ(result.end, End::exited);
  EXPECT_TRUE(endsSoon(std::stoi(readFile(folder.file("pid")))));
}

TEST(ChildProcess, ThatCannotBeStarted_IsAFailureOfTheEnvironment) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.file("text"), "no program");
  std::filesystem::permissions(folder.file("text"), std::filesystem::perms::owner_all);
  try {
    runChild({folder.file("text")}, "/", 1s, kGoOn);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), HasSubstr("can't be started: Exec format error"));
  }
}

TEST(ChildProcess, FindProgram_LooksOnThePathAndRefusesWhatIsNotThere) {
  EXPECT_TRUE(findProgram("sh", "a test").ends_with("/sh"));
  EXPECT_EQ(findProgram("/bin/sh", "a test"), "/bin/sh");
  EXPECT_THROW(findProgram("no-such-program", "a test"), Error);
  EXPECT_THROW(findProgram("/etc/passwd", "a test"), Error);
}

}  // namespace
}  // namespace pb
