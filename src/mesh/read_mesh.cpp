// SPDX-License-Identifier: MIT
#include "mesh/file_bytes.h"
#include "mesh/gltf_scene.h"
#include "mesh/readers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound {
namespace {

/// Bytes that the header of a binary PLY is looked for in.
constexpr std::size_t start_of_file = std::size_t{1} << 16;

/// Whether the reader of such a file takes it from start to end, by ranges.
bool is_read_by_ranges(const std::filesystem::path& path, std::string_view start, std::size_t size) {
  const FileFormat format = format_of(path);
  if (format == FileFormat::Stl) return is_binary_stl(start, size);
  return format == FileFormat::Ply && start.starts_with("ply") && start.find("\nformat binary") != start.npos &&
         start.find("\nend_header") != start.npos;
}

bool is_gltf(FileFormat format) { return format == FileFormat::Glb || format == FileFormat::Gltf; }

/// Refuses empty files; of text also UTF-16, and begins behind a byte order mark.
MeshSource begun(MeshSource source) {
  const FileFormat format = format_of(source.path);
  if (source.bytes.empty()) source.fail("the file is empty (0 bytes)");
  // The header of a binary STL may hold any bytes; its reader recognises text for itself.
  if (format == FileFormat::Stl || (is_gltf(format) && source.bytes.starts_with("glTF"))) return source;
  if (is_utf16(source.bytes)) source.fail_at_byte(0, "the text is UTF-16; save it as ASCII or UTF-8");
  if (source.bytes.starts_with("\xEF\xBB\xBF")) source.begin = 3;
  return source;
}

/// What a file is by its first bytes, where these contradict its extension, and what to do; else empty.
std::string other_content(const MeshSource& source) {
  const FileFormat format = format_of(source.path);
  const std::string_view bytes = source.bytes;
  if (bytes.starts_with("version https://git-lfs"))
    return "it is a pointer of Git LFS in place of the mesh; fetch the mesh with git lfs pull";
  if (bytes.starts_with("\x1F\x8B")) return "it is compressed with gzip; unpack it first";
  if (bytes.starts_with("PK\x03\x04")) return "it is a ZIP archive; unpack it first";
  if (format != FileFormat::Ply && (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")))
    return "it is a PLY file; give it the extension .ply";
  if (!is_gltf(format) && bytes.starts_with("glTF")) return "it is a binary glTF file; give it the extension .glb";
  if (format != FileFormat::Stl && (bytes.starts_with("solid ") || is_binary_stl(bytes, source.size())))
    return "it is an STL file; give it the extension .stl";
  return "";
}

/// What `read` makes of a file. Where it refuses one whose content contradicts its extension, the message says so.
template <class Read>
auto blaming_the_name(const MeshSource& source, const Read& read) {
  try {
    return read();
  } catch (const InvalidInput&) {
    if (const std::string what = other_content(source); !what.empty()) source.fail(what);
    throw;
  }
}

MeshFile parsed_by_extension(const MeshSource& given) {
  const MeshSource source = begun(given);
  switch (format_of(source.path)) {
    case FileFormat::Stl:
      return read_stl(source);
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

MeshFile parsed(const MeshSource& source) {
  return blaming_the_name(source, [&] { return parsed_by_extension(source); });
}

/// What `read` makes of a file that is read by ranges; nothing for any other file, and where `read` refuses it.
template <class Result, class Read>
std::optional<Result> from_ranges(const std::filesystem::path& path, const StopToken& stop, MeshInSpace* into,
                                  const Read& read) {
  const FileBytes start(path, stop, start_of_file);
  FileWindow window(path, stop);
  if (!is_read_by_ranges(path, start.bytes(), window.size())) return std::nullopt;
  try {
    return read(MeshSource{path, start.bytes(), 0, stop, false, &window, into});
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

}  // namespace

MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  const FileBytes file(path, {options.deadline, options.cancel});
  return parse_mesh(path, file.bytes(), options);
}

MeshFile parse_mesh(const std::filesystem::path& path, std::string_view bytes, const ReadOptions& options) {
  return parsed({path, bytes, 0, {options.deadline, options.cancel}, options.attributes});
}

GltfScene parse_gltf_scene(const std::filesystem::path& path, std::string_view bytes, const StopToken& stop) {
  const MeshSource source{path, bytes, 0, stop};
  return blaming_the_name(source, [&] { return read_gltf_scene(begun(source)); });
}

MeshFile parse_mesh_into(const std::filesystem::path& path, std::string_view bytes, const StopToken& stop,
                         MeshInSpace& into) {
  MeshFile file = parsed({path, bytes, 0, stop, false, nullptr, &into});
  into.append(file.mesh.vertices);  // of a format that is not read piece by piece
  into.append(file.mesh.triangles);
  file.mesh = {};
  return file;
}

MeshFile read_mesh_into(const std::filesystem::path& path, const StopToken& stop, MeshInSpace& into,
                        const FileWindow::Reader& reader) {
  (void)format_of(path);
  const FileBytes start(path, stop, start_of_file);
  FileWindow window(path, stop, reader);
  if (is_read_by_ranges(path, start.bytes(), window.size())) {
    MeshFile file = parsed({path, start.bytes(), 0, stop, false, &window, &into});
    (void)window.at(window.size(), 0);  // what follows the mesh
    return file;
  }
  const FileBytes all(path, stop);
  if (reader) reader(all.bytes());
  return parse_mesh_into(path, all.bytes(), stop, into);
}

std::optional<MeshCounts> counts_for_shares(const std::filesystem::path& path, const StopToken& stop) {
  const auto counts = from_ranges<MeshCounts>(path, stop, nullptr, [](const MeshSource& source) {
    return format_of(source.path) == FileFormat::Stl ? stl_counts(source) : ply_counts(source);
  });
  return counts && counts->triangles > 0 ? counts : std::nullopt;
}

std::optional<MeshFile> read_share(const std::filesystem::path& path, const FileShare& share, const StopToken& stop,
                                   MeshInSpace& into) {
  return from_ranges<MeshFile>(path, stop, &into, [&](const MeshSource& source) {
    return format_of(source.path) == FileFormat::Stl ? read_stl_share(source, share) : read_ply_share(source, share);
  });
}

}  // namespace meshbound
