// SPDX-License-Identifier: MIT
// Memory that runs out anywhere inside a C function is the status MB_OUT_OF_MEMORY: no exception reaches the caller,
// who may be written in a language that has none, and no output is changed.
#include <gtest/gtest.h>
#include <meshbound.h>

#include <array>
#include <functional>
#include <string>

#include "failing_new.h"
#include "temporary_folder.h"

namespace {

/// Two triangles of a square, bent along the diagonal for the second mesh.
class COutOfMemory : public testing::Test {
 protected:
  static mb_mesh mesh_of(const std::array<double, 12>& positions) {
    static constexpr std::array<std::uint32_t, 6> indices = {0, 1, 2, 0, 2, 3};
    return {positions.data(), 0, 4, indices.data(), 2, MB_FLOAT64, MB_UINT32};
  }

  std::array<double, 12> flat_ = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, bent_ = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5};
  mb_mesh a_ = mesh_of(flat_), b_ = mesh_of(bent_);
};

/// Calls `run` with memory for more and more allocations, from none on, until that is enough. Returns how often it was
/// not.
int failures_of(const std::function<mb_status()>& run) {
  int failures = 0;
  for (std::ptrdiff_t count = 0; count < 1000000; count += 1 + count / 8) {
    mb_status status = MB_FAILED;
    allowed = count;
    try {
      status = run();
    } catch (...) {
      allowed = unlimited;
      ADD_FAILURE() << "an exception left the function after " << count << " allocations";
      return failures;
    }
    allowed = unlimited;
    if (status == MB_OK) return failures;
    EXPECT_EQ(status, MB_OUT_OF_MEMORY) << mb_error_message();
    ++failures;
  }
  ADD_FAILURE() << "memory is never enough";
  return failures;
}

TEST_F(COutOfMemory, IsAStatusOfEveryMeasurement) {
  mb_mesh_facts facts{};
  mb_distance distance{};
  mb_verdict verdict{};
  EXPECT_GT(failures_of([&] { return mb_describe(&a_, &facts); }), 0);
  EXPECT_GT(failures_of([&] { return mb_measure(&a_, &b_, nullptr, &distance); }), 0);
  EXPECT_GT(failures_of([&] { return mb_check(&a_, &b_, 0.1, nullptr, &verdict, &distance); }), 0);
}

TEST_F(COutOfMemory, IsAStatusOfWhatMakesObjects) {
  mb_level_checker* checker = nullptr;
  EXPECT_GT(failures_of([&] { return mb_level_checker_new(&a_, nullptr, &checker); }), 0);
  mb_verdict verdict{};
  EXPECT_GT(failures_of([&] { return mb_level_checker_check(checker, &b_, 0.1, nullptr, &verdict, nullptr); }), 0);
  mb_level_checker_free(checker);
  mb_certificate* certificate = nullptr;
  EXPECT_GT(failures_of([&] { return mb_certificate_new(&a_, &a_, 0.1, nullptr, &certificate); }), 0);
  mb_certificate_free(certificate);
  mb_simplify_options options;
  EXPECT_EQ(failures_of([&] { return mb_simplify_options_init(&options, sizeof options); }), 0);
  options.tolerance = 0.1;
  mb_simplification* simplification = nullptr;
  EXPECT_GT(failures_of([&] { return mb_simplify(&a_, &options, &simplification); }), 0);
  mb_simplification_free(simplification);
}

TEST_F(COutOfMemory, IsAStatusOfFiles) {
  const meshbound::test::TemporaryFolder folder;
  const std::string path = folder / "a.ply";
  EXPECT_GT(failures_of([&] { return mb_mesh_file_write(path.c_str(), &a_, 0, nullptr); }), 0);
  mb_mesh_file* file = nullptr;
  EXPECT_GT(failures_of([&] { return mb_mesh_file_read(path.c_str(), nullptr, &file); }), 0);
  mb_mesh_file_free(file);
}

}  // namespace
