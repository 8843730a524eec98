// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace meshbound::bench {

/// The command line that the benchmark programs share.
struct Options {
  bool quick = false;
  std::filesystem::path out = ".";        ///< tables and data of pictures
  std::filesystem::path cache = "cache";  ///< meshes made once
  double limit = 120;                     ///< seconds of processor time for one run of one function
  double check_limit = 120;               ///< the same for a check by CGAL that is not timed
  std::string only;                       ///< measures only what has this in its name
  std::vector<std::string> pair;          ///< files A, B of `--pair`, one pair after the other: measured alone
  std::string machine;                    ///< one line for every table

  [[nodiscard]] bool wants(std::string_view name) const {
    const bool wanted = name.find(only) != std::string_view::npos;
    found_ = found_ || wanted;
    if (!wanted) left_out_.emplace_back(name);
    return wanted;
  }
  /// Whether `wants` has ever said yes.
  [[nodiscard]] bool found_any() const { return found_; }

 private:
  friend std::string listed_names(const Options& options);
  mutable bool found_ = false;
  mutable std::vector<std::string> left_out_;
};

/// The names that `wants` has refused, each once, with commas.
[[nodiscard]] std::string listed_names(const Options& options);

/// Exit code of a benchmark of which `--only` leaves nothing, so that tools/bench/run can ask the others.
inline constexpr int nothing_measured = 4;

/// Parses, creates the folders and calls `run`, whose result is the exit code; an exception becomes one line on stderr
/// and exit code 2, and so does an `--only` that no name contains, with the names that there are and exit code
/// `nothing_measured`. `add_options` may add options of the program's own.
int bench_main(int argc, char** argv, const char* description, const std::function<int(const Options&)>& run,
               const std::function<void(CLI::App&)>& add_options = {});

}  // namespace meshbound::bench
