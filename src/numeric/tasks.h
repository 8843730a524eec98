// SPDX-License-Identifier: MIT
/// Parallel loops for work of a few milliseconds. A team of threads is formed once for many loops; each loop is cut
/// into tasks, and whichever thread is free takes the next. The thread that runs the loops takes all of them itself
/// where no other one comes: it waits only for tasks that another thread has begun, and once, at the end, for the team.
/// A worksharing loop waits for all threads each time, which costs a time slice of the scheduler where other programs
/// hold the processors. What a task does must not depend on which thread runs it, or when.
///
/// Whatever a thread does here, it does in the floating-point mode of the thread that called.
#pragma once
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <new>
#include <utility>

#include "numeric/first_error.h"
#include "numeric/floating_point_mode.h"

namespace meshbound {

/// Whether loops for so many threads need a team of their own. One thread outside of any team runs them alone as it is;
/// inside a team it would share them with the others.
inline bool needs_team(int threads) { return threads > 1 || omp_get_level() > 0; }

/// Calls `work()` on the calling thread. The loops that it runs are shared with `threads` - 1 others;
/// `omp_get_thread_num()` tells them apart. Rethrows what `work` throws.
template <class Work>
void with_team(int threads, Work&& work) {
  if (!needs_team(threads)) return std::forward<Work>(work)();
  FirstError error;
#pragma omp parallel num_threads(threads) default(none) shared(error, work)
  {
#pragma omp master
    error.guard(work);
  }
  error.rethrow();
}

/// Calls `work()` on each of `threads` threads, the calling one among them, or of as many as OpenMP gives. It must not
/// throw.
template <class Work>
void on_each_thread(int threads, const Work& work) {
  const FloatingPointMode of_caller;
#pragma omp parallel num_threads(threads) default(none) shared(of_caller, work)
  {
    const BorrowedFloatingPointMode borrowed(of_caller);
    work();
  }
}

/// Calls work(0) ... work(count - 1), each on whichever of `threads` threads is free. It must not throw.
template <class Work>
void on_any_thread(int threads, std::size_t count, const Work& work) {
  if (count == 0) return;
  on_each_thread(threads, [&] {
#pragma omp for schedule(dynamic, 1) nowait
    for (std::size_t i = 0; i < count; ++i) work(i);
  });
}

/// Throws `std::bad_alloc` if there is no memory for this many OpenMP tasks, where the OpenMP runtime would end the
/// process. The memory is freed at once for the runtime to allocate, which another thread may prevent.
inline void require_memory_for_tasks(std::size_t tasks) {
  constexpr std::size_t bytes_of_task = 512;  // 231 in libgomp 12
  ::operator delete(::operator new(bytes_of_task* tasks + bytes_of_task));
}

template <class Work>
[[gnu::noinline]] void in_own_frame(const Work& work) {
  work();
}

/// Calls `work()` with a gap on the stack between it and the caller. Other threads read what the caller's stack holds,
/// and this keeps what `work` writes off the same cache lines: a loop that does little else took 1.5 times as long.
template <class Work>
[[gnu::noinline]] void apart(const Work& work) {
  constexpr std::size_t gap = 128;  // a pair of cache lines, as they are fetched
  std::array<volatile char, gap> unused;
  in_own_frame(work);
  unused[0] = 0;  // until here the gap is part of the stack
}

/// Calls work(0) ... work(count - 1) by the team that this is called in, and returns when all are done. Outside any
/// team they run one after the other. Rethrows the first of what they throw.
///
/// A task of OpenMP is an offer of work here, not a piece of it: libgomp runs a `taskloop` of more than 64 tasks for
/// each thread by one thread alone.
template <class Work>
void for_each_task(std::size_t count, Work&& work) {
  if (count == 1) return std::forward<Work>(work)(std::size_t{0});
  FirstError error;
  std::atomic<std::size_t> next{0};
  const auto take_pieces = [&] {
    for (std::size_t i = next++; i < count; i = next++) error.guard([&] { work(i); });
  };
  const std::size_t helpers = std::min(count, static_cast<std::size_t>(omp_get_num_threads()));
  if (helpers > 1) require_memory_for_tasks(helpers);
  const FloatingPointMode of_caller;
  for (std::size_t i = 1; i < helpers; ++i) {
#pragma omp task default(none) shared(of_caller, take_pieces)
    {
      const BorrowedFloatingPointMode borrowed(of_caller);
      take_pieces();
    }
  }
  apart(take_pieces);
#pragma omp taskwait
  error.rethrow();
}

/// Calls work(begin, end) for consecutive ranges of `grain` of the numbers 0 ... n - 1, as `for_each_task` does.
template <class Work>
void for_each_range(std::size_t n, std::size_t grain, Work&& work) {
  for_each_task((n + grain - 1) / grain, [&](std::size_t i) { work(i * grain, std::min(n, (i + 1) * grain)); });
}

/// Calls both, side by side where the team that this is called in has two threads.
template <class First, class Second>
void do_both(First&& first, Second&& second) {
  for_each_task(2, [&](std::size_t i) { i == 0 ? first() : second(); });
}

}  // namespace meshbound
