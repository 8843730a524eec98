// SPDX-License-Identifier: MIT
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>

namespace meshbound::python {

/// What a computation looks at and reports to while Python waits for it.
struct Watch {
  std::atomic<bool> cancel = false;
  std::atomic<double> fraction = 0;

  /// For the options of the library. Must not outlive this.
  [[nodiscard]] std::function<void(double)> progress() {
    return [this](double done) { fraction = done; };
  }
};

/// Runs `work` on a thread of its own, with the GIL released, so that other threads of Python go on. Meanwhile the
/// calling thread runs signal handlers, so that Ctrl-C works, and calls `progress` (may be None) with the share that is
/// done, at most 20 times a second. An exception of either, or an answer that is false and not None, ends the work
/// early. Throws what Python raised, else what `work` threw; `Interrupted` where `progress` answered so.
void run_watched(const pybind11::object& progress, const std::function<void(Watch&)>& work);

}  // namespace meshbound::python
