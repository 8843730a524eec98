// SPDX-License-Identifier: MIT
#include "deviation/deviation_image.h"

#include <algorithm>
#include <cmath>

#include "deviation/checkerboard.h"
#include "deviation/legend.h"
#include "deviation/surface_image.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/transform.h"
#include "numeric/no_index.h"

namespace meshbound::tools {
namespace {

constexpr Colour white = {255, 255, 255}, stone = {196, 200, 208};

// Sizes in pixels of the picture before it is halved.
constexpr int panel = 800;  // width; the height is at most the same
constexpr int header = 56;
constexpr int footer = 72;

Colour shaded(const Colour& colour, double light) {
  Colour shade;
  for (std::size_t k = 0; k < shade.size(); ++k) shade[k] = static_cast<std::uint8_t>(std::lround(colour[k] * light));
  return shade;
}

double light_on(const TriangleMesh& mesh, std::uint32_t triangle, const Camera& camera) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
  const double longest = std::max(ab.cwiseAbs().maxCoeff(), ac.cwiseAbs().maxCoeff());
  return longest > 0 ? camera.light((ab / longest).cross(ac / longest)) : 1;
}

/// Calls draw(x, y, triangle) for each pixel that shows the mesh.
template <class Draw>
void for_each_pixel(const SurfaceImage& image, Draw&& draw) {
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (const std::uint32_t triangle = image.triangle(x, y); triangle != no_index) draw(x, y, triangle);
}

/// Draws a surface; edges only if triangles are large enough to be told apart. `texture` may be null.
void draw_surface(Picture& picture, int left, const TriangleMesh& mesh, const CornerAttribute* texture,
                  const SurfaceImage& image, const Camera& camera) {
  std::size_t edge_pixels = 0;
  for_each_pixel(image, [&](int x, int y, std::uint32_t) { edge_pixels += image.is_edge(x, y) ? 1 : 0; });
  constexpr double max_share = 0.5;  // of the pixels
  const bool has_edges = static_cast<double>(edge_pixels) < max_share * static_cast<double>(image.covered());
  for_each_pixel(image, [&](int x, int y, std::uint32_t triangle) {
    const double light = light_on(mesh, triangle, camera);
    constexpr double on_edges = 0.5;  // share of the light
    const Colour colour = texture != nullptr ? checkerboard_at(*texture, triangle, image.weights(x, y), stone) : stone;
    picture.set(left + x, header + y, shaded(colour, has_edges && image.is_edge(x, y) ? on_edges * light : light));
  });
}

void draw_deviation(Picture& picture, int left, const DeviationScene& scene, const SurfaceImage& image,
                    const Camera& camera, const DeviationOptions& options) {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> errors;
  for_each_pixel(image, [&](int x, int y, std::uint32_t) {
    const RoundedPoint point = image.point(x, y);
    points.push_back(point.position);
    errors.push_back(point.error);
  });
  const std::vector<ClosestPoint> found = closest_points(*scene.other, points, {options.threads, options.stop});
  std::size_t next = 0;
  for_each_pixel(image, [&](int x, int y, std::uint32_t triangle) {
    constexpr double flat = 0.55;  // share of the colour that no light changes, so that it can be read
    const double light = flat + (1 - flat) * light_on(*scene.coloured, triangle, camera);
    Bounds deviation = widened(found[next].distance, errors[next]);
    deviation.upper = std::min(deviation.upper, scene.max_deviation);
    picture.set(left + x, header + y, shaded(scene.scale.colour(deviation), light));
    ++next;
  });
}

void write_centred(Picture& picture, int left, int y, const std::string& text) {
  picture.write(left + (panel - Picture::text_width(text, text_size)) / 2, y, text, ink, text_size);
}

std::string title(const std::string& name, const TriangleMesh& mesh) {
  return name + ": " + std::to_string(mesh.triangles.size()) + " triangles";
}

}  // namespace

Picture deviation_image(const DeviationScene& scene, const DeviationOptions& options) {
  const Eigen::AlignedBox3d box = used_bounding_box(*scene.original).merged(used_bounding_box(*scene.result));
  const int height = 2 * static_cast<int>(panel / 2 * std::clamp(Camera::aspect(box, scene.up), 0.4, 1.0));
  Picture picture(3 * panel, header + height + footer, white);
  const Camera camera(box, scene.up, panel, height);
  const SurfaceImage original(*scene.original, camera, panel, height), result(*scene.result, camera, panel, height);
  options.stop.check();
  draw_surface(picture, 0, *scene.original, scene.original_texture, original, camera);
  draw_surface(picture, panel, *scene.result, scene.result_texture, result, camera);
  draw_deviation(picture, 2 * panel, scene, scene.coloured == scene.original ? original : result, camera, options);
  write_centred(picture, 0, header / 2, title("original", *scene.original));
  write_centred(picture, panel, header / 2, title(scene.result_title, *scene.result));
  write_centred(picture, 2 * panel, header / 2, scene.coloured_title);
  draw_legend(picture, 2 * panel, header + height, panel, scene.scale, scene.unit);
  return picture.halved();
}

}  // namespace meshbound::tools
