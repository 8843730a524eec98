// SPDX-License-Identifier: MIT
// The parts of the certificate verifier: numbers, distances, pieces, proofs by parity, and certificates made by hand
// that lie in one point each.
#include "verify/verifier.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "datasets/analytic_meshes.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"
#include "verify/checksum.h"
#include "verify/near_triangle.h"
#include "verify/parity_check.h"

namespace meshbound::verify {
namespace verifier_test {

using Bytes = std::vector<std::uint8_t>;
using Random = std::mt19937_64;

/// Numbers of all sizes, signs and kinds.
double wild(Random& random) {
  const double mantissa = std::ldexp(static_cast<double>(random() >> 11), -52) - 1;
  switch (random() % 8) {
    case 0:
      return 0;
    case 1:
      return std::ldexp(mantissa, -1060);
    case 2:
      return std::ldexp(mantissa, static_cast<int>(random() % 1000) - 500);
    case 3:
      return std::round(4 * mantissa);
    default:
      return mantissa;
  }
}

TEST(Checksum, IsCrc64Xz) {
  const std::string digits = "123456789";
  Checksum checksum;
  checksum.add({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()});
  EXPECT_EQ(checksum.value(), 0x995DC9BBDF1939FAU);
}

bool holds(const Interval& x, const Exact& exact) {
  const auto not_above = [](double bound, const Exact& value) {
    return std::isinf(bound) ? bound < 0 : Exact(bound) <= value;
  };
  return not_above(x.lower(), exact) && not_above(-x.upper(), -exact);
}

TEST(Interval, HoldsWhatItStandsFor) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double a = wild(random), b = wild(random), c = wild(random);
    const Interval p = Interval(a) * Interval(b) - Interval(c), q = p * p + Interval(b);
    const Exact exact_p = Exact(a) * Exact(b) - Exact(c), exact_q = exact_p * exact_p + Exact(b);
    EXPECT_TRUE(holds(p, exact_p)) << a << ' ' << b << ' ' << c;
    EXPECT_TRUE(holds(q, exact_q)) << a << ' ' << b << ' ' << c;
    EXPECT_TRUE(sgn(exact_p) == 0 || holds(q / p, exact_q / exact_p)) << a << ' ' << b << ' ' << c;
    EXPECT_TRUE(!surely_positive(p) || sgn(exact_p) > 0);
    EXPECT_TRUE(!surely_negative(q) || sgn(exact_q) < 0);
  }
}

/// Needles, points, coplanar and coincident corners, coordinates from 1e-320 to 1e150.
TEST(NearTriangle, AgreesWithTheOracleOnEverySideOfTheTolerance) {
  Random random(2);
  int exactly_decided = 0, told = 0;
  for (int i = 0; i < 4000; ++i) {
    Corners triangle;
    for (Eigen::Vector3d& corner : triangle) corner = {wild(random), wild(random), wild(random)};
    if (i % 5 == 0) triangle[2] = triangle[0] + (triangle[1] - triangle[0]) / 4;
    if (i % 7 == 0) triangle[1] = triangle[0];
    if (i % 11 == 0) triangle[2] = triangle[1];
    Eigen::Vector3d p(wild(random), wild(random), wild(random));
    if (i % 3 == 0) p = triangle[0] + 0.25 * (triangle[1] - triangle[0]);
    const reference::ExactLength distance = reference::exact_distance(p, triangle);
    const double about = distance.approximate();
    for (const double tolerance :
         {about / 2, std::nextafter(about, 0), about, std::nextafter(about, HUGE_VAL), 2 * about}) {
      if (!std::isfinite(tolerance)) continue;
      const bool truth = distance.compare(tolerance) <= 0;
      EXPECT_EQ(is_near(to_vec<Exact>(p), triangle, tolerance), truth) << i;
      const bool sure = surely_near(to_vec<Interval>(p), triangle, tolerance);
      EXPECT_TRUE(truth || !sure) << i;
      exactly_decided += truth && !sure ? 1 : 0;
      told += sure ? 1 : 0;
    }
  }
  EXPECT_GT(told, 2000);
  EXPECT_GT(exactly_decided, 1000);
}

Token chord(std::uint32_t i, std::uint64_t k, std::uint32_t j, std::uint64_t m, int bits = 8) {
  Token token;
  token.kind = Token::Kind::Cut;
  token.from = {i, k};
  token.to = {j, m};
  token.bits = bits;
  return token;
}

double area_of(PieceCorners& corners, const Piece& piece) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero(), first;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const auto &p = corners.exact(piece[i]), &q = corners.exact(piece[(i + 1) % piece.size()]);
    twice += Eigen::Vector3d(p.x.get_d(), p.y.get_d(), p.z.get_d())
                 .cross(Eigen::Vector3d(q.x.get_d(), q.y.get_d(), q.z.get_d()));
  }
  return twice.z() / 2;
}

/// Areas add up, all counter-clockwise: nothing is left out, wherever the chords go.
TEST(PieceCorners, PartsOfRandomCutsHaveTheAreaOfTheWhole) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    PieceCorners corners;
    corners.start({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.25, 1, 0)});
    std::vector<Piece> pieces{{0, 1, 2}};
    for (int cut = 0; cut < 8; ++cut) {
      const std::size_t at = random() % pieces.size();
      const Piece piece = pieces[at];
      const auto i = static_cast<std::uint32_t>(random() % piece.size()),
                 j = static_cast<std::uint32_t>(random() % piece.size());
      if (i == j || piece.size() + 1 > max_corners) continue;
      const auto parts = corners.cut(piece, chord(std::min(i, j), random() % 256, std::max(i, j), random() % 4 * 64));
      pieces[at] = parts.first;
      pieces.push_back(parts.second);
    }
    double sum = 0;
    for (const Piece& piece : pieces) {
      const double area = area_of(corners, piece);
      EXPECT_GE(area, -1e-15);
      sum += area;
      for (const std::uint32_t corner : piece) {
        const auto& exact = corners.exact(corner);
        const auto& rough = corners.rough(corner);
        EXPECT_TRUE(holds(rough.x, exact.x) && holds(rough.y, exact.y) && holds(rough.z, exact.z));
      }
    }
    EXPECT_NEAR(sum, 0.5, 1e-14);
  }
}

TEST(PieceCorners, RefuseChordsThatTheirPieceDoesNotHave) {
  PieceCorners corners;
  corners.start({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)});
  EXPECT_THROW((void)corners.cut({0, 1, 2}, chord(0, 128, 3, 128)), Rejected);
  Piece piece{0, 1, 2};
  EXPECT_THROW(for (int i = 0; i < 20; ++i) piece = corners.cut(piece, chord(0, 1, 1, 255)).second, Rejected);
}

/// Whether a triangle over the unit square's middle is proven by parity with a seed of this mesh.
bool proves(const TriangleMesh& mesh, double tolerance, std::uint32_t seed, const Corners& face) {
  PieceCorners corners;
  corners.start(face);
  Work work(1'000'000'000, 1);
  ParityCheck proof(mesh, tolerance, work);
  return proof.proves(face, corners, {0, 1, 2}, seed);
}

const Corners face{Eigen::Vector3d(0.1, 0.15, 0.02), Eigen::Vector3d(0.9, 0.2, 0.02), Eigen::Vector3d(0.3, 0.85, 0.02)};

std::uint32_t below_middle(const TriangleMesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Eigen::AlignedBox2d box;
    for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices[v].head<2>());
    if (box.contains(Eigen::Vector2d(0.45, 0.4))) return t;
  }
  return 0;
}

TEST(ParityCheck, HoldsOverASheetAndNotForATighterTolerance) {
  const TriangleMesh sheet = reference::unit_square(7);
  const std::uint32_t seed = below_middle(sheet);
  EXPECT_TRUE(proves(sheet, 0.021, seed, face));
  EXPECT_TRUE(proves(sheet, 0.02 * (1 + 1.1e-3), seed, face));
  EXPECT_FALSE(proves(sheet, 0.02, seed, face)) << "drawing in costs a thousandth";
  EXPECT_FALSE(proves(sheet, 0.019, seed, face));
  EXPECT_FALSE(proves(sheet, 0, seed, face));
  EXPECT_FALSE(proves(sheet, 0.021, 0, face)) << "a seed that is not below the face";
}

/// Over a side of a cube: the walls at its edges are out of reach, and must not be taken for a part of it where doubles
/// near the coordinates are coarser than what the face is drawn in by.
TEST(ParityCheck, HoldsFarFromTheOrigin) {
  for (const double away : {0.0, 1.0}) {
    const TriangleMesh cube = reference::moved(reference::cube(0.5), away * Eigen::Vector3d(8769869, -655627, -669836));
    const Triangle& t = cube.triangles[0];
    EXPECT_TRUE(proves(cube, 1e-6, 0, {cube.vertices[t[0]], cube.vertices[t[1]], cube.vertices[t[2]]})) << away;
  }
}

TEST(ParityCheck, SeesAHole) {
  const TriangleMesh sheet = reference::unit_square(7);
  const std::uint32_t seed = below_middle(sheet);
  for (std::uint32_t hole = 0; hole < sheet.triangles.size(); ++hole) {
    TriangleMesh holed = sheet;
    holed.triangles.erase(holed.triangles.begin() + hole);
    if (hole == seed) continue;
    const std::uint32_t seed_now = seed - (hole < seed ? 1 : 0);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : sheet.triangles[hole]) middle += sheet.vertices[v] / 3;
    const Eigen::Vector3d at = middle + Eigen::Vector3d(0, 0, 0.02);
    if (is_near(to_vec<Exact>(at), face, 1e-9)) {
      EXPECT_FALSE(proves(holed, 0.03, seed_now, face)) << hole;
    }
  }
}

/// A sheet folded back over itself below the middle of the face: no distance to the plane is too large, and each edge
/// has two triangles, but half of the face has no layer below it and half has two.
TEST(ParityCheck, CountsLayersModulo2) {
  TriangleMesh sheet = reference::unit_square(6);
  for (Eigen::Vector3d& p : sheet.vertices) p = {6 * p.x() - 2, 2 * p.y() - 0.5, 0};
  TriangleMesh folded = sheet;
  for (Eigen::Vector3d& p : folded.vertices)
    if (p.x() > 0.5) p = {1 - p.x(), p.y(), 0.01};
  for (std::uint32_t seed = 0; seed < folded.triangles.size(); ++seed) {
    EXPECT_FALSE(proves(folded, 0.05, seed, face)) << seed;
  }
  EXPECT_TRUE(proves(sheet, 0.05, below_middle(sheet), face));
}

/// A wall beside the face is out of the prism, one inside it is too high.
TEST(ParityCheck, LooksOnlyAtWhatIsStraightAboveAndBelow) {
  const TriangleMesh sheet = reference::unit_square(10);
  TriangleMesh beside = sheet, inside = sheet;
  for (Eigen::Vector3d& p : beside.vertices)
    if (p.x() > 0.95 || p.y() > 0.95) p.z() = 5;
  for (Eigen::Vector3d& p : inside.vertices)
    if (std::hypot(p.x() - 0.45, p.y() - 0.4) < 0.1) p.z() = 5;
  EXPECT_TRUE(proves(beside, 0.05, below_middle(beside), face));
  EXPECT_FALSE(proves(inside, 0.05, below_middle(inside), face));
}

TEST(ParityCheck, NeedsATriangleWithArea) {
  const TriangleMesh sheet = reference::unit_square(7);
  EXPECT_FALSE(proves(sheet, 0.05, below_middle(sheet), {face[0], face[1], face[1]}));
  EXPECT_FALSE(proves(sheet, 0.05, below_middle(sheet), {face[0], face[0], face[0]}));
}

/// At sizes where intervals of doubles overflow or underflow, rationals give the same decision.
TEST(ParityCheck, HoldsAtAnySize) {
  for (const double size : {1e-200, 1e-100, 1e100, 1e140}) {
    const TriangleMesh sheet = reference::scaled(reference::unit_square(7), size);
    Corners scaled = face;
    for (Eigen::Vector3d& corner : scaled) corner *= size;
    const std::uint32_t seed = below_middle(reference::unit_square(7));
    EXPECT_TRUE(proves(sheet, 0.021 * size, seed, scaled)) << size;
    EXPECT_FALSE(proves(sheet, 0.019 * size, seed, scaled)) << size;
  }
}

/// A certificate of a few bytes cannot ask the verifier for unbounded work.
TEST(ParityCheck, EndsWhereItCostsTooMuch) {
  const TriangleMesh sheet = reference::unit_square(7);
  const std::uint32_t seed = below_middle(sheet);
  PieceCorners corners;
  corners.start(face);
  constexpr std::uint64_t free_work = 65536;
  const auto cost = [&](std::uint64_t limit, std::uint64_t times) {
    Work work(1, limit - free_work);
    ParityCheck proof(sheet, 0.021, work);
    for (std::uint64_t i = 0; i < times; ++i)
      if (!proof.proves(face, corners, {0, 1, 2}, seed)) return std::uint64_t{0};
    return work.done();
  };
  const std::uint64_t once = cost(1'000'000, 1), times = free_work / once + 2;
  EXPECT_GT(once, 10u);
  EXPECT_EQ(cost(1'000'000, times), times * once);
  EXPECT_EQ(cost(times * once, times), times * once);
  EXPECT_EQ(cost(times * once - 1, times), 0u);
}

/// Many triangles at one edge are all looked at, and counted.
TEST(ParityCheck, CountsAllTrianglesAtAnEdge) {
  TriangleMesh sheet = reference::unit_square(7);
  const std::size_t triangles = sheet.triangles.size();
  const std::uint32_t seed = below_middle(sheet);
  PieceCorners corners;
  corners.start(face);
  const auto cost = [&] {
    Work work(1'000'000'000, 1);
    ParityCheck proof(sheet, 0.021, work);
    (void)proof.proves(face, corners, {0, 1, 2}, seed);
    return work.done();
  };
  const std::uint64_t looked_at = cost() / 12;
  constexpr std::uint64_t copies = 101;  // odd: the sheet counts as before
  for (std::uint64_t k = 1; k < copies; ++k)
    for (std::size_t t = 0; t < triangles; ++t) sheet.triangles.push_back(sheet.triangles[t]);
  EXPECT_GT(cost(), copies * copies * looked_at);
}

/// A certificate put together byte by byte: one triangle against one triangle.
struct Forgery {
  TriangleMesh a = reference::single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  TriangleMesh b = reference::single_triangle({0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1});
  double tolerance = 0.1000001;
  Bytes forward{0}, backward{0};
  std::uint64_t forward_pieces = 1, backward_pieces = 1;
  std::uint64_t forward_size = 0, version = 1, reserved = 0;

  [[nodiscard]] Bytes bytes() const {
    Bytes all{'M', 'E', 'S', 'H', 'C', 'E', 'R', 'T'};
    const auto put = [&](std::uint64_t value, int size) {
      for (int i = 0; i < size; ++i) all.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    put(version, 4);
    put(reserved, 4);
    put(std::bit_cast<std::uint64_t>(tolerance), 8);
    for (const TriangleMesh* mesh : {&a, &b}) {
      const MeshIdentity id = identity_of(*mesh);
      for (const std::uint64_t field : {id.vertices, id.triangles, id.checksum}) put(field, 8);
    }
    put(forward_size != 0 ? forward_size : forward.size(), 8);
    put(forward_pieces, 8);
    put(backward.size(), 8);
    put(backward_pieces, 8);
    all.insert(all.end(), forward.begin(), forward.end());
    all.insert(all.end(), backward.begin(), backward.end());
    Checksum checksum;
    checksum.add(all);
    put(checksum.value(), 8);
    return all;
  }

  [[nodiscard]] std::string rejection() const {
    try {
      (void)check_certificate(a, b, bytes());
    } catch (const Rejected& rejected) {
      return rejected.what();
    }
    return {};
  }
};

TEST(Forgery, IsACertificateWhereItDoesNotLie) {
  EXPECT_EQ(Forgery{}.rejection(), "");
  Forgery cut;  // edges 0 and 1, one byte each, at their middles; two leaves
  cut.forward = {1, 128, 128, 0, 0};
  cut.forward_pieces = 2;
  EXPECT_EQ(cut.rejection(), "");
}

TEST(Forgery, OfTheHeaderIsRejected) {
  Forgery f;
  f.version = 4;
  EXPECT_EQ(f.rejection(), "version 4 of the format is not known here");
  f = {};
  f.reserved = 1;
  EXPECT_EQ(f.rejection(), "a reserved field of the header is not 0");
  f = {};
  f.forward_pieces = 2;
  EXPECT_EQ(f.rejection(), "the number of pieces in the header is not that of the proof");
  f = {};
  f.backward_pieces = 0;
  EXPECT_EQ(f.rejection(), "the number of pieces in the header is not that of the proof");
  for (const std::uint64_t size : {std::uint64_t{2}, std::uint64_t{3}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
    f = {};
    f.forward_size = size;
    EXPECT_EQ(f.rejection(), "the sizes in the header do not add up") << size;
  }
}

TEST(Forgery, OfTokensIsRejected) {
  const auto rejection_of = [](const Bytes& forward) {
    Forgery f;
    f.forward = forward;
    return f.rejection();
  };
  EXPECT_EQ(rejection_of({}), "the proof ends in the middle of a token");
  EXPECT_EQ(rejection_of({0x80}), "the proof ends in the middle of a token");
  EXPECT_EQ(rejection_of({1, 128}), "the proof ends in the middle of a token");
  EXPECT_EQ(rejection_of({1, 128, 128, 0}), "the proof ends in the middle of a token");
  EXPECT_EQ(rejection_of({0, 0}), "the proof goes on after its last triangle");
  EXPECT_EQ(rejection_of({0x80, 0x00}), "a number in the proof is not in its shortest form");
  EXPECT_EQ(rejection_of({0x80, 0x80, 0x80, 0x80, 0x80, 0x01}), "a number in the proof is not in its shortest form");
  EXPECT_EQ(rejection_of({8}), "triangle 0 of the original mesh names a triangle that the other mesh does not have");
  EXPECT_EQ(rejection_of({4}), "triangle 0 of the original mesh names a triangle that the other mesh does not have");
  EXPECT_EQ(rejection_of({0xf8, 0xff, 0xff, 0xff, 0x7f}),
            "triangle 0 of the original mesh names a triangle that the other mesh does not have");
  EXPECT_EQ(rejection_of({3 | 3 << 2}), "a token recalls a corner that a triangle does not have");
  EXPECT_EQ(rejection_of({3}), "");  // nothing remembered is triangle 0, which is the right one
  EXPECT_EQ(rejection_of({1 | 3 << 4, 128, 128, 0, 0}), "a chord ends on an edge that its piece does not have");
  EXPECT_EQ(rejection_of({0xf1, 0xff, 0xff, 0xff, 0x7f, 0, 0, 0}), "a chord ends on an edge that no piece has");
}

/// A chord of the kind that would never end.
TEST(Forgery, WithoutBottomIsRejected) {
  Forgery f;
  f.forward.clear();
  for (int i = 0; i < 100000; ++i) f.forward.insert(f.forward.end(), {1, 128, 0});  // to corner 1: a triangle again
  EXPECT_EQ(f.rejection(), "triangle 0 of the original mesh is cut too often");
}

/// Appends cuts down to 2^`depth` pieces, each with the same leaf.
void append_halves(Bytes& tokens, int depth, std::uint8_t leaf) {
  if (depth > 0) tokens.insert(tokens.end(), {17, 129, 0});
  for (int half = 0; half < 2 && depth > 0; ++half) append_halves(tokens, depth - 1, leaf);
  if (depth == 0) tokens.push_back(leaf);
}

constexpr std::uint8_t near_leaf = 0, parity_leaf = 2;

/// 110 cuts at random shares of 48 bits make corners of thousands of bits, and each piece behind them has only a byte.
void append_pieces_with_large_rationals(Forgery& f, int halvings, std::uint8_t leaf) {
  Random random(5);
  constexpr int cuts = 110;
  f.forward.clear();
  for (int i = 0; i < cuts; ++i) {
    f.forward.push_back(29);
    for (int byte = 0; byte < 6; ++byte) f.forward.push_back(static_cast<std::uint8_t>(random() | 1));
    f.forward.insert(f.forward.end(), 6, 0);
  }
  append_halves(f.forward, halvings, leaf);
  f.forward.insert(f.forward.end(), cuts, near_leaf);
  f.forward_pieces = (1U << halvings) + cuts;
}

TEST(Forgery, OfPiecesWithLargeRationalsIsRejected) {
  Forgery f;
  f.tolerance = 0;
  f.a.vertices = {{0.1, 0.2, 0.3}, {1.7, 0.4, 0.9}, {0.3, 1.1, 2.3}};
  f.b = f.a;
  append_pieces_with_large_rationals(f, 10, near_leaf);
  EXPECT_EQ(f.rejection(), "triangle 0 of the original mesh costs too much to check");
}

/// Proofs by parity whose heights are exactly the largest allowed ones: only rationals tell that they hold.
TEST(Forgery, OfProofsByParityWithLargeRationalsIsRejected) {
  Forgery f;
  f.tolerance = 1;
  f.b = reference::single_triangle({-3, -3, 1023.0 / 1024}, {9, -3, 1023.0 / 1024}, {-3, 9, 1023.0 / 1024});
  f.forward = {parity_leaf};
  EXPECT_EQ(f.rejection(),
            "triangle 0 of the simplified mesh has a piece that is not within the tolerance of its triangle")
      << "the proof by parity holds";
  append_pieces_with_large_rationals(f, 10, parity_leaf);
  EXPECT_EQ(f.rejection(), "triangle 0 of the original mesh costs too much to check");
}

/// The format cannot express a gap. It can only claim of a piece that it lies near a triangle that it is not near.
TEST(Forgery, OfATriangleThatOnlyPartlyLiesNearIsRejected) {
  Forgery f;
  f.b.vertices[1].x() = 0.5;
  f.tolerance = 0.3;
  EXPECT_EQ(f.rejection(),
            "triangle 0 of the original mesh has a piece that is not within the tolerance of its triangle");
  f.forward = {1, 128, 128, 0, 0};
  f.forward_pieces = 2;
  EXPECT_NE(f.rejection(), "");
}

TEST(Forgery, OfMeshesIsRejected) {
  Forgery f;
  f.a.triangles.clear();
  EXPECT_EQ(f.rejection(), "the original mesh has no triangles");
  f = {};
  f.b.triangles[0][1] = 9;
  EXPECT_EQ(f.rejection(), "the simplified mesh has a triangle without finite corners");
  f = {};
  f.b.vertices[2].z() = std::nan("");
  EXPECT_EQ(f.rejection(), "the simplified mesh has a triangle without finite corners");
}

TEST(Certificate, OfAnyLengthIsReadWithoutHarm) {
  const Bytes whole = Forgery{}.bytes();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW((void)parse_certificate(std::span(whole).first(size)), Rejected) << size;
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    Bytes noise(random() % 200);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    TokenReader reader(noise);
    EXPECT_THROW(for (int tokens = 0; tokens < 1000; ++tokens)(void) reader.next(), Rejected);
  }
}

}  // namespace verifier_test
}  // namespace meshbound::verify
