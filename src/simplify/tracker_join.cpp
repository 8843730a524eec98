// SPDX-License-Identifier: MIT
/// Proofs that go from one tracker to another.
#include "meshbound/error.h"
#include "simplify/tracker_impl.h"

namespace meshbound {

TrackerStats& TrackerStats::operator+=(const TrackerStats& other) {
  admitted += other.admitted;
  for (std::size_t i = 0; i < refused.size(); ++i) refused[i] += other.refused[i];
  originals_tested += other.originals_tested;
  originals_split += other.originals_split;
  cuts += other.cuts;
  ring_searches += other.ring_searches;
  faces_tested += other.faces_tested;
  faces_by_degree += other.faces_by_degree;
  return *this;
}

TrackedProof DeviationTracker::proof() const {
  TrackedProof proof;
  proof.tolerance = impl_->tolerance;
  proof.nearest = impl_->nearest;
  proof.ends.reserve(impl_->triangles.size());
  for (std::uint32_t t = 0; t < impl_->triangles.size(); ++t) {
    const auto cover = impl_->cover.faces_of(t);
    proof.faces.insert(proof.faces.end(), cover.begin(), cover.end());
    proof.ends.push_back(proof.faces.size());
  }
  return proof;
}

void DeviationTracker::take_over(const TrackedProof& part, std::span<const std::uint32_t> triangle_of,
                                 std::span<const TrackedFace> faces) {
  if (!(part.tolerance <= impl_->tolerance)) throw InvalidInput("proofs for a larger tolerance cannot be taken over");
  if (part.ends.size() != triangle_of.size() || part.nearest.size() != faces.size())
    throw InvalidInput("the numbers of triangles and faces must be given for all of the part");
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].id == SurfaceChange::no_triangle) continue;
    impl_->put_face(faces[f].id, corners_of(faces[f]), triangle_of[part.nearest[f]]);
  }
  CoverAssignment::Ids ids;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < triangle_of.size(); begin = part.ends[k++]) {
    ids.clear();
    for (std::size_t i = begin; i < part.ends[k]; ++i) {
      ids.push_back(faces[part.faces[i]].id);
      if (ids.back() == SurfaceChange::no_triangle)
        throw InvalidInput("a proof to be taken over uses a face that is not current");
    }
    impl_->cover.assign(triangle_of[k], ids);
  }
}

}  // namespace meshbound
