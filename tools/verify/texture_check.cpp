// SPDX-License-Identifier: MIT
#include "verify/texture_check.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace meshbound::verify {
namespace {

constexpr int deepest_texture_cut = 36;  ///< twelve halvings of the weight of each corner
constexpr int weight_bits = 40;          ///< levels are multiples of 2^-40
constexpr std::size_t max_rest = 256;    ///< pieces of what is not covered
constexpr std::size_t block_size = 32;   ///< triangles of a block of the index

/// Work that a proof may cost for each byte and triangle: some 50 us. Proofs for seven models of games, simplified at
/// 0.1% to 1% of their diagonals, need up to 16, those at a tolerance of 0 up to 23, and those for grids of squares of
/// which two triangles are left, whose corners lie on edges of the other mesh, up to 172.
constexpr std::uint64_t texture_work_per_unit = 512;

/// The first two weights of a point, rounded.
std::array<double, 2> rough_place(const DomainPoint& point) {
  const auto& w = point.rough;
  const double all = w[0].middle() + w[1].middle() + w[2].middle();
  return {w[0].middle() / all, w[1].middle() / all};
}

/// The area of a polygon in the plane of the first two weights, of which the whole triangle has 1/2; rounded.
double rough_area(const DomainPolygon& polygon) {
  double doubled = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::array<double, 2> p = rough_place(polygon[i].point),
                                q = rough_place(polygon[(i + 1) % polygon.size()].point);
    doubled += p[0] * q[1] - p[1] * q[0];
  }
  return std::fabs(doubled) / 2;
}

/// On which side of the line from p to q a point lies: 1 left, -1 right, 0 on it. Empty where doubles cannot tell.
std::optional<int> certain_side(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& point) {
  if (point == p || point == q) return 0;
  const Eigen::Vector2d way = q - p, to = point - p;
  const double left = way.x() * to.y(), right = way.y() * to.x(), size = std::fabs(left) + std::fabs(right);
  // Four differences, two products, their difference: less than 4 roundings of `size`; none underflows.
  const bool is_certain = std::fabs(left - right) > 0x1p-50 * size && size > 0x1p-900 && size < 0x1p900;
  if (!is_certain) return std::nullopt;
  return left > right ? 1 : -1;
}

/// Whether an edge of `a` has all of `b` on its other side or on its line, by its corners, so that no area is common.
bool has_separating_edge(const TextureSurface::Triangle& a, const TextureSurface::Triangle& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &p = a.coordinates[k], &q = a.coordinates[(k + 1) % 3];
    const int inside = certain_side(p, q, a.coordinates[(k + 2) % 3]).value_or(0);
    const bool separates = inside != 0 && std::all_of(b.coordinates.begin(), b.coordinates.end(), [&](const auto& uv) {
                             return certain_side(p, q, uv).value_or(inside) != inside;
                           });
    if (separates) return true;
  }
  return false;
}

class TextureCheck {
 public:
  TextureCheck(const TextureSurface& source, const TextureSurface& target, double tolerance, const Section& section,
               const std::string& name)
      : source_(source),
        target_(target),
        tolerance_(tolerance),
        section_(section),
        name_(name),
        tokens_(section.tokens),
        index_(target),
        work_(texture_work_per_unit, section.tokens.size() + source.triangles.size() + target.triangles.size()) {}

  TextureProof run() {
    result_.bytes = section_.tokens.size();
    for (const TextureSurface::Triangle& triangle : source_.triangles) {
      at_ = &triangle;
      TextureDomain domain(triangle, work_);
      domain_ = &domain;
      is_flat_ = domain.covering(triangle).turn == 0;
      near_.reset();
      if (is_flat_ && !has_proof()) {
        has_left_out_ = true;
        left_out_area_ += triangle.area;
        continue;
      }
      check(domain.whole(), {}, 0);
      require_work();
    }
    if (!tokens_.at_end()) throw Rejected("the proof about the texture goes on after its last triangle");
    if (result_.pieces != section_.pieces)
      throw Rejected("the number of pieces in the header is not that of the proof about the texture");
    const bool has_bare = source_.triangles.size() < source_.of_index.size();
    result_.uncovered_share = share_of(uncovered_area_ + source_.bare_area, has_uncovered_ || has_bare);
    result_.left_out_share = share_of(left_out_area_, has_left_out_);
    return result_;
  }

 private:
  using Levels = std::array<std::int64_t, 3>;  ///< the least weights of a piece, in units of 2^-40

  /// The share of the source's area that `area` is. Where the source has no area, `is_any` decides between 0 and all.
  [[nodiscard]] double share_of(double area, bool is_any) const {
    if (source_.area > 0) return std::min(1.0, area / source_.area);
    return is_any ? 1 : 0;
  }

  /// Whether the proof says something of the triangle at hand, which has no area in the texture.
  bool has_proof() {
    const std::uint64_t word = tokens_.number();
    if (word > 1) fail("has no area in the texture, and neither a proof nor none");
    return word == 1;
  }

  void check(const DomainPolygon& piece, const Levels& low, int depth) {
    const std::uint64_t word = tokens_.number();
    if (word > 0) {
      ++result_.pieces;
      check_leaf(piece, word - 1);
      return;
    }
    if (depth == deepest_texture_cut) fail("is cut too often");
    ++result_.cuts;
    const auto corner = static_cast<std::size_t>(depth % 3);
    const std::int64_t middle = low[corner] + (std::int64_t{1} << (weight_bits - 1 - depth / 3));
    const std::size_t lines_before = domain_->line_count();
    DomainLine* const line = domain_->level(corner, middle, weight_bits);
    for (const int side : {-1, 1}) {
      bool has_area = false;
      DomainPolygon part = domain_->clipped(piece, line, side, has_area);
      if (!has_area) part.clear();
      Levels part_low = low;
      if (side > 0) part_low[corner] = middle;
      check(part, part_low, depth + 1);
    }
    domain_->forget_lines_from(lines_before);
  }

  /// What the named triangles cover of the piece must be near; what they do not cover, no triangle may cover.
  void check_leaf(const DomainPolygon& piece, std::uint64_t count) {
    const std::size_t lines_before = domain_->line_count();
    std::vector<DomainPolygon> rest;
    if (!piece.empty()) rest.push_back(piece);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::size_t lines_of_others = domain_->line_count();
      const CoveringTriangle b = domain_->covering(next_target());
      if (b.turn == 0) fail("names a triangle without area in the texture");
      const DomainPolygon cell = covered(piece, b);
      if (cell.empty()) {
        domain_->forget_lines_from(lines_of_others);
        continue;
      }
      for (const DomainCorner& corner : cell)
        if (!domain_->is_near(corner.point, b, tolerance_))
          fail("has a piece whose texture moves by more than the tolerance");
      rest = without(std::move(rest), b);
      if (rest.size() > max_rest) fail("is covered by too many pieces");
      require_work();
    }
    if (!rest.empty()) check_uncovered(piece, rest);
    domain_->forget_lines_from(lines_before);
  }

  /// What of a polygon with an area a triangle covers; empty where that has no area.
  [[nodiscard]] DomainPolygon covered(DomainPolygon polygon, const CoveringTriangle& b) const {
    for (DomainLine* line : b.lines) {
      bool has_area = false;
      polygon = domain_->clipped(polygon, line, 1, has_area);
      if (!has_area) return {};
    }
    return polygon;
  }

  /// What a triangle does not cover of polygons.
  [[nodiscard]] std::vector<DomainPolygon> without(std::vector<DomainPolygon> polygons,
                                                   const CoveringTriangle& b) const {
    std::vector<DomainPolygon> left;
    for (DomainPolygon& polygon : polygons) {
      const std::size_t before = left.size();
      DomainPolygon inside = polygon;
      bool is_covered = true;  // a part of it with an area
      for (DomainLine* line : b.lines) {
        DomainPolygon within = domain_->clipped(inside, line, 1, is_covered);
        if (!is_covered) break;
        bool has_area = false;
        DomainPolygon beyond = domain_->clipped(inside, line, -1, has_area);
        if (has_area) left.push_back(std::move(beyond));
        inside = std::move(within);
      }
      if (is_covered) continue;
      left.resize(before);
      left.push_back(std::move(polygon));
    }
    return left;
  }

  void check_uncovered(const DomainPolygon& piece, const std::vector<DomainPolygon>& rest) {
    if (!near_) near_ = may_cover();
    for (const TextureSurface::Triangle* const triangle : *near_) {
      work_.add_clip();  // where it has no area nothing is clipped
      require_work();
      const std::size_t lines_of_others = domain_->line_count();
      const CoveringTriangle b = domain_->covering(*triangle);
      const bool touches =
          is_flat_ ? b.turn == 0 || touches_piece(piece, b)
                   : b.turn != 0 && std::any_of(rest.begin(), rest.end(), [&](const DomainPolygon& polygon) {
                       return !covered(polygon, b).empty();
                     });
      if (touches)
        fail(("is not shown to be near triangle " + std::to_string(triangle->index) +
              (b.turn == 0 ? ", which may have a point of it" : ", which covers a part of it"))
                 .c_str());
      domain_->forget_lines_from(lines_of_others);
    }
    has_uncovered_ = true;
    for (const DomainPolygon& polygon : rest) uncovered_area_ += 2 * at_->area * rough_area(polygon);
  }

  /// The triangles that may have an area of the texture in common with the triangle at hand, or any point of it where
  /// it has no area. Around a vertex of thousands of triangles nearly all boxes meet, but no areas.
  [[nodiscard]] std::vector<const TextureSurface::Triangle*> may_cover() const {
    std::vector<const TextureSurface::Triangle*> result = index_.near(*at_);
    const auto is_apart = [&](const TextureSurface::Triangle* triangle) {
      return !is_flat_ && (has_separating_edge(*at_, *triangle) || has_separating_edge(*triangle, *at_));
    };
    result.erase(std::remove_if(result.begin(), result.end(), is_apart), result.end());
    return result;
  }

  /// Whether a triangle covers any point of the piece, its border included.
  [[nodiscard]] bool touches_piece(DomainPolygon piece, const CoveringTriangle& b) const {
    bool has_area = false;
    for (DomainLine* line : b.lines) piece = domain_->clipped(piece, line, 1, has_area);
    return !piece.empty();
  }

  const TextureSurface::Triangle& next_target() {
    last_ += TokenReader::unfolded(tokens_.number());
    if (last_ < 0 || last_ >= static_cast<std::int64_t>(target_.of_index.size()))
      fail("names a triangle that the other mesh does not have");
    const std::int64_t place = target_.of_index[static_cast<std::size_t>(last_)];
    if (place < 0) fail("names a triangle without texture coordinates");
    const TextureSurface::Triangle& target = target_.triangles[static_cast<std::size_t>(place)];
    if (target.material != at_->material) fail("names a triangle of another material");
    return target;
  }

  void require_work() const {
    if (work_.is_too_much()) throw Rejected("the proof about the texture costs too much to check");
  }

  [[noreturn]] void fail(const char* why) const {
    throw Rejected("the texture of triangle " + std::to_string(at_->index) + " of the " + name_ + " mesh " + why);
  }

  const TextureSurface& source_;
  const TextureSurface& target_;
  double tolerance_;
  Section section_;
  std::string name_;
  TokenReader tokens_;
  TextureIndex index_;
  const TextureSurface::Triangle* at_ = nullptr;
  TextureDomain* domain_ = nullptr;
  bool is_flat_ = false;  ///< the triangle at hand has no area in the texture
  std::optional<std::vector<const TextureSurface::Triangle*>> near_;  ///< of the triangle at hand
  std::int64_t last_ = 0;                                             ///< the target named before
  Work work_;
  double uncovered_area_ = 0, left_out_area_ = 0;
  bool has_uncovered_ = false, has_left_out_ = false;
  TextureProof result_;
};

}  // namespace

TextureIndex::Box TextureIndex::box_of(const TextureSurface::Triangle& triangle) {
  const auto& uv = triangle.coordinates;
  const Eigen::Vector2d low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]), high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
  return {low.x(), low.y(), high.x(), high.y()};
}

bool TextureIndex::meet(const Box& a, const Box& b) {
  return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
}

/// Strips of the texture, as many as blocks in each, so that the triangles of a block are close to each other.
TextureIndex::TextureIndex(const TextureSurface& surface) {
  for (const TextureSurface::Triangle& triangle : surface.triangles) order_.push_back(&triangle);
  const auto by_u = [](const auto* a, const auto* b) { return box_of(*a)[0] < box_of(*b)[0]; };
  const auto by_v = [](const auto* a, const auto* b) { return box_of(*a)[1] < box_of(*b)[1]; };
  std::stable_sort(order_.begin(), order_.end(), by_u);
  const auto strip =
      static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(static_cast<double>(order_.size()) / block_size)) * block_size);
  for (auto begin = order_.begin(); begin != order_.end();) {
    const auto end = begin + std::min(strip, order_.end() - begin);
    std::stable_sort(begin, end, by_v);
    begin = end;
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Box box = box_of(*order_[i]);
    if (i % block_size == 0) blocks_.push_back(box);
    Box& block = blocks_.back();
    block = {std::min(block[0], box[0]), std::min(block[1], box[1]), std::max(block[2], box[2]),
             std::max(block[3], box[3])};
  }
}

std::vector<const TextureSurface::Triangle*> TextureIndex::near(const TextureSurface::Triangle& triangle) const {
  std::vector<const TextureSurface::Triangle*> found;
  const Box box = box_of(triangle);
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    if (!meet(box, blocks_[block])) continue;
    for (std::size_t i = block * block_size; i < std::min(order_.size(), (block + 1) * block_size); ++i)
      if (order_[i]->material == triangle.material && meet(box, box_of(*order_[i]))) found.push_back(order_[i]);
  }
  return found;
}

TextureProof check_texture(const TextureSurface& source, const TextureSurface& target, double tolerance,
                           const Section& section, const std::string& name) {
  return TextureCheck(source, target, tolerance, section, name).run();
}

}  // namespace meshbound::verify
