// SPDX-License-Identifier: MIT
#include "penetration/volumes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "numeric/rounding.h"
#include "penetration/flush.h"
#include "penetration/parity.h"
#include "penetration/triangulate.h"

namespace meshbound {
namespace {

std::size_t count_different(std::vector<std::uint32_t> sources) {
  std::sort(sources.begin(), sources.end());
  return static_cast<std::size_t>(std::unique(sources.begin(), sources.end()) - sources.begin());
}

CornerTriple whole_triangle(const Triangle& t) {
  return {{{PieceCorner::Kind::Vertex, t[0]}, {PieceCorner::Kind::Vertex, t[1]}, {PieceCorner::Kind::Vertex, t[2]}}};
}

/// Directions of the rays from a cavity to the shell around it, tried in turn until one ray passes no edge.
constexpr std::array<Vec3, 6> directions{{{0.31, 0.17, 0.93},
                                          {-0.71, 0.43, 0.56},
                                          {0.29, -0.87, 0.41},
                                          {0.83, 0.37, -0.42},
                                          {-0.53, -0.61, -0.59},
                                          {0.11, 0.97, -0.23}}};

}  // namespace

void Patch::add(std::uint32_t source, const CornerTriple& corners) {
  const auto first = static_cast<std::uint32_t>(sources.size());
  sources.push_back(source);
  triangles.push_back({first, first + 1, corners});
}

void Patch::add(const Patch& other) {
  const auto shift = static_cast<std::uint32_t>(sources.size());
  sources.insert(sources.end(), other.sources.begin(), other.sources.end());
  for (const PatchTriangle& t : other.triangles)
    triangles.push_back({t.first_source + shift, t.end_source + shift, t.corners});
  displacement = std::max(displacement, other.displacement);
}

const Vec3& VolumeFinder::position(std::uint32_t side, PieceCorner corner) const {
  return position_of(*pair_, *curves_, side, corner);
}

double VolumeFinder::error(std::uint32_t side, PieceCorner corner) const {
  return error_of(*pair_, *curves_, side, corner);
}

std::vector<IntersectionVolume> VolumeFinder::find(PlacedPair& pair, CrossingCurves& curves, Pieces& pieces, Cut cut) {
  pair_ = &pair;
  curves_ = &curves;
  pieces_ = &pieces;
  borders_.begin(pair, curves, pieces);
  std::vector<Shell> shells;
  std::unordered_map<std::uint32_t, std::size_t> shell_of;
  for (std::uint32_t piece = 0; piece < pieces.pieces.size(); ++piece) {
    const auto [found, is_new] = shell_of.try_emplace(pieces.shells.find(piece), shells.size());
    if (is_new) shells.emplace_back();
    shells[found->second].pieces.push_back(piece);
  }
  for (Shell& shell : shells) {
    find_sign(shell);
    if (shell.sign != 0) triangulate_shell(shell, cut);
  }
  std::vector<IntersectionVolume> volumes;
  for (Shell& shell : shells) {
    if (shell.sign <= 0) continue;
    shell.volume = volumes.size();
    volumes.emplace_back().content = shell.content;
  }
  if (volumes.empty()) return volumes;
  for (Shell& shell : shells) {
    if (shell.sign >= 0) continue;
    shell.volume = shell_around(shell, shells);
    Bounds& content = volumes[shell.volume].content;
    content = {std::max(0.0, next_down(content.lower + shell.content.lower)),
               next_up(content.upper + shell.content.upper)};
  }
  for (const Shell& shell : shells) {
    if (shell.sign == 0) continue;
    for (std::size_t side = 0; side < 2; ++side) volumes[shell.volume].patches[side].add(shell.patches[side]);
  }
  const auto patches_of = [&](std::uint32_t piece) -> std::array<Patch, 2>* {
    const Shell& shell = shells[shell_of.at(pieces.shells.find(piece))];
    return shell.sign == 0 ? nullptr : &volumes[shell.volume].patches;
  };
  for (const FlushFace& face : find_flush_faces(pair, curves, pieces))
    if (std::array<Patch, 2>* const patches = patches_of(face.piece))
      for (std::size_t k = 2; k < face.corners.size(); ++k)
        (*patches)[face.side].add(face.triangle, {{face.corners[0], face.corners[k - 1], face.corners[k]}});
  for (const Shell& shell : shells)
    if (shell.sign > 0) surround(volumes[shell.volume], shell);
  for (IntersectionVolume& volume : volumes)
    for (std::uint32_t side = 0; side < 2; ++side) {
      Patch& patch = volume.patches[side];
      patch.faces = count_different(patch.sources);
      double largest = 0;
      for (const PatchTriangle& t : patch.triangles)
        for (const PieceCorner& corner : t.corners) largest = std::max(largest, error(side, corner));
      patch.displacement = next_up(patch.displacement + largest);
    }
  return volumes;
}

/// Bounds the content of a shell and decides its sign.
void VolumeFinder::find_sign(Shell& shell) {
  measure_content(shell);
  if (shell.content.lower <= 0 && shell.content.upper >= 0) {
    shell.sign = exact_content_sign(shell);
    if (shell.sign > 0) shell.content.lower = 0;
    if (shell.sign < 0) shell.content.upper = 0;
  } else {
    shell.sign = shell.content.lower > 0 ? 1 : -1;
  }
}

/// Visits triangles that cover a shell, counted with the sign of their turn: fans of its cycles.
template <class Visit>
void VolumeFinder::visit_fans(const Shell& shell, const Visit& visit) {
  for (const std::uint32_t index : shell.pieces) {
    const Piece& piece = pieces_->pieces[index];
    for (const std::span<const PieceCorner> cycle : pieces_->border_of(piece))
      for (std::size_t k = 2; k < cycle.size(); ++k) {
        pair_->count_step();
        visit(piece.side, CornerTriple{cycle[0], cycle[k - 1], cycle[k]});
      }
  }
}

/// Bounds the volume of a shell. Six times the volume is the sum of the determinants of the triangles. If the corners
/// of a triangle are off by at most d, the volume changes by at most d times the largest area that the triangle has
/// between its computed and its exact position.
void VolumeFinder::measure_content(Shell& shell) {
  const Piece& first = pieces_->pieces[shell.pieces[0]];
  const Vec3 o = position(first.side, pieces_->border_of(first)[0][0]);
  double sum = 0, magnitude = 0, moved = 0, count = 0;
  visit_fans(shell, [&](std::uint32_t side, const CornerTriple& corners) {
    const Vec3 a = position(side, corners[0]) - o, b = position(side, corners[1]) - o,
               c = position(side, corners[2]) - o;
    sum += dot(a, cross(b, c));
    magnitude += length(a) * length(b) * length(c);
    const double edges = length(b - a) + length(c - b) + length(a - c);
    const double d = std::max({error(side, corners[0]), error(side, corners[1]), error(side, corners[2])});
    moved += d * (length(cross(b - a, c - a)) / 2 + d * (edges + 4 * d));
    count += 1;
  });
  // At most 32 u for a term including cancellation, n u for the sum; areas and lengths are off by a few u; doubled for
  // safety.
  const double error = 2 * (magnitude * unit_roundoff * (32 + count) + 6 * moved) + 0x1p-900;
  shell.content = {next_down((sum - error) / 6), next_up((sum + error) / 6)};
}

int VolumeFinder::exact_content_sign(const Shell& shell) {
  mpq_class sum = 0;
  visit_fans(shell, [&](std::uint32_t side, const CornerTriple& corners) {
    std::array<ExactNode, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = exact_position_of(*pair_, *curves_, side, corners[k]);
    mpq_class term(dot(p[0].numerator, cross(p[1].numerator, p[2].numerator)),
                   p[0].denominator * p[1].denominator * p[2].denominator);
    term.canonicalize();
    sum += term;
  });
  return sgn(sum);
}

/// Cuts the faces of a shell into triangles. Those without area are left out, as they enclose nothing: they come from a
/// touch that the perturbation made an overlap.
void VolumeFinder::triangulate_shell(Shell& shell, Cut cut) {
  const auto face_of = [&](std::uint32_t piece) { return cut == Cut::Faces ? pieces_->faces.find(piece) : piece; };
  std::stable_sort(shell.pieces.begin(), shell.pieces.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return face_of(a) < face_of(b); });
  const std::span<const std::uint32_t> pieces(shell.pieces);
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    while (end < pieces.size() && face_of(pieces[end]) == face_of(pieces[begin])) ++end;
    triangulate_face(pieces.subspan(begin, end - begin), cut, shell);
  }
}

void VolumeFinder::triangulate_face(std::span<const std::uint32_t> face, Cut cut, Shell& shell) {
  pair_->count_steps(face.size());
  const Piece& first = pieces_->pieces[face[0]];
  Patch& patch = shell.patches[first.side];
  if (face.size() == 1 && first.is_whole_triangle()) {
    patch.add(first.triangle, whole_triangle(pair_->model(first.side).triangles[first.triangle]));
    return;
  }
  const std::span<const std::span<const PieceCorner>> border =
      cut == Cut::Faces ? borders_.trace(face) : pieces_->border_of(first);
  if (border.empty()) return;
  const PiecePlane plane(*pair_, *curves_, first.side, first.triangle);
  triangles_.clear();
  patch.displacement = std::max(patch.displacement, triangulate(plane, border, triangles_));
  const auto has_no_area = [&](const CornerTriple& t) { return plane.turn(t[0], t[1], t[2]) == 0; };
  std::erase_if(triangles_, has_no_area);
  if (triangles_.empty()) return;
  const auto first_source = static_cast<std::uint32_t>(patch.sources.size());
  for (const std::uint32_t index : face) {
    const Piece& piece = pieces_->pieces[index];
    if (face.size() == 1 || piece.is_whole_triangle() || plane.area_sign(pieces_->border_of(piece)) != 0)
      patch.sources.push_back(piece.triangle);
  }
  const auto end_source = static_cast<std::uint32_t>(patch.sources.size());
  if (first_source == end_source) return;
  for (const CornerTriple& corners : triangles_) patch.triangles.push_back({first_source, end_source, corners});
}

/// Whether a ray crosses a shell an odd number of times: 1 or 0, or -1 if rounding could change the answer.
int VolumeFinder::parity_of(const Shell& shell, const Vec3& from, const Vec3& direction) const {
  // Much larger than the error of corners; coordinates of magnitude 1 make products of a few at most.
  constexpr double margin = 0x1p-30;
  int parity = 0;
  for (std::uint32_t side = 0; side < 2; ++side)
    for (const PatchTriangle& t : shell.patches[side].triangles) {
      pair_->count_step();
      const Vec3 a = position(side, t.corners[0]) - from, b = position(side, t.corners[1]) - from,
                 c = position(side, t.corners[2]) - from;
      const double u = dot(direction, cross(a, b)), v = dot(direction, cross(b, c)), w = dot(direction, cross(c, a));
      const double scale = margin * std::max({length(a), length(b), length(c)}) *
                           std::max({length(b - a), length(c - b), length(a - c)});
      if (std::min({u, v, w}) < -scale && std::max({u, v, w}) > scale) continue;
      const double sum = u + v + w;
      const bool is_hit = std::min({u, v, w}) > scale || std::max({u, v, w}) < -scale;
      const double along = dot(a, cross(b, c));
      if (!is_hit || std::fabs(along) <= scale * length(a)) return -1;
      if ((along > 0) == (sum > 0)) parity = 1 - parity;
    }
  return parity;
}

/// The smallest shell around a cavity. If rounding hides which that is, the largest shell gets the cavity, which is
/// then as thin as rounding errors.
std::size_t VolumeFinder::shell_around(const Shell& cavity, const std::vector<Shell>& shells) {
  const std::uint32_t side = cavity.patches[0].triangles.empty() ? 1 : 0;
  const PatchTriangle& t = cavity.patches[side].triangles[0];
  const Vec3 from =
      (1.0 / 3) * (position(side, t.corners[0]) + position(side, t.corners[1]) + position(side, t.corners[2]));
  const Shell *best = nullptr, *largest = nullptr;
  for (const Shell& shell : shells) {
    if (shell.sign <= 0) continue;
    if (largest == nullptr || shell.content.upper > largest->content.upper) largest = &shell;
    int parity = -1;
    for (std::size_t i = 0; i < directions.size() && parity < 0; ++i) parity = parity_of(shell, from, directions[i]);
    if (parity == 1 && (best == nullptr || shell.content.upper < best->content.upper)) best = &shell;
  }
  return best != nullptr ? best->volume : largest->volume;
}

/// Adds the component that a volume lies in, for a volume whose boundary has no part of one of the models: it is then
/// inside that model's solid, and the nearest component around it stands for the missing part.
void VolumeFinder::surround(IntersectionVolume& volume, const Shell& outer) {
  for (std::uint32_t side = 0; side < 2; ++side) {
    if (!volume.patches[side].triangles.empty()) continue;
    volume.overlap = side == 0 ? Overlap::BInsideA : Overlap::AInsideB;
    add_component(volume, side, component_around(side, outer));
  }
}

std::uint32_t VolumeFinder::component_around(std::uint32_t side, const Shell& shell) {
  const ClosedModel::Data& model = pair_->model(side);
  std::uint32_t next = no_index;
  for (const PatchTriangle& t : shell.patches[1 - side].triangles)
    for (const PieceCorner& corner : t.corners) {
      if (corner.kind == PieceCorner::Kind::Node) {
        // No vertex is inside: it touches this component.
        const CurveNode& node = curves_->nodes[corner.index];
        next = model.component_of[node.side == side ? model.edges[node.edge].triangle[0] : node.triangle];
        continue;
      }
      // The innermost of nested components has the smallest extent in every direction.
      const std::vector<bool> around = components_around(*pair_, {1 - side, corner.index});
      const auto reach = [&](std::size_t i) { return model.positions[model.components[i].extremes[3]].x; };
      std::size_t innermost = around.size();
      for (std::size_t i = 0; i < around.size(); ++i)
        if (around[i] && (innermost == around.size() || reach(i) < reach(innermost))) innermost = i;
      return static_cast<std::uint32_t>(innermost);
    }
  return next;
}

void VolumeFinder::add_component(IntersectionVolume& volume, std::uint32_t side, std::uint32_t component) {
  const ClosedModel::Data& model = pair_->model(side);
  for (std::uint32_t i = 0; i < model.triangles.size(); ++i) {
    const Triangle& t = model.triangles[i];
    if (model.component_of[i] == component) volume.patches[side].add(i, whole_triangle(t));
  }
}

}  // namespace meshbound
