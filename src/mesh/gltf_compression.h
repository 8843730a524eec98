// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>

#include "mesh/gltf_document.h"

namespace meshbound {

/// Whether compressed data under this extension's name are decoded by this build.
[[nodiscard]] bool is_read_compression(std::string_view extension);

/// Whether a buffer only reserves room for what EXT_meshopt_compression stores elsewhere, so that it need not be there.
[[nodiscard]] bool is_placeholder_buffer(const GltfValue& root, const GltfValue& buffer);

/// Replaces all compressed data of a document by what they decode to, as the document would hold it without
/// EXT_meshopt_compression and KHR_draco_mesh_compression, and removes their names. Decoded bytes become new buffers at
/// the end. Data that are stored uncompressed as well are taken from there where Draco is only optional. Throws
/// `InvalidInput` where compressed data are malformed, disagree with what the document says of them, or need Draco in a
/// build without it.
void decompress(const MeshSource& source, GltfDocument& document);

}  // namespace meshbound
