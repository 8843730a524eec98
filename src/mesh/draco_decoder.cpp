// SPDX-License-Identifier: MIT
// The one file that is compiled against Draco (https://google.github.io/draco/spec/).
#include "mesh/draco_decoder.h"

#include <utility>

#ifdef MESHBOUND_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <cstring>
#include <exception>
#endif

namespace meshbound {

#ifdef MESHBOUND_HAS_DRACO

struct DracoMesh::Data {
  std::unique_ptr<draco::Mesh> mesh;
};

namespace {

/// Triangles that a byte may stand for. Draco allocates for the number that a file declares before it reads on, so that
/// a few bytes could ask for all memory; regular grids compress to some hundred triangles a byte.
constexpr std::uint64_t max_triangles_per_byte = 1024;

/// What precedes the connectivity: "DRACO", two bytes of the version, the type, the method and two bytes of flags.
constexpr std::size_t header_size = 11, major_at = 5, minor_at = 6, method_at = 8, flags_at = 9;
constexpr unsigned flag_metadata = 0x80;  // in the second byte of flags

/// The number of triangles that a mesh declares; nothing where the bytes end before it or are of an old version.
std::optional<std::uint32_t> declared_triangles(std::string_view bytes) {
  if (bytes.size() < header_size) return std::nullopt;
  const auto byte_at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  const auto version = static_cast<std::uint16_t>(DRACO_BITSTREAM_VERSION(byte_at(major_at), byte_at(minor_at)));
  if (version < DRACO_BITSTREAM_VERSION(2, 2)) return std::nullopt;
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data() + header_size, bytes.size() - header_size, version);
  draco::GeometryMetadata metadata;
  if ((byte_at(flags_at + 1) & flag_metadata) != 0 &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
    return std::nullopt;
  std::uint32_t triangles = 0;
  if (byte_at(method_at) == draco::MESH_EDGEBREAKER_ENCODING) {
    std::uint8_t traversal = 0;
    std::uint32_t vertices = 0;
    if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&vertices, &buffer)) return std::nullopt;
  }
  if (!draco::DecodeVarint(&triangles, &buffer)) return std::nullopt;
  return triangles;
}

template <class T>
bool append_numbers(const draco::PointAttribute& attribute, std::size_t vertices, std::size_t width,
                    std::vector<double>& to) {
  std::vector<T> element(width);
  const std::size_t size = width * sizeof(T);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(v));
    if (index.value() >= attribute.size()) return false;
    const auto at = static_cast<std::size_t>(attribute.GetBytePos(index));
    const std::size_t stored = attribute.buffer()->data_size();
    if (at > stored || size > stored - at) return false;
    std::memcpy(element.data(), attribute.GetAddress(index), size);
    to.insert(to.end(), element.begin(), element.end());
  }
  return true;
}

bool append_values(const draco::PointAttribute& attribute, std::size_t vertices, std::size_t width,
                   std::vector<double>& to) {
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return append_numbers<std::int8_t>(attribute, vertices, width, to);
    case draco::DT_UINT8:
      return append_numbers<std::uint8_t>(attribute, vertices, width, to);
    case draco::DT_INT16:
      return append_numbers<std::int16_t>(attribute, vertices, width, to);
    case draco::DT_UINT16:
      return append_numbers<std::uint16_t>(attribute, vertices, width, to);
    case draco::DT_UINT32:
      return append_numbers<std::uint32_t>(attribute, vertices, width, to);
    case draco::DT_FLOAT32:
      return append_numbers<float>(attribute, vertices, width, to);
    default:
      return false;  // glTF has no other type
  }
}

}  // namespace

bool can_decode_draco() { return true; }

std::optional<DracoMesh> DracoMesh::decode(std::string_view bytes) {
  const auto declared = declared_triangles(bytes);
  if (!declared || *declared / max_triangles_per_byte > bytes.size()) return std::nullopt;
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok() || decoded.value() == nullptr) return std::nullopt;
    auto data = std::make_shared<Data>();
    data->mesh = std::move(decoded).value();
    for (std::uint32_t f = 0; f < data->mesh->num_faces(); ++f)
      for (const draco::PointIndex& corner : data->mesh->face(draco::FaceIndex(f)))
        if (corner.value() >= data->mesh->num_points()) return std::nullopt;
    return DracoMesh(std::move(data));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::size_t DracoMesh::vertex_count() const { return data_->mesh->num_points(); }
std::size_t DracoMesh::triangle_count() const { return data_->mesh->num_faces(); }

std::vector<double> DracoMesh::indices() const {
  std::vector<double> result;
  result.reserve(3 * triangle_count());
  for (std::uint32_t f = 0; f < data_->mesh->num_faces(); ++f)
    for (const draco::PointIndex& corner : data_->mesh->face(draco::FaceIndex(f))) result.push_back(corner.value());
  return result;
}

std::optional<std::vector<double>> DracoMesh::values(std::uint32_t identifier, std::size_t width) const {
  const draco::PointAttribute* const attribute = data_->mesh->GetAttributeByUniqueId(identifier);
  if (attribute == nullptr || static_cast<std::size_t>(attribute->num_components()) != width) return std::nullopt;
  std::vector<double> result;
  result.reserve(vertex_count() * width);
  if (!append_values(*attribute, vertex_count(), width, result)) return std::nullopt;
  return result;
}

#else

struct DracoMesh::Data {};

bool can_decode_draco() { return false; }
std::optional<DracoMesh> DracoMesh::decode(std::string_view) { return std::nullopt; }
std::size_t DracoMesh::vertex_count() const { return 0; }
std::size_t DracoMesh::triangle_count() const { return 0; }
std::vector<double> DracoMesh::indices() const { return {}; }
std::optional<std::vector<double>> DracoMesh::values(std::uint32_t, std::size_t) const { return std::nullopt; }

#endif

DracoMesh::DracoMesh(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

}  // namespace meshbound
