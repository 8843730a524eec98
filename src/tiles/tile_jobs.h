// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace meshbound {

/// Jobs that do not depend on one another: 0, 1, ... below `size`. Each leaves a result here, and whoever continues
/// needs all results, unless only the first process does. A result may come from another process as bytes: what `run`
/// leaves behind and what `unpack` makes of the bytes of `run_packed` is the same to the bit.
class TileJobs {
 public:
  TileJobs() = default;
  TileJobs(const TileJobs&) = delete;
  TileJobs& operator=(const TileJobs&) = delete;
  virtual ~TileJobs() = default;

  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Expected work of a job, in any unit: jobs that weigh more begin first.
  [[nodiscard]] virtual std::uint64_t weight(std::size_t job) const = 0;
  /// Does a job. Several threads may run different jobs at once.
  virtual void run(std::size_t job) = 0;
  /// As `run`; returns the result in a compact form that is the same on every machine of one byte order.
  [[nodiscard]] virtual std::string run_packed(std::size_t job) = 0;
  /// Takes a result over instead of `run`. Throws `InvalidInput` where the bytes are none. Several threads may unpack
  /// different jobs at once.
  virtual void unpack(std::size_t job, std::string_view bytes) = 0;
  /// Whether a job has come to its own end, not to that of a time limit.
  [[nodiscard]] virtual bool is_complete(std::size_t job) const = 0;
  /// Whether results are of no use but to the first process, so that they need not be sent to others.
  [[nodiscard]] virtual bool only_first_needs_results() const { return false; }
  /// Called now and then from the thread that called `JobRunner::run`, with the share of the weight that is done.
  virtual void progress(double share) = 0;
};

/// Who does jobs: threads of this process, or the ranks of a parallel run, which hold the same jobs and leave with the
/// same results. Passes call it one after the other, from one thread.
class JobRunner {
 public:
  JobRunner() = default;
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;
  virtual ~JobRunner() = default;

  /// Has each job run, or its result unpacked. Throws what a job throws.
  virtual void run(TileJobs& jobs) = 0;
  /// Whether this is the first process.
  [[nodiscard]] virtual bool is_first() const { return true; }
  /// Whether any process says so: for decisions on which all must agree.
  [[nodiscard]] virtual bool any(bool here) { return here; }
  /// Does a step that all processes do alike. Where it throws in one of them, all throw what the first of these threw.
  virtual void do_together(const std::function<void()>& step) { step(); }
};

/// Jobs from the heaviest to the lightest; of equal ones the first comes first. O(n log n).
[[nodiscard]] std::vector<std::size_t> heaviest_first(const TileJobs& jobs);

/// Threads of this process, each of which works on one job at a time.
class ThreadRunner : public JobRunner {
 public:
  /// `threads`: 0 for as many as OpenMP has.
  explicit ThreadRunner(int threads);
  void run(TileJobs& jobs) override;

 private:
  int threads_;
};

}  // namespace meshbound
