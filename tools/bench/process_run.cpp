// SPDX-License-Identifier: GPL-3.0-or-later
#include "process_run.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace meshbound::bench {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessRun run_process(const std::vector<std::string>& arguments, const std::filesystem::path& output, double limit) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  pid_t child = 0;
  const int failure = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " + arguments[0]);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit);
  ProcessRun run;
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, run.in_time ? WNOHANG : 0, &usage) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (std::chrono::steady_clock::now() < end) continue;
    run.in_time = false;
    ::kill(child, SIGKILL);
  }
  if (run.in_time && !WIFEXITED(status)) throw std::runtime_error(arguments[0] + " was ended by a signal");
  run.exit_code = WEXITSTATUS(status);
  run.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  return run;
}

}  // namespace meshbound::bench
