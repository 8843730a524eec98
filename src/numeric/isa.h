// SPDX-License-Identifier: MIT
#pragma once

/// Code that is compiled once per instruction set lives in this inline namespace, so that the linker never merges an
/// inline function built for AVX2 with its portable twin and hands it to a machine without AVX2.
#if defined(__AVX2__)
#define MESHBOUND_ISA isa_avx2
#else
#define MESHBOUND_ISA isa_portable
#endif
