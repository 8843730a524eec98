// SPDX-License-Identifier: MIT
// Certificates that also speak of texture deviation: what is proven, what is refused, and what forgers may try.
#include "meshbound/texture_certificate.h"

#include <gtest/gtest.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "forged_bytes.h"
#include "meshbound/error.h"
#include "verify/texture_check.h"
#include "verify/texture_surface.h"
#include "verify/verifier.h"

namespace meshbound {
namespace texture_certificate_test {

using Bytes = std::vector<std::uint8_t>;
using test::sealed;
using test::with;

/// A mesh with texture coordinates.
struct Textured {
  TriangleMesh mesh;
  MeshAttributes attributes;

  void add(const Eigen::Vector3d& at, const Eigen::Vector2d& uv) {
    mesh.vertices.push_back(at);
    attributes.texture_coordinates.values.emplace_back(uv.x(), uv.y(), 0);
  }
  void add(const Triangle& corners) {
    mesh.triangles.push_back(corners);
    attributes.texture_coordinates.index.push_back(corners);
  }
};

using Shape = std::function<Eigen::Vector3d(double s, double t)>;
using Chart = std::function<Eigen::Vector2d(double s, double t)>;

Eigen::Vector2d plain(double s, double t) { return {s, t}; }

/// Appends n x n squares of the unit square, cut into triangles.
void add_grid(Textured& to, std::uint32_t n, const Shape& shape, const Chart& chart = plain) {
  const auto first = static_cast<std::uint32_t>(to.mesh.vertices.size());
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      to.add(shape(double(i) / n, double(j) / n), chart(double(i) / n, double(j) / n));
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      to.add({a, b, d});
      to.add({a, d, c});
    }
}

Textured grid(std::uint32_t n, const Shape& shape, const Chart& chart = plain) {
  Textured result;
  add_grid(result, n, shape, chart);
  return result;
}

Shape lifted(double z) {
  return [z](double s, double t) { return Eigen::Vector3d(s, t, z); };
}

struct Case {
  Textured a, b;
  double tolerance, texture_tolerance;

  [[nodiscard]] std::array<TexturedMesh, 2> meshes() const {
    return textured_meshes(a.mesh, a.attributes, b.mesh, b.attributes);
  }
  [[nodiscard]] TextureCertificate certificate(int threads = 1) const {
    CertificateOptions options;
    options.threads = threads;
    return *with_texture_proof(*build_certificate(a.mesh, b.mesh, tolerance, options), meshes(), texture_tolerance,
                               options);
  }
  [[nodiscard]] verify::Proof check(const Bytes& bytes) const {
    return verify::check_certificate(a.mesh, b.mesh, bytes, &a.attributes, &b.attributes);
  }
  /// Why it is rejected; empty when it is not.
  [[nodiscard]] std::string rejection(const Bytes& bytes) const {
    try {
      (void)check(bytes);
    } catch (const verify::Rejected& rejected) {
      return rejected.what();
    }
    return {};
  }
  /// Why there is no certificate.
  [[nodiscard]] std::string failure() const {
    try {
      (void)certificate();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
};

/// Two squares whose textures are 1/64 apart everywhere.
Case two_squares() { return {grid(7, lifted(0)), grid(3, lifted(0x1p-6)), 0.1, 0x1p-6}; }

/// Where the part about the texture begins, in a certificate that does not speak of lines.
std::size_t texture_at(const Bytes& bytes) { return test::end_of_proofs(bytes); }

constexpr std::size_t header = 56;  // of the part about the texture

TEST(TextureCertificate, ProvesTheDeviationThatIsThereAndNoLess) {
  Case c = two_squares();
  const TextureCertificate certificate = c.certificate();
  const verify::Proof proof = c.check(certificate.certificate.bytes);
  ASSERT_TRUE(proof.texture);
  EXPECT_EQ(proof.texture->tolerance, 0x1p-6);
  EXPECT_EQ(proof.texture->original_to_simplified.pieces, 98U);
  EXPECT_EQ(proof.texture->simplified_to_original.pieces, 18U);
  EXPECT_EQ(certificate.simplified_to_original.pieces, 18U);
  EXPECT_EQ(proof.texture->original_to_simplified.uncovered_share, 0);
  EXPECT_EQ(proof.tolerance, 0.1);
  c.texture_tolerance = std::nextafter(0x1p-6, 0);
  EXPECT_NE(c.failure().find("the texture of triangle 0 of the original mesh moves by more"), std::string::npos)
      << c.failure();
}

TEST(TextureCertificate, IsTheSameForAnyNumberOfThreads) {
  const Case c = two_squares();
  EXPECT_EQ(c.certificate(1).certificate.bytes, c.certificate(3).certificate.bytes);
}

TEST(TextureCertificate, KeepsWhatWasProvenAlready) {
  const Case c = two_squares();
  CertificateOptions options;
  options.lines = CertifiedLines{{{0, 1}}, {{0, 1}}, 1};
  const auto lines = build_certificate(c.a.mesh, c.b.mesh, c.tolerance, options);
  const auto both = with_texture_proof(*lines, c.meshes(), c.texture_tolerance);
  const verify::Proof proof = c.check(both->certificate.bytes);
  EXPECT_TRUE(proof.lines && proof.texture);
}

TEST(TextureCertificate, TakesTheNearestOfChartsThatOverlap) {
  Case c{grid(4, lifted(0)), grid(3, lifted(0)), 2, 0.25};
  add_grid(c.a, 4, lifted(1), [](double s, double t) { return Eigen::Vector2d(1 - s, t); });  // mirrored
  add_grid(c.b, 3, lifted(1.125), [](double s, double t) { return Eigen::Vector2d(1 - s, t); });
  EXPECT_TRUE(c.check(c.certificate().certificate.bytes).texture);
}

/// The sheets of A cross between those of B: which one is near changes inside triangles, which must be cut.
TEST(TextureCertificate, CutsWhereNoTriangleIsNearEverywhere) {
  const auto slope = [](double from, double to) {
    return [from, to](double s, double t) { return Eigen::Vector3d(s, t, from + (to - from) * s); };
  };
  Case c{grid(1, slope(0, 1)), grid(1, lifted(0)), 2, 0.55};
  add_grid(c.a, 1, slope(1, 0));
  add_grid(c.b, 1, lifted(1));
  const TextureCertificate certificate = c.certificate();
  EXPECT_GT(certificate.original_to_simplified.cuts, 0U);
  EXPECT_EQ(c.check(certificate.certificate.bytes).texture->original_to_simplified.cuts,
            certificate.original_to_simplified.cuts);
}

TEST(TextureCertificate, TellsWhatIsNotCovered) {
  const Case c{grid(5, lifted(0)), grid(3, lifted(0), [](double s, double t) { return Eigen::Vector2d(s / 2, t); }), 1,
               0.75};
  const auto proof = c.check(c.certificate().certificate.bytes);
  EXPECT_NEAR(proof.texture->original_to_simplified.uncovered_share, 0.5, 1e-12);
  EXPECT_EQ(proof.texture->simplified_to_original.uncovered_share, 0);
}

Case scaled(Case c, double by) {
  for (Textured* mesh : {&c.a, &c.b})
    for (Eigen::Vector3d& vertex : mesh->mesh.vertices) vertex *= by;
  c.tolerance *= by;
  c.texture_tolerance *= by;
  return c;
}

/// Products of edges of 2^-300 underflow in squared areas, products of edges of 2^300 overflow.
TEST(TextureCertificate, TellsSharesOfTheAreaAtAnySize) {
  Case c{grid(2, lifted(0)), grid(2, lifted(0), [](double s, double t) { return Eigen::Vector2d(s / 2, t); }), 1, 0.75};
  add_grid(c.a, 2, lifted(0), [](double s, double) { return Eigen::Vector2d(s, 2.5); });
  for (const int exponent : {-400, -300, 0, 300}) {
    const Case at_size = scaled(c, std::ldexp(1, exponent));
    const auto proof = at_size.check(at_size.certificate().certificate.bytes);
    EXPECT_EQ(proof.texture->original_to_simplified.uncovered_share, 0.75) << exponent;
    EXPECT_EQ(proof.texture->simplified_to_original.uncovered_share, 0) << exponent;
  }
}

/// Shares of a mesh all of whose triangles are segments: what is not covered or left out is all of it.
TEST(TextureCertificate, TellsWhatIsNotCoveredOfAMeshWithoutArea) {
  const Shape segment = [](double s, double t) { return Eigen::Vector3d(s + t, 0, 0); };
  const Case c{grid(1, segment), grid(1, segment, [](double s, double t) { return Eigen::Vector2d(s + 2, t); }), 1, 1};
  const auto proof = c.check(c.certificate().certificate.bytes);
  EXPECT_EQ(proof.texture->original_to_simplified.uncovered_share, 1);
  EXPECT_EQ(proof.texture->original_to_simplified.left_out_share, 0);
}

TEST(TextureCertificate, TellsMaterialsApart) {
  Case c = two_squares();
  for (Textured* mesh : {&c.a, &c.b}) {
    mesh->attributes.materials.names = {"wood", "stone"};
    mesh->attributes.materials.index.assign(mesh->mesh.triangles.size(), 0);
  }
  EXPECT_EQ(c.check(c.certificate().certificate.bytes).texture->original_to_simplified.uncovered_share, 0);
  const Bytes wood = c.certificate().certificate.bytes;
  c.b.attributes.materials.index.assign(c.b.mesh.triangles.size(), 1);
  EXPECT_NE(c.rejection(wood).find("names a triangle of another material"), std::string::npos);
  EXPECT_EQ(c.check(c.certificate().certificate.bytes).texture->original_to_simplified.uncovered_share, 1);
}

/// Half of the area is a square that lies on a line of the texture, too far from what lies there in the other mesh.
TEST(TextureCertificate, TellsWhichTrianglesWithoutAreaInTheTextureAreLeftOut) {
  const Chart line = [](double s, double) { return Eigen::Vector2d(s, 0.5); };
  Case c{grid(2, lifted(0)), grid(2, lifted(0)), 3, 0.1};
  add_grid(c.a, 2, lifted(2), line);
  const Bytes bytes = c.certificate().certificate.bytes;
  EXPECT_EQ(c.check(bytes).texture->original_to_simplified.left_out_share, 0.5);
  EXPECT_EQ(c.check(bytes).texture->original_to_simplified.uncovered_share, 0);
  EXPECT_EQ(c.check(bytes).texture->simplified_to_original.left_out_share, 0);
  // A square has eight triangles, whose leaves take two bytes. The ninth triangle has no proof.
  const std::size_t at = texture_at(bytes) + header + std::size_t{8} * 2;
  ASSERT_EQ(bytes[at], 0);
  EXPECT_NE(c.rejection(with(bytes, at, 1, 1)), "");
  EXPECT_NE(c.rejection(with(bytes, at, 2, 1)).find("neither a proof nor none"), std::string::npos);
}

/// A slope on a line of the texture, between two sheets that are near to a half of it each. Other triangles without
/// area there are beyond, so that all of the slope must be covered.
TEST(TextureCertificate, CutsTrianglesWithoutAreaInTheTexture) {
  const Chart line = [](double s, double) { return Eigen::Vector2d(s, 0.25); };
  Case c{grid(
             1, [](double s, double t) { return Eigen::Vector3d(s, t, s); }, line),
         grid(1, lifted(0)), 4, 0.95};
  add_grid(c.b, 1, lifted(1));
  add_grid(c.b, 1, lifted(3), line);
  const TextureCertificate certificate = c.certificate();
  EXPECT_GT(certificate.original_to_simplified.cuts, 0U);
  EXPECT_EQ(c.check(certificate.certificate.bytes).texture->original_to_simplified.left_out_share, 0);
}

/// No cut parts the triangles around a vertex.
TEST(TextureCertificate, HoldsAroundAVertexOfManyTriangles) {
  constexpr std::uint32_t n = 200;
  Case c{grid(1, lifted(0)), {}, 10, 0};
  c.b.add({0.5, 0.4, 0}, {0.5, 0.4});
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n, x = 0.5 + 2 * std::cos(angle), y = 0.4 + 2 * std::sin(angle);
    c.b.add({x, y, 0}, {x, y});
    c.b.add(Triangle{0, 1 + k, 1 + (k + 1) % n});
  }
  EXPECT_EQ(c.check(c.certificate().certificate.bytes).texture->original_to_simplified.uncovered_share, 0);
}

/// Squares of such distances overflow or underflow.
TEST(TextureCertificate, HoldsForTheSmallestAndLargestCoordinates) {
  for (const double scale : {1e-300, 1e-160, 1e160, 1e290}) {
    const auto wavy = [scale](double z) {
      return [scale, z](double s, double t) -> Eigen::Vector3d {
        return {scale * s, scale * t, scale * z * std::sin(9 * s + 5 * t)};
      };
    };
    const Case c{grid(5, wavy(0.01)), grid(4, wavy(0)), 0.1 * scale, 0.1 * scale};
    EXPECT_EQ(c.rejection(c.certificate().certificate.bytes), "") << scale;
  }
}

/// What it takes to check a leaf grows with the square of the triangles that it names.
TEST(TextureCertificate, NamesFewTrianglesInALeaf) {
  constexpr std::uint32_t n = 24;
  const Case c{grid(n, lifted(0)), grid(1, lifted(0)), 0.01, 0.01};
  const Bytes bytes = c.certificate().certificate.bytes;
  EXPECT_GE(c.check(bytes).texture->simplified_to_original.pieces, 2 * n * n / 64);
}

TEST(TextureCertificate, RefusesTrianglesWithoutAreaInTheTextureThatSomethingCovers) {
  const Chart line = [](double s, double) { return Eigen::Vector2d(s, 0.5); };
  const Case covered{grid(2, lifted(0), line), grid(2, lifted(0)), 1, 1};
  EXPECT_TRUE(covered.check(covered.certificate().certificate.bytes).texture) << "flat triangles that are near";
  EXPECT_EQ(covered.check(covered.certificate().certificate.bytes).texture->original_to_simplified.left_out_share, 0);
  const Case alone{grid(2, lifted(0), line),
                   grid(2, lifted(0), [](double s, double t) { return Eigen::Vector2d(s + 2, t); }), 1, 0};
  EXPECT_EQ(alone.check(alone.certificate().certificate.bytes).texture->original_to_simplified.uncovered_share, 1);
  // The proof that nothing covers them does not hold for the mesh that does, with the checksum of its texture.
  Bytes forged = alone.certificate().certificate.bytes;
  const Bytes other = covered.certificate().certificate.bytes;
  const auto checksum = [](const Bytes& bytes) { return static_cast<std::ptrdiff_t>(texture_at(bytes)) + 16; };
  std::copy_n(other.begin() + checksum(other), 8, forged.begin() + checksum(forged));
  EXPECT_NE(covered.rejection(sealed(forged)).find("triangle 0 of the original mesh is not shown to be near"),
            std::string::npos)
      << covered.rejection(sealed(forged));
}

TEST(TextureCertificate, HoldsOnRandomMeshes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.04, 0.04);
  for (int i = 0; i < 10; ++i) {
    const auto bent = [&](double, double) { return noise(random); };
    const Shape wavy = [&](double s, double t) {
      return Eigen::Vector3d(s, t, 0.1 * std::sin(5 * s + t) + bent(s, t));
    };
    const Chart torn = [&](double s, double t) { return Eigen::Vector2d(s + bent(s, t), 1.25 * t + bent(s, t)); };
    Case c{grid(9, wavy, torn), grid(4, wavy, torn), 1, 0};
    const TextureDeviation deviation = texture_deviation(c.meshes()[0], c.meshes()[1]);
    c.texture_tolerance = deviation.bounds.upper * 1.001;
    const auto proof = c.check(c.certificate().certificate.bytes);
    EXPECT_NEAR(proof.texture->original_to_simplified.uncovered_share, deviation.a_to_b.uncovered.upper, 1e-9);
    c.texture_tolerance = deviation.bounds.lower * 0.99;
    EXPECT_NE(c.failure(), "");
  }
}

TEST(TextureCertificate, IsRejectedWhereTheTextureIsAnother) {
  Case c = two_squares();
  const Bytes bytes = c.certificate().certificate.bytes;
  EXPECT_EQ(c.rejection(bytes), "");
  c.b.attributes.texture_coordinates.values[0].x() = 0x1p-40;
  EXPECT_NE(c.rejection(bytes).find("not those that the certificate was made for"), std::string::npos);
  c.b.attributes = {};
  EXPECT_NE(c.rejection(bytes).find("the simplified mesh has no texture coordinates"), std::string::npos);
  EXPECT_THROW((void)verify::check_certificate(c.a.mesh, c.b.mesh, bytes), verify::Rejected);
}

/// Numbers beyond the range of floats have no place in a file of floats.
TEST(TextureCertificate, OfCoordinatesThatOneOfTheFilesCannotHoldIsRejected) {
  const auto flat = [](double s, double t) { return Eigen::Vector3d(s, t, 0); };
  Textured a = grid(1, flat), b = grid(1, flat);
  const auto surfaces = [&] { return verify::texture_surfaces({&a.mesh, &a.attributes}, {&b.mesh, &b.attributes}); };
  a.attributes.texture_coordinates.values[0].x() = 1e39;
  EXPECT_NO_THROW((void)surfaces());
  b.attributes.texture_precision = TexturePrecision::FloatFromTop;
  EXPECT_THROW((void)surfaces(), verify::Rejected);
}

TEST(TextureCertificate, OfAnotherTextureIsRejectedAlsoWithItsChecksum) {
  Case c = two_squares();
  const Bytes bytes = c.certificate().certificate.bytes;
  c.b.attributes.texture_coordinates.values[5] += Eigen::Vector3d(0.01, 0, 0);
  c.texture_tolerance = 1;
  const Bytes other = c.certificate().certificate.bytes;
  Bytes forged = bytes;
  const std::size_t at = texture_at(bytes);
  std::copy_n(other.begin() + static_cast<std::ptrdiff_t>(texture_at(other)) + 8, 16,
              forged.begin() + static_cast<std::ptrdiff_t>(at) + 8);
  EXPECT_NE(c.rejection(sealed(forged)).find("the texture of triangle "), std::string::npos);
}

TEST(TextureCertificate, RejectsForgeries) {
  const Case c = two_squares();
  const Bytes bytes = c.certificate().certificate.bytes;
  const std::size_t at = texture_at(bytes);
  const auto rejected = [&](const Bytes& forged, const std::string& because) {
    EXPECT_NE(c.rejection(forged).find(because), std::string::npos) << c.rejection(forged);
  };
  rejected(with(bytes, at, std::bit_cast<std::uint64_t>(std::nextafter(0x1p-6, 0))),
           "moves by more than the tolerance");
  rejected(with(bytes, at, std::bit_cast<std::uint64_t>(-1.0)), "not a finite length");
  rejected(with(bytes, at + 8, 1), "not those that the certificate was made for");
  rejected(with(bytes, at + 24, bytes[at + 24] + 1U), "do not add up");
  rejected(with(bytes, at + 32, 97), "the number of pieces");
  rejected(with(bytes, 12, 1, 4), "do not add up");
  rejected(with(bytes, 12, 2, 4), "a reserved field");
  rejected(with(bytes, 8, 1, 4), "do not add up");
  rejected(with(bytes, 8, 4, 4), "version 4 of the format is not known");
  // The first triangle's only leaf: no triangle instead of some, one that is elsewhere, one that does not exist.
  ASSERT_GE(bytes[at + header], 2);
  Bytes nothing = bytes;
  nothing[at + header] = 1;
  rejected(sealed(nothing), "is not shown to be near triangle");
  rejected(with(bytes, at + header + 1, 2 * 17, 1), "is not shown to be near triangle");
  rejected(with(bytes, at + header + 1, 2 * 18, 1), "names a triangle that the other mesh does not have");
  rejected(with(bytes, at + header + 1, 1, 1), "names a triangle that the other mesh does not have");
}

/// Whatever bytes of the proof change, nothing that is false is accepted.
TEST(TextureCertificate, AcceptsNothingFalseWhateverBytesChange) {
  Case c{grid(3, lifted(0)), grid(2, lifted(0x1p-6)), 0.1, 0x1p-6};
  c.a.add({9, 9, 9}, {0.4, 0.4}), c.a.add({9.5, 9, 9}, {0.6, 0.4}), c.a.add({9, 9.5, 9}, {0.4, 0.6});
  const auto last = static_cast<std::uint32_t>(c.a.mesh.vertices.size());
  c.a.add({last - 3, last - 2, last - 1});
  c.tolerance = 20;
  c.texture_tolerance = 20;
  const auto honest = c.certificate().certificate.bytes;
  ASSERT_EQ(c.rejection(honest), "");
  // The last triangle is far away from everything with its texture: claim that it is near.
  const std::size_t at = texture_at(honest);
  const Bytes lying = with(honest, at, std::bit_cast<std::uint64_t>(1.0));
  EXPECT_NE(c.rejection(lying), "");
  std::mt19937 random(9);
  for (int i = 0; i < 1000; ++i) {
    Bytes forged = lying;
    const int changes = 1 + static_cast<int>(random() % 3);
    for (int k = 0; k < changes; ++k)
      forged[at + header + random() % (forged.size() - at - header - 8)] = static_cast<std::uint8_t>(random() % 40);
    ASSERT_NE(c.rejection(sealed(forged)), "") << "change " << i;
  }
}

/// A triangle whose texture coordinates are its first two coordinates.
verify::TextureSurface::Triangle flat_triangle(const Eigen::Vector2d& at, double size) {
  verify::TextureSurface::Triangle triangle;
  triangle.coordinates = {at, at + Eigen::Vector2d(size, 0), at + Eigen::Vector2d(0, size)};
  for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] << triangle.coordinates[k], 0;
  return triangle;
}

/// Appends the cuts of a triangle into pieces whose weights are at least `low`, each of which names no triangle.
void append_cuts(Bytes& tokens, std::uint64_t& pieces, std::array<double, 3> low, int depth, int max_depth) {
  std::array<double, 3> size{};
  for (int k = 0; k < 3; ++k) size[static_cast<std::size_t>(k)] = std::ldexp(1, -(depth + 2 - k) / 3);
  const double sum = low[0] + low[1] + low[2];
  const bool is_empty = sum >= 1 || sum + size[0] + size[1] + size[2] <= 1;
  if (is_empty || depth == max_depth) {
    tokens.push_back(1);
    ++pieces;
    return;
  }
  tokens.push_back(0);
  append_cuts(tokens, pieces, low, depth + 1, max_depth);
  const auto corner = static_cast<std::size_t>(depth % 3);
  low[corner] += size[corner] / 2;
  append_cuts(tokens, pieces, low, depth + 1, max_depth);
}

/// Thousands of pieces that nothing covers, each of which must be compared with thousands of triangles: these lie in
/// the last piece.
TEST(TextureCertificate, ThatCostsFarMoreThanItsBytesIsRefused) {
  verify::TextureSurface source, target;
  source.triangles = {flat_triangle({0, 0}, 1)};
  for (int i = 0; i < 1500; ++i) target.triangles.push_back(flat_triangle({0.001 + i * 1e-7, 0.001}, 1e-7));
  const auto rejection = [&](int max_depth) -> std::string {
    Bytes tokens;
    std::uint64_t pieces = 0;
    append_cuts(tokens, pieces, {0, 0, 0}, 0, max_depth);
    try {
      (void)verify::check_texture(source, target, 1, {tokens, pieces}, "original");
    } catch (const verify::Rejected& rejected) {
      return rejected.what();
    }
    return {};
  };
  const std::string too_much = "the proof about the texture costs too much to check";
  EXPECT_NE(rejection(3), too_much);
  EXPECT_EQ(rejection(14), too_much);
}

/// What the C library has taken so far; 0 where it does not tell.
std::size_t bytes_from_system() {
#ifdef __GLIBC__
  const auto info = mallinfo2();
  return info.arena + info.hblkhd;
#else
  return 0;
#endif
}

/// The lines of cuts are forgotten once both halves are done: 4 MB of a proof took 800 MB.
TEST(TextureCertificate, OfManyCutsTakesNoMemoryForEach) {
  verify::TextureSurface source, target;
  source.triangles = {flat_triangle({0, 0}, 1)};
  Bytes tokens;
  std::uint64_t pieces = 0;
  append_cuts(tokens, pieces, {0, 0, 0}, 0, 18);
  const std::size_t before = bytes_from_system();
  (void)verify::check_texture(source, target, 1, {tokens, pieces}, "original");
  EXPECT_LT(bytes_from_system(), before + 20 * tokens.size());
}

/// One leaf names many triangles, each of which is clipped from what all before leave. Products of coordinates of
/// 2^-300 underflow, so that all signs are left to rationals of thousands of bits.
TEST(TextureCertificate, ThatAsksForLargeRationalsIsRefused) {
  constexpr int n = 8;
  const auto rejection = [&](double size) -> std::string {
    verify::TextureSurface source, target;
    source.triangles = {flat_triangle({0, 0}, 2 * size)};
    std::mt19937 random(2);
    std::uniform_real_distribution<double> length(0.3, 0.9);
    Bytes tokens{1 + n * n};  // a leaf that names all, in their order
    for (int i = 0; i < n * n; ++i) {
      const double leg = length(random) * size / n;
      target.triangles.push_back(flat_triangle(size / n * Eigen::Vector2d(i % n + length(random), i / n), leg));
      target.of_index.push_back(i);
      tokens.push_back(i == 0 ? 0 : 2);
    }
    try {
      (void)verify::check_texture(source, target, 1, {tokens, 1}, "original");
    } catch (const verify::Rejected& rejected) {
      return rejected.what();
    }
    return {};
  };
  EXPECT_EQ(rejection(1), "");
  EXPECT_EQ(rejection(0x1p-300), "the proof about the texture costs too much to check");
}

/// Without a scale, all decisions would be left to large rationals, and honest proofs refused.
TEST(TextureCertificate, OfTinyCoordinatesCostsWhatOthersCost) {
  const auto at_size = [](int exponent) {
    const double size = std::ldexp(1, exponent);
    const Chart chart = [size](double s, double t) { return Eigen::Vector2d(size * s, size * t); };
    return scaled(Case{grid(24, lifted(0), chart), grid(1, lifted(0), chart), 0.01, 0.01}, size);
  };
  const Case usual = at_size(0), tiny = at_size(-400);
  const auto bytes = usual.certificate().certificate.bytes;
  EXPECT_EQ(usual.rejection(bytes), "");
  // The proof of the usual meshes, with the identity of the tiny ones in its header.
  const auto surfaces =
      verify::texture_surfaces({&tiny.a.mesh, &tiny.a.attributes}, {&tiny.b.mesh, &tiny.b.attributes});
  const std::array identities = {verify::identity_of(tiny.a.mesh), verify::identity_of(tiny.b.mesh)};
  Bytes other = bytes;
  const std::size_t at = texture_at(bytes);
  for (std::size_t i = 0; i < 2; ++i) {
    other = with(other, 40 + 24 * i, identities[i].checksum);
    other = with(other, at + 8 + 8 * i, verify::checksum_of(surfaces[i]));
  }
  other = with(other, 16, std::bit_cast<std::uint64_t>(tiny.tolerance));
  other = with(other, at, std::bit_cast<std::uint64_t>(tiny.texture_tolerance));
  EXPECT_EQ(tiny.rejection(other), "");
}

}  // namespace texture_certificate_test
}  // namespace meshbound
