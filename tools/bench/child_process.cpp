// SPDX-License-Identifier: GPL-3.0-or-later
#include "child_process.h"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "processor_time.h"

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
[[noreturn]] void run_child(int file, const std::function<std::vector<double>()>& work) {
  const rlimit core{0, 0};
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

double cpu_seconds_of(pid_t child) {
  clockid_t clock{};
  return ::clock_getcpuclockid(child, &clock) == 0 ? processor_seconds(clock) : 0;
}

/// Everything until the other end closes; false when the child has used its seconds first. RLIMIT_CPU would do it
/// without asking, but under it Linux counts the processor time of a process in ticks of some milliseconds.
bool read_until_closed(int file, pid_t child, double cpu_seconds, std::string& bytes) {
  const std::chrono::duration<double> wall_limit(10 * cpu_seconds + 10);
  const auto end = std::chrono::steady_clock::now() + wall_limit;
  std::array<char, 4096> buffer;
  while (std::chrono::steady_clock::now() < end && cpu_seconds_of(child) < cpu_seconds) {
    constexpr int milliseconds = 50;
    pollfd wait{file, POLLIN, 0};
    if (::poll(&wait, 1, milliseconds) == 0) continue;
    const ssize_t got = ::read(file, buffer.data(), buffer.size());
    if (got <= 0) return true;
    bytes.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return false;
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
    run_child(ends[1], work);
  }
  ::close(ends[1]);
  std::string bytes;
  const bool in_time = read_until_closed(ends[0], child, cpu_seconds, bytes);
  ::close(ends[0]);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);

  ChildResult result;
  result.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  if (!in_time) {
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
