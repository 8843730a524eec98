// SPDX-License-Identifier: MIT
// Certificates hold where the distance does: what the engine proves, the verifier confirms by exact arithmetic, and
// what is not so cannot be certified.
#include "meshbound/certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bvh/bvh_data.h"
#include "certificate/cut_search.h"
#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "proof/edge_neighbours.h"
#include "reference/small_meshes.h"
#include "tiles/certificate_in_tiles.h"
#include "verify/verifier.h"

namespace meshbound {
namespace certificate_test {

struct Pair {
  std::string name;
  TriangleMesh a, b;
};

/// A copy whose vertices are off by up to `by`, in a way that repeats.
TriangleMesh shaken(TriangleMesh mesh, double by) {
  double angle = 0;
  for (Eigen::Vector3d& p : mesh.vertices) {
    angle += 2.4;
    p += by * Eigen::Vector3d(std::sin(angle), std::sin(3 * angle), std::cos(5 * angle)) / 2;
  }
  return mesh;
}

TriangleMesh with_needles(TriangleMesh mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t i = 0; i < n; i += 7) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[1], t[1]});  // a segment
    mesh.triangles.push_back({t[2], t[2], t[2]});  // a point
    mesh.triangles.push_back(t);                   // twice the same
  }
  return mesh;
}

std::vector<Pair> pairs() {
  using namespace datasets;
  const TriangleMesh soup = reference::random_soup(7, 40, 0.4);
  const TriangleMesh far = reference::moved(icosphere(1, 2), {1e6, -3e6, 2e6});
  return {
      {"FineAndCoarseSphere", icosphere(1, 4), icosphere(1, 1)},
      {"CoarseAndFineSphere", icosphere(1, 1), icosphere(1, 4)},
      {"SphereWithPoles", uv_sphere(1, 20, 30), uv_sphere(1, 9, 11)},
      {"Torus", torus(1, 0.3, 60, 24), torus(1, 0.3, 17, 9)},
      {"Gear", gear(1, 0.4, 12, 8, 3), shaken(gear(1, 0.4, 12, 8, 3), 0.01)},
      {"FineAndCoarseCube", cube(1, 9), cube(1.01, 1)},
      {"ThinSheetAndSquare", thin_sheet(1, 0.02, 12), reference::unit_square(3)},
      {"SpikesOnAPlane", spiked_plane(1, 0.1, 16, 4), reference::unit_square(1)},
      {"Terrain", terrain(1, 24, 5), shaken(terrain(1, 12, 5), 0.02)},
      {"Soups", soup, shaken(soup, 0.05)},
      {"SoupAndSphere", soup, icosphere(1, 2)},
      {"DegenerateTriangles", with_needles(icosphere(1, 2)), with_needles(icosphere(1, 3))},
      {"OneTriangleAndTwo", reference::unit_square(1), reference::single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
      {"FarFromTheOrigin", far, shaken(far, 0.01)},
      {"Tiny", reference::scaled(icosphere(1, 3), 1e-150), reference::scaled(icosphere(1, 1), 1e-150)},
      {"Huge", reference::scaled(icosphere(1, 3), 1e150), reference::scaled(icosphere(1, 1), 1e150)},
      {"BelowTheNormalRange", reference::scaled(icosphere(1, 2), 1e-300), reference::scaled(icosphere(1, 1), 1e-300)}};
}

double distance_of(const Pair& pair) { return hausdorff_distance(Bvh(pair.a), Bvh(pair.b)).bounds.upper; }

verify::Proof proof_of(const Pair& pair, double tolerance) {
  const auto certificate = build_certificate(pair.a, pair.b, tolerance);
  EXPECT_TRUE(certificate);
  const verify::Proof proof = verify::check_certificate(pair.a, pair.b, certificate->bytes);
  EXPECT_EQ(proof.tolerance, tolerance);
  EXPECT_EQ(proof.original_to_simplified.pieces, certificate->original_to_simplified.pieces);
  EXPECT_EQ(proof.simplified_to_original.cuts, certificate->simplified_to_original.cuts);
  return proof;
}

class CertificateOfPair : public testing::TestWithParam<Pair> {};

TEST_P(CertificateOfPair, HoldsJustAboveTheDistance) {
  const double distance = distance_of(GetParam());
  const verify::Proof proof = proof_of(GetParam(), distance * (1 + 1e-5));
  EXPECT_GE(proof.original_to_simplified.pieces, GetParam().a.triangles.size());
  EXPECT_GE(proof.simplified_to_original.pieces, GetParam().b.triangles.size());
}

TEST_P(CertificateOfPair, HoldsFarAboveTheDistance) {
  const verify::Proof proof = proof_of(GetParam(), 3 * distance_of(GetParam()));
  EXPECT_GE(proof.original_to_simplified.pieces, GetParam().a.triangles.size());
}

TEST_P(CertificateOfPair, IsNotMadeBelowTheDistance) {
  const double lower = hausdorff_distance(Bvh(GetParam().a), Bvh(GetParam().b)).bounds.lower;
  try {
    (void)build_certificate(GetParam().a, GetParam().b, lower * (1 - 1e-9));
    FAIL() << "a certificate of what is not so";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no certificate: triangle "), std::string::npos) << error.what();
  }
}

TEST(Certificate, EndsWithWhatItsCallerThrows) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  for (const int threads : {1, 2}) {
    CertificateOptions options;
    options.threads = threads;
    options.progress = [](double) { throw std::runtime_error("enough"); };
    EXPECT_THROW((void)build_certificate(sphere, sphere, 0.1, options), std::runtime_error);
  }
}

TEST_P(CertificateOfPair, IsTheSameForAnyNumberOfThreads) {
  const double tolerance = 1.5 * distance_of(GetParam());
  CertificateOptions options;
  options.threads = 1;
  const auto one = build_certificate(GetParam().a, GetParam().b, tolerance, options);
  options.threads = 3;
  const auto three = build_certificate(GetParam().a, GetParam().b, tolerance, options);
  EXPECT_EQ(one->bytes, three->bytes);
}

/// Gives each job the bytes of its result, as other processes would take them.
class PackingRunner : public JobRunner {
 public:
  void run(TileJobs& jobs) override {
    for (const std::size_t job : heaviest_first(jobs)) jobs.unpack(job, jobs.run_packed(job));
  }
};

std::optional<Certificate> in_tiles(const TriangleMesh& a, const TriangleMesh& b, double tolerance, JobRunner& runner) {
  return certify_in_tiles(MeshInMemory(a), MeshInMemory(b), tolerance, {}, {40}, runner);
}

TEST_P(CertificateOfPair, HoldsInTilesWhoeverWorksOnThem) {
  const TriangleMesh &a = GetParam().a, &b = GetParam().b;
  for (const double share : {1 + 1e-5, 3.0}) {
    const double tolerance = share * distance_of(GetParam());
    ThreadRunner one(1), three(3);
    PackingRunner packing;
    const auto certificate = in_tiles(a, b, tolerance, one);
    EXPECT_EQ(verify::check_certificate(a, b, certificate->bytes).tolerance, tolerance);
    EXPECT_EQ(in_tiles(a, b, tolerance, three)->bytes, certificate->bytes);
    EXPECT_EQ(in_tiles(a, b, tolerance, packing)->bytes, certificate->bytes);
  }
}

TEST_P(CertificateOfPair, IsNotMadeInTilesBelowTheDistance) {
  const double lower = hausdorff_distance(Bvh(GetParam().a), Bvh(GetParam().b)).bounds.lower;
  ThreadRunner threads(2);
  EXPECT_THROW((void)in_tiles(GetParam().a, GetParam().b, lower * (1 - 1e-9), threads), Error);
}

INSTANTIATE_TEST_SUITE_P(Pairs, CertificateOfPair, testing::ValuesIn(pairs()),
                         [](const auto& of) { return of.param.name; });

TEST(Certificate, OfAMeshAndItselfHoldsForATolerance0) {
  for (const TriangleMesh& mesh : {datasets::icosphere(1, 2), with_needles(datasets::cube(1, 3)),
                                   reference::moved(datasets::torus(1, 0.3, 20, 9), {1e7, 1e7, 1e7})}) {
    EXPECT_EQ(proof_of({"", mesh, mesh}, 0).tolerance, 0);
    EXPECT_EQ(proof_of({"", mesh, mesh}, -0.0).tolerance, 0);
    ThreadRunner threads(2);
    EXPECT_EQ(verify::check_certificate(mesh, mesh, in_tiles(mesh, mesh, 0, threads)->bytes).tolerance, 0);
  }
}

/// An original that is written as it is, or rounded: a time limit leaves this when there is no time for a search.
TEST(Certificate, OfTrianglesThatCorrespondTakesOnePass) {
  const TriangleMesh mesh = with_needles(datasets::torus(1, 0.3, 40, 16));
  for (const double by : {0.0, 1e-7}) {
    const TriangleMesh other = shaken(mesh, by);
    const std::uint64_t tree_before = Bvh(mesh).data().serial;
    const auto certificate = build_certificate(mesh, other, 2e-7);
    ASSERT_TRUE(certificate);
    EXPECT_EQ(Bvh(mesh).data().serial, tree_before + 1) << "a tree was built";
    const auto proof = verify::check_certificate(mesh, other, certificate->bytes);
    EXPECT_EQ(proof.original_to_simplified.pieces, mesh.triangles.size());
    EXPECT_EQ(certificate->original_to_simplified.cuts, 0u);
    EXPECT_EQ(certificate->original_to_simplified.bytes, mesh.triangles.size());
  }
}

/// Corners that are as far apart as the tolerance, but for some roundings: never a wrong certificate.
TEST(Certificate, OfTrianglesThatCorrespondKeepsAMarginForTheVerifier) {
  const TriangleMesh square = reference::unit_square(2);
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d(0.03, 0.05, 0.07)}) {
    const TriangleMesh above = reference::moved(square, direction);
    for (int step = -100; step <= 100; ++step) {
      const double tolerance = direction.norm() * (1 + step * 0x1p-52);
      try {
        const auto certificate = build_certificate(square, above, tolerance);
        EXPECT_NO_THROW((void)verify::check_certificate(square, above, certificate->bytes)) << step;
      } catch (const Error&) {
        EXPECT_LT(step, 90);
      }
    }
  }
}

/// Where coordinates are as coarse as the triangles, pieces of these are proven by parity for a tolerance far below the
/// rounding of sums of coordinates.
TEST(Certificate, OfAMeshAndItselfHoldsVeryFarFromTheOrigin) {
  const auto path = test::dataset("broken/syn_far_offset_1e15.off");
  if (!path) GTEST_SKIP() << "no datasets folder with broken/ (set MESHBOUND_DATASETS)";
  const TriangleMesh mesh = read_mesh(*path).mesh;
  TriangleMesh reversed = mesh;  // so that triangles of the same number are others
  std::reverse(reversed.triangles.begin(), reversed.triangles.end());
  EXPECT_GT(proof_of({"", mesh, reversed}, 1.6e-5).original_to_simplified.by_parity, 0u);
}

TEST(Certificate, OfBuffersIsThatOfTheMeshTheyHold) {
  const TriangleMesh mesh = datasets::icosphere(1, 2);
  std::vector<float> positions;
  std::vector<std::uint16_t> indices;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) indices.push_back(static_cast<std::uint16_t>(v));
  const MeshView view(positions.data(), mesh.vertices.size(), 3 * sizeof(float), indices.data(), mesh.triangles.size());
  const auto certificate = build_certificate(mesh, view, 1e-6);
  EXPECT_NO_THROW((void)verify::check_certificate(mesh, to_triangle_mesh(view), certificate->bytes));
  EXPECT_THROW((void)verify::check_certificate(mesh, mesh, certificate->bytes), verify::Rejected);
}

/// Tolerances around a distance that doubles cannot tell from it: a certificate is made or not, but never a wrong one.
TEST(Certificate, KeepsAMarginForTheVerifier) {
  const TriangleMesh square = reference::unit_square(2);
  const TriangleMesh above = reference::moved(reference::unit_square(3), {0, 0, 0.1});
  int made = 0, refused = 0;
  for (int step = -600; step <= 3000; step += 20) {
    const double tolerance = 0.1 * (1 + step * 1e-15);
    try {
      const auto certificate = build_certificate(square, above, tolerance);
      EXPECT_NO_THROW((void)verify::check_certificate(square, above, certificate->bytes)) << step;
      ++made;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(made, 20);
  EXPECT_GT(refused, 20);
}

/// One triangle over 200,000 others: more than one proof by parity may use.
TEST(Certificate, OfALargeFlatFaceIsSmall) {
  const TriangleMesh plain = reference::unit_square(300);
  const auto certificate = build_certificate(plain, reference::unit_square(1), 1e-4);
  EXPECT_NO_THROW((void)verify::check_certificate(plain, reference::unit_square(1), certificate->bytes));
  EXPECT_GT(certificate->simplified_to_original.by_parity, 2U);
  EXPECT_LT(certificate->simplified_to_original.bytes, 20000U);
}

/// Each large triangle of a stack could be proven by one byte that costs a reader half of the fine sheet.
TEST(Certificate, OfAStackOverAFineSheetAsksForLittleWorkAByte) {
  const TriangleMesh sheet = reference::unit_square(40);
  TriangleMesh stack;
  for (std::uint32_t layer = 0; layer < 100; ++layer) {
    const TriangleMesh square = reference::moved(reference::unit_square(1), {0, 0, 1e-5 * layer});
    for (const Triangle& t : square.triangles)
      stack.triangles.push_back({4 * layer + t[0], 4 * layer + t[1], 4 * layer + t[2]});
    stack.vertices.insert(stack.vertices.end(), square.vertices.begin(), square.vertices.end());
  }
  const auto certificate = build_certificate(stack, sheet, 0.01);
  ASSERT_TRUE(certificate);
  const verify::Proof::Direction proof =
      verify::check_certificate(stack, sheet, certificate->bytes).original_to_simplified;
  EXPECT_LT(proof.work, 128 * proof.bytes);
  const auto single = build_certificate(reference::unit_square(1), sheet, 0.01);
  ASSERT_TRUE(single);
  const verify::Proof::Direction whole =
      verify::check_certificate(reference::unit_square(1), sheet, single->bytes).original_to_simplified;
  EXPECT_GT(whole.work, 512 * whole.bytes) << "what is rare may still be proven by few bytes";
}

/// A tolerance that is the distance itself leaves no room for rounding; the message names one that does.
TEST(Certificate, NamesAToleranceThatCanBeProven) {
  const TriangleMesh plate = reference::unit_square(3),
                     other = reference::moved(reference::unit_square(2), {0, 0, 0.1});
  std::string message;
  try {
    (void)build_certificate(plate, other, 0.1);
  } catch (const Error& error) {
    message = error.what();
  }
  const std::size_t number = message.find("no further, ");
  ASSERT_NE(number, std::string::npos) << message;
  const double tolerance = std::stod(message.substr(number + 12));
  EXPECT_GT(tolerance, 0.1);
  EXPECT_LT(tolerance, 0.1 * (1 + 1e-9));
  const auto certificate = build_certificate(plate, other, tolerance);
  ASSERT_TRUE(certificate);
  EXPECT_NO_THROW((void)verify::check_certificate(plate, other, certificate->bytes));
}

TEST(Certificate, EndsWhenItIsTold) {
  const TriangleMesh fine = datasets::icosphere(1, 4), coarse = datasets::icosphere(1, 1);
  const std::atomic<bool> cancel = true;
  CertificateOptions cancelled, late, short_of_steps;
  cancelled.cancel = &cancel;
  late.seconds = 0;
  short_of_steps.steps_per_triangle = 1;
  EXPECT_FALSE(build_certificate(fine, coarse, 1, cancelled));
  const std::uint64_t tree_before = Bvh(coarse).data().serial;
  EXPECT_FALSE(build_certificate(fine, coarse, 1, late));
  EXPECT_EQ(Bvh(coarse).data().serial, tree_before + 1) << "a tree was built although there was no time";
  const double distance = hausdorff_distance(Bvh(fine), Bvh(coarse)).bounds.upper;
  EXPECT_THROW((void)build_certificate(fine, coarse, 1.00001 * distance, short_of_steps), Error);
}

/// The search within one triangle and from one to the next, which a run of triangles consists of.
TEST(CutSearch, EndsOnceTheTokenSaysStop) {
  const Bvh tree(datasets::icosphere(1, 3));
  const Bvh::Data& data = tree.data();
  const auto neighbours = edge_neighbours(data.vertices, data.corners);
  Goal goal;
  goal.tolerance = 0.01;
  const std::atomic<bool> told = true;
  goal.stop.cancel = &told;
  CutSearch search(data, neighbours, goal, 1, 1);
  const CornerTriangle<double> t = triangle_at(data, 0);
  std::uint32_t hint = 0;
  std::vector<ProofNode> nodes;
  EXPECT_THROW((void)search.prove({t.a, t.a + t.ab, t.a + t.ac}, hint, nodes, 1000), Stopped);
}

TEST(Certificate, RefusesTolerancesThatAreNoLengths) {
  const TriangleMesh mesh = datasets::cube(1, 1);
  for (const double tolerance : {-1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW((void)build_certificate(mesh, mesh, tolerance), InvalidInput) << tolerance;
}

/// Real meshes against what another simplifier would make of them: here, every vertex a little off.
TEST(Certificate, HoldsForFetchedMeshes) {
  for (const char* name : {"cad/c3d_fandisk.obj", "scan/igl_bunny.off", "cad/c3d_rocker-arm.obj"}) {
    SCOPED_TRACE(name);
    const auto path = test::dataset(name);
    if (!path) GTEST_SKIP() << name << " is not on this machine (MESHBOUND_DATASETS)";
    const TriangleMesh mesh = read_mesh(*path).mesh;
    const double step = 1e-3 * Bvh(mesh).bounding_box_diagonal();
    const Pair pair{name, mesh, shaken(mesh, step)};
    EXPECT_GE(proof_of(pair, distance_of(pair) * (1 + 1e-6)).original_to_simplified.pieces, mesh.triangles.size());
  }
}

}  // namespace certificate_test
}  // namespace meshbound
