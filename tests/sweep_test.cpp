// SPDX-License-Identifier: GPL-3.0-or-later
// Every real mesh on this machine through the simplifier at many tolerances, with every driver: what would be written
// is measured afresh, and no verdict may stay open. Failures name the mesh, the tolerance and the interval.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "datasets.h"
#include "drivers.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"

namespace meshbound {
namespace sweep_test {

namespace fs = std::filesystem;

using Percentages = std::span<const double>;  // of the diagonal
constexpr double ten_tolerances[] = {0.01, 0.02, 0.05, 0.1, 0.12, 0.15, 0.2, 0.3, 0.5, 1};
constexpr double two_tolerances[] = {0.1, 0.5};
/// Above this a mesh is simplified at two tolerances only, which keeps the sweep at some minutes.
constexpr std::size_t max_triangles_at_ten = 30'000;

struct Subject {
  std::string name;
  TriangleMesh mesh;
  double diagonal = 0;
};

/// Nothing where the reader refuses the file.
std::optional<Subject> read_subject(const fs::path& file) {
  try {
    Subject subject{file.parent_path().filename().string() + '/' + file.filename().string(), read_mesh(file).mesh};
    subject.diagonal = diagonal_of(used_bounding_box(subject.mesh));
    (void)Bvh(subject.mesh, BvhOptions{1});  // refuses coordinates that are too large
    return subject;
  } catch (const Error&) {
    return std::nullopt;
  }
}

SimplifyOptions options_for(double tolerance, const fs::path& format, const test::NamedDriver& driver) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.precision = format_of(format) == FileFormat::Stl ? Precision::Single : Precision::Double;
  options.threads = 1;
  options.driver = driver.driver;
  return options;
}

/// The sweep counts its work: a measurement that needs far more cuts than any should is an undecided one.
DistanceOptions measurement(const Subject& subject, double tolerance) {
  DistanceOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  options.budget.subdivisions = 1'000'000 + 1000 * subject.mesh.triangles.size();
  return options;
}

/// Simplifies and measures what a file of this format would hold. Whether the verdict is Within.
bool is_decided(const Subject& subject, double tolerance, const fs::path& format, const test::NamedDriver& driver) {
  const SimplifiedLevel level = simplify_with_bound(subject.mesh, options_for(tolerance, format, driver)).last();
  const TriangleMesh written = rounded_for(format, level.mesh);
  const HausdorffDistance distance = hausdorff_distance(subject.mesh, written, measurement(subject, tolerance));
  const bool is_within = level.verdict == Verdict::Within && distance.bounds.upper <= tolerance;
  if (!is_within)
    std::printf(
        "undecided: %s to %s, driver %s, at %.17g (%.4g%%), %zu faces left: library's verdict %s, measured [%.17g, "
        "%.17g]\n",
        subject.name.c_str(), format.c_str(), driver.name.c_str(), tolerance, 100 * tolerance / subject.diagonal,
        level.faces(), to_string(level.verdict).c_str(), distance.bounds.lower, distance.bounds.upper);
  return is_within;
}

int count_undecided(const Subject& subject, std::span<const double> tolerances, const fs::path& format) {
  int undecided = 0;
  for (const test::NamedDriver& driver : test::drivers())
    for (const double tolerance : tolerances) undecided += is_decided(subject, tolerance, format, driver) ? 0 : 1;
  std::printf("%s, %zu triangles, %s: %zu tolerances, %d undecided\n", subject.name.c_str(),
              subject.mesh.triangles.size(), format.c_str(), tolerances.size(), undecided);
  std::fflush(stdout);
  return undecided;
}

std::vector<double> of_diagonal(const Subject& subject, Percentages percentages) {
  std::vector<double> lengths;
  for (const double percent : percentages) lengths.push_back(percent / 100 * subject.diagonal);
  return lengths;
}

class SlowSweep : public testing::TestWithParam<const char*> {};

TEST_P(SlowSweep, DecidesEveryMeshOfTheFolder) {
  const std::vector<fs::path> files = test::datasets_in(GetParam());
  if (files.empty()) GTEST_SKIP() << "no data set has a folder " << GetParam() << ": set MESHBOUND_DATASETS";
  int meshes = 0, undecided = 0;
  for (const fs::path& file : files) {
    const std::optional<Subject> subject = read_subject(file);
    if (!subject) continue;
    const bool is_large = subject->mesh.triangles.size() > max_triangles_at_ten;
    const auto tolerances = of_diagonal(*subject, is_large ? Percentages(two_tolerances) : Percentages(ten_tolerances));
    undecided += count_undecided(*subject, tolerances, "out.ply");
    ++meshes;
  }
  std::printf("%s: %d meshes of %zu files, %d runs undecided\n", GetParam(), meshes, files.size(), undecided);
  EXPECT_GT(meshes, 0) << "the reader refuses all files";
  EXPECT_EQ(undecided, 0) << "the lines above that begin with 'undecided' name them";
}

INSTANTIATE_TEST_SUITE_P(Of, SlowSweep, testing::Values("cad", "game", "organic", "scan", "pairs", "broken"),
                         [](const auto& folder) { return std::string(folder.param); });

/// Machined parts at the tolerances that engineers give, to files of both precisions.
TEST(SlowPartsSweep, DecidesSevenPartsAtSevenTolerancesInStlAndPly) {
  std::vector<fs::path> files = test::datasets_in("cad");
  std::erase_if(files, [](const fs::path& file) { return file.extension() != ".stl"; });
  if (files.empty()) GTEST_SKIP() << "no data set has STL files in cad: set MESHBOUND_DATASETS";
  int undecided = 0;
  for (const fs::path& file : files) {
    const std::optional<Subject> subject = read_subject(file);
    ASSERT_TRUE(subject) << file;
    std::vector<double> tolerances = {0.01, 0.02, 0.05, 0.1, 0.2};
    for (const double share : {0.001, 0.005}) tolerances.push_back(share * subject->diagonal);
    for (const char* format : {"out.stl", "out.ply"}) undecided += count_undecided(*subject, tolerances, format);
  }
  EXPECT_EQ(undecided, 0) << "the lines above that begin with 'undecided' name them";
}

}  // namespace sweep_test
}  // namespace meshbound
