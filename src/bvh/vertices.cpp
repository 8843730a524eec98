// SPDX-License-Identifier: MIT
/// Vertices renumbered by first use along the curve: neighbours in space become neighbours in memory. Each thread
/// numbers those that its run of slots is the first to use, in order of that use; the numbers of the runs follow each
/// other. One run or many, the numbering is the same.
#include <algorithm>
#include <atomic>

#include "bvh/build.h"
#include "numeric/first_error.h"

namespace meshbound {
namespace {

constexpr std::uint32_t unused = 0xffffffff;

class Renumbering {
 public:
  Renumbering(Bvh::Data& data, const MeshView& mesh, int threads)
      : data_(data), mesh_(mesh), threads_(threads), runs_(static_cast<std::uint32_t>(threads)) {}

  void run() {
    data_.corners.resize(mesh_.triangle_count());
    place_of_.resize(mesh_.vertex_count());
    first_run_.resize(runs_ > 1 ? mesh_.vertex_count() : 0);
    used_.resize(runs_);
    // By one thread: each thread's own heap would have to grow first. A closed surface has half as many vertices as
    // triangles.
    for (std::uint32_t r = 0; r < runs_; ++r) used_[r].reserve((begin(r + 1) - begin(r)) / 2 + 64);
    FirstError error;
#pragma omp parallel num_threads(threads_)
    {
#pragma omp for schedule(static)
      for (std::size_t v = 0; v < place_of_.size(); ++v) {
        place_of_[v] = unused;
        if (runs_ > 1) first_run_[v] = unused;
      }
#pragma omp for schedule(static)
      for (std::uint32_t r = 0; r < runs_; ++r) gather_corners(r);
#pragma omp for schedule(static)
      for (std::uint32_t r = 0; r < runs_; ++r) error.guard([&] { number_vertices(r); });
    }
    error.rethrow();
    std::vector<std::uint32_t> base(runs_ + 1, 0);
    for (std::uint32_t r = 0; r < runs_; ++r) base[r + 1] = base[r] + static_cast<std::uint32_t>(used_[r].size());
    data_.vertices.resize(base[runs_]);
    data_.source_vertex.resize(base[runs_]);
    double largest_rounding = 0;
#pragma omp parallel num_threads(threads_)
    {
#pragma omp for schedule(static) reduction(max : largest_rounding)
      for (std::uint32_t r = 0; r < runs_; ++r)
        largest_rounding = std::max(largest_rounding, store_vertices(r, base[r]));
#pragma omp for schedule(static)
      for (std::uint32_t r = 0; r < runs_; ++r) renumber_corners(r, base);
    }
    data_.frame.error = largest_rounding;
  }

 private:
  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const {
    return static_cast<std::uint32_t>(std::uint64_t{data_.triangle_count()} * run / runs_);
  }

  /// Corners in the mesh's numbering, and which run is the first to use a vertex.
  void gather_corners(std::uint32_t run) {
    for (std::uint32_t slot = begin(run); slot < begin(run + 1); ++slot) {
      const Triangle t = mesh_.triangle(data_.triangle_of_slot[slot]);
      data_.corners[slot] = t;
      if (runs_ == 1) continue;
      for (const std::uint32_t v : t) {
        const std::atomic_ref<std::uint32_t> first(first_run_[v]);
        std::uint32_t seen = first.load(std::memory_order_relaxed);
        while (run < seen && !first.compare_exchange_weak(seen, run, std::memory_order_relaxed)) {
        }
      }
    }
  }

  void number_vertices(std::uint32_t run) {
    Array<std::uint32_t>& used = used_[run];
    for (std::uint32_t slot = begin(run); slot < begin(run + 1); ++slot) {
      for (const std::uint32_t v : data_.corners[slot]) {
        if ((runs_ > 1 && first_run_[v] != run) || place_of_[v] != unused) continue;
        place_of_[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(v);
      }
    }
  }

  /// Returns the largest rounding error that a vertex suffered.
  double store_vertices(std::uint32_t run, std::uint32_t base) {
    const FrameMap to_working(data_.frame);
    double error = 0;
    for (std::size_t i = 0; i < used_[run].size(); ++i) {
      const Eigen::Vector3d p = mesh_.vertex(used_[run][i]);
      const Vec3 model{p.x(), p.y(), p.z()};
      data_.vertices[base + i] = to_working(model);
      data_.source_vertex[base + i] = used_[run][i];
      error = std::max(error, data_.frame.rounding_of(model));
    }
    return error;
  }

  void renumber_corners(std::uint32_t run, const std::vector<std::uint32_t>& base) {
    for (std::uint32_t slot = begin(run); slot < begin(run + 1); ++slot) {
      Triangle t = data_.corners[slot];
      for (std::uint32_t& v : t) v = place_of_[v] + (runs_ > 1 ? base[first_run_[v]] : 0);
      const std::uint32_t first = longest_edge(data_.vertices[t[0]], data_.vertices[t[1]], data_.vertices[t[2]]);
      data_.corners[slot] = {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
    }
  }

  Bvh::Data& data_;
  const MeshView& mesh_;
  int threads_;
  std::uint32_t runs_;
  Array<std::uint32_t> place_of_;   ///< by the mesh's vertex: its number among those of its run
  Array<std::uint32_t> first_run_;  ///< by the mesh's vertex; empty where there is one run only
  std::vector<Array<std::uint32_t>> used_;
};

}  // namespace

std::uint32_t longest_edge(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = squared_length(b - a), bc = squared_length(c - b), ca = squared_length(a - c);
  if (ab >= bc && ab >= ca) return 0;
  return bc >= ca ? 1 : 2;
}

void place_vertices(Bvh::Data& data, const MeshView& mesh, int threads) { Renumbering(data, mesh, threads).run(); }

}  // namespace meshbound
