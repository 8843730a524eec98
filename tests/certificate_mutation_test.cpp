// SPDX-License-Identifier: MIT
// Thousands of wrong certificates. Damage of any kind is seen by the checksum; what a forger would do, who seals his
// certificate again, is rejected by the proof itself, or is another proof that an oracle confirms.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>

#include "certificate/encoder.h"
#include "datasets/analytic_meshes.h"
#include "forged_bytes.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"
#include "verify/pieces.h"
#include "verify/verifier.h"

namespace meshbound {
namespace certificate_mutation_test {

using Bytes = std::vector<std::uint8_t>;
using test::put;
using test::sealed;
using Nodes = std::vector<ProofNode>;
using Random = std::mt19937;

std::size_t below(Random& random, std::size_t n) { return random() % n; }

/// Two meshes, a tolerance slightly above their distance, and the certificate for it.
struct Case {
  TriangleMesh a, b;
  Bounds distance;
  double tolerance = 0;
  Bytes bytes;
};

Case make_case(const TriangleMesh& a, const TriangleMesh& b) {
  DistanceOptions options;
  options.error_bound = 1e-10;  // far below the 1e-6 by which the tolerance below is changed
  Case made{a, b, hausdorff_distance(Bvh(a), Bvh(b), options).bounds, 0, {}};
  made.tolerance = 1.001 * made.distance.upper;
  made.bytes = build_certificate(a, b, made.tolerance)->bytes;
  return made;
}

TriangleMesh bent(TriangleMesh mesh, double by) {
  for (Eigen::Vector3d& p : mesh.vertices) p.z() += by * std::sin(7 * p.x() + 5 * p.y());
  return mesh;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      make_case(datasets::icosphere(1, 2), datasets::icosphere(1, 1)),
      make_case(datasets::gear(1, 0.4, 8, 6, 1), bent(datasets::gear(1, 0.4, 8, 5, 2), 0.02)),
      make_case(datasets::terrain(1, 12, 3), datasets::terrain(1, 4, 3)),
      make_case(datasets::cube(1, 5), datasets::cube(1.03, 1)),
      make_case(reference::random_soup(3, 30, 0.4), bent(reference::random_soup(3, 30, 0.4), 0.1))};
  return all;
}

/// For these meshes, whatever it was made for.
Bytes made_out_to(Bytes bytes, const TriangleMesh& a, const TriangleMesh& b) {
  const verify::MeshIdentity ids[] = {verify::identity_of(a), verify::identity_of(b)};
  for (std::size_t i = 0; i < 2; ++i) {
    put(bytes, 24 + 24 * i, ids[i].vertices);
    put(bytes, 32 + 24 * i, ids[i].triangles);
    put(bytes, 40 + 24 * i, ids[i].checksum);
  }
  return sealed(bytes);
}

/// Why it is rejected; empty when it is not.
std::string rejection(const TriangleMesh& a, const TriangleMesh& b, const Bytes& bytes) {
  try {
    (void)verify::check_certificate(a, b, bytes);
  } catch (const verify::Rejected& rejected) {
    return rejected.what();
  }
  return {};
}

std::string rejection(const Case& of, const Bytes& bytes) { return rejection(of.a, of.b, bytes); }

/// The trees of one direction with triangles instead of steps.
Nodes decoded(const TriangleMesh& source, const verify::Section& section) {
  Nodes nodes;
  verify::TokenReader reader(section.tokens);
  std::vector<std::uint32_t> last_at(source.vertices.size(), 0);
  std::uint32_t last = 0;
  for (const Triangle& triangle : source.triangles) {
    for (int open = 1; open > 0; --open) {
      const verify::Token token = reader.next();
      ProofNode& node = nodes.emplace_back();
      if (token.kind == verify::Token::Kind::Cut) {
        node.kind = ProofNode::Kind::Cut;
        node.chord = {{token.from.edge, token.from.numerator}, {token.to.edge, token.to.numerator}, token.bits};
        open += 2;
        continue;
      }
      node.kind = token.kind == verify::Token::Kind::Parity ? ProofNode::Kind::Parity : ProofNode::Kind::Near;
      last = token.kind == verify::Token::Kind::Recall ? last_at[triangle[token.corner]]
                                                       : static_cast<std::uint32_t>(last + token.step);
      node.target = last;
    }
    for (const std::uint32_t vertex : triangle) last_at[vertex] = last;
  }
  return nodes;
}

struct Trees {
  Nodes forward, backward;
};

Trees trees_of(const Case& of) {
  const verify::Certificate certificate = verify::parse_certificate(of.bytes);
  return {decoded(of.a, certificate.original_to_simplified), decoded(of.b, certificate.simplified_to_original)};
}

Bytes encoded(const Case& of, const Trees& trees) {
  const std::vector<Nodes> forward{trees.forward}, backward{trees.backward};
  return assemble(CertifiedMesh(of.a), CertifiedMesh(of.b), of.tolerance, encode(of.a, forward),
                  encode(of.b, backward));
}

/// Where the tree of each source triangle begins, and the end.
std::vector<std::size_t> roots_of(const Nodes& nodes) {
  std::vector<std::size_t> roots;
  int open = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (open == 0) {
      roots.push_back(i);
      open = 1;
    }
    open += nodes[i].kind == ProofNode::Kind::Cut ? 1 : -1;
  }
  roots.push_back(nodes.size());
  return roots;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh, std::size_t triangle) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.extend(mesh.vertices[v]);
  return box;
}

/// All of it further than the tolerance from all of a source triangle.
std::uint32_t far_triangle(Random& random, const TriangleMesh& source, std::size_t triangle, const TriangleMesh& target,
                           double tolerance) {
  for (;;) {
    const std::size_t candidate = below(random, target.triangles.size());
    if (box_of(source, triangle).exteriorDistance(box_of(target, candidate)) > tolerance)
      return static_cast<std::uint32_t>(candidate);
  }
}

TEST(CertificateMutation, DecodingAndEncodingGiveTheSameBytes) {
  for (const Case& of : cases()) {
    EXPECT_EQ(rejection(of, of.bytes), "");
    EXPECT_EQ(encoded(of, trees_of(of)), of.bytes);
    EXPECT_EQ(sealed(of.bytes), of.bytes);
    EXPECT_EQ(made_out_to(of.bytes, of.a, of.b), of.bytes);
  }
}

TEST(CertificateMutation, TheCasesUseEveryKindOfToken) {
  std::map<verify::Token::Kind, int> seen;
  for (const Case& of : cases()) {
    const verify::Certificate certificate = verify::parse_certificate(of.bytes);
    for (const verify::Section& section : {certificate.original_to_simplified, certificate.simplified_to_original})
      for (verify::TokenReader reader(section.tokens); !reader.at_end();) ++seen[reader.next().kind];
  }
  EXPECT_EQ(seen.size(), 4U);
  for (const auto& [kind, count] : seen) EXPECT_GE(count, 10) << static_cast<int>(kind);
}

/// Every bit of two certificates, and bits of the others: not one goes unseen, however harmless.
TEST(CertificateMutation, AnyFlippedBitIsRejected) {
  Random random(1);
  std::size_t tried = 0, rejected = 0;
  for (std::size_t c = 0; c < cases().size(); ++c) {
    const Case& of = cases()[c];
    const std::size_t bits = 8 * of.bytes.size(), wanted = c < 2 ? bits : 1000;
    for (std::size_t i = 0; i < wanted; ++i, ++tried) {
      const std::size_t bit = wanted == bits ? i : below(random, bits);
      Bytes mutated = of.bytes;
      mutated[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      if (!rejection(of, mutated).empty()) ++rejected;
    }
  }
  EXPECT_GT(tried, 10000U);
  EXPECT_EQ(rejected, tried);
  RecordProperty("mutations", static_cast<int>(tried));
}

TEST(CertificateMutation, AnyMovedVertexOrSwappedIndexOfAMeshIsRejected) {
  Random random(2);
  for (const Case& of : cases()) {
    for (int i = 0; i < 200; ++i) {
      TriangleMesh a = of.a, b = of.b;
      TriangleMesh& mesh = i % 2 == 0 ? a : b;
      if (i % 4 < 2) {
        double& x = mesh.vertices[below(random, mesh.vertices.size())][static_cast<Eigen::Index>(below(random, 3))];
        x = std::nextafter(x, 2);
      } else {
        Triangle& t = mesh.triangles[below(random, mesh.triangles.size())];
        std::swap(t[below(random, 2)], t[2]);
      }
      EXPECT_NE(rejection(a, b, of.bytes), "");
    }
    EXPECT_NE(rejection(of.b, of.a, of.bytes), "") << "the meshes are swapped";
  }
}

TEST(CertificateMutation, SealedAgainATriangleThatIsFarIsRejected) {
  Random random(3);
  for (const Case& of : cases()) {
    const Trees trees = trees_of(of);
    for (int i = 0; i < 300; ++i) {
      Trees mutated = trees;
      const bool forward = i % 2 == 0;
      Nodes& nodes = forward ? mutated.forward : mutated.backward;
      const TriangleMesh &source = forward ? of.a : of.b, &target = forward ? of.b : of.a;
      const std::vector<std::size_t> roots = roots_of(nodes);
      std::size_t at = below(random, nodes.size());
      while (nodes[at].kind == ProofNode::Kind::Cut) ++at;
      const auto triangle =
          static_cast<std::size_t>(std::upper_bound(roots.begin(), roots.end(), at) - roots.begin() - 1);
      nodes[at].target = far_triangle(random, source, triangle, target, of.tolerance);
      const std::string why = rejection(of, encoded(of, mutated));
      EXPECT_NE(why.find("triangle " + std::to_string(triangle) + " of the "), std::string::npos) << why;
    }
  }
}

/// One piece for a whole triangle that needs several: its corners tell whether that one is enough.
TEST(CertificateMutation, SealedAgainAMissingPieceIsRejected) {
  std::size_t tried = 0;
  for (const Case& of : cases()) {
    const Trees trees = trees_of(of);
    for (const bool forward : {true, false}) {
      const Nodes& nodes = forward ? trees.forward : trees.backward;
      const TriangleMesh &source = forward ? of.a : of.b, &target = forward ? of.b : of.a;
      const std::vector<std::size_t> roots = roots_of(nodes);
      for (std::size_t t = 0; t < source.triangles.size(); ++t) {
        if (nodes[roots[t]].kind != ProofNode::Kind::Cut) continue;
        for (std::size_t i = roots[t]; i < roots[t + 1]; ++i) {
          if (nodes[i].kind != ProofNode::Kind::Near) continue;
          bool is_enough = true;
          for (const Eigen::Vector3d& corner : reference::corners(source, t))
            is_enough =
                is_enough &&
                reference::exact_distance(corner, reference::corners(target, nodes[i].target)).compare(of.tolerance) <=
                    0;
          if (is_enough) continue;
          Trees mutated = trees;
          Nodes& cut = forward ? mutated.forward : mutated.backward;
          cut.erase(cut.begin() + static_cast<std::ptrdiff_t>(roots[t]),
                    cut.begin() + static_cast<std::ptrdiff_t>(roots[t + 1]));
          cut.insert(cut.begin() + static_cast<std::ptrdiff_t>(roots[t]), nodes[i]);
          EXPECT_NE(rejection(of, encoded(of, mutated)), "");
          ++tried;
        }
      }
    }
  }
  EXPECT_GT(tried, 500U);
  RecordProperty("mutations", static_cast<int>(tried));
}

TEST(CertificateMutation, SealedAgainTreesLeftOutOrRepeatedAreRejected) {
  for (const Case& of : cases()) {
    const Trees trees = trees_of(of);
    const std::vector<std::size_t> roots = roots_of(trees.forward);
    Trees shorter = trees;
    shorter.forward.erase(shorter.forward.begin() + static_cast<std::ptrdiff_t>(roots[roots.size() - 2]),
                          shorter.forward.end());
    EXPECT_EQ(rejection(of, encoded(of, shorter)), "the proof ends in the middle of a token");
    const std::size_t size = encode(of.b, std::vector<Nodes>{trees.backward}).bytes.size();
    Bytes trailing = of.bytes;
    trailing.insert(trailing.end() - 8, 0);  // a leaf too many
    put(trailing, 88, size + 1);
    EXPECT_EQ(rejection(of, sealed(trailing)), "the proof goes on after its last triangle");
  }
}

TEST(CertificateMutation, SealedAgainATighterToleranceThanTheDistanceIsRejected) {
  for (const Case& of : cases()) {
    for (int i = 0; i < 200; ++i) {
      const double claimed = of.distance.lower * (1 - std::pow(0.5, i % 40)) * (i < 40 ? 1 : 1 - i / 400.0);
      if (!(claimed < of.distance.lower)) continue;
      Bytes mutated = of.bytes;
      put(mutated, 16, std::bit_cast<std::uint64_t>(claimed));
      EXPECT_NE(rejection(of, sealed(mutated)), "") << claimed << " below " << of.distance.lower;
    }
  }
}

TEST(CertificateMutation, SealedAgainATighterToleranceIsRejectedWhereThePiecesNeedTheOldOne) {
  for (const Case& of : cases()) {
    Bytes mutated = of.bytes;
    put(mutated, 16, std::bit_cast<std::uint64_t>(0.999 * of.tolerance));
    EXPECT_NE(rejection(of, sealed(mutated)), "");
  }
}

TEST(CertificateMutation, SealedAgainTolerancesThatAreNoLengthsAreRejected) {
  for (const double tolerance : {-1.0, -0.0, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Bytes mutated = cases()[0].bytes;
    put(mutated, 16, std::bit_cast<std::uint64_t>(tolerance));
    EXPECT_EQ(rejection(cases()[0], sealed(mutated)), "the tolerance is not a finite length of 0 or more");
  }
}

/// A vertex moved so far that the tolerance no longer holds, in a certificate made out to the new mesh.
TEST(CertificateMutation, MadeOutToAMeshThatIsTooFarItIsRejected) {
  Random random(4);
  std::size_t tried = 0;
  for (const Case& of : cases()) {
    for (int i = 0; i < 150; ++i) {
      TriangleMesh a = of.a, b = of.b;
      TriangleMesh& mesh = i % 2 == 0 ? a : b;
      Eigen::Vector3d& p = mesh.vertices[below(random, mesh.vertices.size())];
      p += (1 + 0.02 * i) * of.tolerance * Eigen::Vector3d(p.x() + 0.1, p.y(), p.z() + 0.2).normalized();
      if (hausdorff_distance(Bvh(a), Bvh(b)).bounds.lower <= of.tolerance) continue;  // it still holds
      EXPECT_NE(rejection(a, b, made_out_to(of.bytes, a, b)), "");
      ++tried;
    }
  }
  EXPECT_GT(tried, 300U);
  RecordProperty("mutations", static_cast<int>(tried));
}

/// Points of a piece, in doubles.
std::vector<Eigen::Vector3d> samples_of(verify::PieceCorners& corners, const verify::Piece& piece) {
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t i : piece) {
    const auto& p = corners.exact(i);
    points.emplace_back(p.x.get_d(), p.y.get_d(), p.z.get_d());
  }
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const double share : {0.2, 0.5, 0.8}) points.push_back(points[i] + share * (points[j] - points[i]));
  return points;
}

/// Checks the leaves of a direction by sampling, with nothing of what the verifier decides with: points of a piece lie
/// near its triangle, or near the mesh for a proof by parity.
class SamplingOracle {
 public:
  SamplingOracle(const TriangleMesh& source, const TriangleMesh& target, double tolerance)
      : source_(source), target_(target), tree_(target), tolerance_(tolerance) {}

  /// Trees that are as in `known` are taken for granted.
  [[nodiscard]] bool confirms(const Nodes& nodes, const Nodes& known) {
    const std::vector<std::size_t> roots = roots_of(nodes), known_roots = roots_of(known);
    for (std::size_t i = 0; i < source_.triangles.size(); ++i) {
      if (std::equal(nodes.begin() + at(roots[i]), nodes.begin() + at(roots[i + 1]), known.begin() + at(known_roots[i]),
                     known.begin() + at(known_roots[i + 1]), same))
        continue;
      const Triangle& t = source_.triangles[i];
      corners_.start({source_.vertices[t[0]], source_.vertices[t[1]], source_.vertices[t[2]]});
      std::size_t next = roots[i];
      if (!confirms(verify::Piece{0, 1, 2}, nodes, next)) return false;
    }
    return true;
  }

 private:
  static std::ptrdiff_t at(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }
  static bool same(const ProofNode& x, const ProofNode& y) {
    if (x.kind != y.kind) return false;
    if (x.kind != ProofNode::Kind::Cut) return x.target == y.target;
    const Chord &c = x.chord, &d = y.chord;
    return c.bits == d.bits && c.from.edge == d.from.edge && c.to.edge == d.to.edge &&
           c.from.numerator == d.from.numerator && c.to.numerator == d.to.numerator;
  }

  bool confirms(const verify::Piece& piece, const Nodes& nodes, std::size_t& next) {
    const ProofNode& node = nodes[next++];
    if (node.kind == ProofNode::Kind::Cut) {
      verify::Token chord;
      chord.from = {node.chord.from.edge, node.chord.from.numerator};
      chord.to = {node.chord.to.edge, node.chord.to.numerator};
      chord.bits = node.chord.bits;
      const auto [first, second] = corners_.cut(piece, chord);
      return confirms(first, nodes, next) && confirms(second, nodes, next);
    }
    constexpr double rounding = 1e-14;  // of the sample points, for models of size 1
    const auto points = samples_of(corners_, piece);
    return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
      if (node.kind == ProofNode::Kind::Parity) return closest_point(tree_, p).distance.lower <= tolerance_ + rounding;
      return reference::exact_distance(p, reference::corners(target_, node.target)).compare(tolerance_ + rounding) <= 0;
    });
  }

  const TriangleMesh& source_;
  const TriangleMesh& target_;
  Bvh tree_;
  double tolerance_;
  verify::PieceCorners corners_;
};

/// Both directions.
struct Oracle {
  explicit Oracle(const Case& made_for)
      : of(made_for), forward(of.a, of.b, of.tolerance), backward(of.b, of.a, of.tolerance) {}

  [[nodiscard]] bool confirms(const Bytes& bytes, const Trees& known) {
    const verify::Certificate certificate = verify::parse_certificate(bytes);
    EXPECT_EQ(certificate.tolerance, of.tolerance);
    return forward.confirms(decoded(of.a, certificate.original_to_simplified), known.forward) &&
           backward.confirms(decoded(of.b, certificate.simplified_to_original), known.backward);
  }

  const Case& of;
  SamplingOracle forward, backward;
};

/// Trees that no tree is the same as: nothing is taken for granted.
Trees nothing_known(const Trees& trees) {
  ProofNode none;
  none.target = 0xffffffff;
  return {Nodes(roots_of(trees.forward).size() - 1, none), Nodes(roots_of(trees.backward).size() - 1, none)};
}

/// Flips bits of the proof itself. Some of the results are proofs as well: with a chord that ends elsewhere, another
/// seed, or another triangle that is as near.
TEST(CertificateMutation, SealedAgainAFlippedBitIsRejectedOrStillAProof) {
  Random random(6);
  std::size_t tried = 0, accepted = 0;
  for (const Case& of : cases()) {
    Oracle oracle(of);
    const Trees trees = trees_of(of);
    ASSERT_TRUE(oracle.confirms(of.bytes, nothing_known(trees)));
    const std::size_t header = 104, bits = 8 * (of.bytes.size() - header - 8);
    for (int i = 0; i < 1000; ++i, ++tried) {
      const std::size_t bit = below(random, bits);
      Bytes mutated = of.bytes;
      mutated[header + bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      mutated = sealed(mutated);
      if (!rejection(of, mutated).empty()) continue;
      ++accepted;
      EXPECT_TRUE(oracle.confirms(mutated, trees)) << "bit " << bit;
    }
  }
  EXPECT_LT(accepted, tried / 2);
  RecordProperty("mutations", static_cast<int>(tried));
  RecordProperty("other_proofs", static_cast<int>(accepted));
}

/// The proofs of two triangles exchanged by exchanging the triangles, in a certificate made out to the new mesh.
TEST(CertificateMutation, MadeOutToPermutedMeshesItIsRejectedOrStillAProof) {
  Random random(5);
  std::size_t tried = 0, accepted = 0;
  for (const Case& of : cases()) {
    const Trees trees = trees_of(of);
    for (int i = 0; i < 100; ++i, ++tried) {
      Case permuted = of;
      TriangleMesh& mesh = i % 2 == 0 ? permuted.a : permuted.b;
      const std::size_t first = below(random, mesh.triangles.size());
      std::swap(mesh.triangles[first], mesh.triangles[far_triangle(random, mesh, first, mesh, of.tolerance)]);
      const Bytes bytes = made_out_to(of.bytes, permuted.a, permuted.b);
      if (!rejection(permuted, bytes).empty()) continue;
      ++accepted;
      EXPECT_TRUE(Oracle(permuted).confirms(bytes, nothing_known(trees)));
    }
  }
  EXPECT_LT(accepted, tried / 4);
}

/// Bits of the header: each field is one that the proof or the meshes contradict. Only a larger tolerance is a weaker
/// truth.
TEST(CertificateMutation, SealedAgainAFlippedBitOfTheHeaderIsRejectedOrAWeakerTruth) {
  for (const Case& of : cases()) {
    for (std::size_t bit = 0; bit < 8 * 104; ++bit) {
      Bytes mutated = of.bytes;
      mutated[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      mutated = sealed(mutated);
      if (!rejection(of, mutated).empty()) continue;
      EXPECT_EQ(bit / 64, 2U) << "bit " << bit << " is not of the tolerance";
      EXPECT_GE(verify::parse_certificate(mutated).tolerance, of.distance.upper);
    }
  }
}

}  // namespace certificate_mutation_test
}  // namespace meshbound
