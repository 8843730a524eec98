// SPDX-License-Identifier: MIT
#include "simplify/approximation_proof.h"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <tuple>

#include "bvh/bvh_data.h"
#include "meshbound/proximity.h"
#include "numeric/first_error.h"
#include "simplify/forward_cover.h"
#include "simplify/tracker_impl.h"

namespace meshbound {
namespace {

/// Triangles whose candidates come from one search of the tree of boxes, and of these, triangles that share them: more
/// have more candidates, all of which each corner is compared with, fewer prepare the same ones more often.
constexpr std::size_t triangles_of_run = 128, triangles_of_cluster = 16;

/// A triangle that needs more cuts or candidates than the cover of one has is halved this often at most, into at most
/// so many parts, each with candidates of its own. The cuts of parts and of covers count together.
constexpr int most_halvings = 16;
constexpr std::size_t most_parts = 4096;

constexpr std::uint32_t unknown = SurfaceChange::no_triangle;

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min().array() - by, box.max().array() + by};
}

Eigen::AlignedBox3d box_of(const ProofOriginal& original, std::span<const std::uint32_t> triangles) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : original.triangles[t]) {
      const Vec3 p = original.vertices[v];
      box.extend(Eigen::Vector3d(p.x, p.y, p.z));
    }
  }
  return box;
}

/// The rounding slack of the tracker is one for coordinates up to this; a face beyond is further than the tolerance.
bool is_in_range(const ProofOriginal& original, const TrackedFace& face) {
  const double most = original.magnitude + original.tolerance;
  return std::all_of(face.corners.begin(), face.corners.end(),
                     [&](const Eigen::Vector3d& p) { return (p.array().abs() <= most).all(); });
}

/// Empty ones, which meet nothing, for faces out of range.
std::vector<Eigen::AlignedBox3d> boxes_of(const ProofOriginal& original, std::span<const TrackedFace> faces) {
  std::vector<Eigen::AlignedBox3d> boxes(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (is_in_range(original, faces[i])) boxes[i] = box_of(corners_of(faces[i]));
  return boxes;
}

Vec3 middle_of(const FaceCorners& c) { return (1.0 / 3) * (c[0] + c[1] + c[2]); }

}  // namespace

/// Covers the triangles of a run.
class ApproximationProof::ForwardWorker {
 public:
  explicit ForwardWorker(ApproximationProof& proof)
      : proof_(proof), original_(proof.original_), cover_(original_.vertices, original_.triangles) {}

  void operator()(std::size_t run) {
    const auto& curve = original_.bvh.data().triangle_of_slot;
    const std::size_t begin = run * triangles_of_run, end = std::min(begin + triangles_of_run, curve.size());
    covers_ = &proof_.covers_[run];
    covers_->triangles.assign(curve.begin() + begin, curve.begin() + end);
    const std::span<const std::uint32_t> triangles = covers_->triangles;
    near_run_.clear();
    if (!all_unchanged(triangles))
      proof_.boxes_.find(grown(box_of(original_, triangles), original_.tolerance), near_run_);
    for (std::size_t first = 0; first < triangles.size(); first += triangles_of_cluster)
      cover_cluster(triangles.subspan(first, std::min(triangles_of_cluster, triangles.size() - first)));
  }
  void finish() {
    proof_.splits += cover_.splits;
    proof_.cuts += cover_.cuts;
  }

 private:
  [[nodiscard]] bool all_unchanged(std::span<const std::uint32_t> triangles) const {
    return std::all_of(triangles.begin(), triangles.end(),
                       [&](std::uint32_t t) { return proof_.unchanged_.face_of(t) != UnchangedFaces::none; });
  }

  /// Whether a triangle is a face still, which covers it then.
  bool cover_unchanged(std::uint32_t triangle) {
    const std::uint32_t face = proof_.unchanged_.face_of(triangle);
    if (face == UnchangedFaces::none) return false;
    covers_->ids.push_back(proof_.faces_[face].id);
    covers_->ends.push_back(covers_->ids.size());
    return true;
  }

  void cover_cluster(std::span<const std::uint32_t> cluster) {
    if (all_unchanged(cluster)) {
      for (const std::uint32_t t : cluster) cover_unchanged(t);
      return;
    }
    const Eigen::AlignedBox3d box = box_of(original_, cluster), reach = grown(box, original_.tolerance);
    candidates_.clear();
    for (const std::uint32_t i : near_run_)
      if (proof_.boxes_.box(i).intersects(reach)) candidates_.push_back(i);
    if (const std::size_t half = cluster.size() / 2; half > 0 && candidates_.size() > CandidateFaces::capacity) {
      cover_cluster(cluster.first(half));
      cover_cluster(cluster.subspan(half));
      return;
    }
    const double limit = original_.limit(box);
    bool entered = false;
    for (const std::uint32_t t : cluster) {
      if (cover_unchanged(t)) continue;
      if (!entered && candidates_.size() <= CandidateFaces::capacity) enter(candidates_, limit), entered = true;
      FaceMask used = entered ? cover_.cover_thoroughly(t, ForwardCover::first(cover_.size())) : 0;
      if (used == 0) {
        cover_in_parts(t, limit);
        entered = false;
      }
      for (; used != 0; used &= used - 1) covers_->ids.push_back(cover_.face(std::countr_zero(used)));
      covers_->ends.push_back(covers_->ids.size());
    }
  }

  void enter(const std::vector<std::uint32_t>& candidates, double limit) {
    cover_.begin(limit);
    if (!(limit > 0)) return;
    for (const std::uint32_t i : candidates) cover_.add(corners_of(proof_.faces_[i]), proof_.faces_[i].id);
  }

  /// Appends the faces of a cover of the triangle, none when there is none.
  void cover_in_parts(std::uint32_t triangle, double limit) {
    const Triangle& t = original_.triangles[triangle];
    parts_.assign(1, {{original_.vertices[t[0]], original_.vertices[t[1]], original_.vertices[t[2]]}, 0});
    ids_.clear();
    for (std::size_t count = 1; !parts_.empty();) {
      const Part part = parts_.back();
      parts_.pop_back();
      find_candidates(part.corners);
      enter(candidates_of_part_, limit);
      const std::optional<FaceMask> used = cover_.cover_part(part.corners, ForwardCover::deepest_cut - part.halvings);
      if (!used || (*used == 0 && (part.halvings == most_halvings || ++count > most_parts))) return;
      if (*used == 0) halve(part);
      for (FaceMask rest = *used; rest != 0; rest &= rest - 1) ids_.push_back(cover_.face(std::countr_zero(rest)));
    }
    std::sort(ids_.begin(), ids_.end());
    covers_->ids.insert(covers_->ids.end(), ids_.begin(), std::unique(ids_.begin(), ids_.end()));
  }

  struct Part {
    FaceCorners corners;
    int halvings = 0;
  };
  void halve(const Part& part) {
    std::size_t from = 0;
    double longest = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double edge = squared_length(part.corners[(i + 1) % 3] - part.corners[i]);
      if (edge > longest) longest = edge, from = i;
    }
    const std::size_t to = (from + 1) % 3;
    const Vec3 middle = 0.5 * (part.corners[from] + part.corners[to]);
    for (const std::size_t end : {from, to}) {
      Part& half = parts_.emplace_back(part);
      half.corners[end] = middle;
      ++half.halvings;
    }
  }

  /// Of the faces near, those that hold most of the corners, then those nearest to the middle.
  void find_candidates(const FaceCorners& corners) {
    const Eigen::AlignedBox3d reach = grown(box_of(corners), original_.tolerance);
    candidates_of_part_.clear();
    for (const std::uint32_t i : near_run_)
      if (proof_.boxes_.box(i).intersects(reach)) candidates_of_part_.push_back(i);
    if (candidates_of_part_.size() <= CandidateFaces::capacity) return;
    const double squared_tolerance = original_.tolerance * original_.tolerance;
    const auto squared_distance = [&](std::uint32_t i, Vec3 p) {
      const FaceCorners f = corners_of(proof_.faces_[i]);
      return closest_on_triangle(CornerTriangle<double>{f[0], f[1] - f[0], f[2] - f[0]}, p).squared_distance;
    };
    std::vector<std::tuple<std::ptrdiff_t, double, std::uint32_t>> ranked;
    for (const std::uint32_t i : candidates_of_part_) {
      const auto lost = std::count_if(corners.begin(), corners.end(),
                                      [&](Vec3 p) { return squared_distance(i, p) > squared_tolerance; });
      ranked.emplace_back(lost, squared_distance(i, middle_of(corners)), i);
    }
    std::nth_element(ranked.begin(), ranked.begin() + CandidateFaces::capacity, ranked.end());
    std::sort(ranked.begin(), ranked.begin() + CandidateFaces::capacity);
    candidates_of_part_.clear();
    for (std::size_t k = 0; k < CandidateFaces::capacity; ++k) candidates_of_part_.push_back(std::get<2>(ranked[k]));
  }

  ApproximationProof& proof_;
  const ProofOriginal& original_;
  ForwardCover cover_;
  Covers* covers_ = nullptr;
  std::vector<std::uint32_t> near_run_, candidates_, candidates_of_part_;  ///< places of faces
  std::vector<std::uint32_t> ids_;
  std::vector<Part> parts_;
};

/// Compares a face with the original.
class ApproximationProof::BackwardWorker {
 public:
  explicit BackwardWorker(ApproximationProof& proof)
      : proof_(proof), original_(proof.original_), degree_(original_.degree), proximity_(original_.bvh) {}

  void operator()(std::size_t i) {
    const TrackedFace& face = proof_.faces_[i];
    if (const std::uint32_t t = proof_.unchanged_.triangle_of(static_cast<std::uint32_t>(i));
        t != UnchangedFaces::none) {
      proof_.nearest_[i] = t;
      proof_.is_near_[i] = 1;
      return;
    }
    const Eigen::AlignedBox3d& box = proof_.boxes_.box(static_cast<std::uint32_t>(i));
    if (box.isEmpty()) return;
    const double limit = original_.limit(box);
    if (!(limit > 0)) return;
    std::uint32_t& near = proof_.nearest_[i];
    if (near == unknown) {
      near = 0;
      (void)proximity_.upper_distance((face.corners[0] + face.corners[1] + face.corners[2]) / 3, near);
    }
    const bool by_degree = degree_.covers(corners_of(face), limit, original_.magnitude, near);
    by_degree_ += by_degree ? 1 : 0;
    proof_.is_near_[i] = by_degree || proximity_.triangle_within(face.corners, limit, near) == Verdict::Within;
  }
  void finish() { proof_.faces_by_degree += by_degree_; }

 private:
  ApproximationProof& proof_;
  const ProofOriginal& original_;
  DegreeCover degree_;
  Proximity proximity_;
  std::uint64_t by_degree_ = 0;
};

ApproximationProof::ApproximationProof(const ProofOriginal& original, std::span<const TrackedFace> faces, int threads,
                                       const StopToken& stop)
    : original_(original),
      faces_(faces),
      threads_(threads > 0 ? threads : omp_get_max_threads()),
      stop_(stop),
      boxes_(boxes_of(original, faces)),
      unchanged_(original.vertices, original.triangles, faces),
      covers_((original.triangles.size() + triangles_of_run - 1) / triangles_of_run),
      nearest_(faces.size(), unknown),
      is_near_(faces.size(), 0) {}

/// One worker for each thread, as they keep scratch memory.
template <class Worker>
void ApproximationProof::in_parallel(std::size_t items) {
  FirstError error;
#pragma omp parallel num_threads(threads_)
  {
    std::optional<Worker> worker;
    error.guard([&] { worker.emplace(*this); });
#pragma omp for schedule(dynamic, 8)
    for (std::size_t item = 0; item < items; ++item) {
      if (worker)
        error.guard([&] {
          stop_.check();
          (*worker)(item);
        });
    }
#pragma omp critical
    if (worker) worker->finish();
  }
  error.rethrow();
}

/// The triangle with its middle nearest to that of the face lies above it, if any does: DegreeCover begins there.
void ApproximationProof::choose_hints() {
  std::vector<std::uint32_t> place;
  for (std::uint32_t i = 0; i < faces_.size(); ++i) {
    if (faces_[i].id >= place.size()) place.resize(std::size_t{faces_[i].id} + 1);
    place[faces_[i].id] = i;
  }
  std::vector<Vec3> middles;
  for (const TrackedFace& face : faces_) middles.push_back(middle_of(corners_of(face)));
  std::vector<double> least(faces_.size(), HUGE_VAL);
  for_each_cover([&](std::uint32_t t, std::span<const std::uint32_t> ids) {
    if (ids.empty()) unproven_.originals.push_back(t);
    const Triangle& c = original_.triangles[t];
    const Vec3 middle = middle_of({original_.vertices[c[0]], original_.vertices[c[1]], original_.vertices[c[2]]});
    for (const std::uint32_t id : ids) {
      const std::uint32_t i = place[id];
      const double squared_distance = squared_length(middle - middles[i]);
      if (!(squared_distance < least[i])) continue;
      least[i] = squared_distance;
      nearest_[i] = t;
    }
  });
  std::sort(unproven_.originals.begin(), unproven_.originals.end());
}

void ApproximationProof::run() {
  in_parallel<ForwardWorker>(covers_.size());
  choose_hints();
  in_parallel<BackwardWorker>(faces_.size());
  for (std::size_t i = 0; i < faces_.size(); ++i)
    if (!is_near_[i]) unproven_.faces.push_back(faces_[i].id);
}

}  // namespace meshbound
