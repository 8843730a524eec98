// SPDX-License-Identifier: MIT
/// Vertices renumbered by first use along the curve: neighbours in space become neighbours in memory. Those of a run of
/// slots are numbered in order of first use, by themselves: a cache line that two threads write to costs more than a
/// hundred vertices. What an earlier run uses too, it then takes from there; the numbers of the others follow those of
/// the runs before. One run or many, the numbering is the same.
#include <algorithm>
#include <utility>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "geometry/longest_edge.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr std::uint32_t of_earlier_run = 0xffffffff;

/// Most runs that pay: every run has a table of all vertices.
constexpr std::size_t max_runs = 16;

struct Run {
  explicit Run(Arena& arena)
      : local(array_in<std::uint32_t>(arena)),
        own_used(array_in<std::uint32_t>(arena)),
        rank(array_in<std::uint32_t>(arena)),
        positions(array_in<Vec3>(arena)) {}

  Array<std::uint32_t> local;       ///< by the mesh's vertex: its number among those that the run uses
  Array<std::uint32_t> own_used;    ///< what `used` shows, but for the first run, where that is the tree's array
  std::uint32_t* used = nullptr;    ///< by local number: the mesh's vertex, in the end its final number
  std::uint32_t count = 0;          ///< of used vertices
  Array<std::uint32_t> rank;        ///< by local number: number among those that no earlier run uses, or that mark
  Array<Vec3> positions;            ///< by local number, in the working frame; of the first run they are the tree's
  std::vector<std::uint64_t> seen;  ///< a bit for each of the mesh's vertices; empty where there is one run only
  double rounding = 0;              ///< the largest that a vertex suffered
};

class Renumbering {
 public:
  Renumbering(Bvh::Data& data, const MeshView& mesh, std::size_t runs)
      : data_(data),
        mesh_(mesh),
        runs_(static_cast<std::uint32_t>(std::min(runs, max_runs))),
        run_(runs_, Run(data.arena)),
        slots_(slots_per_chunk(mesh.triangle_count(), runs)),
        first_of_chunk_((mesh.triangle_count() + slots_ - 1) / slots_ + 1),
        to_working_(data.frame) {}

  std::vector<std::uint32_t> run() {
    // By one thread: each thread's own heap would have to grow first.
    for (std::uint32_t r = 0; r < runs_; ++r) {
      run_[r].local.resize(mesh_.vertex_count());
      run_[r].own_used.resize(r > 0 ? max_used(r) + 1 : 0);
      run_[r].used = r > 0 ? run_[r].own_used.data() : data_.source_vertex.data();
      run_[r].rank.resize(r > 0 ? max_used(r) : 0);
      run_[r].positions.resize(r > 0 ? max_used(r) : 0);
      run_[r].seen.resize(runs_ > 1 ? mesh_.vertex_count() / 64 + 1 : 0);
    }
    std::vector<std::uint32_t> first_vertex(runs_ + 1, 0);
    for_each_run([&](std::uint32_t r) { number_vertices(r); });
    for_each_run([&](std::uint32_t r) { first_vertex[r + 1] = rank_vertices(r); });
    for (std::uint32_t r = 0; r < runs_; ++r) first_vertex[r + 1] += first_vertex[r];
    data_.vertices.resize(first_vertex[runs_]);
    data_.source_vertex.resize(first_vertex[runs_]);
    for_each_run([&](std::uint32_t r) {
      store_vertices(r, first_vertex);
      renumber_corners(r, first_vertex[r]);
    });
    for (const Run& run : run_) data_.frame.error = std::max(data_.frame.error, run.rounding);
    first_of_chunk_.back() = first_vertex[runs_];
    return std::move(first_of_chunk_);
  }

 private:
  template <class Work>
  void for_each_run(Work&& work) {
    for_each_task(runs_, [&](std::size_t r) { work(static_cast<std::uint32_t>(r)); });
  }

  [[nodiscard]] std::size_t max_used(std::uint32_t r) const {
    return std::min<std::size_t>(mesh_.vertex_count(), std::size_t{3} * (begin(r + 1) - begin(r)));
  }
  [[nodiscard]] std::uint32_t begin(std::uint32_t r) const { return run_begin(data_.triangle_count(), r, runs_); }

  /// Works in batches, in passes that do not depend on what was fetched just before, and asks for what the next batch
  /// needs while it works on this one: the processor then waits for many entries at a time, or not at all.
  void number_vertices(std::uint32_t r) {
    Run& run = run_[r];
    std::fill(run.local.begin(), run.local.end(), no_index);
    Vec3* const positions = r == 0 ? data_.vertices.data() : run.positions.data();
    std::array<Batch<Triangle>, 2> batches;
    std::uint32_t count = 0;
    const std::uint32_t end = begin(r + 1);
    fetch(run, begin(r), end, batches[0]);
    for (std::uint32_t slot = begin(r), odd = 0; slot < end; slot += triangles_at_once, odd ^= 1) {
      const std::uint32_t size = std::min(triangles_at_once, end - slot), known = count;
      const Batch<Triangle>& triangles = batches[odd];
      if (r == 0 && slot % slots_ == 0) first_of_chunk_[slot / slots_] = count;
      fetch(run, slot + size, end, batches[odd ^ 1]);
      for (std::uint32_t i = 0; i < size; ++i)
        for (const std::uint32_t v : triangles[i]) count = number_vertex(run, v, count);
      place(run, positions, known, count);
      for (std::uint32_t i = 0; i < size; ++i)
        data_.corners[slot + i] = longest_edge_first(run, positions, triangles[i]);
    }
    run.count = count;
  }

  /// Reads the triangles of a batch that begins at a slot, and asks for their vertices and for the batch that follows.
  void fetch(const Run& run, std::uint32_t slot, std::uint32_t end, Batch<Triangle>& batch) const {
    const MeshView mesh = mesh_;
    const std::uint32_t* const order = data_.triangle_of_slot.data();
    const std::uint32_t* const local = run.local.data();
    const std::uint32_t after = std::min(slot + triangles_at_once, end),
                        ahead = std::min(slot + 2 * triangles_at_once, end);
    for (std::uint32_t i = after; i < ahead; ++i) mesh.prefetch_triangle(order[i]);
    for (std::uint32_t i = slot; i < after; ++i) batch[i - slot] = mesh.triangle(order[i]);
    for (std::uint32_t i = slot; i < after; ++i) {
      for (const std::uint32_t v : batch[i - slot]) {
        __builtin_prefetch(local + v);
        mesh.prefetch_vertex(v);
      }
    }
  }

  /// Returns the number of vertices that have a number then. Without a branch on whether this one is new, which would
  /// be guessed wrong one time in six: what is no new vertex is written behind the last one.
  std::uint32_t number_vertex(Run& run, std::uint32_t v, std::uint32_t count) const {
    const std::uint32_t known = run.local[v];
    const bool is_new = known == no_index;
    run.local[v] = is_new ? count : known;
    run.used[count] = v;
    if (runs_ > 1) run.seen[v / 64] |= std::uint64_t{1} << v % 64;
    return count + static_cast<std::uint32_t>(is_new);
  }

  /// Fetches the positions of the vertices with the local numbers from `from` to below `to`.
  void place(Run& run, Vec3* positions, std::uint32_t from, std::uint32_t to) const {
    for (std::uint32_t i = from; i < to; ++i) {
      const Eigen::Vector3d p = mesh_.vertex(run.used[i]);
      positions[i] = {p.x(), p.y(), p.z()};
    }
    double rounding = run.rounding;
    for (std::uint32_t i = from; i < to; ++i) {
      rounding = std::max(rounding, to_working_.rounding_of(positions[i]));
      positions[i] = to_working_(positions[i]);
    }
    run.rounding = rounding;
  }

  /// The corners of a triangle by local numbers, without a branch, which would be guessed wrong two times in three.
  [[nodiscard]] static Triangle longest_edge_first(const Run& run, const Vec3* positions, const Triangle& t) {
    const std::array<std::uint32_t, 5> turned{run.local[t[0]], run.local[t[1]], run.local[t[2]], run.local[t[0]],
                                              run.local[t[1]]};
    const std::uint32_t first = longest_edge(positions[turned[0]], positions[turned[1]], positions[turned[2]]);
    return {turned[first], turned[first + 1], turned[first + 2]};
  }

  /// The first run that uses a vertex, of those up to `r`, which does.
  [[nodiscard]] std::uint32_t owner(std::uint32_t v, std::uint32_t r) const {
    for (std::uint32_t earlier = 0; earlier < r; ++earlier)
      if ((run_[earlier].seen[v / 64] >> v % 64 & 1U) != 0) return earlier;
    return r;
  }

  /// Returns how many vertices the run is the first to use.
  std::uint32_t rank_vertices(std::uint32_t r) {
    Run& run = run_[r];
    if (r == 0) return run.count;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < run.count; ++i) run.rank[i] = owner(run.used[i], r) == r ? count++ : of_earlier_run;
    return count;
  }

  /// The number among those of run `r` of a vertex that it is the first to use.
  [[nodiscard]] std::uint32_t rank_in(std::uint32_t r, std::uint32_t v) const {
    return r == 0 ? run_[0].local[v] : run_[r].rank[run_[r].local[v]];
  }

  void store_vertices(std::uint32_t r, const std::vector<std::uint32_t>& first_vertex) {
    Run& run = run_[r];
    if (r == 0) return;  // they stand where they belong
    for (std::uint32_t i = 0; i < run.count; ++i) {
      const std::uint32_t v = run.used[i];
      if (run.rank[i] == of_earlier_run) {
        const std::uint32_t earlier = owner(v, r);
        run.used[i] = first_vertex[earlier] + rank_in(earlier, v);
        continue;
      }
      const std::uint32_t number = first_vertex[r] + run.rank[i];
      data_.vertices[number] = run.positions[i];
      data_.source_vertex[number] = v;
      run.used[i] = number;
    }
  }

  /// `next`: the number of the first vertex that no earlier run uses.
  void renumber_corners(std::uint32_t r, std::uint32_t next) {
    if (r == 0) return;  // its local numbers are the final ones
    for (std::uint32_t slot = begin(r); slot < begin(r + 1); ++slot) {
      if (slot % slots_ == 0) first_of_chunk_[slot / slots_] = next;
      for (std::uint32_t& v : data_.corners[slot]) {
        v = run_[r].used[v];
        next = std::max(next, v + 1);
      }
    }
  }

  Bvh::Data& data_;
  const MeshView& mesh_;
  std::uint32_t runs_;
  std::vector<Run> run_;
  std::uint32_t slots_;                        ///< of a chunk
  std::vector<std::uint32_t> first_of_chunk_;  ///< as `place_vertices` returns it
  FrameMap to_working_;
};

}  // namespace

std::vector<std::uint32_t> place_vertices(Bvh::Data& data, const MeshView& mesh, std::size_t runs) {
  data.corners.resize(mesh.triangle_count());
  data.vertices.resize(std::min(mesh.vertex_count(), 3 * mesh.triangle_count()));
  data.source_vertex.resize(data.vertices.size() + 1);  // as `Run::used`
  const Arena::Loan loan(data.arena);
  return Renumbering(data, mesh, runs).run();
}

}  // namespace meshbound
