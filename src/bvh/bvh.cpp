// SPDX-License-Identifier: MIT
#include "meshbound/bvh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "bvh/build.h"
#include "bvh/bvh_data.h"
#include "geometry/eigen_vec3.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {
namespace {

/// Slots are 30-bit numbers in the adjacency.
constexpr std::size_t max_triangles = std::size_t{1} << 30;

void check_size(const MeshView& mesh) {
  if (mesh.triangle_count() >= max_triangles)
    throw InvalidInput("the mesh has " + std::to_string(mesh.triangle_count()) +
                       " triangles; a tree holds fewer than 2^30, split the mesh");
}

/// The least and the largest coordinate on each axis, and the vertices that have them.
struct Extremes {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  double lo[3] = {infinity, infinity, infinity}, hi[3] = {-infinity, -infinity, -infinity};
  std::uint32_t at[6] = {};  ///< of `lo`, then of `hi`

  void extend(double x, int axis, std::uint32_t vertex) {
    if (x < lo[axis]) lo[axis] = x, at[axis] = vertex;
    if (x > hi[axis]) hi[axis] = x, at[3 + axis] = vertex;
  }
};

/// The extreme vertices of a mesh. `sound`: all coordinates may be used.
Extremes extremes_of(const MeshView& mesh, std::size_t vertices, std::atomic<bool>& sound) {
  std::vector<Extremes> of_task(vertices / triangles_per_task + 1);
  for_each_range(vertices, triangles_per_task, [&](std::size_t begin, std::size_t end) {
    Extremes own;
    bool own_sound = true;
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Vector3d p = mesh.vertex(v);
      for (int axis = 0; axis < 3; ++axis) {
        own_sound = own_sound && std::abs(p[axis]) <= largest_coordinate;
        own.extend(p[axis], axis, static_cast<std::uint32_t>(v));
      }
    }
    of_task[begin / triangles_per_task] = own;
    if (!own_sound) sound = false;
  });
  Extremes all;
  for (const Extremes& own : of_task) {
    for (int axis = 0; axis < 3; ++axis) {
      all.extend(own.lo[axis], axis, own.at[axis]);
      all.extend(own.hi[axis], axis, own.at[3 + axis]);
    }
  }
  return all;
}

/// Which of the six extreme vertices are used by triangles, a bit for each. `sound`: all indices are in range.
unsigned used_extremes(const MeshView& mesh, const Extremes& all, std::size_t vertices, std::atomic<bool>& sound) {
  std::vector<std::uint8_t> sides(vertices, 0);  // by vertex, the bits of those that it is
  for (unsigned side = 0; side < 6 && all.at[side] < vertices; ++side) {
    std::uint8_t& of_vertex = sides[all.at[side]];
    of_vertex = static_cast<std::uint8_t>(of_vertex | 1U << side);
  }
  std::atomic<unsigned> used{0};
  for_each_range(mesh.triangle_count(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
    unsigned own_used = 0;
    bool own_sound = true;
    for (std::size_t i = begin; i < end; ++i) {
      for (const std::uint32_t v : mesh.triangle(i)) {
        if (v < vertices)
          own_used |= sides[v];
        else
          own_sound = false;
      }
    }
    used |= own_used;
    if (!own_sound) sound = false;
  });
  return used;
}

/// As `used_bounding_box` after `validate`, by tasks: the box of all vertices is that of the used ones if those at its
/// sides are used, so that no two threads write to one table.
Eigen::AlignedBox3d checked_box(const MeshView& mesh) {
  constexpr std::uint64_t max_indexed = std::uint64_t{1} << 32;
  const auto vertices = static_cast<std::size_t>(std::min<std::uint64_t>(mesh.vertex_count(), max_indexed));
  std::atomic<bool> sound = mesh.triangle_count() > 0;
  const Extremes all = extremes_of(mesh, vertices, sound);
  const unsigned used = used_extremes(mesh, all, vertices, sound);
  Eigen::AlignedBox3d box(Eigen::Map<const Eigen::Vector3d>(all.lo), Eigen::Map<const Eigen::Vector3d>(all.hi));
  if (!sound || used != 0x3f) {
    validate(mesh);  // says what is wrong, and throws; or nothing, where what is wrong is not used
    box = used_bounding_box(mesh);
  }
  // -0 and 0 are one position.
  return {box.min() + Eigen::Vector3d::Zero(), box.max() + Eigen::Vector3d::Zero()};
}

std::size_t max_used_vertices(const MeshView& mesh) { return std::min(mesh.vertex_count(), 3 * mesh.triangle_count()); }

/// The arrays of `Bvh::Data`. Above the lowest level there are 1/8 + 1/64 + ... = 1/7 of its nodes.
std::size_t tree_bytes(const MeshView& mesh) {
  constexpr std::size_t by_triangle = sizeof(Triangle) + sizeof(EdgeNeighbours) + sizeof(std::array<float, 3>) +
                                      sizeof(std::uint32_t),
                        by_vertex = sizeof(Vec3) + sizeof(std::uint32_t), rounding = 4096;
  const std::size_t lowest_nodes = mesh.triangle_count() / (block_width * node_width);
  return by_triangle * mesh.triangle_count() + by_vertex * max_used_vertices(mesh) +
         sizeof(BvhNode) * (lowest_nodes + lowest_nodes / 7) + rounding;
}

/// `stop` is looked at between the steps, each of which takes about 50 ns for a triangle.
std::unique_ptr<const Bvh::Data> build(const MeshView& mesh, std::size_t runs, const StopToken& stop) {
  check_floating_point_model();
  check_size(mesh);
  stop.check();
  auto data = std::make_unique<Bvh::Data>(tree_bytes(mesh));
  if (runs > 1) data->arena.touch();
  set_frame(*data, checked_box(mesh));
  stop.check();
  hilbert_order(*data, mesh, runs);
  stop.check();
  const std::vector<std::uint32_t> first_vertex = place_vertices(*data, mesh, runs);
  stop.check();
  build_adjacency(*data, first_vertex, runs);
  stop.check();
  if (!build_nodes_and_normals(*data)) link_segments(*data);
  return data;
}

/// By how many threads the share of a mesh may exceed its number of runs: so much of its build is left to threads that
/// have finished, instead of cutting it into another run.
constexpr double tolerated_excess = 0.2;

/// Trees of several meshes. Threads are shared out by size; one that has built its tree helps with the tasks of others.
template <std::size_t count>
std::array<std::unique_ptr<const Bvh::Data>, count> build_all(const std::array<MeshView, count>& meshes,
                                                              const BvhOptions& options) {
  std::size_t triangles = 0;
  for (const MeshView& mesh : meshes) triangles += mesh.triangle_count();
  const std::size_t threads = useful_threads(options.threads, triangles);
  std::array<std::unique_ptr<const Bvh::Data>, count> trees;
  std::array<FirstError, count> errors;
  const auto build_one = [&](std::size_t i) {
    const std::size_t size = meshes[i].triangle_count();
    const auto share = static_cast<double>(threads) * static_cast<double>(size) / static_cast<double>(triangles + 1);
    const auto runs = static_cast<std::size_t>(std::ceil(share - tolerated_excess));
    errors[i].guard([&] {
      trees[i] = build(meshes[i], std::clamp<std::size_t>(runs, 1, 1 + size / triangles_per_thread), options.stop);
    });
  };
  if (needs_team(static_cast<int>(threads))) {
    on_any_thread(static_cast<int>(threads), count, build_one);
  } else {
    for (std::size_t i = 0; i < count; ++i) build_one(i);
  }
  for (const FirstError& error : errors) error.rethrow();
  return trees;
}

}  // namespace

std::size_t useful_threads(int wanted, std::size_t triangles) {
  const auto threads = static_cast<std::size_t>(thread_count(wanted));
  return std::min(threads, 1 + triangles / triangles_per_thread);
}

std::vector<std::uint32_t> triangles_along_curve(const MeshView& mesh, const BvhOptions& options) {
  check_floating_point_model();
  check_size(mesh);
  options.stop.check();
  Bvh::Data data;
  const std::size_t threads = useful_threads(options.threads, mesh.triangle_count());
  with_team(static_cast<int>(threads), [&] {
    set_frame(data, checked_box(mesh));
    options.stop.check();
    hilbert_order(data, mesh, threads);
  });
  options.stop.check();
  return {data.triangle_of_slot.begin(), data.triangle_of_slot.end()};
}

void set_frame(Bvh::Data& data, const Eigen::AlignedBox3d& box) {
  static std::atomic<std::uint64_t> last_serial{0};
  data.serial = ++last_serial;
  data.bounding_box = box;
  data.diagonal = diagonal_of(box);
  const Vec3 lo = to_vec3(data.bounding_box.min()), hi = to_vec3(data.bounding_box.max());
  data.frame = frame_for_box(lo, hi);
  data.working_box = {data.frame.to_working(lo), data.frame.to_working(hi)};
}

Bvh::Bvh(const MeshView& mesh, const BvhOptions& options) : Bvh(std::move(build_all<1>({mesh}, options)[0])) {}
Bvh::Bvh(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

std::pair<Bvh, Bvh> build_trees(const MeshView& a, const MeshView& b, const BvhOptions& options) {
  auto trees = build_all<2>({a, b}, options);
  return {Bvh(std::move(trees[0])), Bvh(std::move(trees[1]))};
}

std::size_t Bvh::triangle_count() const { return data_->corners.size(); }
const Eigen::AlignedBox3d& Bvh::bounding_box() const { return data_->bounding_box; }
double Bvh::bounding_box_diagonal() const { return data_->diagonal; }

}  // namespace meshbound
