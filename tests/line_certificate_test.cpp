// SPDX-License-Identifier: MIT
// Certificates that also speak of feature lines: what is proven, what is refused, and what forgers may try.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>

#include "datasets/analytic_meshes.h"
#include "forged_bytes.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "verify/verifier.h"

namespace meshbound {
namespace line_certificate_test {

using Bytes = std::vector<std::uint8_t>;
using test::sealed;
using test::with;

/// Edges that one triangle has.
std::vector<Edge> borders(const TriangleMesh& mesh) {
  std::map<Edge, int> count;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      ++count[{std::min(a, b), std::max(a, b)}];
    }
  std::vector<Edge> edges;
  for (const auto& [edge, triangles] : count)
    if (triangles == 1) edges.push_back(edge);
  return edges;
}

/// The rectangle from the origin to (1, height) in n * n cells of two triangles.
TriangleMesh rectangle(std::uint32_t n, double height) {
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) mesh.vertices.emplace_back(double(i) / n, height * j / n, 0.0);
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// Two rectangles whose borders are 0.01 apart, and a certificate of both distances.
struct Case {
  TriangleMesh a = rectangle(8, 1), b = rectangle(3, 1.01);
  CertifiedLines lines{borders(a), borders(b), 0.010001};
  Bytes bytes = certificate_for(lines).bytes;

  [[nodiscard]] Certificate certificate_for(const CertifiedLines& about) const {
    CertificateOptions options;
    options.lines = about;
    return *build_certificate(a, b, 0.02, options);
  }
  [[nodiscard]] std::size_t lines_at() const {
    return test::end_of_proofs(bytes);
  }  // where the part about lines begins
};

/// Why it is rejected; empty when it is not.
std::string rejection(const Case& of, const Bytes& bytes) {
  try {
    (void)verify::check_certificate(of.a, of.b, bytes);
  } catch (const verify::Rejected& rejected) {
    return rejected.what();
  }
  return {};
}

TEST(LineCertificate, ProvesTheDistanceBetweenBorders) {
  const Case c;
  const verify::Proof proof = verify::check_certificate(c.a, c.b, c.bytes);
  ASSERT_TRUE(proof.lines);
  EXPECT_EQ(proof.tolerance, 0.02);
  EXPECT_EQ(proof.lines->tolerance, 0.010001);
  EXPECT_EQ(proof.lines->original_edges, 32U);
  EXPECT_EQ(proof.lines->simplified_edges, 12U);
  EXPECT_TRUE(proof.lines->has_all_borders);
  EXPECT_GE(proof.lines->original_to_simplified.pieces, 32U);
}

TEST(LineCertificate, IsNotMadeBelowTheDistance) {
  const Case c;
  try {
    (void)c.certificate_for({c.lines.original, c.lines.simplified, 0.0099});
    FAIL() << "the borders are 0.01 apart";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line "), std::string::npos) << error.what();
  }
}

TEST(LineCertificate, OfLinesThatDidNotMoveHoldsForATolerance0) {
  const TriangleMesh mesh = rectangle(4, 1);
  CertificateOptions options;
  options.lines = CertifiedLines{borders(mesh), borders(mesh), 0};
  const auto proof = verify::check_certificate(mesh, mesh, build_certificate(mesh, mesh, 0.1, options)->bytes);
  EXPECT_EQ(proof.lines->tolerance, 0);
}

TEST(LineCertificate, HasVersion1WithoutLines) {
  const Case c;
  EXPECT_EQ(c.bytes[8], 2);
  const Bytes without = build_certificate(c.a, c.b, 0.02)->bytes;
  EXPECT_EQ(without[8], 1);
  EXPECT_FALSE(verify::check_certificate(c.a, c.b, without).lines);
}

TEST(LineCertificate, SaysWhetherABorderIsMissing) {
  Case c;
  c.lines.original.pop_back();  // its neighbours and the other border are near it still
  c.lines.tolerance = 0.2;
  const Certificate made = c.certificate_for(c.lines);
  EXPECT_FALSE(verify::check_certificate(c.a, c.b, made.bytes).lines->has_all_borders);
}

/// A triangle with two corners at one position has one edge twice, and no border.
TEST(LineCertificate, TakesSegmentsForNoTriangles) {
  const TriangleMesh mesh = rectangle(2, 1);
  TriangleMesh with_segments = mesh;
  const std::vector<Edge> lines = borders(mesh);
  const auto away = static_cast<std::uint32_t>(with_segments.vertices.size());
  with_segments.vertices.emplace_back(1.5, 0.0, 0.0);
  with_segments.triangles.push_back({lines[0][0], away, away});
  with_segments.triangles.push_back({lines[1][0], lines[1][1], lines[1][1]});
  const auto has_all = [&](const std::vector<Edge>& listed) {
    CertificateOptions options;
    options.lines = CertifiedLines{listed, listed, 1};
    const Certificate made = *build_certificate(with_segments, with_segments, 0.1, options);
    return verify::check_certificate(with_segments, with_segments, made.bytes).lines->has_all_borders;
  };
  EXPECT_TRUE(has_all(lines));
  for (std::size_t left_out = 0; left_out < lines.size(); ++left_out) {
    std::vector<Edge> listed = lines;
    listed.erase(listed.begin() + static_cast<std::ptrdiff_t>(left_out));
    EXPECT_FALSE(has_all(listed)) << left_out;
  }
}

TEST(LineCertificate, TakesVerticesAtOnePositionForOne) {
  const TriangleMesh mesh = rectangle(4, 1);
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  std::vector<Edge> lines;  // by the first vertices at their positions, which need not be of one triangle
  const auto first_at = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::find(soup.vertices.begin(), soup.vertices.end(), mesh.vertices[v]) -
                                      soup.vertices.begin());
  };
  for (const auto& [a, b] : borders(mesh)) lines.push_back({first_at(a), first_at(b)});
  CertificateOptions options;
  options.lines = CertifiedLines{lines, borders(mesh), 1e-9};
  const Bytes bytes = build_certificate(soup, mesh, 0.1, options)->bytes;
  EXPECT_TRUE(verify::check_certificate(soup, mesh, bytes).lines->has_all_borders);
}

TEST(LineCertificate, RefusesWhatIsNoLine) {
  const Case c;
  const auto refuses = [&](std::vector<Edge> original, std::vector<Edge> simplified, double tolerance) {
    EXPECT_THROW((void)c.certificate_for({std::move(original), std::move(simplified), tolerance}), InvalidInput);
  };
  refuses({}, c.lines.simplified, 0.1);
  refuses(c.lines.original, {}, 0.1);
  refuses({{0, 80}}, c.lines.simplified, 0.1);    // the diagonal of the rectangle
  refuses({{0, 1000}}, c.lines.simplified, 0.1);  // no vertex
  refuses(c.lines.original, c.lines.simplified, -1);
  refuses(c.lines.original, c.lines.simplified, std::nan(""));
}

TEST(LineCertificate, ForgedTolerancesAndCountsAreRejected) {
  const Case c;
  const std::size_t at = c.lines_at();
  ASSERT_EQ(rejection(c, sealed(c.bytes)), "");
  EXPECT_NE(rejection(c, with(c.bytes, at, std::bit_cast<std::uint64_t>(0.00999))), "");
  EXPECT_NE(rejection(c, with(c.bytes, at, std::bit_cast<std::uint64_t>(-0.01))), "");
  EXPECT_NE(rejection(c, with(c.bytes, 8, 1, 4)), "");  // version 1 has no such part
  for (const std::size_t field : {8, 16, 24, 32, 40, 48})
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{31}, std::uint64_t{1} << 61,
                                      ~std::uint64_t{0}, std::uint64_t{1} << 32})
      EXPECT_NE(rejection(c, with(c.bytes, at + field, value)), "") << field << " " << value;
}

TEST(LineCertificate, BytesAtItsEndAreRejected) {
  const Case c;
  for (Bytes longer : {c.bytes, build_certificate(c.a, c.b, 0.02)->bytes}) {
    longer.insert(longer.end(), 8, 0);
    EXPECT_NE(rejection(c, sealed(longer)).find("add up"), std::string::npos);
  }
}

TEST(LineCertificate, ForgedLinesAreRejected) {
  const Case c;
  const std::size_t at = c.lines_at() + 56;
  EXPECT_NE(rejection(c, with(c.bytes, at, 40, 4)).find("no edge"), std::string::npos);   // from a border inwards
  EXPECT_NE(rejection(c, with(c.bytes, at, 100, 4)).find("no edge"), std::string::npos);  // no vertex
  EXPECT_NE(rejection(c, with(c.bytes, at, ~0U, 4)).find("no edge"), std::string::npos);
  const std::size_t simplified_at = at + 8 * c.lines.original.size();
  EXPECT_NE(rejection(c, with(c.bytes, simplified_at, 15, 4)).find("no edge"), std::string::npos);
}

/// A vertex without numbers is part of no triangle, so of no line: it is not taken for another one.
TEST(LineCertificate, LinesToVerticesWithoutNumbersAreRejected) {
  for (const double none : {HUGE_VAL, std::nan("")}) {
    Case c;
    for (TriangleMesh* mesh : {&c.a, &c.b}) mesh->vertices.emplace_back(none, none, none);
    c.bytes = c.certificate_for(c.lines).bytes;
    ASSERT_EQ(rejection(c, c.bytes), "");
    const std::size_t at = c.lines_at() + 56, simplified_at = at + 8 * c.lines.original.size();
    ASSERT_EQ(c.lines.original[0][0], 0U);  // its place is the lowest
    EXPECT_NE(rejection(c, with(c.bytes, at, c.a.vertices.size() - 1, 4)).find("no edge"), std::string::npos);
    EXPECT_NE(rejection(c, with(c.bytes, simplified_at, c.b.vertices.size() - 1, 4)).find("no edge"),
              std::string::npos);
  }
}

/// Any byte of the part about lines, changed and sealed again: the certificate is rejected, or what it says is true.
TEST(LineCertificate, WhatAForgerChangesIsRejectedOrTrue) {
  const Case c;
  std::mt19937 random(5);
  const std::size_t begin = c.lines_at(), size = c.bytes.size() - 8 - begin;
  std::size_t accepted = 0;
  for (int i = 0; i < 1000; ++i) {
    Bytes forged = c.bytes;
    for (std::size_t changes = 1 + random() % 2; changes > 0; --changes)
      forged[begin + random() % size] ^= static_cast<std::uint8_t>(1U << random() % 8);
    forged = sealed(forged);
    if (!rejection(c, forged).empty()) continue;
    ++accepted;
    const verify::LinePart part = *verify::parse_certificate(forged).lines;
    std::vector<Edge> original, simplified;
    for (std::size_t e = 0; e < part.original.size(); ++e) original.push_back(part.original.edge(e));
    for (std::size_t e = 0; e < part.simplified.size(); ++e) simplified.push_back(part.simplified.edge(e));
    const auto distance = hausdorff_distance(Bvh(line_mesh(c.a, original)), Bvh(line_mesh(c.b, simplified)));
    EXPECT_LE(distance.bounds.lower, part.tolerance);
  }
  EXPECT_LT(accepted, 500U);
}

}  // namespace line_certificate_test
}  // namespace meshbound
