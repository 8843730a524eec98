// SPDX-License-Identifier: MIT
#include "mesh/file_bytes.h"
#include "mesh/readers.h"
#include "meshbound/io.h"

namespace meshbound {

MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  const FileBytes file(path, {options.deadline, options.cancel});
  return parse_mesh(path, file.bytes(), options);
}

MeshFile parse_mesh(const std::filesystem::path& path, std::string_view bytes, const ReadOptions& options) {
  const FileFormat format = format_of(path);
  MeshSource source{path, bytes, 0, {options.deadline, options.cancel}, options.attributes};
  if (source.bytes.empty()) source.fail("the file is empty (0 bytes)");
  // The header of a binary STL may hold any bytes; its reader recognises text for itself.
  if (format == FileFormat::Stl) return read_stl(source);
  if (source.bytes.starts_with("glTF") && (format == FileFormat::Glb || format == FileFormat::Gltf))
    return read_gltf(source);

  if (is_utf16(source.bytes)) source.fail_at_byte(0, "the text is UTF-16; save it as ASCII or UTF-8");
  if (source.bytes.starts_with("\xEF\xBB\xBF")) source.begin = 3;
  switch (format) {
    case FileFormat::Off:
      return read_off(source);
    case FileFormat::Obj:
      return read_obj(source);
    case FileFormat::Gltf:
    case FileFormat::Glb:
      return read_gltf(source);
    default:
      return read_ply(source);
  }
}

}  // namespace meshbound
