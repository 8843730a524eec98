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

constexpr std::uint32_t unused = 0xffffffff;

/// Slots are 30-bit numbers in the adjacency.
constexpr std::size_t most_triangles = std::size_t{1} << 30;

Vec3 to_vec3(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

void check_size(const MeshView& mesh) {
  if (mesh.triangle_count() >= most_triangles)
    throw InvalidInput("the mesh has " + std::to_string(mesh.triangle_count()) +
                       " triangles; a tree holds fewer than 2^30, split the mesh");
}

/// Working coordinates of all vertices (of unused ones too: they may be anything, and are dropped by `place`).
std::vector<Vec3> working_vertices(const MeshView& mesh, const Frame& frame, int threads) {
  std::vector<Vec3> working(mesh.vertex_count());
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < working.size(); ++i) working[i] = frame.to_working(to_vec3(mesh.vertex(i)));
  return working;
}

/// The same triangle, turned so that its first edge is the longest (what `closest_on_triangle` asks for).
Triangle longest_edge_first(const Triangle& t, const std::vector<Vec3>& working) {
  const std::uint32_t first = longest_edge(working[t[0]], working[t[1]], working[t[2]]);
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

/// Renumbers vertices by first use along the curve: neighbours in space become neighbours in memory.
void place(Bvh::Data& data, const MeshView& mesh, const std::vector<Vec3>& working) {
  std::vector<std::uint32_t> place_of(mesh.vertex_count(), unused);
  data.corners.resize(mesh.triangle_count());
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const Triangle t = longest_edge_first(mesh.triangle(data.triangle_of_slot[slot]), working);
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& at = place_of[t[k]];
      if (at == unused) {
        at = static_cast<std::uint32_t>(data.vertices.size());
        data.vertices.push_back(working[t[k]]);
        data.source_vertex.push_back(t[k]);
        data.frame.error = std::max(data.frame.error, data.frame.rounding_of(to_vec3(mesh.vertex(t[k]))));
      }
      data.corners[slot][k] = at;
    }
  }
}

int thread_count(int wanted) { return wanted > 0 ? wanted : omp_get_max_threads(); }

std::unique_ptr<const Bvh::Data> build(const MeshView& mesh, int threads) {
  check_floating_point_model();
  validate(mesh);
  check_size(mesh);
  auto data = std::make_unique<Bvh::Data>();
  set_frame(*data, used_bounding_box(mesh));
  {
    const std::vector<Vec3> working = working_vertices(mesh, data->frame, threads);
    data->triangle_of_slot = hilbert_order(mesh, working, data->working_box, threads);
    data->vertices.reserve(std::min(mesh.vertex_count(), 3 * mesh.triangle_count()));
    data->source_vertex.reserve(data->vertices.capacity());
    place(*data, mesh, working);
  }
  build_adjacency(*data, threads);
  build_blocks(*data, threads);
  build_nodes(*data, threads);
  return data;
}

template <class T>
std::size_t bytes(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
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

std::uint32_t longest_edge(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = squared_length(b - a), bc = squared_length(c - b), ca = squared_length(a - c);
  if (ab >= bc && ab >= ca) return 0;
  return bc >= ca ? 1 : 2;
}

Bvh::Bvh(const MeshView& mesh, const BvhOptions& options) : data_(build(mesh, thread_count(options.threads))) {}
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;
Bvh::~Bvh() = default;

std::size_t Bvh::triangle_count() const { return data_->corners.size(); }
const Eigen::AlignedBox3d& Bvh::bounding_box() const { return data_->bounding_box; }
double Bvh::bounding_box_diagonal() const { return data_->diagonal; }

std::size_t Bvh::memory_bytes() const {
  const Data& d = *data_;
  return sizeof(Data) + bytes(d.vertices) + bytes(d.source_vertex) + bytes(d.corners) + bytes(d.neighbours) +
         bytes(d.normals) + bytes(d.triangle_of_slot) + bytes(d.blocks) + bytes(d.nodes) + bytes(d.level_begin);
}

}  // namespace meshbound
