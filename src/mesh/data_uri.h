// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace meshbound {

/// Whether a URI holds its data itself: "data:...".
[[nodiscard]] bool is_data_uri(std::string_view uri);

/// The bytes of a data URI in base64 (RFC 2397, RFC 4648); nothing where it is malformed or not in base64.
[[nodiscard]] std::optional<std::string> decode_data_uri(std::string_view uri);

/// Bytes as base64 with padding (RFC 4648, section 4).
[[nodiscard]] std::string encode_base64(std::string_view bytes);

/// The relative path that a URI names, "%20" and its like decoded; nothing for a URI with a scheme, an absolute path,
/// or a malformed one.
[[nodiscard]] std::optional<std::string> relative_path_of(std::string_view uri);

}  // namespace meshbound
