// SPDX-License-Identifier: MIT
#include "scene/shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/pose.h"

namespace meshbound {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Integrals over a surface: its area, and the first and second moments of position.
struct Moments {
  double area = 0;
  Vector3d first = Vector3d::Zero();   ///< of x
  Matrix3d second = Matrix3d::Zero();  ///< of x x^T
};

/// The exact integrals over each triangle: of x, area times the centroid m; of x x^T, area / 12 times
/// (a a^T + b b^T + c c^T + 9 m m^T).
Moments moments_of(const TriangleMesh& mesh) {
  Moments moments;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vector3d m = (a + b + c) / 3;
    moments.area += area;
    moments.first += area * m;
    moments.second += area / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + 9 * m * m.transpose());
  }
  return moments;
}

/// Moves the mesh so that `origin` becomes 0 and scales it. Returns that map.
AffineMap normalise(TriangleMesh& mesh, const Vector3d& origin, double scale) {
  for (Vector3d& p : mesh.vertices) p = scale * (p - origin);
  AffineMap map = AffineMap::Identity();
  map.linear() *= scale;
  map.translation() = -scale * origin;
  return map;
}

/// Maps the bounding box of the mesh to unit size, so that the integrals are over coordinates of about 1 wherever the
/// mesh lies. Returns the map.
AffineMap into_unit_box(TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = used_bounding_box(mesh);
  const double size = box.sizes().maxCoeff();
  if (!(size > 0) || !std::isfinite(1 / size)) throw InvalidInput("the mesh is a single point and has no shape");
  return normalise(mesh, box.center(), 1 / size);
}

/// Eigenvectors of the covariance, longest extent first, a right-handed frame.
Matrix3d principal_axes(const Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  Matrix3d axes = solver.eigenvectors().rowwise().reverse();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return axes;
}

Extents extents_along(const TriangleMesh& mesh, const Matrix3d& axes) {
  Extents extents;
  extents.lo.fill(std::numeric_limits<double>::infinity());
  extents.hi.fill(-std::numeric_limits<double>::infinity());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const Vector3d p = axes.transpose() * mesh.vertices[v];
      for (std::size_t k = 0; k < 3; ++k) {
        extents.lo[k] = std::min(extents.lo[k], p[static_cast<Eigen::Index>(k)]);
        extents.hi[k] = std::max(extents.hi[k], p[static_cast<Eigen::Index>(k)]);
      }
    }
  return extents;
}

/// Vertices of triangles at multiples of the golden ratio along the list of triangles: the first few of them are as
/// evenly spread as all.
std::vector<Vector3d> some_vertices(const TriangleMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  std::vector<Vector3d> samples;
  double along = 0;
  for (std::size_t i = 0; i < std::min(max_samples, n); ++i) {
    const auto triangle = static_cast<std::size_t>(along * static_cast<double>(n));
    const auto& [a, b, c] = mesh.triangles[triangle];
    samples.push_back(i % 2 == 0 ? mesh.vertices[a] : (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
    along += std::numbers::phi - 1;
    along -= std::floor(along);
  }
  return samples;
}

}  // namespace

Shape::Shape(const MeshView& mesh, const BvhOptions& options) : impl_(std::make_unique<Impl>()) {
  validate(mesh);
  Impl& shape = *impl_;
  shape.tree_options = options;
  shape.mesh = to_triangle_mesh(mesh);
  shape.normalisation = into_unit_box(shape.mesh);
  Moments moments = moments_of(shape.mesh);
  Matrix3d covariance = Matrix3d::Identity();
  if (moments.area > 0) {
    const Vector3d centroid = moments.first / moments.area;
    covariance = moments.second / moments.area - centroid * centroid.transpose();
    const double mean_square = covariance.trace();
    if (mean_square > 0)
      shape.normalisation = normalise(shape.mesh, centroid, 1 / std::sqrt(mean_square)) * shape.normalisation;
  }
  shape.axes = principal_axes(covariance);
  shape.along_world = extents_along(shape.mesh, Matrix3d::Identity());
  shape.along_axes = extents_along(shape.mesh, shape.axes);
  shape.samples = some_vertices(shape.mesh);
}

Shape::Shape(Shape&&) noexcept = default;
Shape& Shape::operator=(Shape&&) noexcept = default;
Shape::~Shape() = default;

const AffineMap& Shape::normalisation() const { return impl_->normalisation; }

const Eigen::Matrix3d& Shape::axes() const { return impl_->axes; }

const Bvh& Shape::tree() const {
  if (!impl_->tree) {
    impl_->tree.emplace(impl_->mesh, impl_->tree_options);
    impl_->mesh = {};
  }
  return *impl_->tree;
}

}  // namespace meshbound
