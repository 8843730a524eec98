// SPDX-License-Identifier: MIT
#include "mpi/rank_runner.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "numeric/first_error.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

enum Tag { Request = 1, Reply = 2 };
/// A request says whether its rank goes on; a reply with `no_job` is the last one to a rank.
constexpr std::int64_t has_failed = -1, wants_job = 0, no_job = -1;

/// A job and its result.
using Done = std::pair<std::size_t, std::string>;

/// The jobs that a rank has been given, between the thread that asks for them and those that work.
class LocalQueue {
 public:
  explicit LocalQueue(TileJobs& jobs) : jobs_(jobs) {}

  void put(std::size_t job) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(job);
    ++under_work_;
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }
  /// Works until the queue is closed and empty.
  void work() {
    while (const std::optional<std::size_t> job = take()) do_job(*job);
  }
  /// For a rank without a second thread: does one of the jobs, if there is one.
  bool work_once() {
    std::optional<std::size_t> job;
    {
      const std::lock_guard lock(mutex_);
      if (!waiting_.empty()) {
        job = waiting_.front();
        waiting_.pop_front();
      }
    }
    if (job) do_job(*job);
    return job.has_value();
  }
  /// Jobs that were put in and are not done.
  [[nodiscard]] std::size_t under_work() const {
    const std::lock_guard lock(mutex_);
    return under_work_;
  }
  /// The jobs that this rank has done, with their results.
  [[nodiscard]] std::vector<Done> take_done() {
    const std::lock_guard lock(mutex_);
    return std::move(done_);
  }
  /// Does a step beside the jobs. If it throws, no further job is done.
  template <class Step>
  void guard(const Step& step) {
    error_.guard(step);
  }
  [[nodiscard]] const FirstError& error() const { return error_; }

 private:
  std::optional<std::size_t> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !waiting_.empty() || is_closed_; });
    if (waiting_.empty()) return std::nullopt;
    const std::size_t job = waiting_.front();
    waiting_.pop_front();
    return job;
  }
  void do_job(std::size_t job) {
    std::string bytes;
    if (!error_.has_error()) error_.guard([&] { bytes = jobs_.run_packed(job); });
    const std::lock_guard lock(mutex_);
    --under_work_;
    if (!error_.has_error()) done_.emplace_back(job, std::move(bytes));
  }

  TileJobs& jobs_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> waiting_;
  std::vector<Done> done_;
  std::size_t under_work_ = 0;
  bool is_closed_ = false;
  FirstError error_;
};

/// What one rank does while jobs are handed out; rank 0 hands them out as well.
class Dealer {
 public:
  Dealer(Communicator& ranks, TileJobs& jobs, LocalQueue& queue, std::size_t workers)
      : ranks_(ranks), jobs_(jobs), queue_(queue), workers_(std::max<std::size_t>(workers, 1)) {
    if (ranks.rank() == 0) order_ = heaviest_first(jobs);
    for (const std::size_t job : order_) weight_ += jobs.weight(job);
  }

  /// Returns when this rank has no more to do and, on rank 0, every other one knows that there is nothing left.
  void run(bool has_workers) {
    while (!is_over()) {
      bool did_something = ranks_.rank() == 0 ? deal() : ask();
      if (!has_workers) did_something = queue_.work_once() || did_something;
      if (!did_something) rest();
    }
  }

 private:
  [[nodiscard]] bool is_over() const {
    const bool all_know = ranks_.rank() != 0 || dismissed_ == ranks_.size() - 1;
    return is_last_ && all_know && queue_.under_work() == 0;
  }
  [[nodiscard]] bool wants_more() const { return !is_last_ && queue_.under_work() < workers_; }

  bool deal() {
    bool did_something = false;
    if (queue_.error().has_error()) stop_dealing();
    if (wants_more()) {
      if (const std::int64_t job = next(); job == no_job)
        is_last_ = true;
      else
        queue_.put(static_cast<std::size_t>(job));
      did_something = true;
    }
    while (const auto message = ranks_.receive(Request)) {
      if (message->number == has_failed) stop_dealing();
      const std::int64_t job = next();
      ranks_.send(job, message->from, Reply);
      if (job == no_job) ++dismissed_;
      did_something = true;
    }
    return did_something;
  }

  bool ask() {
    if (is_waiting_) {
      const auto reply = ranks_.receive(Reply);
      if (!reply) return false;
      is_waiting_ = false;
      if (reply->number == no_job)
        is_last_ = true;
      else
        queue_.put(static_cast<std::size_t>(reply->number));
      return true;
    }
    if (!wants_more()) return false;
    ranks_.send(queue_.error().has_error() ? has_failed : wants_job, 0, Request);
    is_waiting_ = true;
    return true;
  }

  std::int64_t next() {
    if (dealt_ == order_.size()) return no_job;
    const std::size_t job = order_[dealt_++];
    dealt_weight_ += jobs_.weight(job);
    queue_.guard([&] { jobs_.progress(static_cast<double>(dealt_weight_) / static_cast<double>(weight_)); });
    if (!queue_.error().has_error()) return static_cast<std::int64_t>(job);
    stop_dealing();
    return no_job;
  }
  void stop_dealing() { dealt_ = order_.size(); }

  Communicator& ranks_;
  TileJobs& jobs_;
  LocalQueue& queue_;
  std::size_t workers_;
  std::vector<std::size_t> order_;  ///< on rank 0
  std::size_t dealt_ = 0;
  std::uint64_t weight_ = 0, dealt_weight_ = 0;
  int dismissed_ = 0;        ///< ranks that know that nothing is left
  bool is_waiting_ = false;  ///< for a reply
  bool is_last_ = false;     ///< nothing is left for this rank
};

}  // namespace

RankRunner::RankRunner(Communicator& ranks, int threads) : ranks_(ranks), threads_(thread_count(threads)) {}

void RankRunner::run(TileJobs& jobs) {
  LocalQueue queue(jobs);
  on_each_thread(threads_ + 1, [&] {
    const int workers = omp_get_num_threads() - 1;
    if (omp_get_thread_num() == 0) {
      Dealer(ranks_, jobs, queue, static_cast<std::size_t>(workers)).run(workers > 0);
      queue.close();
    } else {
      queue.work();
    }
  });
  ranks_.do_together([&] { queue.error().rethrow(); });
  exchange(jobs, queue.take_done());
}

void RankRunner::exchange(TileJobs& jobs, const std::vector<Done>& done) {
  CompactWriter own;
  own.number(done.size());
  for (const auto& [job, bytes] : done) {
    own.number(job);
    own.text(bytes);
  }
  const std::vector<std::string> all =
      jobs.only_first_needs_results() ? ranks_.gather(own.take()) : ranks_.all_gather(own.take());
  struct Result {
    std::size_t job;
    std::string_view bytes;
  };
  std::vector<Result> results;
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    if (rank == static_cast<std::size_t>(ranks_.rank())) continue;
    CompactReader from(all[rank]);
    for (std::uint64_t left = from.number(); left > 0; --left) {
      const std::size_t job = from.count(jobs.size());
      results.push_back({job, from.text()});
    }
  }
  ranks_.do_together([&] {
    FirstError error;
    on_any_thread(threads_, results.size(),
                  [&](std::size_t i) { error.guard([&] { jobs.unpack(results[i].job, results[i].bytes); }); });
    error.rethrow();
  });
}

}  // namespace meshbound::mpi
