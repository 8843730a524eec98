// SPDX-License-Identifier: MIT
#include "simplify/summary.h"

#include <string>

#include "common/distance_text.h"
#include "common/length.h"
#include "common/memory.h"
#include "common/texture_text.h"
#include "common/tile_workers.h"
#include "decimation/decimation_text.h"
#include "deviation/deviation_outputs.h"

namespace meshbound::tools {
namespace {

std::string end_reason(const FinishedRun& run) {
  const auto ended = run.result.last().ended_by;
  const bool had_target = run.options.target_faces.has_value() || !run.options.target_ratio.empty();
  if (!run.rounding.empty()) return run.rounding;
  if (run.is_ended_by_time && ended != EndedBy::TimeLimit)
    return "the time limit came before a smaller mesh was proven";
  const std::size_t vertices = run.report.original.summary.vertices;
  if (ended != EndedBy::Target && vertices > 0 && run.result.locked_vertices >= vertices)
    return "every vertex is locked, for edges that stay as they are";
  if (ended == EndedBy::Target) return "the target was reached first, within the tolerance";
  if (ended == EndedBy::TimeLimit) return "the time limit came first";
  const std::string tolerance = ended == EndedBy::Tolerance ? "the next collapse would exceed the tolerance"
                                                            : "no further collapse fits the tolerance";
  return had_target ? tolerance + ": it came before the target" : tolerance;
}

}  // namespace

void print_summary(const FinishedRun& run) {
  const SimplifyReport& report = run.report;
  const GatedOutput& out = run.outputs.back();
  const HausdorffDistance& distance = out.distance();
  const std::size_t faces = out.summary().faces, before = report.original.summary.faces;
  print_line("faces", std::to_string(before) + " -> " + std::to_string(faces) + " (" +
                          short_number(100.0 * static_cast<double>(faces) / static_cast<double>(before)) +
                          "%): " + end_reason(run));
  print_line("tolerance", both_units(report.tolerance, run.diagonal));
  print_distance(distance.bounds, distance.a_to_b, &distance.b_to_a,
                 {"original to simplified", "simplified to original"}, run.diagonal);
  print_line("verdict", to_string(report.verdict));
  for (std::size_t i = 0; i < run.decided_by.size(); ++i) {
    if (const std::string how = explanation(run.decided_by[i]); !how.empty())
      print_line("decided", run.outputs[i].path().string() + ": " + how);
  }
  print_lines(report.lines, run.diagonal);
  if (report.normals) print_normals(*report.normals);
  if (report.texture)
    print_texture(*report.texture, {"original to simplified", "simplified to original"}, run.diagonal);
  if (report.deviation) print_deviation(*report.deviation, "original to simplified", "simplified to original");
  print_locked(run.result.locked_vertices, report.original.summary);
  print_turned(out.turned_faces());
  if (run.options.prune)
    print_line("pruned",
               std::to_string(run.result.pruned_components) + " components of " + face_count(run.result.pruned_faces));
  if (report.input.split)
    print_line("input", "not an oriented 2-manifold: simplified as one, with edges and vertices doubled where needed");
  if (report.input.dropped_triangles + report.input.kept_triangles > 0)
    print_line("input", std::to_string(report.input.dropped_triangles) +
                            " duplicate or degenerate triangles dropped, " +
                            std::to_string(report.input.kept_triangles) + " kept as they are");
  print_dropped(report.original);
  print_seconds(report.seconds, report.threads);
  if (report.resumed_tiles)
    print_line("resumed", std::to_string(*report.resumed_tiles) + " finished tiles came from " + run.options.scratch);
  if (report.memory)
    print_line("memory",
               in_mebibytes(static_cast<double>(report.memory->peak_bytes)) + " at most, of " + run.options.memory);
  for (const GatedOutput& output : run.outputs)
    print_line("wrote", output.path().string() + ", " + face_count(output.summary().faces) + ", " +
                            interval(output.distance().bounds));
  for (const CertificateReport& certificate : report.certificates)
    print_line("wrote",
               certificate.path + ", " + std::to_string(certificate.bytes) + " bytes: a proof for verify_certificate");
}

}  // namespace meshbound::tools
