// SPDX-License-Identifier: MIT
// Levels made by another simplifier (meshoptimizer), each checked both ways and made again with a smaller error until
// its tolerance holds. Needs only the MIT core.
// Usage: check_other_simplifier IN TOLERANCE...    TOLERANCE in model units, or 0.1% of the bounding-box diagonal
// Prints for each: tolerance, faces, proven upper bound, attempts. Exits 2 with one line for what it cannot read.
#include <meshbound/error.h>
#include <meshbound/io.h>
#include <meshbound/level_checker.h>
#include <meshbound/mesh_summary.h>
#include <meshoptimizer.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

struct Model {
  std::vector<float> positions;  // x, y, z of each vertex
  std::vector<std::uint32_t> indices;

  explicit Model(const meshbound::TriangleMesh& mesh) {
    for (const auto& p : mesh.vertices)
      for (int i = 0; i < 3; ++i) positions.push_back(static_cast<float>(p[i]));
    for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  }
  std::size_t vertex_count() const { return positions.size() / 3; }
  // The positions with other indices: meshoptimizer leaves the vertices where they are.
  meshbound::MeshView view(const std::vector<std::uint32_t>& of) const { return {positions, of}; }
  std::vector<std::uint32_t> simplified(double error) const {
    const float scale = meshopt_simplifyScale(positions.data(), vertex_count(), 3 * sizeof(float));
    std::vector<std::uint32_t> result(indices.size());
    result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), positions.data(), vertex_count(),
                                   3 * sizeof(float), 0, static_cast<float>(error) / scale));
    return result;
  }
};

// A length in model units; throws for what is none.
double parse_tolerance(const std::string& text, double diagonal) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  if (end == text.c_str() || !(value >= 0) || !(unit.empty() || unit == "%"))
    throw meshbound::InvalidInput("'" + text + "' is no tolerance: give model units (0.5) or a percentage (0.1%)");
  return unit == "%" ? value / 100 * diagonal : value;
}

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  const auto original = meshbound::read_mesh(argv[1]).mesh;
  const double diagonal = meshbound::bounding_box_diagonal(original);
  const Model model(original);
  meshbound::LevelChecker checker(model.view(model.indices));  // keeps what is proven from one level to the next
  for (int i = 2; i < argc; ++i) {
    const double tolerance = parse_tolerance(argv[i], diagonal);
    std::vector<std::uint32_t> level = model.indices;  // what is left when nothing coarser holds
    double upper = 0;
    int attempts = 0;
    for (double error = tolerance; attempts < 20; error *= 0.75) {
      ++attempts;
      const std::vector<std::uint32_t> candidate = model.simplified(error);
      if (candidate.empty()) continue;  // everything collapsed
      const auto check = checker.check(model.view(candidate), tolerance);
      if (check.verdict != meshbound::Verdict::Within) continue;
      level = candidate;
      upper = check.bounds.upper;
      break;
    }
    std::printf("tolerance %.9g: %zu of %zu faces, at most %.17g, attempts %d\n", tolerance, level.size() / 3,
                original.triangles.size(), upper, attempts);
  }
  return 0;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
