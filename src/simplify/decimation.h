// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "geometry/position_table.h"
#include "meshbound/simplify.h"
#include "simplify/decimate.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/mesh/spatial_order.h"
#include "simplify/proven_mesh.h"
#include "simplify/working_frame.h"

namespace meshbound {

/// One decimation under growing tolerances: the state in its working frame, and the maps into that frame and back.
class Decimation {
 public:
  /// `original` and `options` must outlive this. `at_rim`: by vertex of the start, or empty (see `manifold_soup`).
  /// Throws `Stopped`.
  Decimation(const TriangleMesh& original, const SimplifyOptions& options, const StopToken& stop,
             const std::vector<bool>& at_rim = {});
  /// Continues from `start`, which must outlive this. `SimplifyOptions::locked_vertices` are then by the vertices of
  /// `start`, and the sources of a result refer to `start` instead of the original. `start` has no lines and no
  /// tolerances of faces.
  Decimation(const TriangleMesh& original, const ProvenMesh& start, const SimplifyOptions& options,
             const StopToken& stop, const std::vector<bool>& at_rim = {});

  /// Decimates until nothing fits, `target_faces` are left or `stop` says so. `tolerance` in model units, not smaller
  /// than in the call before.
  EndedBy run(double tolerance, std::size_t target_faces, const StopToken& stop);

  /// From now on the texture may move so far, model units, instead of `SimplifyOptions::texture_tolerance`. Needs
  /// texture coordinates in the options.
  void set_texture_tolerance(double tolerance);

  /// Undoes what has led to triangles that a measurement of `current_mesh` refutes, for good. The numbers are those of
  /// the original and of `current_mesh`. False if there is nothing to undo. Needs texture coordinates or a tolerance
  /// for normals in the options.
  [[nodiscard]] bool take_back(std::span<const Refuted> refuted);

  /// The current mesh in model coordinates, with its sources. Vertices and triangles are in the order of the original.
  void current_mesh(SimplifiedLevel& into) const;
  /// The proof of `current_mesh`, without the triangles of the original that it contains unchanged.
  void current_proof(ProvenMesh& into) const;
  /// The triangles of `current_mesh` that face the other way than in the start, ascending.
  [[nodiscard]] std::vector<std::uint32_t> turned_faces() const;
  [[nodiscard]] CollapseCounts counts() const { return threads_->counts(); }
  void describe(SimplifyResult& result) const;
  /// Edges of the original that are feature lines, by the original's own vertex numbers.
  [[nodiscard]] const std::vector<Edge>& lines() const { return lines_; }

 private:
  Decimation(const TriangleMesh& original, const ProvenMesh* start, const SimplifyOptions& options,
             const StopToken& stop, const std::vector<bool>& at_rim);
  void make_state(const StopToken& stop, const std::vector<bool>& at_rim);
  [[nodiscard]] ManifoldSoup soup_of_start(std::span<const TriangleNeighbours> neighbours,
                                           const std::vector<bool>& at_rim);
  void start_as_original(OriginalOfDecimation original, ManifoldSoup soup, ArrayMesh mesh);
  void go_on_from_start(OriginalOfDecimation original, ManifoldSoup soup, ArrayMesh mesh);
  [[nodiscard]] const std::vector<Triangle>& start_triangles() const {
    return start_ != nullptr ? start_->mesh.triangles : order_.triangles;
  }
  /// A vertex of the original in model coordinates.
  [[nodiscard]] const Eigen::Vector3d& in_original(std::uint32_t v) const {
    return original_.vertices[order_.vertex[v]];
  }
  [[nodiscard]] const std::vector<Vec3>& start_points() const { return start_ != nullptr ? start_points_ : vertices_; }
  [[nodiscard]] std::uint32_t caller_vertex(std::uint32_t v) const { return start_ != nullptr ? v : order_.vertex[v]; }
  [[nodiscard]] std::uint32_t caller_triangle(std::uint32_t t) const {
    return start_ != nullptr ? t : order_.triangle[t];
  }
  [[nodiscard]] std::vector<std::uint32_t> faces_in_order() const;
  [[nodiscard]] std::vector<std::uint32_t> index_of_caller_triangle() const;
  [[nodiscard]] std::optional<std::uint32_t> first_at(Vec3 p) const;
  [[nodiscard]] std::vector<std::uint8_t> locked() const;
  void lock_features(std::vector<std::uint8_t>& locked) const;
  void lock_cuts(std::vector<std::uint8_t>& locked) const;
  [[nodiscard]] bool has_lines() const {
    return options_.line_tolerance || !options_.feature_edges.empty() || !options_.texture_coordinates.empty() ||
           (options_.keep_sides && has_turned_faces_);
  }
  /// Whether the side of a triangle that shows matters.
  [[nodiscard]] bool keeps_sides() const { return options_.keep_sides || bounds_appearance(); }
  /// Whether changes may be taken back for what a measurement of texture or normals finds.
  [[nodiscard]] bool bounds_appearance() const {
    return !options_.texture_coordinates.empty() || options_.normal_tolerance.has_value();
  }
  void set_lines();
  [[nodiscard]] std::vector<std::uint8_t> marked_edges() const;
  [[nodiscard]] bool is_seam(Corner edge) const;
  void note_turned_faces();
  void set_texture();
  void set_turns();
  [[nodiscard]] int threads() const;
  [[nodiscard]] std::uint32_t source_of(std::uint32_t vertex) const;
  [[nodiscard]] std::vector<double> limits_in_frame() const;
  [[nodiscard]] double room(double reach) const;
  [[nodiscard]] Eigen::Vector3d in_model(std::uint32_t vertex) const;
  [[nodiscard]] Eigen::Vector3d as_written(const Eigen::Vector3d& point) const;
  [[nodiscard]] double rounding_of_output(double reach) const;

  const ProvenMesh* start_;       ///< null: the original itself
  std::size_t start_vertices_;    ///< that the caller knows
  SpatialOrder order_;            ///< of the original: all indices here are by it
  const TriangleMesh& original_;  ///< as the caller has it
  const SimplifyOptions& options_;
  WorkingFrame frame_;
  Eigen::Vector3d largest_ = Eigen::Vector3d::Zero();  ///< magnitude of a coordinate of the original on each axis
  std::vector<Vec3> vertices_;                         ///< of the original, in the frame
  std::vector<Vec3> start_points_;                     ///< vertices of `start_`, in the frame
  std::vector<std::uint32_t> first_of_start_;  ///< by vertex of the start: the first one there, until the soup is made
  PositionTable at_start_point_;               ///< the vertices of the start by position
  Bvh tree_;                                   ///< in the frame
  std::optional<DecimationState> state_;
  std::optional<DecimationThreads> threads_;
  std::size_t dropped_triangles_ = 0, locked_vertices_ = 0, pruned_components_ = 0, pruned_faces_ = 0;
  std::vector<Edge> lines_;  ///< of the original, by its own numbers
  /// By face, if `keeps_sides` or the start was split: its corners run the other way than in the start.
  std::vector<std::uint8_t> is_turned_over_;
  bool has_turned_faces_ = false;
  bool split_ = false, below_rounding_ = false;
};

}  // namespace meshbound
