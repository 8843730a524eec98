// SPDX-License-Identifier: MIT
// The certificate as part of the library's simplification.
#include <gtest/gtest.h>

#include "datasets/analytic_meshes.h"
#include "meshbound/simplify.h"
#include "verify/verifier.h"

namespace meshbound {
namespace simplify_certificate_test {

TEST(SimplifyWithBound, GivesEachLevelItsCertificate) {
  const TriangleMesh original = datasets::torus(1, 0.3, 40, 16);
  SimplifyOptions options;
  options.tolerance = 0.05;
  options.levels = {0.01};
  EXPECT_FALSE(meshbound::simplify_with_bound(original, options).last().certificate);
  options.certificate = true;
  const SimplifyResult result = meshbound::simplify_with_bound(original, options);
  EXPECT_EQ(result.levels.size(), 2U);
  for (const SimplifiedLevel& level : result.levels) {
    ASSERT_TRUE(level.certificate);
    EXPECT_EQ(verify::check_certificate(original, level.mesh, level.certificate->bytes).tolerance, level.tolerance);
  }
}

}  // namespace simplify_certificate_test
}  // namespace meshbound
