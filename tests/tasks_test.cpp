// SPDX-License-Identifier: MIT
// Loops cut into tasks: each number once, on threads of the team, with exceptions handed on.
#include "numeric/tasks.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <stdexcept>
#include <thread>
#include <vector>

#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "numeric/thread_count.h"

namespace tasks_test {

using namespace meshbound;

TEST(ThreadCount, IsThatOfTheOptionWithinReason) {
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_EQ(thread_count(1000000), max_threads);
  EXPECT_EQ(thread_count(0), omp_get_max_threads());
}

TEST(Tasks, VisitEachNumberOnceByThreadsOfTheTeam) {
  for (const int threads : {1, 2, 5}) {
    for (const std::size_t n : {0U, 1U, 2U, 99U, 100U, 101U, 1000U}) {
      std::vector<int> visits(n, 0);
      std::atomic<int> max_thread{0}, ranges{0};
      with_team(threads, [&] {
        for_each_range(n, 100, [&](std::size_t begin, std::size_t end) {
          EXPECT_LT(begin, end);
          EXPECT_LE(end, n);
          for (std::size_t i = begin; i < end; ++i) ++visits[i];
          ++ranges;
          if (omp_get_thread_num() >= threads) max_thread = omp_get_thread_num();
        });
        EXPECT_EQ(ranges, (n + 99) / 100) << "not all were done when the loop returned";
      });
      EXPECT_EQ(visits, std::vector<int>(n, 1));
      EXPECT_EQ(max_thread, 0);
    }
  }
}

TEST(Tasks, MakeTasksOfTheirOwn) {
  std::vector<int> visits(64, 0);
  with_team(3, [&] {
    for_each_task(8, [&](std::size_t i) { for_each_task(8, [&](std::size_t j) { ++visits[8 * i + j]; }); });
  });
  EXPECT_EQ(visits, std::vector<int>(64, 1));
}

/// A search by a thread of the caller's own team: its tasks are those of a team of one.
TEST(Tasks, OfATeamInsideAnotherStayWithTheThreadThatFormedIt) {
  std::atomic<int> strangers{0};
#pragma omp parallel num_threads(3)
  {
    std::vector<int> visits(50, 0);
    const auto outer = omp_get_ancestor_thread_num(1);
    with_team(1, [&] {
      for_each_task(50, [&](std::size_t i) {
        ++visits[i];
        if (omp_get_thread_num() != 0 || omp_get_ancestor_thread_num(1) != outer) ++strangers;
      });
    });
    if (visits != std::vector<int>(50, 1)) ++strangers;
  }
  EXPECT_EQ(strangers, 0);
}

TEST(Tasks, HandOnAnExceptionWhenAllAreDone) {
  for (const int threads : {1, 3}) {
    std::atomic<int> done{0};
    const auto work = [&](std::size_t i) {
      if (i % 10 == 3) throw std::runtime_error("three");
      ++done;
    };
    EXPECT_THROW(with_team(threads, [&] { for_each_task(100, work); }), std::runtime_error);
    EXPECT_EQ(done, 90);
    EXPECT_THROW(with_team(threads, [] { throw std::logic_error("no task"); }), std::logic_error);
  }
}

TEST(Tasks, HandOnAnExceptionOfATaskOfATask) {
  for (const int threads : {1, 3, 40}) {
    std::atomic<int> done{0};
    const auto inner = [&](std::size_t i) {
      if (i == 5) throw std::runtime_error("five");
      ++done;
    };
    EXPECT_THROW(with_team(threads, [&] { for_each_task(10, [&](std::size_t) { for_each_task(10, inner); }); }),
                 std::runtime_error);
    EXPECT_EQ(done, 90);
  }
}

TEST(Tasks, DoBothOfTwo) {
  for (const int threads : {1, 2, 3}) {
    int first = 0, second = 0;
    with_team(threads, [&] { do_both([&] { ++first; }, [&] { ++second; }); });
    do_both([&] { ++first; }, [&] { ++second; });
    EXPECT_EQ(first, 2);
    EXPECT_EQ(second, 2);
    EXPECT_THROW(with_team(threads, [&] { do_both([&] { ++first; }, [] { throw std::runtime_error("second"); }); }),
                 std::runtime_error);
  }
}

bool is_mode_of_bounds() {
  try {
    check_floating_point_model();
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// An engine has started the threads of OpenMP in a mode of its own, and calls in the mode that bounds need.
TEST(Tasks, RunInTheFloatingPointModeOfTheCaller) {
  constexpr int threads = 3;
#pragma omp parallel num_threads(threads)
  if (omp_get_thread_num() != 0) std::fesetround(FE_UPWARD);
  const auto threads_of_another_mode = [&] {
    std::atomic<int> others{0};
#pragma omp parallel num_threads(threads)
    others += is_mode_of_bounds() ? 0 : 1;
    return others.load();
  };
  const int before = threads_of_another_mode();  // none with clang's OpenMP, which gives its threads the caller's mode
  std::atomic<int> wrong{0};
  on_each_thread(threads, [&] { wrong += is_mode_of_bounds() ? 0 : 1; });
  on_any_thread(threads, 100, [&](std::size_t) { wrong += is_mode_of_bounds() ? 0 : 1; });
  EXPECT_EQ(wrong, 0);
  std::atomic<unsigned> seen{0};
  with_team(threads, [&] {
    for_each_task(100, [&](std::size_t i) {
      seen |= 1U << omp_get_thread_num();
      const auto is_alone = [&] { return (seen & (seen - 1)) == 0 && omp_get_num_threads() > 1; };
      while (i == 0 && is_alone()) std::this_thread::yield();
      for_each_task(4, [&](std::size_t) { wrong += is_mode_of_bounds() ? 0 : 1; });
    });
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(threads_of_another_mode(), before) << "threads have their own mode again";
#pragma omp parallel num_threads(threads)
  std::fesetround(FE_TONEAREST);
}

TEST(Tasks, OfNoneNeedNoThread) {
  on_any_thread(2, 0, [](std::size_t) { FAIL() << "there is nothing to do"; });
}

TEST(Tasks, RunOneAfterTheOtherOutsideAnyTeam) {
  for_each_task(0, [](std::size_t) { FAIL() << "there is nothing to do"; });
  std::vector<std::size_t> order;
  for_each_task(20, [&](std::size_t i) { order.push_back(i); });
  ASSERT_EQ(order.size(), 20U);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

}  // namespace tasks_test
