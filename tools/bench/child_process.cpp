// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_process.h"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace meshbound::bench {
namespace {

constexpr char tag_values = 'v';
constexpr char tag_error = 'e';

void write_all(int file, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(file, at, size);
    if (written <= 0) ::_exit(1);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// Never returns; `_exit` so that the parent's buffers are not flushed twice.
[[noreturn]] void run_child(int file, double cpu_seconds, const std::function<std::vector<double>()>& work) {
  const auto limit = static_cast<rlim_t>(std::ceil(cpu_seconds));
  const rlimit cpu{limit, limit + 1}, core{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_CORE, &core);
  try {
    const std::vector<double> values = work();
    write_all(file, &tag_values, 1);
    write_all(file, values.data(), values.size() * sizeof(double));
  } catch (const std::exception& error) {
    write_all(file, &tag_error, 1);
    write_all(file, error.what(), std::strlen(error.what()));
  }
  ::_exit(0);
}

/// Everything until the other end closes; false when that takes longer than `seconds`.
bool read_until_closed(int file, double seconds, std::string& bytes) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::array<char, 4096> buffer;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd wait{file, POLLIN, 0};
    if (left <= 0 || ::poll(&wait, 1, static_cast<int>(left)) == 0) return false;
    const ssize_t got = ::read(file, buffer.data(), buffer.size());
    if (got <= 0) return true;
    bytes.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

ChildResult run_in_child(double cpu_seconds, const std::function<std::vector<double>()>& work) {
  std::array<int, 2> ends;
  if (::pipe(ends.data()) != 0) throw std::runtime_error("cannot create a pipe");
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot start a child process");
  if (child == 0) {
    ::close(ends[0]);
    run_child(ends[1], cpu_seconds, work);
  }
  ::close(ends[1]);
  std::string bytes;
  const bool in_time = read_until_closed(ends[0], 10 * cpu_seconds + 10, bytes);
  ::close(ends[0]);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);

  ChildResult result;
  result.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  const bool out_of_cpu = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
  if (!in_time || out_of_cpu) {
    result.status = ChildResult::Status::TimedOut;
  } else if (WIFSIGNALED(status)) {
    result.error = std::string("ended by signal ") + strsignal(WTERMSIG(status));
  } else if (bytes.empty() || bytes[0] != tag_values) {
    result.error = bytes.empty() ? "ended without a result" : bytes.substr(1);
  } else {
    result.status = ChildResult::Status::Done;
    result.values.resize((bytes.size() - 1) / sizeof(double));
    std::memcpy(result.values.data(), bytes.data() + 1, result.values.size() * sizeof(double));
  }
  return result;
}

}  // namespace meshbound::bench
