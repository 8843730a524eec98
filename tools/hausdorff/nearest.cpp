// SPDX-License-Identifier: MIT
#include "hausdorff/nearest.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/distance_text.h"
#include "common/distinct_files.h"
#include "common/folder_files.h"
#include "common/length.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/run_clock.h"
#include "common/signals.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"
#include "meshbound/similarity.h"
#include "report/json_parts.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;

struct Unreadable {
  std::string path, reason;
};

/// What was found in the folder. Paths are those of the shapes.
struct Candidates {
  std::vector<std::string> paths;
  std::vector<std::size_t> faces;
  std::vector<Shape> shapes;
  std::vector<Unreadable> unreadable;
};

/// Mesh files below a folder, by name, without the query itself. Folders that cannot be read are noted.
std::vector<std::string> mesh_files(const std::string& folder, const std::string& query,
                                    std::vector<Unreadable>& unreadable) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw IoError("--nearest: " + folder + " is no folder");
  const FolderFiles found = files_below(folder);
  for (const UnreadableFolder& skipped : found.unreadable)
    unreadable.push_back({skipped.path.string(), skipped.reason});
  std::vector<std::string> paths;
  for (const fs::path& path : found.files)
    if (fs::is_regular_file(path, error) && has_mesh_extension(path) && !fs::equivalent(path, query, error))
      paths.push_back(path.string());
  if (paths.empty())
    throw InvalidInput("--nearest: there is no mesh file below " + folder +
                       (unreadable.empty() ? "" : ", and " + unreadable.front().reason));
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Reads them into `candidates`, which may hold folders that cannot be read.
void load(const std::vector<std::string>& paths, const Arguments& arguments, const StopToken& stop,
          Candidates& candidates) {
  ProgressBar bar("reading", arguments.common.quiet);
  for (const std::string& path : paths) {
    if (interrupted()) throw Error("interrupted");
    const auto skip = [&](const Error& problem) { candidates.unreadable.push_back({path, problem.what()}); };
    try {
      const TriangleMesh mesh = read_file(path, false, stop).content.mesh;
      candidates.shapes.emplace_back(mesh, BvhOptions{arguments.common.threads, stop});
      candidates.paths.push_back(path);
      candidates.faces.push_back(mesh.triangles.size());
    } catch (const InvalidInput& problem) {
      skip(problem);
    } catch (const IoError& problem) {
      skip(problem);
    }
    bar.show(static_cast<double>(candidates.shapes.size()) / static_cast<double>(paths.size()));
  }
}

SimilarityOptions options_of(const Arguments& arguments, const RunClock& clock) {
  SimilarityOptions options;
  options.count = arguments.count;
  options.align = arguments.align;
  if (!arguments.error_bound.empty()) {
    const Length length = parse_length("--error-bound", arguments.error_bound);
    if (length.is_percentage)
      throw InvalidInput("--error-bound: with --nearest it is a number in units of normalised shapes");
    options.error_bound = length.value;
    options.relative_error_bound = 0;
  }
  options.distance.method = arguments.method;
  options.distance.threads = arguments.common.threads;
  options.distance.cancel = &interrupted();
  options.distance.budget.seconds = clock.seconds_left();
  return options;
}

/// From the file of the candidate to that of the query: where the candidate was measured.
AffineMap map_to_query(const Shape& query, const Shape& candidate, const Pose& alignment) {
  return query.normalisation().inverse(Eigen::Affine) * alignment * candidate.normalisation();
}

report::Json to_json(const AffineMap& map) {
  report::Json rows = report::Json::array();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) rows.push_back(report::number(map.matrix()(i, j)));
  return rows;
}

bool is_done(const SimilarShapes& found) {
  return found.complete && std::all_of(found.nearest.begin(), found.nearest.end(),
                                       [](const SimilarShape& shape) { return shape.converged; });
}

std::string to_json(const MeshReport& query_file, const Shape& query, const Candidates& candidates,
                    const SimilarShapes& found, const SimilarityOptions& options, const Arguments& arguments,
                    double seconds) {
  using namespace report;
  Json json = {{"schema", "meshbound/nearest/1"}, {"verdict", is_done(found) ? "done" : "undecided"}};
  json["provenance"] = report::provenance(tools::provenance());
  json["error_bound"] = number(options.error_bound);
  json["relative_error_bound"] = number(options.relative_error_bound);
  json["align"] = options.align;
  json["query"] = mesh(query_file);
  json["folder"] = arguments.nearest;
  json["candidates"] = candidates.shapes.size();
  json["unreadable"] = Json::array();
  for (const Unreadable& file : candidates.unreadable)
    json["unreadable"].push_back({{"path", file.path}, {"reason", file.reason}});
  json["nearest"] = Json::array();
  for (const SimilarShape& shape : found.nearest)
    json["nearest"].push_back(
        {{"path", candidates.paths[shape.index]},
         {"faces", candidates.faces[shape.index]},
         {"distance", bounds(shape.distance)},
         {"converged", shape.converged},
         {"map_to_query", to_json(map_to_query(query, candidates.shapes[shape.index], shape.alignment))}});
  const SimilarityStats& stats = found.stats;
  json["stats"] = {{"alignments", stats.alignments},
                   {"ended_by_extents", stats.ended_by_extents},
                   {"ended_by_samples", stats.ended_by_samples},
                   {"ended_by_decision", stats.ended_by_decision},
                   {"measured", stats.measured},
                   {"closest_point_queries", stats.closest_point_queries}};
  json["seconds"] = {{"total", number(seconds)}};
  return text(json);
}

void print(const Candidates& candidates, const SimilarShapes& found, const SimilarityOptions& options, double seconds) {
  print_line("rank", "distance of normalised shapes, triangles, file");
  for (std::size_t i = 0; i < found.nearest.size(); ++i) {
    const SimilarShape& shape = found.nearest[i];
    print_line(std::to_string(i + 1),
               "[" + short_number(shape.distance.lower) + ", " + short_number(shape.distance.upper) + "] " +
                   std::to_string(candidates.faces[shape.index]) + " " + candidates.paths[shape.index]);
  }
  print_line("error bound",
             short_number(options.error_bound) +
                 (options.relative_error_bound > 0 ? ", or half of an upper bound if that is more" : ""));
  const SimilarityStats& stats = found.stats;
  print_line("candidates",
             std::to_string(stats.alignments) + " alignments of " + std::to_string(candidates.shapes.size()) +
                 " meshes: ended by extents " + std::to_string(stats.ended_by_extents) + ", by samples " +
                 std::to_string(stats.ended_by_samples) + ", by a decision " + std::to_string(stats.ended_by_decision) +
                 ", measured " + std::to_string(stats.measured));
  if (!candidates.unreadable.empty())
    print_line("unreadable",
               std::to_string(candidates.unreadable.size()) + ", the first: " + candidates.unreadable.front().reason);
  print_line("verdict", is_done(found) ? "done" : "undecided: the time limit came first, or the precision of doubles");
  print_line("seconds", "total " + rounded_seconds(seconds));
}

}  // namespace

ExitCode run_nearest(const Arguments& arguments) {
  const RunClock clock(arguments.common);
  Candidates candidates;
  const std::vector<std::string> paths = mesh_files(arguments.nearest, arguments.a, candidates.unreadable);
  std::vector<NamedPath> inputs{{"QUERY", arguments.a}};
  for (const std::string& path : paths) inputs.push_back({"a candidate", path});
  require_distinct_files(inputs, {{"--json", arguments.common.json}});
  check_writable(arguments.common.json);
  (void)options_of(arguments, clock);  // a typing error is told before a long read
  MeshReport query_file;
  const StopToken stop = clock.stop_of_reading();
  const Shape query(read_input(arguments.a, !arguments.common.json.empty(), query_file, stop),
                    BvhOptions{arguments.common.threads, stop});
  query_file.dropped.reset();  // nothing is written again
  load(paths, arguments, stop, candidates);
  const SimilarityOptions options = options_of(arguments, clock);
  const SimilarShapes found = nearest_shapes(query, candidates.shapes, options);
  if (interrupted()) throw Error("interrupted");
  if (!arguments.common.json.empty())
    write_text(arguments.common.json,
               to_json(query_file, query, candidates, found, options, arguments, clock.seconds()));
  if (arguments.common.prints_summary()) print(candidates, found, options, clock.seconds());
  return is_done(found) ? ExitDone : ExitUndecided;
}

}  // namespace meshbound::tools
