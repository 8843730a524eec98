// SPDX-License-Identifier: MIT
#include "meshbound/bvh.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "bvh/build.h"
#include "bvh/bvh_data.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Slots are 30-bit numbers in the adjacency.
constexpr std::size_t most_triangles = std::size_t{1} << 30;

Vec3 to_vec3(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

void check_size(const MeshView& mesh) {
  if (mesh.triangle_count() >= most_triangles)
    throw InvalidInput("the mesh has " + std::to_string(mesh.triangle_count()) +
                       " triangles; a tree holds fewer than 2^30, split the mesh");
}

/// As `used_bounding_box` after `validate`, by all threads.
Eigen::AlignedBox3d checked_box(const MeshView& mesh, int threads) {
  const std::size_t triangles = mesh.triangle_count(), vertices = mesh.vertex_count();
  Array<std::uint8_t> used(vertices);
  bool sound = triangles > 0;
  Eigen::AlignedBox3d box;
#pragma omp parallel num_threads(threads)
  {
#pragma omp for schedule(static)
    for (std::size_t v = 0; v < vertices; ++v) used[v] = 0;
#pragma omp for schedule(static) reduction(&& : sound)
    for (std::size_t i = 0; i < triangles; ++i) {
      for (const std::uint32_t v : mesh.triangle(i)) {
        if (v < vertices)
          std::atomic_ref<std::uint8_t>(used[v]).store(1, std::memory_order_relaxed);
        else
          sound = false;
      }
    }
    Eigen::AlignedBox3d own;
#pragma omp for schedule(static) reduction(&& : sound)
    for (std::size_t v = 0; v < vertices; ++v) {
      if (used[v] == 0) continue;
      const Eigen::Vector3d p = mesh.vertex(v);
      sound = sound && std::abs(p.x()) <= largest_coordinate && std::abs(p.y()) <= largest_coordinate &&
              std::abs(p.z()) <= largest_coordinate;
      own.extend(p);
    }
#pragma omp critical(meshbound_box)
    box.extend(own);
  }
  if (!sound) validate(mesh);  // says what is wrong, and throws
  // -0 and 0 are one position, whichever the threads met first.
  return {box.min() + Eigen::Vector3d::Zero(), box.max() + Eigen::Vector3d::Zero()};
}

/// A build has some twenty parallel steps; below this many triangles each is over before another thread has woken up.
constexpr std::size_t triangles_per_thread = 4096;

int thread_count(int wanted, std::size_t triangles) {
  const int most = wanted > 0 ? wanted : omp_get_max_threads();
  return static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(most), 1 + triangles / triangles_per_thread));
}

std::unique_ptr<const Bvh::Data> build(const MeshView& mesh, int threads) {
  check_floating_point_model();
  check_size(mesh);
  auto data = std::make_unique<Bvh::Data>();
  set_frame(*data, checked_box(mesh, threads));
  hilbert_order(*data, mesh, threads);
  place_vertices(*data, mesh, threads);
  build_adjacency(*data, threads);
  build_normals(*data, threads);
  build_nodes(*data, threads);
  return data;
}

template <class Vector>
std::size_t bytes(const Vector& v) {
  return v.capacity() * sizeof(v[0]);
}

}  // namespace

void set_frame(Bvh::Data& data, const Eigen::AlignedBox3d& box) {
  static std::atomic<std::uint64_t> last_serial{0};
  data.serial = ++last_serial;
  data.bounding_box = box;
  data.diagonal = diagonal_of(box);
  const Vec3 lo = to_vec3(data.bounding_box.min()), hi = to_vec3(data.bounding_box.max());
  data.frame = frame_for_box(lo, hi);
  data.working_box = {data.frame.to_working(lo), data.frame.to_working(hi)};
}

Bvh::Bvh(const MeshView& mesh, const BvhOptions& options)
    : data_(build(mesh, thread_count(options.threads, mesh.triangle_count()))) {}
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

std::size_t Bvh::triangle_count() const { return data_->corners.size(); }
const Eigen::AlignedBox3d& Bvh::bounding_box() const { return data_->bounding_box; }
double Bvh::bounding_box_diagonal() const { return data_->diagonal; }

std::size_t Bvh::memory_bytes() const {
  const Data& d = *data_;
  return sizeof(Data) + bytes(d.vertices) + bytes(d.source_vertex) + bytes(d.corners) + bytes(d.neighbours) +
         bytes(d.normals) + bytes(d.triangle_of_slot) + bytes(d.nodes) + bytes(d.level_begin);
}

}  // namespace meshbound
