// SPDX-License-Identifier: MIT
// Sums, products and quotients of double-double numbers against exact rationals.
#include "numeric/double_double.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reference/point_triangle_cases.h"

namespace meshbound {
namespace double_double_test {

using reference::Random;

mpq_class exact(const DoubleDouble& x) { return mpq_class(x.high) + mpq_class(x.low); }

/// |computed - wanted| <= bound |scale|.
bool near(const DoubleDouble& computed, const mpq_class& wanted, const mpq_class& scale, double bound) {
  return abs(exact(computed) - wanted) <= bound * abs(scale);
}

/// A number with 106 bits, of magnitude 2^-20 to 2^20 and either sign.
DoubleDouble random_number(Random& random) {
  const double fraction = random.uniform(-1, 1) + 0x1p-32 * random.uniform(-1, 1);
  const double high = std::ldexp(fraction, random.below(41) - 20);
  return exact_sum(high, high * 0x1p-54 * random.uniform(-1, 1));
}

TEST(DoubleDouble, SumsAndProductsOfDoublesAreExact) {
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double a = random_number(random).high, b = random_number(random).high;
    ASSERT_EQ(exact(exact_sum(a, b)), mpq_class(a) + mpq_class(b));
    ASSERT_EQ(exact(exact_product(a, b)), mpq_class(a) * mpq_class(b));
  }
}

/// Dekker's bounds are below these: 2^-102 leaves room for the roundings of the low parts. A sum is relative to its
/// terms, because they may cancel.
TEST(DoubleDouble, OperationsKeepAHundredBits) {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const DoubleDouble a = random_number(random), b = random_number(random);
    const mpq_class x = exact(a), y = exact(b);
    ASSERT_TRUE(near(a + b, x + y, abs(x) + abs(y), 0x1p-102));
    ASSERT_TRUE(near(a - b, x - y, abs(x) + abs(y), 0x1p-102));
    ASSERT_TRUE(near(a * b, x * y, x * y, 0x1p-102));
    ASSERT_TRUE(near(a / b, x / y, x / y, 0x1p-100));
    ASSERT_EQ(a < b, x < y);
    ASSERT_EQ(a > b, x > y);
  }
  const DoubleDouble one = 1, more(1, 0x1p-80);
  EXPECT_TRUE(one < more);
  EXPECT_FALSE(more < one);
}

}  // namespace double_double_test
}  // namespace meshbound
