// SPDX-License-Identifier: MIT
// Meshes that nodes show more than once, flattened or far from the origin: what is written is what was foreseen.
#include <gtest/gtest.h>

#include "gltf_fixture.h"
#include "mesh/scene_layout.h"
#include "meshbound/io.h"
#include "meshbound/simplify.h"

namespace meshbound {
namespace gltf_copies_test {

using test::GltfFile;
using test::read_with_attributes;
using test::textured_sphere;

class GltfCopies : public test::Gltf {
 protected:
  /// A sphere and its nodes, of which those with these numbers are roots.
  void write_sphere(const test::GltfJson& nodes, const test::GltfJson& roots) const {
    GltfFile file = textured_sphere(48, 24);
    file.json["nodes"] = nodes;
    file.json["scenes"][0]["nodes"] = roots;
    file.write(in("in.glb"));
  }
};

/// A node that turns what its parent has flattened: the product of their matrices is singular but for roundings.
const test::GltfJson flattener = {{"children", {1}}, {"rotation", {0.1, 0.7, -0.2, 0.6}}, {"scale", {1, 0, 1}}},
                     flattened = {{"mesh", 0}, {"rotation", {0.5, -0.1, 0.3, 0.8}}};

TEST_F(GltfCopies, WhatIsFlatButForRoundingsStaysAsItIs) {
  write_sphere({flattener, flattened}, {0});
  const MeshFile from = read_with_attributes(in("in.glb"));
  SimplifyOptions options;
  options.tolerance = 0.05;
  options.precision = Precision::Double;
  const SimplifiedLevel level = decimate_levels(from.mesh, options, from.attributes).last();
  EXPECT_EQ(level.faces(), from.mesh.triangles.size());
}

TEST_F(GltfCopies, AFlatCopyShowsWhatIsWrittenForAnother) {
  for (const double scale : {0.0, 1e-12}) {
    test::GltfJson flat = flattener;
    flat["scale"] = {1, scale, 1};
    write_sphere({flat, flattened, {{"mesh", 0}, {"translation", {3, 0, 0}}, {"rotation", {0, 0.6, 0, 0.8}}}}, {0, 2});
    (void)simplified(0.05);
  }
}

TEST_F(GltfCopies, CopiesFarFromTheOriginShowTheFloatsOfOne) {
  const test::GltfJson turned = {0.2, 0.3, 0.5, 0.8};
  const double size = 0.003;
  write_sphere(
      {{{"mesh", 0}, {"translation", {4.1e6, -2.2e6, 4.3e6}}, {"rotation", turned}, {"scale", {size, size, size}}},
       {{"mesh", 0}, {"translation", {4.1e6 + 3, -2.2e6, 4.3e6}}, {"scale", {size, size, size}}}},
      {0, 1});
  (void)simplified(0.1 * size);
}

TEST_F(GltfCopies, ACopyIsWrittenThatLosesNothing) {
  const test::GltfJson small = {1e-3, 1e-3, 1e-3}, thin = {1, 1, 1e-5};
  write_sphere({{{"mesh", 0}, {"translation", {6.4e8, -2e8, 3e8}}, {"scale", small}},
                {{"mesh", 0}, {"translation", {6.4e3, 0, 0}}, {"scale", thin}},
                {{"mesh", 0}, {"translation", {40, 0, 0}}},
                {{"mesh", 0}}},
               {0, 1, 2, 3});
  const MeshFile from = read_with_attributes(in("in.glb"));
  EXPECT_EQ(scene_layout(from.attributes)->written_copies(), (std::vector<std::uint32_t>{2, 2, 2, 2}));
  (void)simplified(0.05);
}

}  // namespace gltf_copies_test
}  // namespace meshbound
