// SPDX-License-Identifier: MIT
// Files that broke other readers, from the datasets folder: each gives the mesh that its INDEX.tsv names or is refused
// in one line. What each must give stands here, so that a change of the folder cannot hide a change of the reader.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "datasets.h"
#include "mesh_files.h"
#include "meshbound/mesh_view.h"

namespace meshbound::test {
namespace broken_files_test {

struct Readable {
  const char* name;
  std::size_t triangles;
  std::size_t vertices;
};

struct Refused {
  const char* name;
  const char* reason;  ///< part of the message
};

const std::vector<Readable> readable = {
    {"assimp_invalid_malformed2.obj", 10, 8},
    {"assimp_obj_box_longline.obj", 944, 8},
    {"assimp_obj_regr_3429812.obj", 4, 4},
    {"assimp_stl_spherewithhole.stl", 285, 146},
    {"assimp_stl_spider_ascii.stl", 1368, 722},
    {"assimp_stl_triangle_with_empty_solid.stl", 1, 3},
    {"bff_inverted_triangles.obj", 24685, 12577},
    {"gc_moebius.obj", 448, 280},
    {"gc_platonic_shelf.obj", 80, 50},
    {"igl_horse_quad.obj", 4796, 2400},
    {"igl_inspired_mesh_quads_Smooth.off", 3676, 1963},
    {"igl_truck.obj", 4770, 2956},
    {"mf_Generic_Twin_7081.1.t0_left.obj", 19704, 9874},
    {"mf_Generic_Twin_7081.1.t0_right.obj", 11656, 5830},
    {"mf_Offset1.obj", 4418, 2287},
    {"mf_hull-body.obj", 5460, 2736},
    {"mf_hull-mask.obj", 7980, 3996},
    {"ml_many_small_holes.ply", 3524, 2004},
    {"ml_non_manif_hole.ply", 755, 432},
    {"pmp_L.off", 4, 6},
    {"pmp_edge_onering.off", 10, 10},
    {"soup_manifold_input.obj", 57656, 14790},
    {"soup_modelnet_bathtub.obj", 4375, 2124},
    {"soup_modelnet_chair.off", 1804, 2564},
    {"syn_bowtie_vertex.off", 2, 5},
    {"syn_concave_64gon.off", 62, 64},
    {"syn_crlf.obj", 1, 3},
    {"syn_degenerate_idx.off", 2390, 1197},
    {"syn_degenerate_zero_edge.off", 2390, 1197},
    {"syn_dup_faces.off", 2732, 1197},
    {"syn_dup_flipped_faces.off", 2732, 1197},
    {"syn_far_offset_1e15.off", 2390, 1197},
    {"syn_far_offset_1e7.off", 2390, 1197},
    {"syn_flipped_all.off", 2390, 1197},
    {"syn_flipped_third.off", 2390, 1197},
    {"syn_holes_random10pct.off", 2154, 1197},
    {"syn_huge_1e155.off", 2390, 1197},
    {"syn_huge_1e30.off", 2390, 1197},
    {"syn_moebius.off", 120, 120},
    {"syn_nonplanar_quads.off", 1682, 900},
    {"syn_one_triangle.off", 1, 3},
    {"syn_planar_grid.off", 3042, 1600},
    {"syn_point_triangle.off", 1, 3},
    {"syn_random_soup_5000.off", 5000, 15000},
    {"syn_relative_idx.obj", 1, 3},
    {"syn_segment_triangle.off", 1, 3},
    {"syn_self_intersect_two_copies.off", 4780, 2394},
    {"syn_slivers_1e-12.off", 398, 400},
    {"syn_soup_jittered_1e-9.off", 2390, 7170},
    {"syn_soup_unwelded.off", 2390, 7170},
    {"syn_three_faces_one_edge.off", 3, 5},
    {"syn_tiny_1e-160.off", 2390, 1197},
    {"syn_tiny_1e-30.off", 2390, 1197},
    {"syn_unused_vertices.off", 2390, 1697},
    {"thingi_65004.stl", 1466, 731},
    {"thingi_72214.stl", 1660, 830},
    {"tm_7_8ths_cube.stl", 24, 14},
    {"tm_comments.off", 12, 8},
    {"tm_joined_tetrahedra.obj", 8, 5},
    {"tm_quadknot.obj", 2880, 1440},
    {"tm_singlevn.obj", 2, 4},
    {"tm_target.obj", 3318, 1715},
    {"tm_two_objects_mixed_case_names.stl", 24, 16},
    {"tm_whitespace.off", 12, 8},
    {"tobj_cornell_box.obj", 36, 76},
    {"tobj_issue-295-trianguation-failure.obj", 28, 16},
    {"tobj_issue-319-002.obj", 14, 20},
};

const std::vector<Refused> refused = {
    {"assimp_invalid_empty.obj", "empty"},
    {"assimp_obj_box_utf16be.obj", "UTF-16"},
    {"assimp_obj_number_formats.obj", "line 11"},
    {"assimp_obj_point_cloud.obj", "no faces"},
    {"assimp_off_invalid.off", "line 8"},
    {"assimp_ply_points.ply", "no faces"},
    {"syn_empty.off", "no faces"},
    {"syn_header_claims_4e9.stl", "byte 80"},
    {"syn_html_not_mesh.obj", "line 1"},
    {"syn_index_out_of_range.off", "line 3590"},
    {"syn_inf_vertex.off", "line 102"},
    {"syn_nan_vertex.off", "line 20"},
    {"syn_truncated.ply", "the file ends"},
    {"syn_zero_bytes.obj", "empty"},
    {"tobj_test-nan.obj", "line 14"},
};

#define SKIP_WITHOUT_DATASETS() \
  if (!dataset("broken")) GTEST_SKIP() << "no datasets folder with broken/ (set MESHBOUND_DATASETS)"

TEST(BrokenFiles, GiveTheMeshTheyHold) {
  SKIP_WITHOUT_DATASETS();
  for (const Readable& file : readable) {
    const auto path = dataset(std::string("broken/") + file.name);
    ASSERT_TRUE(path) << file.name;
    const TriangleMesh mesh = read_mesh(*path).mesh;
    EXPECT_EQ(mesh.triangles.size(), file.triangles) << file.name;
    EXPECT_EQ(mesh.vertices.size(), file.vertices) << file.name;
    EXPECT_NO_THROW(validate(mesh)) << file.name;
  }
}

TEST(BrokenFiles, AreRefusedInOneLineThatSaysWhatAndWhere) {
  SKIP_WITHOUT_DATASETS();
  for (const Refused& file : refused) {
    const auto path = dataset(std::string("broken/") + file.name);
    ASSERT_TRUE(path) << file.name;
    try {
      (void)read_mesh(*path);
      ADD_FAILURE() << file.name << " was read";
    } catch (const InvalidInput& error) {
      EXPECT_CONTAINS(std::string(error.what()), file.name);
      EXPECT_CONTAINS(std::string(error.what()), file.reason);
      EXPECT_FALSE(contains(error.what(), "\n"));
    }
  }
}

TEST(BrokenFiles, AreAllKnownHere) {
  SKIP_WITHOUT_DATASETS();
  std::set<std::string> known;
  for (const Readable& file : readable) known.insert(file.name);
  for (const Refused& file : refused) known.insert(file.name);
  for (const auto& entry : std::filesystem::directory_iterator(*dataset("broken"))) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "INDEX.tsv" || known.contains(name)) << name;
  }
}

/// Real files, cut at many places: each part is read or refused, never anything else.
TEST(BrokenFiles, CutAnywhereAreReadOrRefused) {
  SKIP_WITHOUT_DATASETS();
  const TemporaryFolder folder;
  for (const char* name : {"ml_non_manif_hole.ply", "tm_two_objects_mixed_case_names.stl", "tm_joined_tetrahedra.obj",
                           "tm_comments.off", "tm_7_8ths_cube.stl", "syn_truncated.ply"}) {
    const std::string content = content_of(*dataset(std::string("broken/") + name));
    for (std::size_t size = 0; size < content.size(); size += 1 + content.size() / 400) {
      write_file(folder / name, content.substr(0, size));
      try {
        EXPECT_FALSE(read_mesh(folder / name).mesh.triangles.empty()) << name << " cut to " << size;
      } catch (const InvalidInput&) {
      }
    }
  }
}

}  // namespace broken_files_test
}  // namespace meshbound::test
