#include "tests/cli/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "scenes/files.h"

namespace pb {
namespace {

void redirect(int descriptor, const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(127);
}

void limitFileSize(long bytes) {
  std::signal(SIGXFSZ, SIG_IGN);  // writes fail with EFBIG, as they do with ENOSPC on a full disk
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  std::vector<char*> argv = {const_cast<char*>(options.program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("the program can't be started");
  if (pid_ > 0) return;
  redirect(STDOUT_FILENO, options.standardOutput.empty() ? folder_.file("out") : options.standardOutput);
  redirect(STDERR_FILENO, folder_.file("err"));
  if (options.maxFileBytes > 0) limitFileSize(options.maxFileBytes);
  ::execv(options.program.c_str(), argv.data());
  ::_exit(127);
}

RunningProgram::~RunningProgram() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void RunningProgram::signal(int number) const { ::kill(pid_, number); }

ProgramResult RunningProgram::wait() {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, captured("out"), captured("err")};
}

std::string RunningProgram::captured(const char* name) const {
  const std::string path = folder_.file(name);
  return std::filesystem::exists(path) ? readFile(path) : "";
}

ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  return RunningProgram(arguments, options).wait();
}

}  // namespace pb
