// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/joined_parts.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

#include "numeric/first_error.h"

namespace meshbound::cgal {

namespace {

/// By vertex of the part.
std::vector<bool> locked_of(const Part& part, const std::vector<bool>& locked) {
  std::vector<bool> of_part;
  for (std::size_t v = 0; v < part.whole_of.size() && !locked.empty(); ++v) of_part.push_back(locked[part.whole_of[v]]);
  return of_part;
}

/// How far the parts are, shown by the calling thread only.
class SharedProgress {
 public:
  SharedProgress(const std::function<void(double)>& show, std::size_t parts) : show_(show), done_(parts) {}

  void operator()(std::size_t part, double fraction) {
    done_[part] = fraction;
    if (!show_ || omp_get_thread_num() != 0) return;
    double sum = 0;
    for (const std::atomic<double>& done : done_) sum += done;
    show_(sum / static_cast<double>(done_.size()));
  }

 private:
  const std::function<void(double)>& show_;
  std::vector<std::atomic<double>> done_;
};

/// Of a run of a part within a parallel region.
SimplifyOptions options_of_part(const SimplifyOptions& options) {
  SimplifyOptions part = options;
  part.threads = 1;
  part.locked_vertices.clear();
  // Rounds of edits go over the whole mesh once it is joined.
  if (options.effort == Effort::High) part.effort = Effort::Normal;
  return part;
}

/// Thrown where another part has failed already.
struct OtherPartFailed {};

/// Calls `run(part, options)` for each, by several threads; once one has failed the others end as well.
template <class Run>
std::vector<FinishedPart> for_each_part(std::size_t parts, const SimplifyOptions& options, const Run& run) {
  std::vector<FinishedPart> finished(parts);
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  const SimplifyOptions common = options_of_part(options);
  SharedProgress progress(options.progress, parts);
  std::atomic<bool> failed = false;
  FirstError error;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (std::size_t i = 0; i < parts; ++i) {
    if (failed) continue;
    bool ended = false;
    error.guard([&] {
      SimplifyOptions own = common;
      own.progress = [&, i](double fraction) {
        if (failed) throw OtherPartFailed();
        progress(i, fraction);
      };
      finished[i] = run(i, own);
      ended = true;
    });
    if (!ended) failed = true;
  }
  error.rethrow();
  return finished;
}

}  // namespace

std::vector<FinishedPart> run_parts(const Cutting& cutting, const std::vector<bool>& locked,
                                    const SimplifyOptions& options, const CollapseGoal& goal) {
  return for_each_part(cutting.parts(), options, [&](std::size_t i, const SimplifyOptions& own) {
    Part part = cutting.part(i);
    const std::vector<bool> locked_here = locked_of(part, locked);
    CollapseRun run(std::move(part), cutting.seams(), own, locked_here);
    run.run(goal);
    return run.finished();
  });
}

std::vector<FinishedPart> estimate_parts(const Cutting& cutting, const std::vector<bool>& locked,
                                         const SimplifyOptions& options, const CollapseGoal& goal) {
  return for_each_part(cutting.parts(), options, [&](std::size_t i, const SimplifyOptions& own) {
    Part part = cutting.part(i);
    const std::vector<bool> locked_here = locked_of(part, locked);
    return CollapseRun(std::move(part), cutting.seams(), own, locked_here).estimated_part(goal);
  });
}

std::vector<FinishedPart> run_parts(const ProvenCutting& cutting, const SimplifyOptions& options,
                                    const CollapseGoal& goal) {
  const std::vector<bool>& all = cutting.mesh().locked;
  const bool any = std::find(all.begin(), all.end(), true) != all.end();
  return for_each_part(cutting.cutting().parts(), options, [&](std::size_t i, const SimplifyOptions& own) {
    ProvenPart part = cutting.part(i);
    const std::vector<bool> locked_here = any ? locked_of(part.part, all) : std::vector<bool>();
    CollapseRun run(std::move(part), cutting.cutting().seams(), own, locked_here);
    run.run(goal);
    return run.finished();
  });
}

JoinedParts join(std::vector<FinishedPart> parts, const Cutting& cutting, const std::vector<bool>& locked,
                 std::span<const Quadric> quadrics) {
  constexpr std::uint32_t none = FinishedPart::none;
  JoinedParts joined;
  std::vector<std::uint32_t> seam_vertex(cutting.seams().has.size(), none);
  std::vector<Kernel::Point_3> points;
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> place;
  for (FinishedPart& part : parts) {
    place.clear();
    for (const FinishedPart::Vertex& vertex : part.vertices) {
      const bool on_seam = vertex.on_seam != none;
      if (on_seam && seam_vertex[vertex.on_seam] != none) {
        place.push_back(seam_vertex[vertex.on_seam]);
        if (quadrics.empty()) joined.quadrics[place.back()] += vertex.quadric;
        joined.heights[place.back()] = joined.heights[place.back()].joined(vertex.heights);
        continue;
      }
      place.push_back(static_cast<std::uint32_t>(points.size()));
      if (on_seam) seam_vertex[vertex.on_seam] = place.back();
      points.push_back(vertex.point);
      joined.copy.vertex_of_vertex.push_back(vertex.soup_vertex);
      joined.quadrics.push_back(on_seam && !quadrics.empty() ? quadrics[vertex.on_seam] : vertex.quadric);
      joined.heights.push_back(vertex.heights);
      joined.on_seam.push_back(on_seam);
      if (!locked.empty()) joined.locked.push_back(on_seam ? locked[vertex.on_seam] : vertex.locked);
    }
    for (std::uint32_t& face : part.proof.face_of) {
      if (face != none) face += static_cast<std::uint32_t>(polygons.size());
    }
    for (const Polygon& corners : part.polygons)
      polygons.push_back({place[corners[0]], place[corners[1]], place[corners[2]]});
    for (const auto& [a, b] : part.settled) joined.settled.push_back({place[a], place[b]});
    joined.copy.triangle_of_face.insert(joined.copy.triangle_of_face.end(), part.triangle_of_face.begin(),
                                        part.triangle_of_face.end());
    joined.counts += part.counts;
    joined.stats += part.stats;
    joined.estimated.performed += part.estimated.performed;
    joined.estimated.restarts += part.estimated.restarts;
    joined.work += part.work;
    joined.proofs.push_back(std::move(part.proof));
  }
  joined.copy.mesh = to_surface_mesh(points, polygons);
  return joined;
}

JoinedParts join(std::vector<FinishedPart> parts, const ProvenCutting& cutting) {
  JoinedParts joined = join(std::move(parts), cutting.cutting(), cutting.mesh().locked, cutting.mesh().quadrics);
  joined.proofs.push_back(cutting.shared_proof(joined.proofs));
  return joined;
}

}  // namespace meshbound::cgal
