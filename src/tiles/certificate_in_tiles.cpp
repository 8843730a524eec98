// SPDX-License-Identifier: MIT
/// Certificates of meshes whose trees would not fit into memory at once.
///
/// A tile of the source is proven near the triangles of the target whose clusters are within a reach of it that is a
/// little larger than the tolerance. Leaves name triangles that are near, so a reader, who has the whole target, finds
/// them near as well. A patch of a proof by parity grows over edges that pass over the piece within the tolerance:
/// all triangles of such an edge are within the reach, so the reader's patch is the same.
#include "tiles/certificate_in_tiles.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "certificate/direction_proof.h"
#include "certificate/encoder.h"
#include "meshbound/error.h"
#include "numeric/checked_seconds.h"
#include "numeric/rounding.h"
#include "tiles/checked_tiles.h"
#include "tiles/clusters.h"
#include "tiles/compact_bytes.h"

namespace meshbound {
namespace {

/// The reach as a multiple of the tolerance: proofs keep away from the tolerance by far less.
constexpr double reach_share = 1.0625;

std::string packed_trees(const ProofTrees& trees) {
  CompactWriter to;
  to.number(trees.parity_work);
  std::uint32_t last = 0;
  for (const std::vector<ProofNode>& run : trees.runs) {
    to.number(run.size());
    for (const ProofNode& node : run) {
      to.number(static_cast<std::uint64_t>(node.kind));
      if (node.kind == ProofNode::Kind::Cut) {
        to.number(static_cast<std::uint64_t>(node.chord.bits));
        for (const ChordEnd& end : {node.chord.from, node.chord.to}) {
          to.number(end.edge);
          to.number(end.numerator);
        }
      } else {
        to.step(std::exchange(last, node.target), node.target);
      }
    }
  }
  return to.take();
}

ProofTrees unpacked_trees(std::string_view bytes) {
  ProofTrees trees;
  if (bytes.empty()) return trees;  // of a tile that was stopped
  CompactReader from(bytes);
  trees.parity_work = from.number();
  std::uint32_t last = 0;
  while (!from.at_end()) {
    std::vector<ProofNode>& run = trees.runs.emplace_back(from.count(bytes.size()));
    for (ProofNode& node : run) {
      node.kind = static_cast<ProofNode::Kind>(from.count(static_cast<std::size_t>(ProofNode::Kind::Parity)));
      if (node.kind == ProofNode::Kind::Cut) {
        node.chord.bits = static_cast<int>(from.count(64));
        for (ChordEnd* const end : {&node.chord.from, &node.chord.to}) {
          end->edge = static_cast<std::uint32_t>(from.number());
          end->numerator = from.number();
        }
      } else {
        node.target = last = from.step(last);
      }
    }
  }
  return trees;
}

/// Reads nodes from one of them on, in order.
class NodeReader {
 public:
  /// `nodes` must outlive this and not change.
  NodeReader(const ItemStore<ProofNode>& nodes, std::size_t first) : nodes_(&nodes), next_(first) {}
  [[nodiscard]] const ProofNode& next() {
    if (read_ == block_.size()) {
      constexpr std::size_t block_size = 256;
      block_.resize(std::min(block_size, nodes_->size() - next_));
      nodes_->read(next_, block_);
      next_ += block_.size();
      read_ = 0;
    }
    return block_[read_++];
  }

 private:
  const ItemStore<ProofNode>* nodes_;
  std::size_t next_;  ///< first node that is not in the block
  std::vector<ProofNode> block_;
  std::size_t read_ = 0;  ///< nodes of it that have been given
};

/// One direction: proves that `source` lies near `target`.
class TiledProof {
 public:
  TiledProof(const Clusters& source, const char* source_name, const Clusters& target, const char* target_name,
             double tolerance, const TileOptions& tiles)
      : source_(source.mesh),
        source_name_(source_name),
        target_(target),
        target_name_(target_name),
        tolerance_(tolerance),
        tiles_(tiles_beside(source, target, reach_share * tolerance, tiles.max_triangles)),
        first_node_(tiles_.size()),
        parity_work_(tiles_.size()),
        nodes_(source.mesh.space()) {}

  struct How {
    CertificateOptions options;  ///< of a tile
    StopToken stop;
    std::function<void(double)> progress;  ///< of this direction
  };

  /// On the first process. Nothing, on all, when it was cancelled or ran out of time.
  std::optional<EncodedSection> run(const How& how, JobRunner& runner) {
    if (!prove(how, DirectionProof::large_patch, runner)) return std::nullopt;
    const std::uint64_t triangles = source_.triangle_count() + target_.mesh.triangle_count();
    const std::uint64_t work = std::accumulate(parity_work_.begin(), parity_work_.end(), std::uint64_t{0});
    const bool costs_too_much = runner.is_first() && DirectionProof::costs_too_much(work, triangles);
    if (runner.any(costs_too_much) && !prove(how, DirectionProof::small_patch, runner)) return std::nullopt;
    EncodedSection section;
    runner.do_together([&] {
      if (runner.is_first()) section = encode();
    });
    return section;
  }

 private:
  /// The tiles as jobs.
  class Jobs : public TileJobs {
   public:
    Jobs(TiledProof& proof, const How& how, std::size_t max_patch) : proof_(proof), how_(how), max_patch_(max_patch) {}

    [[nodiscard]] std::size_t size() const override { return proof_.tiles_.size(); }
    [[nodiscard]] std::uint64_t weight(std::size_t job) const override { return proof_.tiles_.size_of(job); }
    void run(std::size_t job) override { (void)run(job, false); }
    [[nodiscard]] std::string run_packed(std::size_t job) override { return run(job, true); }
    void unpack(std::size_t job, std::string_view bytes) override { proof_.take(job, unpacked_trees(bytes)); }
    [[nodiscard]] bool is_complete(std::size_t) const override { return !was_stopped_; }
    void progress(double share) override { how_.progress(share); }
    [[nodiscard]] bool only_first_needs_results() const override { return true; }
    [[nodiscard]] bool was_stopped() const { return was_stopped_; }

   private:
    std::string run(std::size_t job, bool packs) {
      const std::optional<ProofTrees> trees = proof_.trees_of(job, how_, max_patch_);
      if (!trees) {
        was_stopped_ = true;
        return {};
      }
      proof_.take(job, *trees);
      return packs ? packed_trees(*trees) : std::string();
    }

    TiledProof& proof_;
    const How& how_;
    std::size_t max_patch_;
    std::atomic<bool> was_stopped_ = false;
  };

  /// Whether it came to its end, on all processes.
  [[nodiscard]] bool prove(const How& how, std::size_t max_patch, JobRunner& runner) {
    nodes_ = ItemStore<ProofNode>(source_.space());
    Jobs jobs(*this, how, max_patch);
    runner.run(jobs);
    return !runner.any(jobs.was_stopped());
  }

  [[nodiscard]] std::optional<ProofTrees> trees_of(std::size_t tile, const How& how, std::size_t max_patch) const {
    const std::vector<std::uint32_t> triangles = tiles_[tile];
    const MeshPart source = part_of(source_, triangles);
    std::vector<std::uint32_t> near = near_to(target_, box_of(source.mesh), reach_share * tolerance_).triangles;
    if (near.empty())
      throw Error("no certificate: triangle " + std::to_string(triangles[0]) + " of the " + source_name_ +
                  " mesh is further from the other mesh than the tolerance");
    std::sort(near.begin(), near.end());
    const MeshPart target = part_of(target_.mesh, near);
    const MeshView source_view = source.mesh, target_view = target.mesh;
    try {
      return DirectionProof({source_view, source_name_, triangles}, {target_view, target_name_, near}, tolerance_,
                            how.options, how.stop, "triangle")
          .run(max_patch, {});
    } catch (const Stopped&) {
      return std::nullopt;
    }
  }

  /// Several threads may call this at once.
  void take(std::size_t tile, const ProofTrees& trees) {
    const std::lock_guard lock(taking_);
    parity_work_[tile] = trees.parity_work;
    first_node_[tile] = nodes_.size();
    for (const std::vector<ProofNode>& run : trees.runs) nodes_.append(run);
  }

  /// The trees in the order of the triangles of the source.
  [[nodiscard]] EncodedSection encode() const {
    std::vector<std::uint32_t> tile_of(source_.triangle_count());
    std::vector<NodeReader> readers;
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
      for (const std::uint32_t t : tiles_[tile]) tile_of[t] = tile;
      readers.emplace_back(nodes_, first_node_[tile]);
    }
    SectionEncoder encoder(source_.vertex_count());
    source_.for_each_triangle([&](std::uint32_t t, const Triangle& corners) {
      encoder.begin(corners);
      while (encoder.is_open()) encoder.add(readers[tile_of[t]].next());
    });
    return encoder.take();
  }

  const StoredMesh& source_;
  const char* source_name_;
  const Clusters& target_;
  const char* target_name_;
  double tolerance_;
  StoredLists tiles_;
  std::vector<std::size_t> first_node_;     ///< by tile: where its trees begin
  std::vector<std::uint64_t> parity_work_;  ///< by tile
  ItemStore<ProofNode> nodes_;              ///< those of a tile one after the other
  std::mutex taking_;
};

}  // namespace

std::optional<Certificate> certify_in_tiles(const StoredMesh& original, const StoredMesh& simplified, double tolerance,
                                            const CertificateOptions& options, const TileOptions& tiles,
                                            JobRunner& runner) {
  tolerance = checked_tolerance(tolerance);
  TiledProof::How how{
      options,
      StopToken{.cancel = options.cancel}.until(StopToken::Clock::now(), checked_seconds(options.seconds)),
      {}};
  how.options.threads = 1;
  std::optional<Clusters> clusters_of_original, clusters_of_simplified;
  runner.do_together([&] {
    check_floating_point_model();  // where no tree is built either
    clusters_of_original.emplace(original, checked(tiles).max_triangles);
    clusters_of_simplified.emplace(simplified, tiles.max_triangles);
  });
  const auto prove = [&](const Clusters& source, const char* source_name, const Clusters& target,
                         const char* target_name, double progress_from) {
    how.progress = [&options, progress_from](double share) {
      if (options.progress) options.progress(progress_from + 0.5 * share);
    };
    std::optional<TiledProof> proof;
    runner.do_together([&] { proof.emplace(source, source_name, target, target_name, tolerance, tiles); });
    return proof->run(how, runner);
  };
  const auto forward = prove(*clusters_of_original, "original", *clusters_of_simplified, "simplified", 0);
  if (!forward) return std::nullopt;
  const auto backward = prove(*clusters_of_simplified, "simplified", *clusters_of_original, "original", 0.5);
  if (!backward) return std::nullopt;
  Certificate certificate;
  runner.do_together([&] {
    if (runner.is_first())
      certificate = certificate_of(CertifiedMesh(original), CertifiedMesh(simplified), tolerance, *forward, *backward);
  });
  return certificate;
}

}  // namespace meshbound
