// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <list>
#include <string>

#include "bench_main.h"
#include "contest.h"
#include "table.h"

namespace meshbound::bench {

/// Tables of one program, printed and written row by row, so that what was measured survives a run that is ended.
class Report {
 public:
  struct Section {
    std::string name, title;
    Table table;
    std::string summary;  ///< Markdown below the table
  };

  /// Results go to <out>/<program>.md and, for each section, <out>/<program>-<section>.csv.
  Report(const Options& options, std::string program) : options_(options), program_(std::move(program)) {}

  /// The section stays where it is for the life of the report.
  Section& add(std::string name, std::string title, std::vector<std::string> columns);
  /// Prints the row and writes all that is known by then.
  void row(Section& section, std::vector<std::string> cells);
  void summary(Section& section, const std::string& markdown);

  /// A result of ours that does not hold by one of the measurements, or that failed, makes the program fail.
  void must_hold(const std::string& name, const Turns& turns, const Check& check);
  void fail(std::string failure) { failures_.push_back(std::move(failure)); }
  /// The exit code, after one line for each of the failures and the number of results that could not be judged.
  [[nodiscard]] int finish() const;

 private:
  void write(const Section& section) const;

  const Options& options_;
  std::string program_;
  std::list<Section> sections_;
  std::vector<std::string> failures_;
  std::size_t not_in_time_ = 0, not_measured_ = 0;
};

}  // namespace meshbound::bench
