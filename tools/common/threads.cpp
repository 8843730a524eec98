// SPDX-License-Identifier: MIT
#include "common/threads.h"

#include <omp.h>

#include <array>
#include <exception>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace meshbound::tools {
namespace {

/// How many threads can be there at the same time, this one included; at most `wanted`.
int startable_threads(int wanted) {
  std::latch all_started(1);
  std::vector<std::thread> others;
  try {
    others.reserve(static_cast<std::size_t>(wanted - 1));
    while (static_cast<int>(others.size()) < wanted - 1) others.emplace_back([&] { all_started.wait(); });
  } catch (const std::system_error&) {
    // The limit of the machine or of the process is reached: these many, then.
  }
  all_started.count_down();
  for (std::thread& thread : others) thread.join();
  return static_cast<int>(others.size()) + 1;
}

}  // namespace

int start_threads(int wanted) {
  const int threads = startable_threads(wanted > 0 ? wanted : omp_get_max_threads());
  omp_set_num_threads(threads);
#pragma omp parallel num_threads(threads)
  {
#pragma omp barrier  // the compiler drops a region that does nothing
  }
  return threads;
}

void run_both(int threads, const std::function<void()>& first, const std::function<void()>& second) {
  if (threads < 2) {
    first();
    second();
    return;
  }
  const std::array<const std::function<void()>*, 2> works{&first, &second};
  std::array<std::exception_ptr, 2> errors;
  // Starts all threads, though only two have work: OpenMP ends threads that a team leaves out.
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (std::size_t i = 0; i < works.size(); ++i) {
    try {
      (*works[i])();
    } catch (...) {
      errors[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace meshbound::tools
