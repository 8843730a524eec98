// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <cmath>
#include <cstdio>

namespace meshbound::bench {

Report::Section& Report::add(std::string name, std::string title, std::vector<std::string> columns) {
  std::printf("-- %s\n", title.c_str());
  return sections_.emplace_back(Section{std::move(name), std::move(title), {std::move(columns), {}}, {}});
}

void Report::row(Section& section, std::vector<std::string> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    std::printf("%s%s %s", i == 0 ? "" : ", ", section.table.columns[i].c_str(), cells[i].c_str());
  std::printf("\n");
  std::fflush(stdout);
  section.table.rows.push_back(std::move(cells));
  write(section);
}

void Report::summary(Section& section, const std::string& markdown) {
  section.summary = markdown;
  write(section);
}

void Report::must_hold(const std::string& name, const Turns& turns, const Check& check) {
  if (turns.status == ChildResult::Status::Failed) failures_.push_back(name + ": " + turns.error);
  if (turns.status == ChildResult::Status::TimedOut) ++not_in_time_;
  if (turns.done() && (std::isnan(check.share) || std::isnan(check.cgal_share))) ++not_measured_;
  if (!turns.done() || check.holds()) return;
  failures_.push_back(name + " DOES NOT HOLD: at " + format(check.share, 17) + " of the tolerance by our measure, " +
                      format(check.cgal_share, 17) + " by CGAL's");
}

int Report::finish() const {
  for (const Section& section : sections_)
    if (!section.summary.empty()) std::printf("\n%s\n%s", section.title.c_str(), section.summary.c_str());
  for (const std::string& failure : failures_) std::printf("%s\n", failure.c_str());
  if (not_in_time_ > 0) std::printf("%zu runs of ours did not end in time.\n", not_in_time_);
  if (not_measured_ > 0) std::printf("%zu results were not measured by both in time.\n", not_measured_);
  return failures_.empty() ? 0 : 1;
}

void Report::write(const Section& section) const {
  section.table.write_csv(options_.out / (program_ + '-' + section.name + ".csv"), options_.machine);
  std::string text = options_.machine + '\n';
  for (const Section& s : sections_)
    text += "\n### " + s.title + "\n\n" + s.table.markdown() + (s.summary.empty() ? "" : '\n' + s.summary);
  write_file(options_.out / (program_ + ".md"), text);
}

}  // namespace meshbound::bench
