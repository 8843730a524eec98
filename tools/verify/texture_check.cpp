// SPDX-License-Identifier: MIT
#include "verify/texture_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "verify/texture_domain.h"
#include "verify/texture_index.h"

namespace meshbound::verify {
namespace {

constexpr int deepest_texture_cut = 36;  ///< twelve halvings of the weight of each corner
constexpr int weight_bits = 40;          ///< levels are multiples of 2^-40
constexpr std::size_t max_rest = 256;    ///< pieces of what is not covered

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
    if (!near_) near_ = is_flat_ ? index_.touching(*at_) : index_.sharing_area(*at_);
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

TextureProof check_texture(const TextureSurface& source, const TextureSurface& target, double tolerance,
                           const Section& section, const std::string& name) {
  return TextureCheck(source, target, tolerance, section, name).run();
}

}  // namespace meshbound::verify
