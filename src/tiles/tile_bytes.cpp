// SPDX-License-Identifier: MIT
#include "tiles/tile_bytes.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "numeric/no_index.h"
#include "tiles/adaptive_coder.h"
#include "tiles/compact_bytes.h"
#include "tiles/triangle_neighbours.h"

namespace meshbound {
namespace {

/// Writes numbers that are there. `Unpacking` has the same members and gives back numbers that it reads, so that one
/// description of a result serves both ways.
class Packing {
 public:
  static constexpr bool reads = false;
  bool bit(BitChance& chance, bool one) {
    to_.bit(chance, one);
    return one;
  }
  std::uint64_t number(NumberChances& chances, std::uint64_t value, std::uint64_t /*limit*/) {
    to_.number(chances, value);
    return value;
  }
  [[nodiscard]] std::string take() { return to_.take(); }

 private:
  AdaptiveWriter to_;
};

class Unpacking {
 public:
  static constexpr bool reads = true;
  explicit Unpacking(std::string_view bytes) : from_(bytes) {}
  bool bit(BitChance& chance, bool /*one*/) { return from_.bit(chance); }
  std::uint64_t number(NumberChances& chances, std::uint64_t /*value*/, std::uint64_t limit) {
    const std::uint64_t value = from_.number(chances);
    if (value > limit) CompactReader::fail();
    return value;
  }
  void end() const {
    if (!from_.at_end()) CompactReader::fail();
  }

 private:
  AdaptiveReader from_;
};

constexpr std::uint64_t no_limit = ~std::uint64_t{0};

bool are_same(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// One result, written or read.
template <class Coder>
class TileCoder {
 public:
  TileCoder(Coder& coder, TileOutput& output, const TileStart& start) : coder_(coder), output_(output), start_(start) {}

  void run() {
    const std::size_t originals = start_.cover.size();
    output_.ended_by = static_cast<EndedBy>(
        number(static_cast<std::uint64_t>(output_.ended_by), static_cast<std::uint64_t>(EndedBy::Rounding)));
    output_.split = number(output_.split ? 1 : 0, 1) != 0;
    output_.dropped_triangles = number(output_.dropped_triangles, originals);
    CollapseCounts& counts = output_.counts;
    for (std::uint64_t* count :
         {&counts.tried, &counts.refused, &counts.proven_together, &counts.taken_back, &counts.proven_alone,
          &counts.unproven, &counts.originals_tested, &counts.faces_tested})
      *count = number(*count, no_limit);
    steps(output_.kept, originals, originals);
    vertices();
    triangles();
    steps(output_.turned, output_.source_triangle.size(), output_.source_triangle.size());
    covers();
  }

 private:
  std::uint64_t number(std::uint64_t value, std::uint64_t limit) { return coder_.number(facts_, value, limit); }

  std::uint32_t step(NumberChances& chances, std::uint32_t from, std::uint32_t to, std::size_t size) {
    const std::uint64_t folded = coder_.number(chances, folded_step(from, to), no_limit);
    const std::uint32_t coded = after_step(from, static_cast<std::uint32_t>(folded));
    if (coded >= size) CompactReader::fail();
    return coded;
  }

  /// Chances of numbers that are mostly what is expected.
  struct ExpectedChances {
    std::array<BitChance, 2> is_expected;
    bool was_expected = true;
    NumberChances step;
  };
  /// A number below `size`: the expected one, or a step from another. `expected` may be `no_index`.
  std::uint32_t expected_or_step(ExpectedChances& chances, std::uint32_t expected, std::uint32_t from,
                                 std::uint32_t value, std::size_t size) {
    if (expected != no_index) {
      chances.was_expected = coder_.bit(chances.is_expected[chances.was_expected ? 1 : 0], value == expected);
      if (chances.was_expected) return expected;
    }
    return step(chances.step, from, value, size);
  }

  /// Numbers below `size`, at most `max_count` of them.
  void steps(std::vector<std::uint32_t>& numbers, std::size_t max_count, std::size_t size) {
    numbers.resize(number(numbers.size(), max_count));
    NumberChances chances;
    std::uint32_t before = 0;
    for (std::uint32_t& n : numbers) before = n = step(chances, before, n, size);
  }

  /// Coordinates as the bits in which they differ from those of the vertex that they come from.
  void vertices() {
    const TriangleMesh& from = start_.mesh;
    steps(output_.source_vertex, from.vertices.size() + 3 * from.triangles.size(), from.vertices.size());
    std::vector<Eigen::Vector3d>& to = output_.proven.mesh.vertices;
    to.resize(output_.source_vertex.size());
    NumberChances difference;
    std::array<BitChance, 2> stands;
    bool stood = false;
    for (std::size_t v = 0; v < to.size(); ++v) {
      const Eigen::Vector3d& before = from.vertices[output_.source_vertex[v]];
      std::array<std::uint64_t, 3> bits;
      for (int k = 0; k < 3; ++k)
        bits[static_cast<std::size_t>(k)] =
            std::bit_cast<std::uint64_t>(to[v][k]) ^ std::bit_cast<std::uint64_t>(before[k]);
      stood = coder_.bit(stands[stood ? 1 : 0], (bits[0] | bits[1] | bits[2]) == 0);
      for (int k = 0; k < 3; ++k) {
        std::uint64_t& own = bits[static_cast<std::size_t>(k)];
        own = stood ? 0 : coder_.number(difference, own, no_limit);
        to[v][k] = std::bit_cast<double>(own ^ std::bit_cast<std::uint64_t>(before[k]));
      }
    }
  }

  /// Most triangles are what they were, and many others have some of their corners.
  void triangles() {
    const TriangleMesh& from = start_.mesh;
    steps(output_.source_triangle, from.triangles.size(), from.triangles.size());
    output_.proven.mesh.triangles.resize(output_.source_triangle.size());
    output_.proven.near.resize(output_.source_triangle.size());
    std::vector<std::uint32_t> vertex_now(from.vertices.size(), no_index);
    for (std::uint32_t v = 0; v < output_.source_vertex.size(); ++v) vertex_now[output_.source_vertex[v]] = v;
    ExpectedChances corners, near;
    std::uint32_t corner_before = 0;
    for (std::size_t i = 0; i < output_.source_triangle.size(); ++i) {
      const std::uint32_t source = output_.source_triangle[i];
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& v = output_.proven.mesh.triangles[i][k];
        std::uint32_t& expected = vertex_now[from.triangles[source][k]];
        v = expected_or_step(corners, expected, corner_before, v, output_.proven.mesh.vertices.size());
        corner_before = expected = v;  // a vertex is mostly replaced by one and the same around it
      }
      const std::uint32_t expected = start_.near[source];
      output_.proven.near[i] = expected_or_step(near, expected, expected, output_.proven.near[i], start_.cover.size());
    }
  }

  void covers() {
    triangle_now_.assign(start_.mesh.triangles.size(), no_index);
    for (std::uint32_t i = 0; i < output_.source_triangle.size(); ++i) triangle_now_[output_.source_triangle[i]] = i;
    beside_before_ = neighbours_of_triangles(start_.mesh);
    beside_now_ = neighbours_of_triangles(output_.proven.mesh);
    last_of_.assign(start_.mesh.triangles.size(), no_index);
    NumberLists coded;
    for (std::uint32_t t = 0; t < start_.cover.size(); ++t) {
      if (!start_.cover[t].empty()) {
        list_.clear();
        if constexpr (!Coder::reads) list_.assign(output_.proven.cover[t].begin(), output_.proven.cover[t].end());
        cover(t, coded);
        coded.numbers.insert(coded.numbers.end(), list_.begin(), list_.end());
        last_of_[start_.cover[t][0]] = last_coded_ = t;
      }
      coded.end_list();
    }
    output_.proven.cover = std::move(coded);
  }

  /// Codes `list_`, what covers an original: mostly the same triangles as before, or as cover an original beside it.
  void cover(std::uint32_t t, const NumberLists& coded) {
    find_expected(t);
    if (!expected_.empty()) {
      was_expected_ = coder_.bit(as_expected_[was_expected_ ? 1 : 0], are_same(list_, expected_));
      if (was_expected_) {
        list_ = expected_;
        return;
      }
    }
    find_candidates(t, coded);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (!coder_.bit(as_candidate_[beside_][candidates_.size()][i], are_same(list_, candidates_[i]))) continue;
      list_.assign(candidates_[i].begin(), candidates_[i].end());
      return;
    }
    cover_anew();
  }

  /// What covered it, by the numbers of the result; empty where one of these triangles has gone.
  void find_expected(std::uint32_t t) {
    expected_.clear();
    for (const std::uint32_t before : start_.cover[t]) expected_.push_back(triangle_now_[before]);
    if (std::find(expected_.begin(), expected_.end(), no_index) != expected_.end()) expected_.clear();
  }

  /// The last covers that have been coded: for originals that the same triangle of the start covered, for those of each
  /// triangle beside it, and for any.
  void find_candidates(std::uint32_t t, const NumberLists& coded) {
    candidates_.clear();
    const auto add = [&](std::uint32_t other) {
      if (other == no_index) return;
      const auto cover = coded[other];
      for (const auto& known : candidates_)
        if (are_same(known, cover)) return;
      candidates_.push_back(cover);
    };
    beside_ = 0;
    const auto add_last_of = [&](std::uint32_t triangle) {
      if (triangle == no_index || last_of_[triangle] == no_index) return;
      add(last_of_[triangle]);
      ++beside_;
    };
    const std::uint32_t before = start_.cover[t][0];
    add_last_of(before);
    for (const std::uint32_t other : beside_before_[before]) add_last_of(other);
    add(last_coded_);
  }

  /// Triangles of the candidates, or beside these, by their place among them; others by steps.
  void cover_anew() {
    known_.clear();
    for (const auto& candidate : candidates_)
      for (const std::uint32_t f : candidate) know(f);
    list_.resize(coder_.number(sizes_[candidates_.size()], list_.size(), output_.source_triangle.size()));
    const std::size_t near = known_.size();
    for (std::size_t i = 0; i < near; ++i) know_beside(known_[i]);
    std::uint32_t before = known_.empty() ? 0 : known_[0];
    for (std::size_t i = 0; i < list_.size(); ++i) {
      std::uint32_t& f = list_[i];
      const auto place = static_cast<std::size_t>(std::find(known_.begin(), known_.end(), f) - known_.begin());
      if (coder_.bit(is_known_, place < known_.size())) {
        if (known_.empty()) CompactReader::fail();
        f = known_[coder_.number(places_[std::min<std::size_t>(i, 2)], place, known_.size() - 1)];
      } else {
        f = step(steps_, before, f, output_.source_triangle.size());
        know(f);
        know_beside(f);
      }
      before = f;
    }
  }
  void know(std::uint32_t f) {
    if (std::find(known_.begin(), known_.end(), f) == known_.end()) known_.push_back(f);
  }
  void know_beside(std::uint32_t f) {
    for (const std::uint32_t other : beside_now_[f])
      if (other != no_index) know(other);
  }

  Coder& coder_;
  TileOutput& output_;
  const TileStart& start_;
  NumberChances facts_;

  // Scratch memory for covers:
  std::vector<std::uint32_t> triangle_now_;  ///< by triangle of the start: its number in the result
  std::vector<std::array<std::uint32_t, 3>> beside_before_, beside_now_;
  std::vector<std::uint32_t> last_of_;  ///< by triangle of the start: the last original coded that it covered
  std::vector<std::uint32_t> list_, expected_, known_;
  std::vector<std::span<const std::uint32_t>> candidates_;  ///< at most 5
  std::size_t beside_ = 0;  ///< of the covers tried, those of the same triangle or one beside it
  std::uint32_t last_coded_ = no_index;
  bool was_expected_ = false;
  std::array<BitChance, 2> as_expected_;
  std::array<std::array<std::array<BitChance, 5>, 6>, 5> as_candidate_;
  std::array<NumberChances, 6> sizes_;   ///< by how many candidates there are
  std::array<NumberChances, 3> places_;  ///< of the first triangle of a cover, the second one and others
  NumberChances steps_;
  BitChance is_known_;
};

}  // namespace

std::string packed_tile(TileOutput output, const TileStart& start) {
  Packing coder;
  TileCoder<Packing>(coder, output, start).run();
  return coder.take();
}

TileOutput unpacked_tile(std::string_view bytes, const TileStart& start) {
  Unpacking coder(bytes);
  TileOutput output;
  TileCoder<Unpacking>(coder, output, start).run();
  coder.end();
  return output;
}

}  // namespace meshbound
