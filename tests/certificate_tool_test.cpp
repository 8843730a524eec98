// SPDX-License-Identifier: MIT
// Certificates through the command line: what the tools write, verify_certificate confirms for these files and for no
// others.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace certificate_tool_test {

using testing_tools::checked_document;
using testing_tools::Json;
using testing_tools::run_tool;
using testing_tools::TemporaryFolder;
using testing_tools::ToolRun;
namespace fs = std::filesystem;

class CertificateTools : public testing::Test {
 protected:
  CertificateTools() {
    write_mesh(folder_ / "torus.off", datasets::torus(1, 0.4, 40, 20));
    write_mesh(folder_ / "coarse.off", datasets::torus(1, 0.4, 20, 10));
  }

  /// Names of files are in the folder of the test.
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun verify(const std::string& a, const std::string& b, const std::string& certificate,
                               std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{in(a), in(b), in(certificate)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(VERIFY_CERTIFICATE, arguments);
  }
  [[nodiscard]] ToolRun simplify(const std::string& a, const std::string& b, std::vector<std::string> more) const {
    std::vector<std::string> arguments{in(a), in(b), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(SIMPLIFY_WITH_BOUND, arguments);
  }
  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  TemporaryFolder folder_;
};

void expect_one_line(const ToolRun& run, int exit_code, const std::string& part) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(testing_tools::line_count(run.err), 1) << run.err;
  EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
}

/// The written coordinates, whatever the precision and the order of the format.
TEST_F(CertificateTools, SimplifierAndVerifierAgreeOnEveryFormat) {
  for (const char* out : {"small.off", "small.obj", "small.ply", "small.stl"}) {
    SCOPED_TRACE(out);
    ASSERT_EQ(simplify("torus.off", out, {"--tolerance", "1%", "--certificate", in("small.cert")}).exit_code, 0);
    const ToolRun run = verify("torus.off", out, "small.cert");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("proven"), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "");
  }
}

/// A square of n x n squares with texture coordinates, its height a wave.
void write_textured_wave(const std::string& path, int n) {
  std::ofstream file(path);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      file << "v " << x << ' ' << y << ' ' << 0.03 * std::sin(5 * x + 3 * y) << "\nvt " << x << ' ' << y << '\n';
    }
  for (int j = 0; j < n; ++j)
    for (int i = 1; i <= n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      file << "f " << a << '/' << a << ' ' << b << '/' << b << ' ' << d << '/' << d << '\n';
      file << "f " << a << '/' << a << ' ' << d << '/' << d << ' ' << c << '/' << c << '\n';
    }
}

TEST_F(CertificateTools, ProveTheTextureWithinItsTolerance) {
  write_textured_wave(in("wave.obj"), 24);
  ASSERT_EQ(simplify("wave.obj", "small.obj",
                     {"--tolerance", "0.02", "--texture-tolerance", "0.01", "--certificate", in("c")})
                .exit_code,
            0);
  const ToolRun run = verify("wave.obj", "small.obj", "c");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("texture     moves by at most 0.01 ("), std::string::npos) << run.out;
  const Json json = checked_document(verify("wave.obj", "small.obj", "c", {"--json"}).out);
  EXPECT_EQ(json["texture"]["tolerance"], 0.01);
  EXPECT_GE(json["texture"]["original_to_simplified"]["pieces"], 2 * 24 * 24);
  EXPECT_EQ(verify("wave.obj", "small.obj", "c", {"--texture-tolerance", "0.01"}).exit_code, 0);
  expect_one_line(verify("wave.obj", "small.obj", "c", {"--texture-tolerance", "0.0099"}), 1,
                  "it proves a tolerance of 0.01 about the texture, more than the wanted 0.0099");

  const auto distance = [&](const std::string& texture_tolerance) {
    return run_tool(HAUSDORFF_DISTANCE, {in("wave.obj"), in("small.obj"), "--tolerance", "0.02", "--texture",
                                         "--texture-tolerance", texture_tolerance, "--certificate", in("d")});
  };
  EXPECT_EQ(distance("1e-6").exit_code, 1) << "the texture moves further than that";
  EXPECT_FALSE(fs::exists(in("d")));
  EXPECT_EQ(distance("0.015").exit_code, 0);
  EXPECT_EQ(checked_document(verify("wave.obj", "small.obj", "d", {"--json"}).out)["texture"]["tolerance"], 0.015);
  // The mesh without its texture is no longer what was certified.
  write_mesh(in("bare.obj"), read_mesh(in("small.obj")).mesh);
  EXPECT_EQ(verify("wave.obj", "bare.obj", "d").exit_code, 1);
}

TEST_F(CertificateTools, VerifierTellsInJson) {
  ASSERT_EQ(simplify("torus.off", "small.ply", {"--tolerance", "0.03", "--certificate", in("c"), "--json", in("j")})
                .exit_code,
            0);
  const ToolRun run = verify("torus.off", "small.ply", "c", {"--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json json = checked_document(run.out);
  EXPECT_EQ(json["schema"], "meshbound/verify/1");
  EXPECT_EQ(json["verdict"], "proven");
  EXPECT_EQ(json["tolerance"], 0.03);
  EXPECT_EQ(json["certificate"]["bytes"], fs::file_size(in("c")));
  EXPECT_EQ(json["original"]["faces"], 1600);
  EXPECT_GE(json["original_to_simplified"]["pieces"], 1600);
  const Json simplified = checked_document(testing_tools::content_of(in("j")));
  EXPECT_EQ(simplified["certificates"][0]["path"], in("c"));
  EXPECT_EQ(simplified["certificates"][0]["bytes"], fs::file_size(in("c")));
  const ToolRun rejected = verify("small.ply", "torus.off", "c", {"--json"});
  EXPECT_EQ(rejected.exit_code, 1);
  EXPECT_EQ(checked_document(rejected.out)["verdict"], "rejected");
  EXPECT_NE(checked_document(rejected.out)["reason"].get<std::string>().find("not the one"), std::string::npos);
  EXPECT_EQ(verify("torus.off", "small.ply", "c", {"--quiet"}).out, "");
}

TEST_F(CertificateTools, VerifierRejectsOtherMeshesDamageAndLargerTolerances) {
  ASSERT_EQ(simplify("torus.off", "small.ply", {"--tolerance", "1%", "--certificate", in("c")}).exit_code, 0);
  EXPECT_EQ(verify("torus.off", "small.ply", "c", {"--tolerance", "1%"}).exit_code, 0);
  expect_one_line(verify("torus.off", "small.ply", "c", {"--tolerance", "0.99%"}), 1, "more than the wanted");
  expect_one_line(verify("torus.off", "small.ply", "c", {"--line-tolerance", "10%"}), 1,
                  "it proves nothing about feature lines");
  expect_one_line(verify("torus.off", "small.ply", "c", {"--texture-tolerance", "10%"}), 1,
                  "it proves nothing about the texture");
  expect_one_line(verify("torus.off", "small.ply", "c", {"--line-tolerance", "thin"}), 2, "--line-tolerance");
  expect_one_line(verify("coarse.off", "small.ply", "c"), 1, "the original mesh is not the one");
  expect_one_line(verify("torus.off", "coarse.off", "c"), 1, "the simplified mesh is not the one");
  expect_one_line(verify("torus.off", "small.ply", "small.ply"), 1, "not a meshbound certificate");
  std::string bytes = testing_tools::content_of(in("c"));
  bytes[bytes.size() / 2] ^= 4;
  std::ofstream(in("damaged"), std::ios::binary) << bytes;
  expect_one_line(verify("torus.off", "small.ply", "damaged"), 1, "damaged");
  std::ofstream(in("empty"), std::ios::binary).flush();
  expect_one_line(verify("torus.off", "small.ply", "empty"), 1, "not a meshbound certificate");
}

TEST_F(CertificateTools, VerifierTellsBadUsageFromRejection) {
  ASSERT_EQ(simplify("torus.off", "small.ply", {"--tolerance", "1%", "--certificate", in("c")}).exit_code, 0);
  expect_one_line(verify("torus.off", "small.ply", "none"), 2, "none");
  expect_one_line(verify("none.off", "small.ply", "c"), 2, "none.off");
  expect_one_line(verify("torus.off", "c", "c"), 2, "c");
  expect_one_line(verify("torus.off", "small.ply", ""), 2, "");  // a folder
  expect_one_line(verify("torus.off", "small.ply", "c", {"--tolerance", "much"}), 2, "--tolerance");
  expect_one_line(run_tool(VERIFY_CERTIFICATE, {in("torus.off")}), 2, "SIMPLIFIED");
  EXPECT_EQ(run_tool(VERIFY_CERTIFICATE, {"--version"}).exit_code, 0);
  EXPECT_EQ(run_tool(VERIFY_CERTIFICATE, {"--help"}).exit_code, 0);
}

TEST_F(CertificateTools, VerifierReadsOnlyWhatEnds) {
  std::ofstream(in("large"), std::ios::binary) << "MESHCERX";
  std::filesystem::resize_file(in("large"), std::uintmax_t{1} << 40);  // a hole of a terabyte
  expect_one_line(verify("torus.off", "coarse.off", "large"), 1, "not a meshbound certificate");
  ASSERT_EQ(::mkfifo(in("fifo").c_str(), 0600), 0);
  expect_one_line(verify("torus.off", "coarse.off", "fifo"), 2, "not a regular file");
  if (::mknod(in("zero").c_str(), S_IFCHR | 0666, makedev(1, 5)) == 0) {  // a node of the device without end
    expect_one_line(verify("torus.off", "coarse.off", "zero"), 2, "zero");
  }
}

TEST_F(CertificateTools, EveryLevelHasItsOwn) {
  ASSERT_EQ(simplify("torus.off", "small.ply",
                     {"--levels", "0.3%,1%", "--tolerance", "2%", "--certificate", in("small.cert")})
                .exit_code,
            0);
  EXPECT_EQ(verify("torus.off", "small_level_0.ply", "small_level_0.cert", {"--tolerance", "0.3%"}).exit_code, 0);
  EXPECT_EQ(verify("torus.off", "small_level_1.ply", "small_level_1.cert", {"--tolerance", "1%"}).exit_code, 0);
  EXPECT_EQ(verify("torus.off", "small.ply", "small.cert", {"--tolerance", "2%"}).exit_code, 0);
  EXPECT_EQ(verify("torus.off", "small.ply", "small_level_0.cert").exit_code, 1);
}

TEST_F(CertificateTools, FeatureLinesAreCertifiedInEveryFormat) {
  write_mesh(folder_ / "terrain.ply", datasets::terrain(1, 24, 5));
  for (const std::string format : {"ply", "stl", "obj", "glb"}) {
    const ToolRun made = simplify("terrain.ply", "small." + format,
                                  {"--tolerance", "2%", "--line-tolerance", "0.5%", "--certificate", in("small.cert")});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json document = checked_document(verify("terrain.ply", "small." + format, "small.cert", {"--json"}).out);
    ASSERT_TRUE(document.contains("lines")) << format;
    EXPECT_EQ(document["lines"]["original_edges"], 4 * 24);
    EXPECT_LT(document["lines"]["simplified_edges"], 4 * 24);
    EXPECT_EQ(document["lines"]["all_borders"], true);
    EXPECT_LT(document["lines"]["tolerance"], document["tolerance"]);
    EXPECT_NE(verify("terrain.ply", "small." + format, "small.cert").out.find("all borders"), std::string::npos);
  }
}

TEST_F(CertificateTools, ATolerance0IsCertifiedWhereNothingChanged) {
  for (const char* out : {"same.off", "same.ply"}) {
    ASSERT_EQ(simplify("torus.off", out, {"--tolerance", "0", "--certificate", in("c")}).exit_code, 0);
    EXPECT_EQ(verify("torus.off", out, "c", {"--tolerance", "0"}).exit_code, 0);
  }
}

/// Triangles with corners of small integers: many cross, overlap, repeat one another or have no area.
TriangleMesh integer_soup(std::uint32_t seed, std::size_t triangles) {
  std::mt19937 random(seed);
  TriangleMesh soup;
  for (std::uint32_t v = 0; v < 3 * triangles; ++v) {
    soup.vertices.emplace_back(random() % 4, random() % 4, random() % 4);
    if (v % 3 == 2) soup.triangles.push_back({v - 2, v - 1, v});
  }
  return soup;
}

TEST_F(CertificateTools, TinyTolerancesOfAnySoupAreCertified) {
  for (const std::size_t triangles : {1, 2, 8, 60}) {
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
      write_mesh(in("soup.stl"), integer_soup(seed, triangles));
      for (const char* tolerance : {"0", "1e-9%", "1e-6%"}) {
        for (const char* out : {"out.stl", "out.ply"}) {
          SCOPED_TRACE(std::to_string(triangles) + " triangles, seed " + std::to_string(seed) + ", " + tolerance +
                       ", " + out);
          const ToolRun run = simplify("soup.stl", out, {"--tolerance", tolerance, "--certificate", in("c")});
          EXPECT_EQ(run.exit_code, 0) << run.err;
          EXPECT_EQ(verify("soup.stl", out, "c", {"--tolerance", tolerance}).exit_code, 0);
        }
      }
    }
  }
}

/// No mesh appears without the certificate that was asked for, however little time there was.
TEST_F(CertificateTools, WhatATimeLimitLeavesIsCertified) {
  ASSERT_EQ(simplify("torus.off", "small.ply", {"--tolerance", "1%", "--certificate", in("c"), "--time-limit", "0"})
                .exit_code,
            3);
  EXPECT_EQ(verify("torus.off", "small.ply", "c", {"--tolerance", "1%"}).exit_code, 0);
}

TEST_F(CertificateTools, ACertificateDoesNotReplaceAMesh) {
  const std::string original = testing_tools::content_of(in("torus.off"));
  for (const char* name : {"small.ply", "torus.off"}) {
    const ToolRun run = simplify("torus.off", "small.ply", {"--tolerance", "1%", "--certificate", in(name)});
    expect_one_line(run, 2, "--certificate");
  }
  expect_one_line(run_tool(HAUSDORFF_DISTANCE, {in("torus.off"), in("coarse.off"), "--tolerance", "1", "--quiet",
                                                "--certificate", in("coarse.off")}),
                  2, "--certificate");
  EXPECT_EQ(testing_tools::content_of(in("torus.off")), original);
}

TEST_F(CertificateTools, NothingIsWrittenWhereTheCertificateCannotBe) {
  const std::size_t before = file_count();
  const ToolRun run = simplify("torus.off", "small.ply", {"--tolerance", "1%", "--certificate", in("no/such/c")});
  expect_one_line(run, 2, "no such folder");
  EXPECT_EQ(file_count(), before);
}

TEST_F(CertificateTools, AnyTwoMeshesCanBeCertified) {
  const auto certify = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{in("torus.off"), in("coarse.off"), "--quiet", "--certificate", in("pair.cert")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(HAUSDORFF_DISTANCE, arguments);
  };
  EXPECT_EQ(certify({"--tolerance", "0.05"}).exit_code, 0);
  const std::string proven = verify("torus.off", "coarse.off", "pair.cert").out;
  EXPECT_NE(proven.find(" are within 0.05 ("), std::string::npos) << proven;
  EXPECT_EQ(certify({"--tolerance", "0.08"}).exit_code, 0);
  EXPECT_EQ(verify("torus.off", "coarse.off", "pair.cert", {"--tolerance", "0.08"}).exit_code, 0);
  fs::remove(in("pair.cert"));
  const std::size_t before = file_count();
  EXPECT_EQ(certify({"--tolerance", "0.001"}).exit_code, 1);
  EXPECT_EQ(certify({"--tolerance", "0.08", "--one-sided"}).exit_code, 2);
  EXPECT_EQ(certify({"--tolerance", "0.08", "--transform-b", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}).exit_code, 2);
  EXPECT_EQ(certify({}).exit_code, 2);
  EXPECT_EQ(file_count(), before);
}

TEST_F(CertificateTools, WriteNoDocumentUnderTheNameOfAMesh) {
  const ToolRun run = verify("torus.off", "torus.off", "c", {"--json", in("other.ply")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("has the name of a mesh"), std::string::npos) << run.err;
}

/// The decision itself needs no time where the meshes are the same.
TEST_F(CertificateTools, SaysThatTheTimeLimitLeftTheCertificateUndone) {
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("torus.off"), in("torus.off"), "--tolerance", "1", "--json", "-",
                                                    "--certificate", in("c"), "--time-limit", "0"});
  EXPECT_EQ(run.exit_code, 3);
  const Json json = checked_document(run.out);
  EXPECT_EQ(json["verdict"], "within");
  EXPECT_EQ(json["outcome"], "budget");
  EXPECT_NE(json["reason"].get<std::string>().find("certificate"), std::string::npos);
  EXPECT_FALSE(fs::exists(in("c")));
}

TEST_F(CertificateTools, RealMeshesAreCertified) {
  for (const char* name : {"cad/c3d_fandisk.obj", "scan/igl_bunny.off"}) {
    SCOPED_TRACE(name);
    const auto path = test::dataset(name);
    if (!path) GTEST_SKIP() << name << " is not on this machine (MESHBOUND_DATASETS)";
    ASSERT_EQ(run_tool(SIMPLIFY_WITH_BOUND,
                       {path->string(), in("small.ply"), "--quiet", "--tolerance", "0.5%", "--certificate", in("c")})
                  .exit_code,
              0);
    const ToolRun run = run_tool(VERIFY_CERTIFICATE, {path->string(), in("small.ply"), in("c"), "--tolerance", "0.5%"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
}

}  // namespace certificate_tool_test
}  // namespace meshbound
