// SPDX-License-Identifier: MIT
/// Checks what C callers pass in and converts it to the types of the library.
#pragma once
#include <meshbound.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"

namespace meshbound::c_interface {

/// A view of the caller's buffers. Throws `InvalidInput`, naming `argument`, if they cannot be a mesh.
[[nodiscard]] MeshView view_of(const mb_mesh* mesh, const char* argument);

/// A view whose indices and used coordinates are checked as well.
[[nodiscard]] MeshView valid_view_of(const mb_mesh* mesh, const char* argument);

/// Threads that a call may be asked for: more than machines have, and few enough to be made. Results do not depend on
/// it.
constexpr int max_threads = 4096;

/// The threads that `complete` will find in the options; 0 where an older caller's options have none, or wrong ones.
template <class Options>
[[nodiscard]] int threads_of(const Options* given) {
  constexpr size_t end = offsetof(Options, threads) + sizeof given->threads;
  if (given == nullptr || given->struct_size < end || given->struct_size > sizeof *given) return 0;
  return std::min(given->threads, max_threads);
}

/// The options as given by a caller compiled against any version, over the defaults. `init` is the options' ..._init
/// function. Throws `InvalidInput` for a size that `init` cannot have set.
template <class Options>
[[nodiscard]] Options complete(const Options* given, mb_status (*init)(Options*, size_t)) {
  Options options;
  init(&options, sizeof options);
  if (given == nullptr) return options;
  const size_t size = given->struct_size;
  if (size < sizeof(size_t) || size > sizeof options)
    throw InvalidInput("struct_size is " + std::to_string(size) +
                       ": set the options by their _init function, and run with a library that is not older than the "
                       "header");
  std::memcpy(&options, given, size);
  options.struct_size = sizeof options;
  options.threads = std::min(options.threads, max_threads);
  return options;
}

/// Writes those leading bytes of `defaults` that the caller's version of the options has: `size` bytes.
template <class Options>
void initialise(Options* options, size_t size, Options defaults) {
  if (size < sizeof(size_t) || size > sizeof defaults)
    throw InvalidInput("the size of the options is " + std::to_string(size) +
                       " bytes, which this library does not know");
  defaults.struct_size = size;
  std::memcpy(options, &defaults, size);
}

}  // namespace meshbound::c_interface
