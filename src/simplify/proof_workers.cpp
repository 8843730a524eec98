// SPDX-License-Identifier: MIT
#include "simplify/proof_workers.h"

#include "geometry/boxes.h"
#include "numeric/tasks.h"
#include "simplify/proof_worker.h"

namespace meshbound {

ProofWorkers::ProofWorkers(const DecimationState& state, int threads) : workers_(static_cast<std::size_t>(threads)) {
  with_team(threads, [&] {
    for_each_task(workers_.size(), [&](std::size_t i) { workers_[i] = std::make_unique<Worker>(state); });
  });
}
ProofWorkers::~ProofWorkers() = default;

bool ProofWorkers::cover_anywhere(std::span<const std::uint32_t> originals, const FaceBoxes& boxes,
                                  std::vector<IdList>& covers) {
  covers.resize(originals.size());
  workers_.front()->forget_faces();
  for (std::size_t i = 0; i < originals.size(); ++i) {
    covers[i].assign(workers_.front()->cover_anywhere(originals[i], boxes));
    if (covers[i].empty()) return false;
  }
  return true;
}

template <class IsWanted>
void FaceBoxes::take_faces(const ArrayMesh& mesh, const IsWanted& is_wanted) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    if (!mesh.is_removed(f) && is_wanted(f)) faces_.push_back(f);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(faces_.size());
  for (const std::uint32_t f : faces_) boxes.push_back(box_of(mesh.triangle(f)));
  tree_.emplace(boxes);
}

FaceBoxes::FaceBoxes(const ArrayMesh& mesh) {
  take_faces(mesh, [](std::uint32_t) { return true; });
}

FaceBoxes::FaceBoxes(const ArrayMesh& mesh, const BoxTree& wanted) {
  std::vector<std::uint32_t> met;
  take_faces(mesh, [&](std::uint32_t face) {
    met.clear();
    wanted.find(box_of(mesh.triangle(face)), met);
    return !met.empty();
  });
}

void FaceBoxes::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  const std::size_t before = found.size();
  tree_->find(box, found);
  for (std::size_t i = before; i < found.size(); ++i) found[i] = faces_[found[i]];
}

}  // namespace meshbound
