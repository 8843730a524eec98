// SPDX-License-Identifier: MIT
#include "watched_run.h"

#include <cfenv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "meshbound/error.h"
#include "meshbound/stop_token.h"

namespace py = pybind11;

namespace meshbound::python {
namespace {

/// Between two looks at signals and progress: short enough for a hand on the keyboard.
constexpr std::chrono::milliseconds between_looks{50};

/// Work on a thread of its own.
class Worker {
 public:
  Worker(const std::function<void(Watch&)>& work, Watch& watch)
      : thread_([this, &work, &watch] {
          // A library of the process may have switched denormal numbers off, and threads inherit that.
          std::fesetenv(FE_DFL_ENV);
          try {
            work(watch);
          } catch (...) {
            error_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          is_done_ = true;
          done_.notify_one();
        }) {}

  [[nodiscard]] bool wait() {
    std::unique_lock lock(mutex_);
    return done_.wait_for(lock, between_looks, [&] { return is_done_; });
  }

  /// Waits for the end and rethrows what the work threw.
  void finish() {
    thread_.join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::exception_ptr error_;
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::thread thread_;  // last: it uses the others
};

/// Whether an answer of the progress function ends the work: anything false, such as numpy's False, except None, which
/// is what a function without an answer returns.
bool ends_work(const py::object& answer) {
  if (answer.is_none()) return false;
  const int truth = PyObject_IsTrue(answer.ptr());
  if (truth < 0) throw py::error_already_set();
  return truth == 0;
}

/// Runs pending signal handlers and the progress function. False: the work is to end.
bool look(const py::object& progress, double fraction) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return progress.is_none() || !ends_work(progress(fraction));
}

/// Waits for the end of work that may have been cancelled. Throws `Interrupted` where it was, whatever it had reached.
void finish(Worker& worker, const Watch& watch) {
  try {
    worker.finish();
  } catch (const Stopped&) {  // from where a computation had no result yet, as while it built its trees
    if (!watch.cancel) throw;
  }
  if (watch.cancel) throw Interrupted("cancelled");
}

}  // namespace

void run_watched(const py::object& progress, const std::function<void(Watch&)>& work) {
  Watch watch;
  std::exception_ptr raised;
  Worker worker(work, watch);
  {
    const py::gil_scoped_release released;
    while (!worker.wait()) {
      if (watch.cancel) continue;
      const py::gil_scoped_acquire acquired;
      try {
        if (!look(progress, watch.fraction)) watch.cancel = true;
      } catch (...) {
        raised = std::current_exception();
        watch.cancel = true;
      }
    }
  }
  if (!raised) return finish(worker, watch);
  try {
    worker.finish();
  } catch (...) {
    // Python's exception is the reason for this one.
  }
  std::rethrow_exception(raised);
}

}  // namespace meshbound::python
