// SPDX-License-Identifier: MIT
// The threads of a tool: there before memory becomes scarce, and two of them for two files.
#include "common/threads.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>

namespace threads_test {

using namespace meshbound::tools;

TEST(StartThreads, HasStartedThemWhenItReturns) {
  if (!std::filesystem::exists("/proc/self/task")) GTEST_SKIP() << "the system does not list the threads of a process";
  EXPECT_EQ(start_threads(3), 3);
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  EXPECT_GE(std::distance(begin(tasks), end(tasks)), 3);  // a sanitizer has one of its own
  EXPECT_EQ(omp_get_max_threads(), 3);
}

std::string thrown_by(int threads, const std::function<void()>& first, const std::function<void()>& second) {
  try {
    run_both(threads, first, second);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(RunBoth, RethrowsWhatTheFirstThrows) {
  for (const int threads : {1, 2, 3}) {
    int done = 0;
    const auto works = [] {};
    const auto fails = [] { throw std::runtime_error("first"); };
    const auto also_fails = [] { throw std::runtime_error("second"); };
    EXPECT_EQ(thrown_by(threads, works, [&] { done = 1; }), "");
    EXPECT_EQ(done, 1);
    EXPECT_EQ(thrown_by(threads, fails, works), "first");
    EXPECT_EQ(thrown_by(threads, works, also_fails), "second");
    EXPECT_EQ(thrown_by(threads, fails, also_fails), "first");
  }
}

}  // namespace threads_test
