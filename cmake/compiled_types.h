// SPDX-License-Identifier: MIT
/// Class templates that nearly every file uses, instantiated once with the common headers (CompiledHeaders.cmake):
/// a fifth of the time of compiling a small file.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace meshbound::compiled {

/// The size of a type needs its instantiation, but no code.
inline constexpr std::size_t sizes = sizeof(
    std::tuple<Eigen::Vector2d, Eigen::Vector3d, Eigen::Matrix3d, Eigen::AlignedBox3d, Eigen::Isometry3d,
               Eigen::Affine3d, std::vector<Eigen::Vector3d>, std::vector<Eigen::AlignedBox3d>,
               std::vector<std::array<std::uint32_t, 2>>, std::vector<std::array<std::uint32_t, 3>>,
               std::vector<std::vector<std::uint32_t>>, std::vector<std::uint32_t>, std::vector<std::uint8_t>,
               std::vector<double>, std::vector<float>, std::vector<bool>, std::vector<std::string>,
               std::optional<double>, std::optional<std::uint32_t>, std::function<void(double)>, std::function<bool()>,
               std::atomic<bool>, std::atomic<std::size_t>, std::span<const std::uint32_t>, std::span<const double>>);

}  // namespace meshbound::compiled
