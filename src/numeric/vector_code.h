// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound {

/// Whether kernels compiled for AVX2 are used: where compiler and processor support it, and no test has switched it
/// off.
[[nodiscard]] bool uses_avx2();

/// Likewise for AVX-512 (F, DQ, VL, BW and CD).
[[nodiscard]] bool uses_avx512();

namespace internal {

/// For tests that compare whole runs, and nothing else: true allows portable kernels only. Kernels that were chosen
/// before this call stay in use.
extern bool portable_kernels;

}  // namespace internal
}  // namespace meshbound
