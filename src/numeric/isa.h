// SPDX-License-Identifier: MIT
#pragma once

/// Code that is compiled once per instruction set lives in this inline namespace, so that the linker never merges an
/// inline function built for AVX2 or AVX-512 with its portable twin and hands it to a machine without them.
#if defined(__AVX512F__)
#define MESHBOUND_ISA isa_avx512
#elif defined(__AVX2__)
#define MESHBOUND_ISA isa_avx2
#else
#define MESHBOUND_ISA isa_portable
#endif
