// SPDX-License-Identifier: MIT
#include "meshbound/certificate.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "certificate/cut_search.h"
#include "certificate/encoder.h"
#include "distance/kernel/search_kernel.h"
#include "distance/shortcuts/point_like.h"
#include "geometry/magnitude.h"
#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "numeric/first_error.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

constexpr std::size_t triangles_per_chunk = 256;  ///< hints are handed on inside a chunk

/// Triangles of patches for each triangle of both meshes. Where all parity proofs together would cost a reader more, as
/// in stacks of large triangles over fine ones, patches are made small. A reader may refuse what costs 1024 times this.
constexpr std::uint64_t parity_work_per_triangle = 16;
constexpr std::size_t max_small_patch = 256;

/// What messages call the triangles of a source.
struct SourceName {
  const char* element;  ///< "triangle" or "line"
  const char* mesh;     ///< "original" or "simplified"
};

/// A source triangle that could not be proven.
struct Failure {
  std::size_t triangle = 0;
  CutSearch::Outcome outcome = CutSearch::Outcome::Proven;
};

/// Proves that `source` lies near `target`.
class DirectionProof {
 public:
  DirectionProof(const MeshView& source, const MeshView& target, double tolerance, const CertificateOptions& options,
                 const StopToken& stop, SourceName name)
      : source_(source),
        target_(target),
        tolerance_(tolerance),
        options_(options),
        name_(name),
        tree_(target, BvhOptions{options.threads, stop}),
        neighbours_(edge_neighbours(tree_.data().vertices, tree_.data().corners)) {
    load_vertices();
    goal_.stop = stop;
  }

  /// The proof; nothing when it was cancelled or ran out of time.
  std::optional<EncodedSection> run(double progress_from);

 private:
  /// Fills the chunks. Returns what the parity proofs cost a reader (`ParitySearch::work`); nothing when it was
  /// cancelled or ran out of time.
  [[nodiscard]] std::optional<std::uint64_t> prove(std::size_t max_patch, double progress_from);
  void load_vertices();
  [[nodiscard]] Failure prove_chunk(std::size_t chunk, CutSearch& search);
  [[nodiscard]] bool is_in_target(const Triangle& triangle, std::size_t other) const;
  [[noreturn]] void fail(const Failure& failure) const;

  const MeshView& source_;
  const MeshView& target_;
  double tolerance_;
  const CertificateOptions& options_;
  SourceName name_;
  Bvh tree_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  Goal goal_;
  double magnitude_ = 1;        ///< of all coordinates in the working frame
  std::vector<Vec3> vertices_;  ///< of the source, in the working frame of the tree
  std::vector<std::vector<ProofNode>> chunks_;
};

void DirectionProof::load_vertices() {
  const Frame& frame = tree_.data().frame;
  double error = 0;
  const std::vector<std::uint8_t> used = used_vertices(source_);
  vertices_.resize(source_.vertex_count());
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (used[v] == 0) continue;
    const Eigen::Vector3d p = source_.vertex(v);
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
bool DirectionProof::is_in_target(const Triangle& triangle, std::size_t other) const {
  if (other >= target_.triangle_count()) return false;
  const Triangle near = target_.triangle(other);
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) {
    return std::any_of(near.begin(), near.end(),
                       [&](std::uint32_t w) { return source_.vertex(v) == target_.vertex(w); });
  });
}

Failure DirectionProof::prove_chunk(std::size_t chunk, CutSearch& search) {
  std::uint32_t hint = 0;
  const std::size_t begin = chunk * triangles_per_chunk;
  const std::size_t end = std::min(source_.triangle_count(), begin + triangles_per_chunk);
  for (std::size_t t = begin; t < end; ++t) {
    const Triangle corners = source_.triangle(t);
    const auto outcome = search.prove({vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]}, hint,
                                      chunks_[chunk], options_.steps_per_triangle);
    if (outcome == CutSearch::Outcome::Proven) continue;
    // Where triangles overlap, the nearest one need not be the same one; in a copy that one has the same index.
    const std::uint32_t nearest = tree_.data().triangle_of_slot[search.nearest_to_middle()];
    const bool has_own_index = is_in_target(corners, t);
    if (!has_own_index && !is_in_target(corners, nearest)) return {t, outcome};
    ProofNode node;
    node.target = has_own_index ? static_cast<std::uint32_t>(t) : nearest;
    chunks_[chunk].push_back(node);
  }
  return {};
}

std::optional<EncodedSection> DirectionProof::run(double progress_from) {
  const std::uint64_t enough = parity_work_per_triangle * (source_.triangle_count() + target_.triangle_count());
  std::optional<std::uint64_t> work = prove(ParitySearch::max_patch, progress_from);
  if (work && *work > enough + ParitySearch::max_patch) work = prove(max_small_patch, progress_from);
  if (!work) return std::nullopt;
  return encode(source_, chunks_);
}

std::optional<std::uint64_t> DirectionProof::prove(std::size_t max_patch, double progress_from) {
  const std::size_t count = (source_.triangle_count() + triangles_per_chunk - 1) / triangles_per_chunk;
  chunks_.assign(count, {});
  const int threads = options_.threads > 0 ? options_.threads : omp_get_max_threads();
  std::vector<Failure> failures(count);
  std::size_t done = 0;
  std::uint64_t parity_work = 0;
  std::atomic<bool> stop = false;
  FirstError error;
#pragma omp parallel num_threads(threads)
  {
    std::optional<CutSearch> search;
    error.guard([&] { search.emplace(tree_.data(), neighbours_, goal_, magnitude_, max_patch); });
#pragma omp for schedule(dynamic, 1)
    for (std::size_t chunk = 0; chunk < count; ++chunk) {
      if (stop || !search || goal_.out_of_time()) continue;
      error.guard([&] { failures[chunk] = prove_chunk(chunk, *search); });
      if (failures[chunk].outcome != CutSearch::Outcome::Proven) stop = true;
#pragma omp atomic
      ++done;
      if (options_.progress && omp_get_thread_num() == 0)
        options_.progress(progress_from + 0.5 * static_cast<double>(done) / static_cast<double>(count));
    }
    const std::uint64_t own_work = search ? search->parity_work() : 0;
#pragma omp atomic
    parity_work += own_work;
  }
  error.rethrow();
  for (const Failure& failure : failures)
    if (failure.outcome != CutSearch::Outcome::Proven) fail(failure);
  if (done < count) return std::nullopt;
  return parity_work;
}

void DirectionProof::fail(const Failure& failure) const {
  const std::string where =
      std::string(name_.element) + " " + std::to_string(failure.triangle) + " of the " + name_.mesh + " mesh ";
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

Certificate::Direction counts_of(const EncodedSection& section) {
  return {section.pieces, section.by_parity, section.cuts, section.bytes.size()};
}

double checked_tolerance(double tolerance) {
  if (!(std::isfinite(tolerance) && tolerance >= 0))
    throw InvalidInput("the tolerance of a certificate must be a length in model units, 0 or more");
  return tolerance + 0.0;  // turns the negative zero into the positive one
}

/// Both directions of a proof.
struct Sections {
  EncodedSection forward, backward;
};

/// Nothing if it was cancelled or ran out of time. `element` is what a triangle is called in messages.
std::optional<Sections> prove(const MeshView& original, const MeshView& simplified, double tolerance,
                              const CertificateOptions& options, const StopToken& stop, const char* element) {
  const auto prove_one = [&](const MeshView& source, const MeshView& target, const char* name, double progress_from) {
    return DirectionProof(source, target, tolerance, options, stop, {element, name}).run(progress_from);
  };
  try {
    auto forward = prove_one(original, simplified, "original", 0);
    if (!forward) return std::nullopt;
    auto backward = prove_one(simplified, original, "simplified", 0.5);
    if (!backward) return std::nullopt;
    return Sections{std::move(*forward), std::move(*backward)};
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

/// Edges as triangles without area. Throws `InvalidInput` where there are none, or one that no triangle has.
TriangleMesh checked_lines(const MeshView& mesh, std::span<const Edge> edges, const char* name) {
  if (edges.empty()) throw InvalidInput(std::string("the ") + name + " mesh has no lines to certify");
  std::vector<Vec3> positions = positions_of(mesh);
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] == 0) positions[v] = {};  // may be not finite
  const std::vector<std::uint32_t> first = first_at_position(positions);
  const auto key = [&](std::uint32_t a, std::uint32_t b) { return std::minmax({first[a], first[b]}); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle corners = mesh.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) known.push_back(key(corners[k], corners[(k + 1) % 3]));
  }
  std::sort(known.begin(), known.end());
  for (const auto& [a, b] : edges)
    if (a >= first.size() || b >= first.size() || used[a] == 0 || used[b] == 0 ||
        !std::binary_search(known.begin(), known.end(), std::pair<std::uint32_t, std::uint32_t>(key(a, b))))
      throw InvalidInput("the line from vertex " + std::to_string(a) + " to " + std::to_string(b) + " of the " + name +
                         " mesh is no edge of a triangle");
  TriangleMesh vertices;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) vertices.vertices.push_back(mesh.vertex(v));
  return line_mesh(vertices, edges);
}

std::optional<EncodedLines> prove_lines(const MeshView& original, const MeshView& simplified,
                                        const CertifiedLines& lines, CertificateOptions options,
                                        const StopToken& stop) {
  options.progress = {};
  EncodedLines encoded{checked_tolerance(lines.tolerance), lines.original, lines.simplified, {}, {}};
  auto sections =
      prove(checked_lines(original, lines.original, "original"),
            checked_lines(simplified, lines.simplified, "simplified"), encoded.tolerance, options, stop, "line");
  if (!sections) return std::nullopt;
  encoded.original_to_simplified = std::move(sections->forward);
  encoded.simplified_to_original = std::move(sections->backward);
  return encoded;
}

}  // namespace

std::optional<Certificate> build_certificate(const MeshView& original, const MeshView& simplified, double tolerance,
                                             const CertificateOptions& options) {
  tolerance = checked_tolerance(tolerance);
  const StopToken stop = StopToken{.cancel = options.cancel}.until(StopToken::Clock::now(), options.seconds);
  const auto surface = prove(original, simplified, tolerance, options, stop, "triangle");
  if (!surface) return std::nullopt;
  Certificate certificate;
  certificate.original_to_simplified = counts_of(surface->forward);
  certificate.simplified_to_original = counts_of(surface->backward);
  std::optional<EncodedLines> lines;
  if (options.lines) {
    lines = prove_lines(original, simplified, *options.lines, options, stop);
    if (!lines) return std::nullopt;
    certificate.lines = {counts_of(lines->original_to_simplified), counts_of(lines->simplified_to_original)};
  }
  certificate.bytes =
      assemble(original, simplified, tolerance, surface->forward, surface->backward, lines ? &*lines : nullptr);
  return certificate;
}

}  // namespace meshbound
