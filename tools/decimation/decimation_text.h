// SPDX-License-Identifier: MIT
/// What the tools that decimate tell people of a result.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "meshbound/report.h"

namespace meshbound::tools {

/// "dropped: 6553 texture coordinates, 1 material", a line on stdout where the original has what no output carries, and
/// another one where it has parts that were measured in rest pose.
void print_dropped(const MeshReport& original);

/// What to tell the user about a result that was not decided at once: a sentence, empty where there is nothing to say.
[[nodiscard]] std::string explanation(DecidedBy how);

/// "locked      12 of 482 vertices: ...", a line on stdout where options lock some.
void print_locked(std::size_t vertices, const MeshSummary& original);

/// How many faces of a result face the other way than their originals; prints nothing for 0.
void print_turned(std::size_t faces);

/// "lines       64 -> 10 edges ...", lines on stdout where there are feature lines.
void print_lines(const std::optional<LineReport>& lines, double diagonal);

/// "seconds     read 0.010, simplify ...", a line on stdout.
void print_seconds(const SimplifyReport::Seconds& seconds, int threads);

}  // namespace meshbound::tools
