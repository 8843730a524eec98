// SPDX-License-Identifier: MIT
#include "verify/verifier.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "verify/checksum.h"
#include "verify/mesh_edges.h"
#include "verify/near_triangle.h"
#include "verify/parity_check.h"
#include "verify/pieces.h"
#include "verify/scaling.h"
#include "verify/work.h"

namespace meshbound::verify {
namespace {

/// Cuts on the way to a piece: enough to halve the sides of a triangle forty times each.
constexpr int deepest_cut = 128;

/// Work that proofs about surfaces and lines may cost for each byte and triangle: some 25 us. Proofs for 25 models, at
/// 0.01% to 3% of their diagonals, need up to 14, nearly all of it for proofs by parity. A piece that keeps to one
/// triangle and all corners of which, exactly at the tolerance, must be decided by rationals needs about 20 for each,
/// or 30 behind eight cuts with bytes of their own.
constexpr std::uint64_t surface_work_per_unit = 256;

Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Walks over the trees of one direction, with the tokens at hand.
class DirectionCheck {
 public:
  DirectionCheck(const TriangleMesh& source, const TriangleMesh& target, double tolerance, const Section& section,
                 const char* source_name, const char* element = "triangle")
      : source_(source),
        target_(target),
        tolerance_(tolerance),
        section_(section),
        source_name_(source_name),
        element_(element),
        tokens_(section.tokens),
        work_(surface_work_per_unit, section.tokens.size() + source.triangles.size() + target.triangles.size()),
        last_at_(source.vertices.size(), 0) {}

  Proof::Direction run() {
    result_.bytes = section_.tokens.size();
    for (triangle_ = 0; triangle_ < source_.triangles.size(); ++triangle_) {
      shape_ = corners_of(source_, triangle_);
      corners_.start(shape_);
      check({0, 1, 2}, 0);
      for (const std::uint32_t vertex : source_.triangles[triangle_]) last_at_[vertex] = last_;
    }
    if (!tokens_.at_end()) throw Rejected("the proof goes on after its last triangle");
    if (result_.pieces != section_.pieces)
      throw Rejected("the number of pieces in the header is not that of the proof");
    result_.work = work_.done();
    return result_;
  }

 private:
  /// A node of the tree and all below it.
  void check(const Piece& piece, int depth) {
    const Token token = tokens_.next();
    if (token.kind == Token::Kind::Cut) {
      if (depth == deepest_cut) fail("is cut too often");
      ++result_.cuts;
      const std::uint32_t size = corners_.size();
      const auto [first, second] = corners_.cut(piece, token);
      check(first, depth + 1);
      check(second, depth + 1);
      corners_.shrink(size);
      return;
    }
    ++result_.pieces;
    last_ = target_of(token);
    if (token.kind == Token::Kind::Parity) {
      ++result_.by_parity;
      if (!parity_) parity_ = std::make_unique<ParityCheck>(target_, tolerance_, work_);
      const bool holds = parity_->proves(shape_, corners_, piece, last_);
      require_work();
      if (!holds) fail("has a piece whose proof by parity does not hold");
      return;
    }
    const Corners near = corners_of(target_, last_);
    for (const std::uint32_t corner : piece)
      if (!corner_is_near(corner, near)) fail("has a piece that is not within the tolerance of its triangle");
  }

  std::uint32_t target_of(const Token& token) const {
    if (token.kind == Token::Kind::Recall) return last_at_[source_.triangles[triangle_][token.corner]];
    const std::int64_t index = static_cast<std::int64_t>(last_) + token.step;
    if (index < 0 || index >= static_cast<std::int64_t>(target_.triangles.size()))
      fail("names a triangle that the other mesh does not have");
    return static_cast<std::uint32_t>(index);
  }

  bool corner_is_near(std::uint32_t corner, const Corners& near) {
    const Eigen::Vector3d* const given = corners_.given(corner);
    if (given != nullptr && (*given == near[0] || *given == near[1] || *given == near[2])) return true;
    if (surely_near(corners_.rough(corner), near, tolerance_)) return true;
    ++result_.exact_decisions;
    const Vec<Exact>& exact = corners_.exact(corner);
    work_.add_exact(bits_of(exact) + bits_of(near[0]) + bits_of(near[1]) + bits_of(near[2]));
    require_work();
    return is_near(exact, near, tolerance_);
  }

  void require_work() const {
    if (work_.is_too_much()) fail("costs too much to check");
  }

  [[noreturn]] void fail(const char* why) const {
    throw Rejected(std::string(element_) + " " + std::to_string(triangle_) + " of the " + source_name_ + " mesh " +
                   why);
  }

  const TriangleMesh& source_;
  const TriangleMesh& target_;
  double tolerance_;
  Section section_;
  const char* source_name_;
  const char* element_;  ///< what a triangle of the source is called
  TokenReader tokens_;
  Work work_;
  std::vector<std::uint32_t> last_at_;  ///< by source vertex: the triangle used last there
  std::uint32_t last_ = 0;
  std::size_t triangle_ = 0;
  Corners shape_;
  PieceCorners corners_;
  std::unique_ptr<ParityCheck> parity_;
  Proof::Direction result_;
};

/// The meshes of a file are so already; those of a caller may not be.
void require_mesh(const TriangleMesh& mesh, const char* name) {
  const std::string which = std::string("the ") + name + " mesh ";
  if (mesh.triangles.empty()) throw Rejected(which + "has no triangles");
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) throw Rejected(which + "is too large");
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t)
      if (vertex >= mesh.vertices.size() || !mesh.vertices[vertex].allFinite())
        throw Rejected(which + "has a triangle without finite corners");
}

void require_identity(const TriangleMesh& mesh, const MeshIdentity& claimed, const char* name) {
  if (identity_of(mesh) != claimed)
    throw Rejected(std::string("the ") + name + " mesh is not the one that the certificate was made for");
}

/// Everything here relies on doubles rounded to nearest.
void require_ieee_doubles() {
  volatile double one = 1, half_step = 0x1p-53, smallest = std::numeric_limits<double>::denorm_min();
  if (one + half_step != 1 || one - half_step == 1 || one + 3 * half_step <= 1 + half_step || smallest / 2 != 0 ||
      smallest * 1 == 0)
    throw std::runtime_error("this build or processor mode does not round doubles as IEEE 754 says");
}

/// A scale for all vertices of both meshes with finite coordinates and the tolerances: no two vertices become equal.
double scale_for(const TriangleMesh& original, const TriangleMesh& simplified, const Certificate& certificate) {
  return common_scale([&](const auto& visit) {
    for (const TriangleMesh* mesh : {&original, &simplified})
      for (const Eigen::Vector3d& vertex : mesh->vertices)
        if (vertex.allFinite()) std::for_each(vertex.begin(), vertex.end(), visit);
    visit(certificate.tolerance);
    if (certificate.lines) visit(certificate.lines->tolerance);
    if (certificate.texture) visit(certificate.texture->tolerance);
  });
}

TriangleMesh scaled(TriangleMesh mesh, double scale) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= scale;
  return mesh;
}

Proof::Lines check_lines(const TriangleMesh& original, const TriangleMesh& simplified, const LinePart& part,
                         double scale) {
  const MeshEdges original_edges(original), simplified_edges(simplified);
  const TriangleMesh original_lines = original_edges.lines(part.original, "original");
  const TriangleMesh simplified_lines = simplified_edges.lines(part.simplified, "simplified");
  const auto check = [&](const TriangleMesh& source, const TriangleMesh& target, const Section& section,
                         const char* name) {
    return DirectionCheck(source, target, scale * part.tolerance, section, name, "line").run();
  };
  Proof::Lines proof{part.tolerance, part.original.size(), part.simplified.size(), false, {}, {}};
  proof.has_all_borders =
      original_edges.has_all_borders(part.original) && simplified_edges.has_all_borders(part.simplified);
  proof.original_to_simplified = check(original_lines, simplified_lines, part.original_to_simplified, "original");
  proof.simplified_to_original = check(simplified_lines, original_lines, part.simplified_to_original, "simplified");
  return proof;
}

Proof::Texture check_texture_part(const TexturedFile& original, const TexturedFile& simplified, const TexturePart& part,
                                  double scale) {
  if (original.attributes == nullptr || simplified.attributes == nullptr)
    throw Rejected("the certificate speaks of texture, but no texture coordinates were given");
  auto surfaces = texture_surfaces(original, simplified);
  if (checksum_of(surfaces[0]) != part.original_checksum || checksum_of(surfaces[1]) != part.simplified_checksum)
    throw Rejected("the texture coordinates are not those that the certificate was made for");
  scale_coordinates(surfaces);
  const double tolerance = scale * part.tolerance;
  return {part.tolerance, check_texture(surfaces[0], surfaces[1], tolerance, part.original_to_simplified, "original"),
          check_texture(surfaces[1], surfaces[0], tolerance, part.simplified_to_original, "simplified")};
}

/// What the certificate proves of meshes that were multiplied by `scale`.
Proof check(const Certificate& certificate, const TexturedFile& original, const TexturedFile& simplified,
            double scale) {
  const auto direction = [&](const TexturedFile& source, const TexturedFile& target, const Section& section,
                             const char* name) {
    return DirectionCheck(*source.mesh, *target.mesh, scale * certificate.tolerance, section, name).run();
  };
  Proof proof;
  proof.tolerance = certificate.tolerance;
  proof.original_to_simplified = direction(original, simplified, certificate.original_to_simplified, "original");
  proof.simplified_to_original = direction(simplified, original, certificate.simplified_to_original, "simplified");
  if (certificate.lines) proof.lines = check_lines(*original.mesh, *simplified.mesh, *certificate.lines, scale);
  if (certificate.texture) proof.texture = check_texture_part(original, simplified, *certificate.texture, scale);
  return proof;
}

}  // namespace

MeshIdentity identity_of(const TriangleMesh& mesh) {
  Checksum checksum;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) checksum.add_little_endian(std::bit_cast<std::uint64_t>(p[axis]), 8);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t vertex : t) checksum.add_little_endian(vertex, 4);
  return {mesh.vertices.size(), mesh.triangles.size(), checksum.value()};
}

Proof check_certificate(const TriangleMesh& original, const TriangleMesh& simplified,
                        std::span<const std::uint8_t> bytes, const MeshAttributes* original_attributes,
                        const MeshAttributes* simplified_attributes) {
  require_ieee_doubles();
  const Certificate certificate = parse_certificate(bytes);
  require_mesh(original, "original");
  require_mesh(simplified, "simplified");
  require_identity(original, certificate.original, "original");
  require_identity(simplified, certificate.simplified, "simplified");
  const double scale = scale_for(original, simplified, certificate);
  if (scale == 1)
    return check(certificate, {&original, original_attributes}, {&simplified, simplified_attributes}, scale);
  const TriangleMesh scaled_original = scaled(original, scale), scaled_simplified = scaled(simplified, scale);
  return check(certificate, {&scaled_original, original_attributes}, {&scaled_simplified, simplified_attributes},
               scale);
}

}  // namespace meshbound::verify
