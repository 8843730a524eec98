// SPDX-License-Identifier: MIT
#include "deviation/surface_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "numeric/no_index.h"

namespace meshbound::tools {
namespace {

using Eigen::Vector3d;

/// A triangle of the picture: corners in pixels, with depths.
struct Projected {
  Vector3d a, b, c;
  double doubled_area = 0;  ///< signed; 0 where the triangle is seen from its side

  Projected(const TriangleMesh& mesh, std::uint32_t triangle, const Camera& camera) {
    const Triangle& t = mesh.triangles[triangle];
    a = camera.project(mesh.vertices[t[0]]);
    b = camera.project(mesh.vertices[t[1]]);
    c = camera.project(mesh.vertices[t[2]]);
    doubled_area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  }
  /// Barycentric coordinates of the point that is seen at (x, y).
  [[nodiscard]] Vector3d weights(double x, double y) const {
    const double of_b = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / doubled_area;
    const double of_c = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / doubled_area;
    return {1 - of_b - of_c, of_b, of_c};
  }
  /// The least and the greatest x where the triangle meets the line of this y, up to rounding.
  [[nodiscard]] std::pair<double, double> span(double y) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto meet = [&](const Vector3d& p, const Vector3d& q) {
      if (std::min(p.y(), q.y()) > y || std::max(p.y(), q.y()) < y) return;
      const double share = p.y() == q.y() ? 0 : (y - p.y()) / (q.y() - p.y()), x = p.x() + share * (q.x() - p.x());
      low = std::min(low, x), high = std::max(high, x);
    };
    meet(a, b), meet(b, c), meet(c, a);
    return {low, high};
  }
};

/// The first and last pixel whose middle lies between two positions.
struct PixelRange {
  int first, last;
  PixelRange(double low, double high, int size)
      : first(static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(size)))),
        last(static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, size - 1.0))) {}
};

}  // namespace

SurfaceImage::SurfaceImage(const TriangleMesh& mesh, const Camera& camera, int width, int height)
    : mesh_(mesh),
      camera_(camera),
      width_(width),
      height_(height),
      triangles_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), no_index),
      depths_(triangles_.size(), std::numeric_limits<double>::infinity()) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) draw(t);
}

void SurfaceImage::draw(std::uint32_t triangle) {
  const Projected p(mesh_, triangle, camera_);
  if (p.doubled_area == 0 || !std::isfinite(p.doubled_area)) return;
  const auto [top, bottom] = std::minmax({p.a.y(), p.b.y(), p.c.y()});
  const PixelRange rows(top, bottom, height_);
  for (int y = rows.first; y <= rows.last; ++y) {
    const auto [left, right] = p.span(y + 0.5);
    const PixelRange columns(left - 1, right + 1, width_);  // a pixel of room for rounding
    for (int x = columns.first; x <= columns.last; ++x) {
      const Vector3d weights = p.weights(x + 0.5, y + 0.5);
      if (!(weights.minCoeff() >= 0)) continue;
      const double depth = weights.dot(Vector3d(p.a.z(), p.b.z(), p.c.z()));
      if (!(depth < depths_[index(x, y)])) continue;
      depths_[index(x, y)] = depth;
      triangles_[index(x, y)] = triangle;
    }
  }
}

Vector3d SurfaceImage::weights(int x, int y) const {
  return Projected(mesh_, triangle(x, y), camera_).weights(x + 0.5, y + 0.5);
}

RoundedPoint SurfaceImage::point(int x, int y) const {
  const Triangle& t = mesh_.triangles[triangle(x, y)];
  const Vector3d w = weights(x, y);  // none is below 0, see `draw`
  return rounded_point({mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]}, w[1], w[2]);
}

bool SurfaceImage::is_edge(int x, int y) const {
  const std::uint32_t here = triangle(x, y);
  return (x + 1 < width_ && triangle(x + 1, y) != here) || (y + 1 < height_ && triangle(x, y + 1) != here);
}

std::size_t SurfaceImage::covered() const {
  return triangles_.size() - static_cast<std::size_t>(std::count(triangles_.begin(), triangles_.end(), no_index));
}

}  // namespace meshbound::tools
