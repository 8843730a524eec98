// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "certificate/cut_search.h"
#include "certificate/proof_node.h"
#include "meshbound/bvh.h"
#include "meshbound/certificate.h"
#include "meshbound/mesh_view.h"
#include "meshbound/stop_token.h"
#include "proof/goal.h"

namespace meshbound {

/// A mesh of a certificate, or some of its triangles.
struct ProofMesh {
  const MeshView& mesh;
  const char* name;  ///< "original" or "simplified"
  /// By triangle: its number in the whole mesh, ascending; empty where `mesh` is the whole.
  std::span<const std::uint32_t> numbers = {};

  [[nodiscard]] std::uint32_t number(std::size_t triangle) const {
    return numbers.empty() ? static_cast<std::uint32_t>(triangle) : numbers[triangle];
  }
  /// The triangle with this number; `no_index` where it is not among these.
  [[nodiscard]] std::uint32_t triangle(std::uint32_t number) const;
};

/// A proof for some source triangles: their trees, one after the other, in any number of runs.
struct ProofTrees {
  std::vector<std::vector<ProofNode>> runs;
  std::uint64_t parity_work = 0;  ///< what proofs by parity cost a reader (`ParitySearch::work`)
};

/// Proves that `source` lies near `target`.
class DirectionProof {
 public:
  /// Everything must outlive this. `element` is what messages call a triangle: "triangle" or "line". Throws `Stopped`.
  DirectionProof(const ProofMesh& source, const ProofMesh& target, double tolerance, const CertificateOptions& options,
                 const StopToken& stop, const char* element);

  /// Parity patches have at most `max_patch` triangles. The targets of leaves are numbers of whole meshes. Nothing when
  /// it was cancelled or ran out of time; throws `Error` for a triangle that could not be proven.
  [[nodiscard]] std::optional<ProofTrees> run(std::size_t max_patch, const std::function<void(double)>& progress) const;

  /// The patches to begin with, and those of a proof whose patches would cost a reader too much otherwise: such are
  /// stacks of large triangles over fine ones. A small patch for each leaf, which takes about four bytes with its cut,
  /// costs half of what a reader accepts.
  static constexpr std::size_t large_patch = ParitySearch::max_patch, small_patch = 32;
  /// Whether that is so, of a whole direction. `triangles`: of both meshes.
  [[nodiscard]] static bool costs_too_much(std::uint64_t parity_work, std::uint64_t triangles);

 private:
  /// A source triangle that could not be proven.
  struct Failure {
    std::size_t triangle = 0;
    CutSearch::Outcome outcome = CutSearch::Outcome::Proven;
  };

  void load_vertices();
  [[nodiscard]] Failure prove_run(std::size_t run, CutSearch& search, std::vector<ProofNode>& nodes) const;
  [[nodiscard]] bool is_in_target(const Triangle& triangle, std::uint32_t other) const;
  [[noreturn]] void fail(const Failure& failure) const;

  ProofMesh source_, target_;
  double tolerance_;
  const CertificateOptions& options_;
  const char* element_;
  Bvh tree_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  Goal goal_;
  double magnitude_ = 1;        ///< of all coordinates in the working frame
  std::vector<Vec3> vertices_;  ///< of the source, in the working frame of the tree
};

}  // namespace meshbound
