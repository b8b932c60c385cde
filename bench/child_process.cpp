#include "bench/child_process.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include "scenes/error.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kPollInterval = 20ms;
constexpr auto kGrace = 2s;  // between the request to end and the order

bool isExecutable(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none) && ::access(path.c_str(), X_OK) == 0;
}

// Both ends are closed in programs that are started.
struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throwEnvironmentError("no pipe can be made: {}", std::strerror(errno));
  }
  ~Pipe() {
    closeEnd(0);
    closeEnd(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int readEnd() const { return ends[0]; }
  int writeEnd() const { return ends[1]; }
  void closeEnd(std::size_t end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

// Between fork and exec, in a process of several threads: system calls only, and nothing that takes memory. Whatever
// fails is told through `failure` as errno.
[[noreturn]] void becomeProgram(char* const* arguments, const char* folder, int standardError, int failure,
                                pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // an orphan would go on for nobody
  if (::getppid() != parent) ::_exit(127);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  const bool ready = nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(nothing, STDOUT_FILENO) >= 0 &&
                     ::dup2(standardError, STDERR_FILENO) >= 0 && ::chdir(folder) == 0;
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);  // files of the driver and of running tasks are none of its business
  if (ready) ::execv(arguments[0], arguments);
  const int reason = errno;
  const ssize_t written = ::write(failure, &reason, sizeof reason);
  ::_exit(written == sizeof reason ? 126 : 127);
}

class Child {
 public:
  Child(const std::vector<std::string>& command, const std::string& folder) {
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    Pipe failure;
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ < 0) throwEnvironmentError("'{}' can't be started: {}", command.front(), std::strerror(errno));
    if (pid_ == 0) becomeProgram(arguments.data(), folder.c_str(), words_.writeEnd(), failure.writeEnd(), parent);
    ::setpgid(pid_, pid_);  // here as well, so that the group is there whoever comes first
    words_.closeEnd(1);
    failure.closeEnd(1);
    int reason = 0;
    if (::read(failure.readEnd(), &reason, sizeof reason) != sizeof reason) return;
    reap();
    throwEnvironmentError("'{}' can't be started: {}", command.front(), std::strerror(reason));
  }

  ~Child() {
    if (pid_ > 0) endGroup();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Reads what it writes, for about kPollInterval.
  void listen() {
    if (words_.readEnd() < 0) return std::this_thread::sleep_for(kPollInterval);
    pollfd ready{words_.readEnd(), POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(kPollInterval / 1ms)) <= 0) return;
    readAvailable();
  }

  bool hasEnded() const {
    siginfo_t info{};  // left alone if it has not ended
    return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
  }

  // Ends it and its group, politely at first; the group also if it has ended by itself. Returns wait()'s status.
  int endGroup() {
    if (!hasEnded()) {
      ::kill(-pid_, SIGTERM);
      for (const auto deadline = Clock::now() + kGrace; !hasEnded() && Clock::now() < deadline;) listen();
    }
    ::kill(-pid_, SIGKILL);  // before the process is reaped: until then nobody else can have its number
    return reap();
  }

  // What is left in the pipe, without waiting for whoever still holds it.
  std::string takeLastWords() {
    pollfd ready{words_.readEnd(), POLLIN, 0};
    while (words_.readEnd() >= 0 && ::poll(&ready, 1, 0) > 0 && readAvailable()) {
    }
    return std::move(lastWords_);
  }

 private:
  int reap() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

  // False at the end of what there is.
  bool readAvailable() {
    std::array<char, kMaxLastWords> bytes;
    const ssize_t count = ::read(words_.readEnd(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) {
      words_.closeEnd(0);
      return false;
    }
    lastWords_.append(bytes.data(), static_cast<std::size_t>(count));
    if (lastWords_.size() > kMaxLastWords) lastWords_.erase(0, lastWords_.size() - kMaxLastWords);
    return true;
  }

  Pipe words_;
  pid_t pid_ = -1;
  std::string lastWords_;
};

ChildResult resultOf(int status) {
  if (WIFSIGNALED(status)) return {ChildResult::End::killedBySignal, WTERMSIG(status), {}};
  return {ChildResult::End::exited, WEXITSTATUS(status), {}};
}

}  // namespace

std::string findProgram(const std::string& name, const std::string& who) {
  if (name.find('/') != std::string::npos) {
    if (!isExecutable(name)) throwEnvironmentError("{} wants to run '{}', which is no executable file", who, name);
    return name;
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (isExecutable(fs::path(folder) / name)) return fs::absolute(fs::path(folder) / name).string();
  throwEnvironmentError("{} wants to run '{}', which is not on the PATH", who, name);
}

ChildResult runChild(const std::vector<std::string>& command, const std::string& folder, std::chrono::seconds timeout,
                     const std::atomic<bool>& stop) {
  Child child(command, folder);
  const auto deadline = Clock::now() + timeout;
  const auto late = [&] { return Clock::now() >= deadline; };
  while (!child.hasEnded() && !stop && !late()) child.listen();
  const bool ended = child.hasEnded();
  ChildResult result = resultOf(child.endGroup());
  if (!ended) result.end = stop ? ChildResult::End::stopped : ChildResult::End::timedOut;
  result.lastWords = child.takeLastWords();
  return result;
}

}  // namespace pb
