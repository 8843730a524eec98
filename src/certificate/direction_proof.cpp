// SPDX-License-Identifier: MIT
#include "certificate/direction_proof.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <iomanip>
#include <sstream>
#include <string>

#include "distance/kernel/search_kernel.h"
#include "distance/shortcuts/point_like.h"
#include "geometry/magnitude.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "numeric/first_error.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

constexpr std::size_t triangles_per_run = 256;  ///< hints are handed on inside a run

/// What patches may cost a reader for each triangle of both meshes, and in all proofs, before they are made small: half
/// of what it accepts. Proofs for real models cost up to 25 for each triangle.
constexpr std::uint64_t parity_work_per_triangle = 128, min_parity_work = 32768;

}  // namespace

std::uint32_t ProofMesh::triangle(std::uint32_t number) const {
  if (numbers.empty()) return number < mesh.triangle_count() ? number : no_index;
  const auto at = std::lower_bound(numbers.begin(), numbers.end(), number);
  return at != numbers.end() && *at == number ? static_cast<std::uint32_t>(at - numbers.begin()) : no_index;
}

DirectionProof::DirectionProof(const ProofMesh& source, const ProofMesh& target, double tolerance,
                               const CertificateOptions& options, const StopToken& stop, const char* element)
    : source_(source),
      target_(target),
      tolerance_(tolerance),
      options_(options),
      element_(element),
      tree_(target.mesh, BvhOptions{options.threads, stop}),
      neighbours_(edge_neighbours(tree_.data().vertices, tree_.data().corners)) {
  load_vertices();
  goal_.stop = stop;
}

bool DirectionProof::costs_too_much(std::uint64_t parity_work, std::uint64_t triangles) {
  return parity_work > parity_work_per_triangle * triangles + min_parity_work;
}

void DirectionProof::load_vertices() {
  const Frame& frame = tree_.data().frame;
  double error = 0;
  const std::vector<std::uint8_t> used = used_vertices(source_.mesh);
  vertices_.resize(source_.mesh.vertex_count());
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (used[v] == 0) continue;
    const Eigen::Vector3d p = source_.mesh.vertex(v);
    const Vec3 model{p.x(), p.y(), p.z()};
    vertices_[v] = frame.to_working(model);
    magnitude_ = std::max(magnitude_, largest_magnitude_of(vertices_[v]));
    error = std::max(error, frame.rounding_of(model));
  }
  if (!(magnitude_ <= max_magnitude))
    throw InvalidInput("the meshes differ too much in size, or lie too far apart, for a certificate");
  goal_.decide_only = true;
  goal_.tolerance = frame.working_length_down(tolerance_);
  set_slack(goal_, magnitude_, frame.error + error);
}

/// A triangle whose corners are corners of triangle `other` of the target, bit for bit, needs no arithmetic.
bool DirectionProof::is_in_target(const Triangle& triangle, std::uint32_t other) const {
  if (other == no_index) return false;
  const Triangle near = target_.mesh.triangle(other);
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) {
    return std::any_of(near.begin(), near.end(),
                       [&](std::uint32_t w) { return source_.mesh.vertex(v) == target_.mesh.vertex(w); });
  });
}

DirectionProof::Failure DirectionProof::prove_run(std::size_t run, CutSearch& search,
                                                  std::vector<ProofNode>& nodes) const {
  std::uint32_t hint = 0;
  const std::size_t begin = run * triangles_per_run;
  const std::size_t end = std::min(source_.mesh.triangle_count(), begin + triangles_per_run);
  for (std::size_t t = begin; t < end; ++t) {
    const Triangle corners = source_.mesh.triangle(t);
    const auto outcome = search.prove({vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]}, hint,
                                      nodes, options_.steps_per_triangle);
    if (outcome == CutSearch::Outcome::Proven) continue;
    // Where triangles overlap, the nearest one need not be the same one; in a copy that one has the same number.
    const std::uint32_t own = target_.triangle(source_.number(t));
    const std::uint32_t nearest = tree_.data().triangle_of_slot[search.nearest_to_middle()];
    const bool has_own_number = is_in_target(corners, own);
    if (!has_own_number && !is_in_target(corners, nearest)) return {t, outcome};
    ProofNode node;
    node.target = has_own_number ? own : nearest;
    nodes.push_back(node);
  }
  for (ProofNode& node : nodes)
    if (node.kind != ProofNode::Kind::Cut) node.target = target_.number(node.target);
  return {};
}

std::optional<ProofTrees> DirectionProof::run(std::size_t max_patch,
                                              const std::function<void(double)>& progress) const {
  const std::size_t count = (source_.mesh.triangle_count() + triangles_per_run - 1) / triangles_per_run;
  ProofTrees trees;
  trees.runs.resize(count);
  const int threads = thread_count(options_.threads);
  std::vector<Failure> failures(count);
  std::atomic<std::size_t> done = 0;
  std::uint64_t& parity_work = trees.parity_work;
  std::atomic<bool> stop = false;
  FirstError error;
  on_each_thread(threads, [&] {
    std::optional<CutSearch> search;
    error.guard([&] { search.emplace(tree_.data(), neighbours_, goal_, magnitude_, max_patch); });
#pragma omp for schedule(dynamic, 1)
    for (std::size_t run = 0; run < count; ++run) {
      if (stop || !search || goal_.out_of_time()) continue;
      error.guard([&] { failures[run] = prove_run(run, *search, trees.runs[run]); });
      if (failures[run].outcome != CutSearch::Outcome::Proven) stop = true;
      const std::size_t done_now = ++done;
      if (!progress || omp_get_thread_num() != 0) continue;
      error.guard([&] { progress(static_cast<double>(done_now) / static_cast<double>(count)); });
      if (error.has_error()) stop = true;
    }
    const std::uint64_t own_work = search ? search->parity_work() : 0;
#pragma omp atomic
    parity_work += own_work;
  });
  error.rethrow();
  for (const Failure& failure : failures)
    if (failure.outcome != CutSearch::Outcome::Proven) fail(failure);
  if (done < count) return std::nullopt;
  return trees;
}

void DirectionProof::fail(const Failure& failure) const {
  const std::string where = std::string(element_) + " " + std::to_string(source_.number(failure.triangle)) +
                            " of the " + source_.name + " mesh ";
  if (failure.outcome == CutSearch::Outcome::TooFar) {
    const double slack = tree_.data().frame.length_up(2 * goal_.largest_slack());
    std::ostringstream provable;
    provable << std::setprecision(17) << tolerance_ + slack;
    throw Error("no certificate: " + where +
                "has a point that is further from the other mesh than the tolerance, or too close to it for doubles; "
                "if it is no further, " +
                provable.str() + " can be proven");
  }
  throw Error("no certificate: " + where +
              "could not be proven in pieces that the format allows; give a slightly larger tolerance");
}

}  // namespace meshbound
