// SPDX-License-Identifier: MIT
// Passes when a program that is compiled with flags of its own (tests/consumer/CMakeLists.txt names them) agrees with
// the installed library on the layout of every structure with members that Eigen may align, and gets its results.
#include <meshbound/meshbound.h>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using namespace meshbound;

template <class T>
constexpr bool has_layout(std::size_t size, std::size_t alignment) {
  return sizeof(T) == size && alignof(T) == alignment;
}

static_assert(sizeof(void*) != 8 || has_layout<PlacedModel>(136, 8));
static_assert(sizeof(void*) != 8 || has_layout<PlacedClosedModel>(136, 8));
static_assert(sizeof(void*) != 8 || has_layout<ViewInstance>(152, 8));
static_assert(sizeof(void*) != 8 || has_layout<SimilarShape>(160, 8));
static_assert(has_layout<Pose>(128, alignof(double)) && has_layout<AffineMap>(128, alignof(double)));
static_assert(has_layout<TextureCoordinate>(16, alignof(double)));
static_assert(has_layout<TexturedTriangle>(144, 16) && offsetof(TexturedTriangle, coordinates) == 80);
static_assert(has_layout<TextureWitness>(96, 16) && offsetof(TextureWitness, coordinate) == 64);

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("wrong: %s\n", what);
}

bool is_near(const Bounds& bounds, double value) {
  return bounds.lower <= value + 1e-6 && bounds.upper >= value - 1e-6 && bounds.upper - bounds.lower <= 1e-3;
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

Eigen::Isometry3d moved_along_x(double by) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = by;
  return pose;
}

void measure(const TriangleMesh& mesh) {
  const Bvh tree(mesh);
  const Eigen::Isometry3d pose = moved_along_x(0.25);
  expect(is_near(hausdorff_distance({tree}, {tree, pose}).bounds, 0.25), "hausdorff_distance");
  MovingPair pair(tree, tree);
  expect(is_near(pair.hausdorff_distance(Eigen::Isometry3d::Identity(), pose).bounds, 0.25), "MovingPair");
  const ClosedModel solid(mesh);
  expect(in_contact({solid}, {solid, pose}) && !in_contact({solid}, {solid, moved_along_x(2)}), "in_contact");
  expect(penetration_depth({solid}, {solid, pose}).volumes.size() == 1, "penetration_depth");
  Scene scene;
  scene.add(tree);
  scene.add(solid, pose);
  scene.move(scene.add(tree), moved_along_x(0.5));
  expect(scene.check_tolerance(0.3).pairs.size() == 2, "Scene");
  expect(scene.model(2).pose.translation().x() == 0.5, "Scene::model");
}

void transform(const TriangleMesh& mesh) {
  const TransformedMesh image = transformed(mesh, Eigen::Affine3d(Eigen::Scaling(2.0)));
  expect(image.mesh.vertices[1].x() == 2 && image.displacement_bound == 0, "transformed");
  const Shape shape(mesh);
  std::vector<Shape> shapes;
  for (int i = 0; i < 3; ++i) shapes.emplace_back(mesh);
  SimilarityOptions options;
  options.count = 3;
  options.align = true;
  const SimilarShapes found = nearest_shapes(shape, shapes, options);
  for (const SimilarShape& near : found.nearest)
    expect(near.distance.lower == 0 && near.alignment.linear().isApprox(Eigen::Matrix3d::Identity()), "nearest_shapes");
  expect(found.nearest.size() == 3 && shape.normalisation().matrix().allFinite(), "Shape");
}

void choose_levels(const TriangleMesh& mesh) {
  std::vector<ViewInstance> instances(3);
  instances[1].pose = moved_along_x(2);
  instances[2].pose.translation().x() = -2;
  std::vector<ViewCamera> cameras(1);
  cameras[0].position = {0, 0, 50};
  const ViewLevels levels = view_levels(std::vector<TriangleMesh>{mesh}, instances, cameras, {});
  expect(levels.cameras.size() == 1 && levels.cameras[0].level.size() == 3, "view_levels");
  expect(view_tolerance(cameras[0], 1, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, moved_along_x(1)) > 0,
         "view_tolerance");
}

void compare_textures(const TriangleMesh& mesh) {
  TexturedMesh a;
  for (const Triangle& t : mesh.triangles) {
    TexturedTriangle& triangle = a.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = mesh.vertices[t[k]];
      triangle.coordinates[k] = {static_cast<double>(t[k] % 2), static_cast<double>(t[k] / 2)};
    }
    triangle.material = static_cast<std::uint32_t>(a.triangles.size());
  }
  TexturedMesh b = a;
  for (TexturedTriangle& triangle : b.triangles)
    for (Eigen::Vector3d& corner : triangle.corners) corner.x() += 0.5;
  const TextureDeviation deviation = texture_deviation(a, b);
  expect(is_near(deviation.bounds, 0.5), "texture_deviation");
  expect(deviation.a_to_b.witness && deviation.a_to_b.witness->coordinate.allFinite(), "TextureWitness");
  struct {
    char before;
    Eigen::Vector2d coordinate;
  } odd{0, {0.1, 0.5}};
  const Eigen::Vector2d rounded = rounded_to(TexturePrecision::Float, odd.coordinate);
  expect(rounded.x() == static_cast<double>(0.1F) && rounded.y() == 0.5, "rounded_to");
}

}  // namespace

int main() {
  const TriangleMesh mesh = tetrahedron();
  measure(mesh);
  transform(mesh);
  choose_levels(mesh);
  compare_textures(mesh);
  return failures;
}
