// SPDX-License-Identifier: MIT
#include "common/gated_output.h"

#include <algorithm>
#include <utility>

#include "common/sha256.h"
#include "common/standard_streams.h"
#include "geometry/position_table.h"
#include "mesh/file_bytes.h"
#include "mesh/mesh_arrays.h"
#include "mesh/readers.h"
#include "mesh/round_to_floats.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {
namespace {

/// Measured without any tree if the meshes are equal but for the rounding of coordinates.
HausdorffDistance distance_between(MeshWithTree& original, const TriangleMesh& mesh, DistanceOptions options,
                                   const StopToken& stop) {
  const StoredMesh* const stored = original.stored();
  const bool may_be_equal = stored == nullptr || stored->triangle_count() == mesh.triangles.size();
  if (options.method == Method::CellWalking && may_be_equal) {
    const double limit = std::min(*options.tolerance, options.error_bound.value_or(*options.tolerance));
    if (const auto distance = distance_without_trees(original.mesh(), mesh, limit)) return *distance;
  }
  if (stored != nullptr) {
    options.budget.seconds = std::min(options.budget.seconds, stop.seconds_left());
    return original.workers().measure(*stored, MeshInMemory(mesh), options);
  }
  const Bvh& original_tree = original.tree(stop);
  const Bvh mesh_tree(mesh, BvhOptions{options.threads, stop});
  options.budget.seconds = std::min(options.budget.seconds, stop.seconds_left());
  return hausdorff_distance(original_tree, mesh_tree, options);
}

/// Among points in the order of their first coordinates, the nearest one within a distance.
std::optional<Eigen::Vector3d> nearest_of(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& p,
                                          double distance) {
  const auto is_left = [](const Eigen::Vector3d& point, double x) { return point.x() < x; };
  std::optional<Eigen::Vector3d> nearest;
  for (auto point = std::lower_bound(points.begin(), points.end(), p.x() - distance, is_left);
       point != points.end() && point->x() <= p.x() + distance; ++point) {
    if ((*point - p).norm() > (nearest ? (*nearest - p).norm() : distance)) continue;
    nearest = *point;
  }
  return nearest;
}

}  // namespace

GatedOutput::GatedOutput(std::filesystem::path path, const StopToken& stop, const WriteOptions& options)
    : path_(std::move(path)), stop_(stop), options_(options) {
  (void)format_of(path_);
  restart();
}

void GatedOutput::restart() {
  file_ = std::make_unique<AtomicFile>(device_of(path_), AtomicFile::Stream::Staged, stop_);
}

Precision GatedOutput::precision() const {
  return stores_floats(format_of(path_), options_) ? Precision::Single : Precision::Double;
}

void GatedOutput::write(const TriangleMesh& mesh, std::span<const Edge> lines, const MeshAttributes& attributes,
                        std::size_t turned_faces) {
  restart();
  found_.turned_faces = turned_faces;
  found_.lines = line_mesh(mesh, lines);
  if (precision() == Precision::Single && !attributes.document) round_to_floats(found_.lines);
  if (workers_ != nullptr)
    workers_->write(*file_, path_, mesh, options_);
  else
    write_mesh(*file_, path_, mesh, options_, attributes);
  file_->complete();
}

TriangleMesh GatedOutput::written_mesh() const { return written_file(only_flag(), false).mesh; }

MeshFile GatedOutput::written_with_attributes() const { return written_file(only_flag(), true); }

MeshFile GatedOutput::written_file(const StopToken& stop, bool with_attributes) const {
  const FileBytes bytes(file_->staged(), stop);
  return parse_mesh(path_, bytes.bytes(), {stop.cancel, stop.deadline, with_attributes});
}

std::string GatedOutput::checksum() const { return sha256(FileBytes(file_->staged(), only_flag()).bytes()); }

const HausdorffDistance& GatedOutput::measure(MeshWithTree& original, const DistanceOptions& options) {
  found_.verdict = Verdict::Undecided;
  found_.texture.reset();
  found_.normals.reset();
  found_.narrowed_to.reset();
  const MeshFile file = written_file(stop_, original_texture_.has_value());
  const TriangleMesh& mesh = file.mesh;
  found_.summary = summarise(mesh);
  found_.distance = distance_between(original, mesh, options, stop_);
  found_.verdict = verdict_of(found_.distance.bounds, *options.tolerance);
  if (original_lines_ != nullptr && found_.verdict == Verdict::Within) measure_lines(mesh, options);
  if (found_.verdict == Verdict::Within) look_at(file, options.threads);
  return found_.distance;
}

bool GatedOutput::narrow(MeshWithTree& original, const DistanceOptions& options) {
  try {
    HausdorffDistance narrower = distance_between(original, written_file(stop_, false).mesh, options, stop_);
    for (const OneSidedDistance* direction : {&narrower.a_to_b, &narrower.b_to_a})
      if (direction->outcome != Outcome::Converged) return false;
    found_.distance = std::move(narrower);
    found_.narrowed_to = options.error_bound;
    return true;
  } catch (const Stopped&) {
    return false;
  }
}

void GatedOutput::look_at(const MeshFile& level, int threads) {
  found_.texture.reset();
  found_.normals.reset();
  if (original_texture_) measure_texture(level, threads);
  if (!original_normals_) return;
  const bool is_known = looked_at_ && looked_at_->mesh.vertices == level.mesh.vertices &&
                        looked_at_->mesh.triangles == level.mesh.triangles;
  if (!is_known)
    looked_at_ = LookedAt{level.mesh, normal_comparison_.measure(*original_normals_->mesh, level.mesh,
                                                                 {original_normals_->tolerance, threads})};
  found_.normals = looked_at_->normals;
}

void GatedOutput::measure_texture(const MeshFile& level, int threads) {
  auto meshes = textured_meshes(*original_texture_->mesh, *original_texture_->attributes, level.mesh, level.attributes);
  TextureDeviationOptions texture;
  texture.tolerance = original_texture_->tolerance;
  texture.error_bound = original_texture_->error_bound;
  texture.threads = threads;
  texture.stop = stop_;
  found_.texture = texture_comparison_.measure(std::move(meshes), texture);
}

bool GatedOutput::are_normals_within() const {
  return !original_normals_ || (found_.normals && found_.normals->exceeding.empty());
}

bool GatedOutput::is_texture_within() const {
  if (!original_texture_) return true;
  return found_.texture && verdict_of(found_.texture->bounds, original_texture_->tolerance) == Verdict::Within;
}

std::vector<Edge> GatedOutput::lines_of(const TriangleMesh& written) const {
  const std::vector<Vec3> positions = positions_of(written);
  const PositionTable table(positions);
  const auto vertex = [&](std::uint32_t v) {
    const Eigen::Vector3d& p = found_.lines.vertices[v];
    return table.find({p.x(), p.y(), p.z()});
  };
  std::vector<Edge> edges;
  for (const Triangle& line : found_.lines.triangles) edges.push_back({vertex(line[0]), vertex(line[1])});
  return edges;
}

void GatedOutput::measure_lines(const TriangleMesh& written, DistanceOptions options) {
  const auto before = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<Eigen::Vector3d> points = written.vertices;
  std::sort(points.begin(), points.end(), before);
  for (Eigen::Vector3d& p : found_.lines.vertices) {
    if (std::binary_search(points.begin(), points.end(), p, before)) continue;
    const auto written_as = nearest_of(points, p, original_lines_->rounding);
    if (!written_as)
      throw Error("internal error: a vertex of a feature line is not in " + path_.string() + " as it was written");
    p = *written_as;
  }
  options.tolerance = std::min(original_lines_->tolerance, *options.tolerance);
  options.budget.seconds = std::min(options.budget.seconds, stop_.seconds_left());
  const Bvh tree(found_.lines, BvhOptions{options.threads, stop_});
  found_.line_distance = hausdorff_distance(original_lines_->tree, tree, options);
  found_.verdict = verdict_of(found_.line_distance->bounds, *options.tolerance);
}

void GatedOutput::fall_back(const GatedOutput* smaller, MeshWithTree& original, std::span<const Edge> lines,
                            const MeshAttributes& attributes, DistanceOptions options) {
  stop_ = only_flag();
  if (smaller == nullptr) {
    write(original.mesh(), lines, attributes);
    options.budget = {};
    measure(original, options);
    return;
  }
  restart();
  file_->write(FileBytes(smaller->file_->staged(), stop_).bytes());
  file_->complete();
  found_ = smaller->found_;
}

void GatedOutput::publish() {
  if (found_.verdict != Verdict::Within || !keeps_appearance())
    throw Error(path_.string() + " is not proven to be within the tolerance: not written");
  file_->commit();
}

void GatedOutput::copy_rejected_to(const std::filesystem::path& path) const {
  AtomicFile copy(path);
  copy.write(FileBytes(file_->staged()).bytes());
  copy.commit();
}

}  // namespace meshbound::tools
