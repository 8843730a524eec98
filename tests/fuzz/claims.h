// SPDX-License-Identifier: MIT
/// What must hold for any bytes at all. Each function returns when it does and throws `std::logic_error` otherwise, so
/// that libFuzzer sees a crash and a test that replays old findings sees a failure.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace meshbound::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A mesh file of this extension (".off") and content is read into a mesh that `validate` accepts, or refused in one
/// line that names the file.
void check_reader(const std::string& extension, Bytes content);

/// The bytes as two soups of a few triangles: every bound and verdict on their distance agrees with exact arithmetic.
void check_distance(Bytes content);

}  // namespace meshbound::fuzz
