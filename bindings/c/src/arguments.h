// SPDX-License-Identifier: MIT
/// Checks what C callers pass in and converts it to the types of the library.
#pragma once
#include <meshbound.h>

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
