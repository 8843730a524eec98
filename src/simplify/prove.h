// SPDX-License-Identifier: MIT
/// The proof that a mesh under decimation is within its tolerance of the original, both ways, for what was changed
/// since the last one.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "meshbound/stop_token.h"
#include "simplify/proof_workers.h"

namespace meshbound {

/// What a proof could not confirm.
struct Unproven {
  std::vector<std::uint32_t> originals;  ///< triangles with a part that no face is near enough to
  std::vector<std::uint32_t> faces;      ///< those that are too far from the original
  [[nodiscard]] bool empty() const { return originals.empty() && faces.empty(); }
};

/// A proof under way.
///
/// Forward, each original triangle whose cover has lost a face, or never had one, is compared with the faces that its
/// corners were found nearest to, then with those around; pieces of it, where no single face holds it. Backward, each
/// face that was changed is compared with the original. All are independent of each other, so the result is the same
/// for any number of threads.
class Proof {
 public:
  Proof(DecimationState& state, ProofWorkers& workers);

  /// Proves what is still open: faces first, and originals once no face is too far. Throws `Stopped` where `stop` asks
  /// for it; the state is then as it was.
  void run(const StopToken& stop);
  /// What does not hold; empty if all is proven.
  [[nodiscard]] const Unproven& unproven() const { return unproven_; }
  /// Opens what was proven with these faces: they have been changed again, most of them back to what they were.
  void reopen(const std::vector<std::uint32_t>& changed);
  /// Takes the proof over into the state, which then has nothing unproven.
  void commit();

  std::uint64_t originals_tested = 0, faces_tested = 0;

 private:
  using Work = std::function<void(ProofWorkers::Worker& worker, std::size_t i)>;
  void for_each(std::size_t count, std::size_t at_once, const StopToken& stop, const Work& work);
  [[nodiscard]] std::vector<std::uint32_t> find_far_faces(const StopToken& stop);
  void reopen_originals();
  void cover(const StopToken& stop);
  void cover_anywhere(const StopToken& stop);
  [[nodiscard]] std::size_t open_count() const { return has_all_open_ ? originals_.size() : open_originals_.size(); }
  [[nodiscard]] std::uint32_t open_original(std::size_t i) const {
    return has_all_open_ ? static_cast<std::uint32_t>(i) : open_originals_[i];
  }
  [[nodiscard]] bool is_stale(std::uint32_t original) const;

  DecimationState& state_;
  ProofWorkers& workers_;
  std::vector<std::uint32_t> originals_;       ///< to be covered anew; none: not any more
  std::vector<IdList> drafts_;                 ///< by index in `originals_`: faces that cover it; empty if it is open
  bool has_all_open_ = true;                   ///< all of `originals_` are open
  std::vector<std::uint32_t> open_originals_;  ///< else: their indices there
  std::vector<std::uint32_t> open_faces_;
  std::vector<std::uint8_t> is_changed_;  ///< by face: it was reopened since originals were covered; empty: none was
  Unproven unproven_;
};

}  // namespace meshbound
