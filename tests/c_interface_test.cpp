// SPDX-License-Identifier: MIT
// The C interface answers as the library does, bit for bit, for buffers of every kind; whatever is wrong becomes a
// status and one line.
#include <fenv.h>
#include <gtest/gtest.h>
#include <meshbound.h>
#include <omp.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "c_calls.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/meshbound.h"
#include "temporary_folder.h"

namespace {

using meshbound::TriangleMesh;
using namespace meshbound::test;

class CInterface : public testing::Test {
 protected:
  TriangleMesh torus_ = meshbound::datasets::torus(1, 0.3, 48, 24);
  TriangleMesh sphere_ = meshbound::datasets::icosphere(1, 3);
  mb_mesh a_ = c_mesh(torus_), b_ = c_mesh(sphere_);
};

TEST_F(CInterface, MeasuresAsTheLibraryDoes) {
  const auto expected = meshbound::hausdorff_distance(torus_, sphere_);
  mb_distance distance{};
  ASSERT_EQ(mb_measure(&a_, &b_, nullptr, &distance), MB_OK) << mb_error_message();
  EXPECT_EQ(distance.bounds.lower, expected.bounds.lower);
  EXPECT_EQ(distance.bounds.upper, expected.bounds.upper);
  EXPECT_EQ(distance.a_to_b.bounds.upper, expected.a_to_b.bounds.upper);
  EXPECT_EQ(distance.b_to_a.from.triangle, expected.b_to_a.witness.from.triangle);
  EXPECT_EQ(distance.b_to_a.nearest.position[2], expected.b_to_a.witness.nearest.position.z());
  EXPECT_EQ(distance.a_to_b.outcome, MB_CONVERGED);

  auto options = defaults(mb_distance_options_init);
  options.one_sided = 1;
  options.error_bound = 0.01;
  ASSERT_EQ(mb_measure(&b_, &a_, &options, &distance), MB_OK);
  EXPECT_EQ(distance.b_to_a.outcome, MB_NOT_SEARCHED);
  EXPECT_EQ(distance.bounds.upper, distance.a_to_b.bounds.upper);
  EXPECT_LE(distance.bounds.upper - distance.bounds.lower, 0.01);
}

TEST_F(CInterface, MeasuresUntilATolerance) {
  auto options = defaults(mb_distance_options_init);
  options.error_bound = 0.3;
  mb_distance rough{}, decided{};
  ASSERT_EQ(mb_measure(&a_, &b_, &options, &rough), MB_OK);
  options.tolerance = 1.000001 * meshbound::hausdorff_distance(torus_, sphere_).bounds.upper;
  ASSERT_GT(rough.bounds.upper, options.tolerance);
  ASSERT_EQ(mb_measure(&a_, &b_, &options, &decided), MB_OK);
  EXPECT_LE(decided.bounds.upper, options.tolerance);
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mb_measure(&a_, &b_, &options, &decided), MB_INVALID_INPUT);
}

TEST_F(CInterface, DecidesBothWays) {
  const double upper = meshbound::hausdorff_distance(torus_, sphere_).bounds.upper;
  mb_verdict verdict = MB_UNDECIDED;
  ASSERT_EQ(mb_check(&a_, &b_, 1.01 * upper, nullptr, &verdict, nullptr), MB_OK);
  EXPECT_EQ(verdict, MB_WITHIN);
  mb_distance distance{};
  ASSERT_EQ(mb_check(&a_, &b_, 0.99 * upper, nullptr, &verdict, &distance), MB_OK);
  EXPECT_EQ(verdict, MB_EXCEEDS);
  EXPECT_GT(distance.bounds.lower, 0.99 * upper);
}

/// Both meshes have one large triangle. The small triangle of A lies in it and that of B floats 1 above it, so that
/// h(A, B) is 0 and H(A, B) is 1. The triangles correspond in order, which decides without trees.
TEST_F(CInterface, DecidesOneSideByItsOwnBounds) {
  TriangleMesh flat{{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}}, {{0, 1, 2}, {3, 4, 5}}};
  TriangleMesh floating = flat;
  for (std::size_t v = 3; v < 6; ++v) floating.vertices[v].z() = 1;
  const mb_mesh a = c_mesh(flat), b = c_mesh(floating);
  auto options = defaults(mb_distance_options_init);
  options.one_sided = 1;
  mb_verdict verdict = MB_UNDECIDED;
  mb_distance distance{};
  ASSERT_EQ(mb_check(&a, &b, 1.5, &options, &verdict, &distance), MB_OK) << mb_error_message();
  EXPECT_EQ(verdict, MB_WITHIN);
  EXPECT_EQ(distance.bounds.lower, 0);
  EXPECT_LE(distance.bounds.upper, 1.5);
  EXPECT_EQ(distance.b_to_a.outcome, MB_NOT_SEARCHED);
  ASSERT_EQ(mb_check(&a, &b, 1.5, nullptr, &verdict, &distance), MB_OK) << mb_error_message();
  EXPECT_GT(distance.bounds.lower, 0.99);
  EXPECT_NE(distance.b_to_a.outcome, MB_NOT_SEARCHED);
}

/// The time for the trees counts.
TEST_F(CInterface, EndsAtTheTimeLimit) {
  auto options = defaults(mb_distance_options_init);
  options.time_limit = 0;
  mb_distance distance{};
  ASSERT_EQ(mb_measure(&a_, &b_, &options, &distance), MB_OK) << mb_error_message();
  EXPECT_EQ(distance.bounds.lower, 0);
  EXPECT_EQ(distance.bounds.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(distance.a_to_b.outcome, MB_NOT_SEARCHED);
  mb_verdict verdict = MB_WITHIN;
  ASSERT_EQ(mb_check(&a_, &b_, 1, &options, &verdict, nullptr), MB_OK) << mb_error_message();
  EXPECT_EQ(verdict, MB_UNDECIDED);
}

/// Floats at a stride, at an odd address, with 16-bit indices.
TEST_F(CInterface, ReadsBuffersOfEveryKind) {
  std::vector<char> bytes(1 + 20 * sphere_.vertices.size());
  TriangleMesh rounded = sphere_;
  for (std::size_t i = 0; i < sphere_.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const volatile float x = static_cast<float>(sphere_.vertices[i][k]);  // GCC 12 takes unrounded values otherwise
      const float stored = x;
      rounded.vertices[i][k] = stored;
      std::memcpy(bytes.data() + 1 + 20 * i + 4 * static_cast<std::size_t>(k), &stored, 4);
    }
  }
  std::vector<std::uint16_t> indices;
  for (const auto& triangle : sphere_.triangles)
    for (const std::uint32_t v : triangle) indices.push_back(static_cast<std::uint16_t>(v));
  mb_mesh mesh{};
  mesh.positions = bytes.data() + 1;
  mesh.coordinate_type = MB_FLOAT32;
  mesh.position_stride = 20;
  mesh.vertex_count = sphere_.vertices.size();
  mesh.indices = indices.data();
  mesh.index_type = MB_UINT16;
  mesh.triangle_count = sphere_.triangles.size();
  const mb_mesh same = c_mesh(rounded);
  mb_distance distance{};
  ASSERT_EQ(mb_measure(&mesh, &same, nullptr, &distance), MB_OK) << mb_error_message();
  EXPECT_EQ(distance.bounds.upper, 0);
  mb_mesh_facts facts{};
  ASSERT_EQ(mb_describe(&mesh, &facts), MB_OK);
  EXPECT_EQ(facts.triangles, sphere_.triangles.size());
  EXPECT_EQ(facts.components, 1u);
  EXPECT_EQ(facts.closed, 1);
  EXPECT_EQ(facts.bbox_diagonal, meshbound::bounding_box_diagonal(rounded));
}

TEST_F(CInterface, SimplifiesAsTheLibraryDoes) {
  meshbound::SimplifyOptions wanted;
  wanted.tolerance = 0.02;
  wanted.levels = {0.005};
  wanted.certificate = true;
  const auto expected = meshbound::simplify_with_bound(torus_, wanted);

  auto options = simplify_options(0.02);
  const double finer = 0.005;
  options.levels = &finer;
  options.level_count = 1;
  options.certificate = 1;
  Simplification result;
  ASSERT_EQ(mb_simplify(&a_, &options, &result.handle), MB_OK) << mb_error_message();
  ASSERT_EQ(mb_simplification_level_count(result.handle), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const mb_level level = result.level(i);
    const auto& other = expected.levels[i];
    EXPECT_EQ(level.tolerance, other.tolerance);
    EXPECT_EQ(level.verdict, MB_WITHIN);
    EXPECT_EQ(level.ended_by, MB_ENDED_NOTHING_FITS);
    EXPECT_EQ(level.distance.bounds.upper, other.distance->bounds.upper);
    ASSERT_EQ(level.vertex_count, other.mesh.vertices.size());
    ASSERT_EQ(level.triangle_count, other.mesh.triangles.size());
    EXPECT_EQ(std::memcmp(level.positions, other.mesh.vertices.data(), 24 * level.vertex_count), 0);
    EXPECT_EQ(std::memcmp(level.indices, other.mesh.triangles.data(), 12 * level.triangle_count), 0);
    EXPECT_EQ(level.source_vertices[0], other.source_vertex[0]);
    EXPECT_EQ(level.source_triangles[0], other.source_triangle[0]);
    EXPECT_EQ(std::vector<std::uint8_t>(level.certificate, level.certificate + level.certificate_size),
              other.certificate->bytes);
  }
}

/// Each option changes the result in its own way.
TEST_F(CInterface, PassesOptionsOn) {
  const auto simplified = [&](const mb_simplify_options& options) {
    auto result = std::make_unique<Simplification>();
    EXPECT_EQ(mb_simplify(&a_, &options, &result->handle), MB_OK) << mb_error_message();
    return result;
  };
  auto options = simplify_options(0.05);
  options.target_faces = 1000;
  EXPECT_EQ(simplified(options)->level(0).ended_by, MB_ENDED_TARGET);
  options.target_faces = MB_NO_TARGET;
  options.target_ratio = 0.5;
  EXPECT_EQ(simplified(options)->level(0).ended_by, MB_ENDED_TARGET);
  options.target_ratio = -1;
  options.placement = MB_SUBSET;
  const auto subset = simplified(options);
  const mb_level of_subset = subset->level(0);
  for (std::size_t v = 0; v < of_subset.vertex_count; ++v)
    EXPECT_EQ(of_subset.positions[3 * v], torus_.vertices[of_subset.source_vertices[v]].x());
  options.placement = MB_OPTIMAL;
  options.single_precision = 1;
  const auto single = simplified(options);
  const mb_level of_single = single->level(0);
  for (std::size_t i = 0; i < 3 * of_single.vertex_count; ++i)
    EXPECT_EQ(of_single.positions[i], static_cast<double>(static_cast<float>(of_single.positions[i])));
  const std::vector<std::uint8_t> all(torus_.vertices.size(), 1);
  options.locked_vertices = all.data();
  EXPECT_EQ(simplified(options)->level(0).triangle_count, torus_.triangles.size());
}

TEST_F(CInterface, KeepsSidesOnRequestAndCountsTurnedFacesElse) {
  TriangleMesh grid = meshbound::datasets::terrain(1, 17, 3);
  for (std::size_t t = 0; t < grid.triangles.size(); t += 10) std::swap(grid.triangles[t][0], grid.triangles[t][1]);
  const mb_mesh mesh = c_mesh(grid);
  auto options = simplify_options(0.1);
  Simplification turned, kept;
  ASSERT_EQ(mb_simplify(&mesh, &options, &turned.handle), MB_OK) << mb_error_message();
  EXPECT_GT(mb_simplification_turned_faces(turned.handle, 0), 0u);
  options.keep_sides = 1;
  ASSERT_EQ(mb_simplify(&mesh, &options, &kept.handle), MB_OK) << mb_error_message();
  EXPECT_EQ(mb_simplification_turned_faces(kept.handle, 0), 0u);
  EXPECT_EQ(mb_simplification_turned_faces(turned.handle, 1), 0u);
  EXPECT_EQ(mb_simplification_turned_faces(nullptr, 0), 0u);
  EXPECT_GT(kept.level(0).triangle_count, turned.level(0).triangle_count);
}

TEST_F(CInterface, FindsFeatureLines) {
  const TriangleMesh grid = meshbound::datasets::terrain(1, 17, 3);
  const mb_mesh mesh = c_mesh(grid);
  auto options = simplify_options(0.1);
  options.line_tolerance = 0.01;
  Simplification result;
  ASSERT_EQ(mb_simplify(&mesh, &options, &result.handle), MB_OK) << mb_error_message();
  EXPECT_EQ(result.level(0).has_lines, 1);
  EXPECT_LE(result.level(0).line_distance.upper, 0.01);

  std::vector<std::uint32_t> edges;  // all of them: nothing but flat parts of straight lines may go
  for (const auto& t : grid.triangles) edges.insert(edges.end(), {t[0], t[1], t[1], t[2], t[2], t[0]});
  options.feature_edges = edges.data();
  options.feature_edge_count = edges.size() / 2;
  Simplification with_edges;
  ASSERT_EQ(mb_simplify(&mesh, &options, &with_edges.handle), MB_OK) << mb_error_message();
  EXPECT_GT(with_edges.level(0).triangle_count, result.level(0).triangle_count);

  auto by_face = simplify_options(0.1);
  const std::vector<double> tight(grid.triangles.size(), 1e-6);
  Simplification with_tolerances, without;
  ASSERT_EQ(mb_simplify(&mesh, &by_face, &without.handle), MB_OK) << mb_error_message();
  by_face.face_tolerances = tight.data();
  ASSERT_EQ(mb_simplify(&mesh, &by_face, &with_tolerances.handle), MB_OK) << mb_error_message();
  EXPECT_GT(with_tolerances.level(0).triangle_count, without.level(0).triangle_count);
}

TEST_F(CInterface, ChecksManyLevelsOfOneOriginal) {
  mb_level_checker* checker = nullptr;
  ASSERT_EQ(mb_level_checker_new(&a_, nullptr, &checker), MB_OK) << mb_error_message();
  mb_verdict verdict = MB_UNDECIDED;
  mb_distance distance{};
  EXPECT_EQ(mb_level_checker_check(checker, &a_, 0, nullptr, &verdict, nullptr), MB_OK);
  EXPECT_EQ(verdict, MB_WITHIN);
  EXPECT_EQ(mb_level_checker_check(checker, &b_, 0.1, nullptr, &verdict, &distance), MB_OK);
  EXPECT_EQ(verdict, MB_EXCEEDS);
  ASSERT_EQ(mb_level_checker_measure(checker, &b_, nullptr, &distance), MB_OK);
  EXPECT_NEAR(distance.bounds.upper, meshbound::hausdorff_distance(torus_, sphere_).bounds.upper, 1e-5);
  auto options = defaults(mb_distance_options_init);
  options.one_sided = 1;
  EXPECT_EQ(mb_level_checker_measure(checker, &b_, &options, &distance), MB_INVALID_INPUT);
  mb_level_checker_free(checker);
}

TEST_F(CInterface, ProvesOrSaysWhyNot) {
  mb_certificate* certificate = nullptr;
  ASSERT_EQ(mb_certificate_new(&a_, &a_, 0.001, nullptr, &certificate), MB_OK) << mb_error_message();
  const auto expected = meshbound::build_certificate(torus_, torus_, 0.001);
  const std::vector<std::uint8_t> bytes(mb_certificate_data(certificate),
                                        mb_certificate_data(certificate) + mb_certificate_size(certificate));
  EXPECT_EQ(bytes, expected->bytes);
  mb_certificate_free(certificate);
  certificate = nullptr;
  EXPECT_EQ(mb_certificate_new(&a_, &b_, 0.001, nullptr, &certificate), MB_FAILED);
  EXPECT_EQ(certificate, nullptr);
  EXPECT_NE(std::string(mb_error_message()).find("triangle"), std::string::npos) << mb_error_message();
}

TEST_F(CInterface, RefusesWhatIsNoMesh) {
  mb_distance distance{};
  distance.bounds.lower = 42;
  const auto refused = [&](const mb_mesh* mesh, const std::string& reason) {
    EXPECT_EQ(mb_measure(mesh, &b_, nullptr, &distance), MB_INVALID_INPUT) << reason;
    EXPECT_NE(std::string(mb_error_message()).find(reason), std::string::npos) << mb_error_message();
    EXPECT_EQ(distance.bounds.lower, 42) << "an output of a call that failed was changed";
  };
  refused(nullptr, "a is NULL");
  mb_mesh mesh = a_;
  mesh.positions = nullptr;
  refused(&mesh, "a.positions is NULL");
  mesh = a_;
  mesh.indices = nullptr;
  refused(&mesh, "a.indices is NULL");
  mesh = a_;
  mesh.position_stride = 8;
  refused(&mesh, "a.position_stride is 8 bytes");
  mesh = a_;
  mesh.coordinate_type = 2;
  refused(&mesh, "coordinate_type");
  mesh = a_;
  mesh.index_type = 2;
  refused(&mesh, "index_type");
  mesh = a_;
  mesh.triangle_count = 0;
  refused(&mesh, "no triangles");
  mesh = a_;
  mesh.vertex_count = 10;
  refused(&mesh, "there are only 10");
  torus_.vertices[5].y() = std::numeric_limits<double>::infinity();
  refused(&a_, "vertex 5");
}

TEST_F(CInterface, RefusesWrongOptions) {
  mb_distance distance{};
  const auto refuses = [&](const mb_distance_options& options, const std::string& reason) {
    EXPECT_EQ(mb_measure(&a_, &b_, &options, &distance), MB_INVALID_INPUT) << reason;
    EXPECT_NE(std::string(mb_error_message()).find(reason), std::string::npos) << mb_error_message();
  };
  auto options = defaults(mb_distance_options_init);
  options.time_limit = -1;
  refuses(options, "time_limit");
  options = defaults(mb_distance_options_init);
  options.error_bound = std::nan("");
  refuses(options, "error_bound");
  options = defaults(mb_distance_options_init);
  options.struct_size = 0;
  refuses(options, "struct_size");
  options.struct_size = sizeof options + 8;
  refuses(options, "not older than the header");
  mb_verdict verdict = MB_WITHIN;
  EXPECT_EQ(mb_check(&a_, &a_, -1, nullptr, &verdict, nullptr), MB_INVALID_INPUT);
  EXPECT_EQ(mb_check(&a_, &a_, 1, nullptr, nullptr, nullptr), MB_INVALID_INPUT);
  auto unset = defaults(mb_simplify_options_init);
  mb_simplification* result = nullptr;
  EXPECT_EQ(mb_simplify(&a_, &unset, &result), MB_INVALID_INPUT);
  EXPECT_NE(std::string(mb_error_message()).find("tolerance"), std::string::npos);
  unset.tolerance = 1;
  unset.effort = 7;
  EXPECT_EQ(mb_simplify(&a_, &unset, &result), MB_INVALID_INPUT);
  mb_level level{};
  EXPECT_EQ(mb_simplification_level(nullptr, 0, &level), MB_INVALID_INPUT);
}

/// A program that was compiled when the options ended earlier: what lies behind is not read.
TEST_F(CInterface, TakesOptionsOfAnOlderHeader) {
  auto options = defaults(mb_distance_options_init);
  options.struct_size = offsetof(mb_distance_options, cancel);
  options.progress = [](double, void*) { return 1; };
  options.cancel = reinterpret_cast<mb_cancel*>(std::uintptr_t{1});
  mb_distance distance{};
  EXPECT_EQ(mb_measure(&a_, &b_, &options, &distance), MB_OK) << mb_error_message();
}

TEST_F(CInterface, KeepsTheMessageOfEachThread) {
  mb_distance distance{};
  EXPECT_EQ(mb_measure(nullptr, &b_, nullptr, &distance), MB_INVALID_INPUT);
  std::thread([] { EXPECT_EQ(std::string(mb_error_message()), ""); }).join();
  EXPECT_NE(std::string(mb_error_message()), "");
}

/// As in a process in which some library was linked with -ffast-math.
TEST_F(CInterface, WorksInAnyRoundingMode) {
  mb_distance expected{}, distance{};
  ASSERT_EQ(mb_measure(&a_, &b_, nullptr, &expected), MB_OK);
  ASSERT_EQ(fesetround(FE_UPWARD), 0);
#if defined(__SSE2__)
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
#endif
  EXPECT_EQ(mb_measure(&a_, &b_, nullptr, &distance), MB_OK) << mb_error_message();
  EXPECT_EQ(fegetround(), FE_UPWARD);
#if defined(__SSE2__)
  EXPECT_EQ(_MM_GET_FLUSH_ZERO_MODE(), _MM_FLUSH_ZERO_ON);
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_OFF);
#endif
  fesetround(FE_TONEAREST);
  EXPECT_EQ(distance.bounds.upper, expected.bounds.upper);
}

#if defined(__SSE2__)
/// More threads are asked for than OpenMP has by itself, and those that an engine has left in its pool flush to zero:
/// the denormal height between two grids would be 0 there. A triangle that is there twice keeps the grids from
/// corresponding.
TEST_F(CInterface, WorksInAnyRoundingModeOnThreadsOfAnEngine) {
  constexpr int threads = 3;
  constexpr double height = 3e-310;
  TriangleMesh low = meshbound::datasets::terrain(1, 65, 3), high = low;
  for (auto& v : low.vertices) v.z() = 0;
  for (auto& v : high.vertices) v.z() = height;
  high.triangles.push_back(high.triangles.front());
  const mb_mesh a = c_mesh(low), b = c_mesh(high);
  auto options = defaults(mb_distance_options_init);
  options.threads = threads;
  const int threads_before = omp_get_max_threads();
  omp_set_num_threads(1);
  mb_distance distance{};
  const unsigned before = _mm_getcsr();
#pragma omp parallel num_threads(threads)
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);  // clang's OpenMP gives the caller its mode back after a region
  const mb_status status = mb_measure(&a, &b, &options, &distance);
#pragma omp parallel num_threads(threads)
  _mm_setcsr(before);
  _mm_setcsr(before);
  omp_set_num_threads(threads_before);
  ASSERT_EQ(status, MB_OK) << mb_error_message();
  EXPECT_LE(distance.bounds.lower, height);
  EXPECT_GE(distance.bounds.upper, height);
}
#endif

TEST(CVersion, IsThatOfTheHeader) {
  EXPECT_EQ(mb_abi_version(), MB_ABI_VERSION);
  EXPECT_EQ(std::string(mb_version()), MESHBOUND_VERSION);
}

TEST(CFree, TakesNull) {
  mb_simplification_free(nullptr);
  mb_level_checker_free(nullptr);
  mb_certificate_free(nullptr);
  mb_cancel_free(nullptr);
  EXPECT_EQ(mb_simplification_level_count(nullptr), 0u);
}

TEST_F(CInterface, ReadsAndWritesFilesOfEveryFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"a.off", "a.obj", "a.ply", "a.stl", "a.glb"}) {
    const std::string path = folder / name;
    ASSERT_EQ(mb_mesh_file_write(path.c_str(), &a_, 0, nullptr), MB_OK) << mb_error_message();
    const TriangleMesh expected = meshbound::read_mesh(path).mesh;
    mb_mesh_file* file = nullptr;
    ASSERT_EQ(mb_mesh_file_read(path.c_str(), nullptr, &file), MB_OK) << mb_error_message();
    mb_mesh mesh{};
    ASSERT_EQ(mb_mesh_file_mesh(file, &mesh), MB_OK);
    ASSERT_EQ(mesh.vertex_count, expected.vertices.size()) << name;
    ASSERT_EQ(mesh.triangle_count, torus_.triangles.size()) << name;
    EXPECT_EQ(std::memcmp(mesh.positions, expected.vertices.data(), 24 * mesh.vertex_count), 0) << name;
    EXPECT_EQ(std::memcmp(mesh.indices, expected.triangles.data(), 12 * mesh.triangle_count), 0) << name;
    mb_mesh_file_free(file);
  }
  ASSERT_EQ(mb_mesh_file_write((folder / "f.ply").c_str(), &a_, 1, nullptr), MB_OK);
  EXPECT_EQ(meshbound::read_mesh(folder / "f.ply").mesh.vertices[1].x(), static_cast<float>(torus_.vertices[1].x()));
}

TEST_F(CInterface, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const auto status_of = [](const std::string& path, const mb_cancel* cancel) {
    mb_mesh_file* file = nullptr;
    const mb_status status = mb_mesh_file_read(path.c_str(), cancel, &file);
    EXPECT_EQ(file == nullptr, status != MB_OK);
    mb_mesh_file_free(file);
    return status;
  };
  EXPECT_EQ(status_of(folder / "missing.ply", nullptr), MB_FAILED);
  EXPECT_EQ(status_of(folder / "mesh.txt", nullptr), MB_INVALID_INPUT);
  EXPECT_NE(std::string(mb_error_message()).find("unknown mesh format"), std::string::npos) << mb_error_message();
  EXPECT_EQ(mb_mesh_file_write((folder / "missing/a.ply").c_str(), &a_, 0, nullptr), MB_FAILED);
  EXPECT_EQ(mb_mesh_file_write((folder / "a.ply").c_str(), nullptr, 0, nullptr), MB_INVALID_INPUT);
  EXPECT_EQ(mb_mesh_file_read(nullptr, nullptr, nullptr), MB_INVALID_INPUT);
  EXPECT_EQ(mb_mesh_file_mesh(nullptr, nullptr), MB_INVALID_INPUT);
  mb_cancel* cancel = mb_cancel_new();
  mb_cancel_request(cancel);
  EXPECT_EQ(mb_mesh_file_write((folder / "b.ply").c_str(), &a_, 0, cancel), MB_CANCELLED);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.ply"));
  mb_cancel_free(cancel);
}

}  // namespace
