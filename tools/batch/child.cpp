// SPDX-License-Identifier: MIT
#include "batch/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/memory.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

constexpr int exit_of_failed_start = 127;

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string content_of(int file) {
  std::string text;
  std::array<char, 65536> buffer;
  ::lseek(file, 0, SEEK_SET);
  for (ssize_t n = 0; (n = ::read(file, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(n));
  return text;
}

/// Between fork and exec: system calls only. No descriptor that comes here is one of 0 to 2, which `tool_main`
/// occupies.
[[noreturn]] void become(char* const* argv, std::uint64_t memory_limit, int out, int err, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(exit_of_failed_start);
  if (memory_limit > 0) limit_memory(memory_limit);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execv(argv[0], argv);
  ::_exit(exit_of_failed_start);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, std::uint64_t memory_limit, std::chrono::duration<double> seconds)
    : out_(::memfd_create("out", MFD_CLOEXEC)), err_(::memfd_create("err", MFD_CLOEXEC)), start_(Clock::now()) {
  constexpr std::chrono::duration<double> no_limit(1e9);  // seconds; about 30 years, and no overflow
  deadline_ =
      seconds < no_limit ? start_ + std::chrono::duration_cast<Clock::duration>(seconds) : Clock::time_point::max();
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::signal(SIGCHLD, SIG_DFL);  // ignored, as whoever started this process may have it, exit codes are lost
  const pid_t parent = ::getpid();
  process_ = out_.is_open() && err_.is_open() ? ::fork() : -1;
  if (process_ == 0) become(argv.data(), memory_limit, out_.number(), err_.number(), parent);
  if (process_ < 0) throw IoError("cannot start " + command[0] + ": " + std::strerror(errno));
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      out_(std::move(other.out_)),
      err_(std::move(other.err_)),
      start_(other.start_),
      deadline_(other.deadline_),
      was_late_(other.was_late_) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(out_, other.out_);
  std::swap(err_, other.err_);
  std::swap(start_, other.start_);
  std::swap(deadline_, other.deadline_);
  std::swap(was_late_, other.was_late_);
  return *this;
}

Child::~Child() {
  if (process_ <= 0) return;
  ::kill(process_, SIGTERM);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
}

std::optional<ChildEnd> Child::poll() {
  int status = 0;
  rusage usage{};
  const pid_t ended = ::wait4(process_, &status, WNOHANG, &usage);
  const int error = errno;
  if (ended == 0) {
    if (!was_late_ && Clock::now() >= deadline_) {
      was_late_ = true;
      ::kill(process_, SIGKILL);
    }
    return std::nullopt;
  }
  process_ = -1;
  ChildEnd end;
  if (ended < 0)
    end.fault = std::string("nobody knows how it ended: ") + std::strerror(error);
  else if (WIFEXITED(status))
    end.exit_code = WEXITSTATUS(status);
  else
    end.signal = WTERMSIG(status);
  end.was_late = was_late_;
  end.out = content_of(out_.number());
  end.err = content_of(err_.number());
  end.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  end.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  constexpr std::uint64_t kibibyte = 1024;
  end.peak_memory = kibibyte * static_cast<std::uint64_t>(usage.ru_maxrss);
  return end;
}

}  // namespace meshbound::tools
