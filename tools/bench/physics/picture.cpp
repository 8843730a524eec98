// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/picture.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

namespace meshbound::bench {
namespace {

/// PNG: W3C Recommendation, second edition; zlib streams of stored blocks: RFC 1950, RFC 1951.
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t value = 0xffffffff;
  for (const char c : bytes) {
    value ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0xedb88320U : 0U);
  }
  return ~value;
}

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc(type + data));
}

std::string stored(const std::string& bytes) {
  constexpr std::size_t block = 65535;
  std::string stream("\x78\x01", 2);
  std::uint32_t a = 1, b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  for (std::size_t at = 0; at < bytes.size(); at += block) {
    const std::size_t size = std::min(block, bytes.size() - at);
    stream += static_cast<char>(at + size == bytes.size());
    for (const std::size_t length : {size, ~size}) {
      stream += static_cast<char>(length & 0xff);
      stream += static_cast<char>((length >> 8) & 0xff);
    }
    stream += bytes.substr(at, size);
  }
  return stream + big_endian((b << 16) | a);
}

}  // namespace

Picture::Picture(int width, int height, const Eigen::Vector3d& eye, const Eigen::Vector3d& target)
    : width_(width),
      height_(height),
      eye_(eye),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Colour{255, 255, 255}),
      depth_(pixels_.size(), std::numeric_limits<float>::infinity()) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  to_view_.row(0) = right;
  to_view_.row(1) = right.cross(forward);
  to_view_.row(2) = forward;
}

/// Pixels, and the depth.
Eigen::Vector3d Picture::project(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = to_view_ * (p - eye_);
  const double focal = height_ / (2 * std::tan(0.35));
  return {width_ / 2.0 + focal * q.x() / q.z(), height_ / 2.0 - focal * q.y() / q.z(), q.z()};
}

void Picture::set(int x, int y, const Colour& colour) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] = colour;
}

void Picture::add(const MeshView& mesh, const Pose& pose, const Colour& colour) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle corners = mesh.triangle(t);
    const Eigen::Vector3d p = pose * mesh.vertex(corners[0]), q = pose * mesh.vertex(corners[1]),
                          r = pose * mesh.vertex(corners[2]);
    const Eigen::Vector3d a = project(p), b = project(q), c = project(r);
    if (!(std::min({a.z(), b.z(), c.z()}) > 0)) continue;
    const double light = 0.35 + 0.65 * std::fabs((q - p).cross(r - p).normalized().dot((eye_ - p).normalized()));
    Colour shade;
    for (std::size_t k = 0; k < 3; ++k) shade[k] = static_cast<std::uint8_t>(light * colour[k]);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (area == 0) continue;
    const auto bound = [](double value, int largest) {
      return static_cast<int>(std::clamp(value, 0.0, largest - 1.0));
    };
    const int x0 = bound(std::min({a.x(), b.x(), c.x()}), width_), x1 = bound(std::max({a.x(), b.x(), c.x()}), width_);
    const int y0 = bound(std::min({a.y(), b.y(), c.y()}), height_),
              y1 = bound(std::max({a.y(), b.y(), c.y()}), height_);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double u = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area;
        const double v = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const auto depth = static_cast<float>(a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()));
        float& here =
            depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
        if (!(depth < here)) continue;
        here = depth;
        set(x, y, shade);
      }
    }
  }
}

void Picture::add_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Colour& colour) {
  const Eigen::Vector3d a = project(from), b = project(to);
  if (!(std::min(a.z(), b.z()) > 0)) return;
  constexpr int steps = 400, radius = 3;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector3d p = a + (b - a) * i / steps;
    const int reach = i == 0 || i == steps ? radius : 1;
    for (int dx = -reach; dx <= reach; ++dx)
      for (int dy = -reach; dy <= reach; ++dy) set(static_cast<int>(p.x()) + dx, static_cast<int>(p.y()) + dy, colour);
  }
}

void Picture::write(const std::filesystem::path& path) const {
  std::string rows;
  for (int y = 0; y < height_; ++y) {
    rows += '\0';
    for (int x = 0; x < width_; ++x)
      for (const std::uint8_t value :
           pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)])
        rows += static_cast<char>(value);
  }
  const std::string header = big_endian(static_cast<std::uint32_t>(width_)) +
                             big_endian(static_cast<std::uint32_t>(height_)) + std::string("\x08\x02\0\0\0", 5);
  std::ofstream file(path, std::ios::binary);
  file << "\x89PNG\r\n\x1a\n" << chunk("IHDR", header) << chunk("IDAT", stored(rows)) << chunk("IEND", "");
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace meshbound::bench
