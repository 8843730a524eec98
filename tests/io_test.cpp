// SPDX-License-Identifier: MIT
// What holds for every format: dispatch, errors of the file system, round trips, atomic writing.
#include "meshbound/io.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <bit>
#include <csignal>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "mesh/readers.h"
#include "mesh_files.h"

namespace meshbound::test {
namespace io_test {

struct Target {
  const char* name;
  WriteOptions options;
};

const std::vector<Target> double_targets = {
    {"m.off", {}}, {"m.obj", {}}, {"m.ply", {}}, {"m.PLY", {.ascii = true, .single_precision = false}}};
const std::vector<Target> float_targets = {{"m.stl", {}},
                                           {"m.off", {.ascii = false, .single_precision = true}},
                                           {"m.obj", {.ascii = false, .single_precision = true}},
                                           {"m.STL", {.ascii = true, .single_precision = false}},
                                           {"m.ply", {.ascii = false, .single_precision = true}},
                                           {"m.ply", {.ascii = true, .single_precision = true}},
                                           {"m.gltf", {}},
                                           {"m.glb", {}}};

std::vector<std::uint64_t> bits_of(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> bits;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (const double x : p) bits.push_back(std::bit_cast<std::uint64_t>(x));
  return bits;
}

void expect_round_trip(const Target& target, const TriangleMesh& mesh) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / target.name;
  write_mesh(path, mesh, target.options);
  const TriangleMesh back = read_mesh(path).mesh;
  const TriangleMesh expected = rounded_for(path, mesh, target.options);
  EXPECT_EQ(bits_of(back), bits_of(expected)) << target.name;
  EXPECT_EQ(back.triangles, expected.triangles) << target.name;
}

/// Triangles over vertices with the coordinates given, three a vertex.
TriangleMesh mesh_over(const std::vector<double>& coordinates) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i + 3 <= coordinates.size(); i += 3)
    mesh.vertices.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  for (std::uint32_t i = 0; i + 3 <= mesh.vertices.size(); ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TriangleMesh random_bits_mesh(double largest) {
  std::mt19937_64 random(20240607);
  std::vector<double> coordinates;
  while (coordinates.size() < 30000) {
    const double x = std::bit_cast<double>(random());
    if (std::abs(x) <= largest) coordinates.push_back(x);  // false for NaN
  }
  return mesh_over(coordinates);
}

const TriangleMesh extreme_doubles =
    mesh_over({0x1p-1074, -0x1p-1074, 0x0.fffffffffffffp-1022, 0x1p-1022, 1e155, -1e155, 0x1p1000, -0x1p1000, 0.1, -0.0,
               0.0, 1.0 / 3, 5e-324, 1e22, 1e23, 9007199254740993.0, 123456789012345678.0, -1e-160});

const TriangleMesh triangle = mesh_over({0, 0, 0, 1, 0, 0, 0, 1, 0});

TEST(Formats, AreToldFromTheExtension) {
  EXPECT_EQ(format_of("a.off"), FileFormat::Off);
  EXPECT_EQ(format_of("/b/c.d/A.OBJ"), FileFormat::Obj);
  EXPECT_EQ(format_of("x.Ply"), FileFormat::Ply);
  EXPECT_EQ(format_of("x.stl"), FileFormat::Stl);
  EXPECT_EQ(format_of("x.glb"), FileFormat::Glb);
  EXPECT_EQ(format_of("x.GLTF"), FileFormat::Gltf);
  for (const char* unknown : {"x.fbx", "x", "", ".ply", "x.ply.gz", "off"})
    EXPECT_THROW((void)format_of(unknown), InvalidInput) << unknown;
}

TEST(RoundTrip, OfDoublesIsExactToTheBit) {
  for (const Target& target : double_targets) {
    for (const TriangleMesh& mesh : {triangle, extreme_doubles, random_bits_mesh(0x1p1000)}) {
      expect_round_trip(target, mesh);
      EXPECT_EQ(bits_of(rounded_for(target.name, mesh, target.options)), bits_of(mesh));
    }
  }
}

TEST(RoundTrip, OfFloatsGivesTheMeshAsRounded) {
  constexpr double largest = std::numeric_limits<float>::max();
  for (const Target& target : float_targets)
    for (const TriangleMesh& mesh :
         {triangle, random_bits_mesh(largest), mesh_over({0.1, 1e-50, 1e-42, -0.0, 1, 2, 3e38, 0, -1})})
      expect_round_trip(target, mesh);
}

TEST(RoundTrip, KeepsUnusedVerticesWhateverTheyHold) {
  TriangleMesh mesh = triangle;
  mesh.vertices.emplace_back(std::numeric_limits<double>::infinity(), 0, -std::numeric_limits<double>::infinity());
  for (const Target& target : double_targets) expect_round_trip(target, mesh);
}

TEST(Rounding, ForStlAndGltfWeldsAndDropsWhatNoTriangleUses) {
  TriangleMesh mesh = mesh_over({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1 + 1e-12, -0.0, 0, 1, 1, 0});
  mesh.triangles = {{1, 2, 3}, {4, 5, 3}};
  for (const char* name : {"m.stl", "m.gltf", "m.glb"}) {
    const TriangleMesh rounded = rounded_for(name, mesh);
    EXPECT_EQ(rounded.vertices.size(), 4u) << name;
    EXPECT_EQ(rounded.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}})) << name;
    expect_round_trip({name, {}}, mesh);
  }
}

TEST(Rounding, RefusesWhatLeavesTheRangeOfFloat) {
  const TemporaryFolder folder;
  const TriangleMesh huge = mesh_over({1e39, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const Target& target : float_targets) {
    EXPECT_THROW((void)rounded_for(target.name, huge, target.options), InvalidInput);
    EXPECT_THROW(write_mesh(folder / target.name, huge, target.options), InvalidInput);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Writing, IsCompactAndReadable) {
  const TemporaryFolder folder;
  write_mesh(folder / "m.off", triangle);
  EXPECT_EQ(content_of(folder / "m.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write_mesh(folder / "m.obj", triangle);
  EXPECT_EQ(content_of(folder / "m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_mesh(folder / "m.stl", triangle, {.ascii = true, .single_precision = false});
  EXPECT_CONTAINS(content_of(folder / "m.stl"), "facet normal 0 0 1\n");
  write_mesh(folder / "m.stl", triangle);
  EXPECT_EQ(std::filesystem::file_size(folder / "m.stl"), 84u + 50u);
}

TEST(Writing, RefusesAMeshThatCouldNotBeReadBack) {
  const TemporaryFolder folder;
  TriangleMesh out_of_range = triangle;
  out_of_range.triangles.push_back({0, 1, 3});
  TriangleMesh not_finite = triangle;
  not_finite.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  for (const TriangleMesh& mesh : {TriangleMesh{}, out_of_range, not_finite})
    EXPECT_THROW(write_mesh(folder / "m.ply", mesh), InvalidInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Writing, ReplacesAFileAndKeepsItsPermissions) {
  const TemporaryFolder folder;
  write_file(folder / "m.off", "old");
  ::chmod((folder / "m.off").c_str(), 0640);
  write_mesh(folder / "m.off", triangle);
  EXPECT_EQ(read_mesh(folder / "m.off").mesh.triangles.size(), 1u);
  EXPECT_EQ(std::filesystem::status(folder / "m.off").permissions(), std::filesystem::perms(0640));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Writing, FollowsASymbolicLink) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  write_file(folder / "real/m.off", "old");
  std::filesystem::create_symlink("real/m.off", folder / "link.off");
  write_mesh(folder / "link.off", triangle);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.off"));
  EXPECT_EQ(read_mesh(folder / "real/m.off").mesh.triangles.size(), 1u);
}

TEST(Writing, MakesWhatADanglingLinkPointsTo) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_symlink("real/m.off", folder / "link.off");
  std::filesystem::create_symlink("link.off", folder / "second.off");
  write_mesh(folder / "second.off", triangle);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "second.off"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.off"));
  EXPECT_EQ(read_mesh(folder / "real/m.off").mesh.triangles.size(), 1u);
}

/// Its owner may change the mode; nobody else may decide that it does not count. The superuser is no exception.
TEST(Writing, RefusesAWriteProtectedFile) {
  const TemporaryFolder folder;
  write_file(folder / "m.off", "old");
  ::chmod((folder / "m.off").c_str(), 0444);
  EXPECT_THROW(write_mesh(folder / "m.off", triangle), IoError);
  EXPECT_EQ(content_of(folder / "m.off"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Writing, NamesThePathThatTheUserGave) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("missing/target.off", folder / "m.off");
  try {
    write_mesh(folder / "m.off", triangle);
    FAIL() << "written into a folder that is not there";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).rfind((folder / "m.off").string() + ": ", 0), 0u) << error.what();
  }
}

TEST(Cancelling, EndsReadingAndWritingAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  const std::atomic<bool> cancel = true;
  WriteOptions writing;
  writing.cancel = &cancel;
  for (const char* name : {"m.off", "m.obj", "m.ply", "m.stl"}) {
    write_mesh(folder / name, triangle);
    const std::string before = content_of(folder / name);
    EXPECT_THROW(read_mesh(folder / name, {&cancel}), Interrupted) << name;
    EXPECT_THROW(write_mesh(folder / name, triangle, writing), Interrupted) << name;
    EXPECT_EQ(content_of(folder / name), before) << name;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4) << "a temporary file was left";
}

/// Parsing looks at the flag too: the bytes are here, so it is not the file that ends it.
TEST(Cancelling, EndsTheParsing) {
  const TemporaryFolder folder;
  const std::atomic<bool> cancel = true;
  for (const char* name : {"m.off", "m.obj", "m.ply", "m.stl"}) {
    write_mesh(folder / name, triangle);
    const std::string bytes = content_of(folder / name);
    EXPECT_EQ(parse_mesh(name, bytes).mesh.triangles.size(), 1u) << name;
    EXPECT_THROW(parse_mesh(name, bytes, {&cancel}), Interrupted) << name;
  }
}

/// What a reader steps over without taking anything is looked at as well: without a vertex the content would be
/// refused.
TEST(Cancelling, EndsTheParsingOfWhatIsSteppedOver) {
  const std::atomic<bool> cancel = true;
  std::string comments, elements = "ply\nformat ascii 1.0\nelement dot 1\nproperty int x\nend_header\n1\n";
  for (int i = 0; i < 70'000; ++i) comments += "# nothing\n";
  const std::pair<const char*, std::string> files[] = {{"m.obj", comments}, {"m.off", comments}, {"m.ply", elements}};
  for (const auto& [name, bytes] : files) {
    EXPECT_THROW(parse_mesh(name, bytes), InvalidInput) << name;
    EXPECT_THROW(parse_mesh(name, bytes, {&cancel}), Interrupted) << name;
  }
}

TEST(Deadlines, EndReadingAndWritingAndLeaveTheOldFile) {
  const TemporaryFolder folder;
  const auto now = StopToken::Clock::now();
  WriteOptions writing;
  writing.deadline = now;
  for (const char* name : {"m.off", "m.obj", "m.ply", "m.stl"}) {
    write_mesh(folder / name, triangle);
    const std::string before = content_of(folder / name);
    EXPECT_THROW(read_mesh(folder / name, {nullptr, now}), Stopped) << name;
    EXPECT_THROW(parse_mesh(name, before, {nullptr, now}), Stopped) << name;
    EXPECT_EQ(parse_mesh(name, before, {nullptr, now + std::chrono::hours(1)}).mesh.triangles.size(), 1u) << name;
    EXPECT_THROW(write_mesh(folder / name, triangle, writing), Stopped) << name;
    EXPECT_EQ(content_of(folder / name), before) << name;
    try {
      (void)read_mesh(folder / name, {nullptr, now});
    } catch (const Stopped& stopped) {
      EXPECT_EQ(stopped.what(), (folder / name).string() + ": the time limit came while it was read");
    }
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4) << "a temporary file was left";
}

TEST(Writing, ReportsAFullDevice) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "m.ply");
  EXPECT_THROW(write_mesh(folder / "m.ply", triangle), IoError);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

/// For as long as it lives no file may grow beyond `bytes`: writing more fails as it does on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : previous_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &previous_);
    rlimit limit = previous_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit previous_{};
  void (*previous_handler_)(int);
};

TEST(Writing, LeavesTheOldFileAloneWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const TriangleMesh large = random_bits_mesh(1e30);
  for (const char* name : {"m.off", "m.obj", "m.ply", "m.stl"}) {
    write_file(folder / name, "old");
    {
      const FileSizeLimit limit(4096);
      EXPECT_THROW(write_mesh(folder / name, large), IoError) << name;
    }
    EXPECT_EQ(content_of(folder / name), "old") << name;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4) << "a temporary file was left";
}

TEST(Writing, ReportsAFolderThatIsMissingOrInTheWay) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(folder / "missing/m.off", triangle), IoError);
  std::filesystem::create_directory(folder / "m.off");
  EXPECT_THROW(write_mesh(folder / "m.off", triangle), IoError);
  EXPECT_THROW(write_mesh("/proc/m.off", triangle), IoError);
  EXPECT_THROW(write_mesh(folder / "m.xyz", triangle), InvalidInput);
}

TEST(Reading, ReportsPathsThatAreNoFiles) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)read_mesh(folder / "missing.off"), IoError);
  std::filesystem::create_directory(folder / "folder.off");
  EXPECT_THROW((void)read_mesh(folder / "folder.off"), IoError);
  ASSERT_EQ(::mkfifo((folder / "fifo.off").c_str(), 0600), 0);
  EXPECT_THROW((void)read_mesh(folder / "fifo.off"), IoError);
  EXPECT_THROW((void)read_mesh(folder / "m.xyz"), InvalidInput);
}

TEST(Reading, RefusesAnEmptyFileOfEveryFormat) {
  for (const char* name : {"m.off", "m.obj", "m.ply", "m.stl"}) EXPECT_CONTAINS(refusal(name, ""), "empty");
}

TEST(Io, NamesTheContentThatContradictsTheExtension) {
  TriangleMesh mesh = mesh_over({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const TemporaryFolder folder;
  for (const char* const name : {"m.ply", "m.stl", "m.glb"}) write_mesh(folder / name, mesh);
  const std::string ply = content_of(folder / "m.ply"), stl = content_of(folder / "m.stl"),
                    glb = content_of(folder / "m.glb");
  for (const std::string name : {"m.off", "m.obj", "m.ply", "m.stl", "m.glb", "m.gltf"}) {
    EXPECT_CONTAINS(refusal(name, "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n"),
                    "git lfs pull");
    EXPECT_CONTAINS(refusal(name, std::string("\x1F\x8B\x08\0\0\0\0\0", 8)), "gzip; unpack it");
    EXPECT_CONTAINS(refusal(name, std::string("PK\x03\x04\x14\0\0\0", 8)), "ZIP archive; unpack it");
    if (name != "m.ply") {
      EXPECT_CONTAINS(refusal(name, ply), "it is a PLY file; give it the extension .ply");
    }
    if (name != "m.stl") {
      EXPECT_CONTAINS(refusal(name, stl), "it is an STL file; give it the extension .stl");
      EXPECT_CONTAINS(refusal(name, "solid x\nendsolid x\n"), "it is an STL file");
    }
    if (name != "m.glb" && name != "m.gltf") {
      EXPECT_CONTAINS(refusal(name, glb), "it is a binary glTF file; give it the extension .glb");
    }
  }
}

/// The header of a binary STL may hold any text, and an OBJ may have statements that nobody knows.
TEST(Io, ReadsWhatOnlyBeginsLikeAnotherFormat) {
  const TemporaryFolder folder;
  write_mesh(folder / "m.stl", mesh_over({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  const std::string stl = content_of(folder / "m.stl");
  for (const std::string start : {"ply\n", "glTF", "PK\x03\x04", "version https://git-lfs"})
    EXPECT_EQ(read_content("m.stl", start + stl.substr(start.size())).mesh.triangles.size(), 1u);
}

}  // namespace io_test
}  // namespace meshbound::test
