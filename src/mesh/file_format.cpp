// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound {

FileFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".off") return FileFormat::Off;
  if (extension == ".obj") return FileFormat::Obj;
  if (extension == ".ply") return FileFormat::Ply;
  if (extension == ".stl") return FileFormat::Stl;
  if (extension == ".gltf") return FileFormat::Gltf;
  if (extension == ".glb") return FileFormat::Glb;
  throw InvalidInput(path.string() +
                     ": unknown mesh format; the file name must end in .off, .obj, .ply, .stl, .glb or .gltf");
}

}  // namespace meshbound
