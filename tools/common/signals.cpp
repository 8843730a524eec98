// SPDX-License-Identifier: MIT
#include "common/signals.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "common/exit_code.h"
#include "mesh/temporary_files.h"

namespace meshbound::tools {
namespace {

std::atomic<bool> flag = false;
std::atomic<int> uninterrupted_scopes = 0;
std::array<char, 128> last_line{};  // what the process says when it is ended from outside
std::size_t last_line_size = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

void start_timer() {
  itimerval timer{};
  timer.it_value.tv_usec = static_cast<suseconds_t>(grace * 1e6);
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

extern "C" void note_interrupt(int) {
  const int error = errno;
  if (!flag.exchange(true)) start_timer();
  errno = error;
}

extern "C" void end_process(int) {
  const int error = errno;
  if (uninterrupted_scopes == 0) {
    remove_temporary_files();
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, last_line.data(), last_line_size);
    ::_exit(ExitBadInput);
  }
  start_timer();
  errno = error;
}

/// Without SA_RESTART: a call that waits, for the reader of a FIFO say, is to return.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void watch_interrupts(const std::string& tool) {
  // A progress bar may stand on the line of a terminal.
  const std::string line = (::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "") + tool.substr(0, 60) +
                           ": interrupted; unfinished files were removed\n";
  last_line_size = std::min(line.size(), last_line.size());
  std::copy_n(line.data(), last_line_size, last_line.data());
  handle(SIGALRM, end_process);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(signal)) handle(signal, note_interrupt);
}

const std::atomic<bool>& interrupted() { return flag; }

UninterruptedScope::UninterruptedScope() { ++uninterrupted_scopes; }
UninterruptedScope::~UninterruptedScope() { --uninterrupted_scopes; }

void ignore_write_signals() {
  handle(SIGXFSZ, SIG_IGN);
  handle(SIGPIPE, SIG_IGN);
}

}  // namespace meshbound::tools
