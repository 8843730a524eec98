// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "simplify/cover/face_boxes.h"
#include "simplify/cover/id_list.h"
#include "simplify/decimation_state.h"

namespace meshbound {

/// Scratch memory of the threads that prove, kept from proof to proof.
class ProofWorkers {
 public:
  /// `state` must outlive this.
  ProofWorkers(const DecimationState& state, int threads);
  ~ProofWorkers();

  /// Covers originals by faces found by their boxes. False if one has no cover.
  [[nodiscard]] bool cover_anywhere(std::span<const std::uint32_t> originals, const FaceBoxes& boxes,
                                    std::vector<IdList>& covers);

  class Worker;
  [[nodiscard]] std::size_t count() const { return workers_.size(); }
  [[nodiscard]] Worker& of_thread(std::size_t thread) { return *workers_[thread]; }

 private:
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace meshbound
