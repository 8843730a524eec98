// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "gltf_file.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "temporary_folder.h"

namespace meshbound::test {

/// Reads files of tests through a folder of its own.
class GltfReading {
 protected:
  /// The file with its attributes.
  MeshFile read(const GltfFile& file, const std::string& name = "m.glb") {
    file.write(folder_ / name);
    ReadOptions options;
    options.attributes = true;
    return read_mesh(folder_ / name, options);
  }

  /// The line that refuses the file, or "not refused".
  std::string refusal(const GltfFile& file) {
    try {
      (void)read(file);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "not refused";
  }

  TemporaryFolder folder_;
};

}  // namespace meshbound::test
