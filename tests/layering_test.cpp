// SPDX-License-Identifier: MIT
// The rules of the source tree, read from the sources: each folder of src includes only itself and earlier ones, CGAL
// and Boost stay in the GPL part, every file names its licence and none grows past a readable length.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Folders of src in dependency order; those of src/distance and src/simplify are rooms of their own, the files beside
/// them are the entry points of a measurement and the steps of a decimation. `cgal` and `mpi` are what is
/// compiled against CGAL and MPI; they may use everything before them.
// clang-format off
constexpr std::array layers = std::to_array<std::string_view>(
    {"numeric", "geometry", "mesh", "bvh", "proof", "distance/paper", "distance/kernel", "distance/shortcuts",
     "distance/search", "distance", "distance/levels", "deviation", "penetration", "scene", "attributes", "simplify/kernel", "simplify/mesh",
     "simplify/cover", "simplify/normals", "simplify/texture", "simplify", "normals", "texture", "certificate", "texture_proof", "levels", "tiles", "view", "report", "cgal", "mpi"});
// clang-format on
constexpr std::size_t longest_file = 600;

struct SourceFile {
  std::string path;  ///< relative to the source root, with forward slashes
  std::vector<std::string> lines;
};

bool starts_with(std::string_view text, std::string_view prefix) { return text.substr(0, prefix.size()) == prefix; }

SourceFile load(const fs::path& root, const fs::path& path) {
  SourceFile file{fs::relative(path, root).generic_string(), {}};
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) file.lines.push_back(line);
  return file;
}

bool is_source(const fs::path& path) {
  static const std::set<std::string> extensions = {".h",  ".c",   ".cpp", ".cmake", ".in", ".sh",
                                                   ".js", ".mjs", ".ts",  ".py",    ".pyi"};
  return extensions.contains(path.extension().string()) || path.filename() == "CMakeLists.txt" ||
         (path.extension().empty() && path.filename() != "LICENSE");
}

std::vector<SourceFile> sources(const fs::path& root) {
  std::vector<SourceFile> files;
  for (const char* folder : {"include", "src", "bindings", "tools", "tests", "datasets", "cmake", "examples"}) {
    if (!fs::is_directory(root / folder)) continue;
    for (auto it = fs::recursive_directory_iterator(root / folder); it != fs::recursive_directory_iterator(); ++it) {
      const std::string name = it->path().filename().string();
      if (it->is_directory() && (name == "cache" || name == "corpus")) it.disable_recursion_pending();
      if (it->is_regular_file() && is_source(it->path())) files.push_back(load(root, it->path()));
    }
  }
  if (fs::exists(root / "CMakeLists.txt")) files.push_back(load(root, root / "CMakeLists.txt"));
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

/// What stands between the quotes or brackets of an #include, with its opening character; empty for other lines.
std::string included(const std::string& line) {
  const std::size_t start = line.find_first_not_of(' ');
  if (start == std::string::npos || line.compare(start, 8, "#include") != 0) return {};
  const std::size_t open = line.find_first_of("<\"", start);
  if (open == std::string::npos) return {};
  return line.substr(open, line.find_first_of(">\"", open + 1) - open);
}

/// Position of the folder of a path like `bvh/build.h` in `layers`; `layers.size()` when it is none of them.
std::size_t layer_of(std::string_view path) {
  const auto found = std::find(layers.begin(), layers.end(), path.substr(0, path.rfind('/')));
  return static_cast<std::size_t>(found - layers.begin());
}

bool may_use_cgal(const SourceFile& file) {
  for (const char* prefix : {"include/meshbound/cgal/", "src/cgal/", "examples/", "tests/", "tools/"})
    if (starts_with(file.path, prefix)) return true;
  return false;
}

bool may_use_mpi(const SourceFile& file) {
  for (const char* prefix :
       {"include/meshbound/mpi.h", "src/mpi/", "tools/mpi/", "tools/bench/ranks/", "tests/", "examples/"})
    if (starts_with(file.path, prefix)) return true;
  return false;
}

bool is_gpl(const SourceFile& file) {
  return !file.lines.empty() && file.lines[0].find("GPL-3.0-or-later") != std::string::npos;
}

/// Why `file` may not contain this include; empty when it may.
std::string include_violation(const SourceFile& file, const std::string& include) {
  const bool gpl_header = starts_with(include, "<CGAL/") || starts_with(include, "<boost/") ||
                          starts_with(include, "\"CGAL/") || include.find("meshbound/cgal/") == 1;
  if (gpl_header && !may_use_cgal(file)) return "CGAL and Boost belong to the GPL part";
  if (gpl_header && !is_gpl(file) && !starts_with(file.path, "tests/"))
    return "a file that includes CGAL must carry the SPDX line of the GPL";
  if ((include == "<mpi.h" || include.find("meshbound/mpi.h") == 1) && !may_use_mpi(file))
    return "MPI belongs to src/mpi and to the tools that run over it";
  const bool quoted = starts_with(include, "\"");
  if (starts_with(file.path, "include/") && quoted && include.find("meshbound/") != 1)
    return "public headers include only public headers";
  if (starts_with(file.path, "bindings/") && quoted && layer_of(std::string_view(include).substr(1)) != layers.size())
    return "bindings use public headers alone";
  if (!starts_with(file.path, "src/") || !quoted || include.find("meshbound/") == 1) return {};
  if (starts_with(file.path, "src/levels/") && starts_with(include, "\"mesh/gltf_"))
    return "levels know where parts stand (mesh/scene_layout.h), not the document";
  const std::size_t used = layer_of(std::string_view(include).substr(1));
  const std::size_t own = layer_of(std::string_view(file.path).substr(4));
  if (used == layers.size()) return "not a folder of src; write the path from src";
  return used > own ? "a later folder" : "";
}

std::vector<std::string> violations(const fs::path& root) {
  std::vector<std::string> found;
  for (const SourceFile& file : sources(root)) {
    const bool in_a_folder = starts_with(file.path, "src/") && file.path.find('/', 4) != std::string::npos;
    if (in_a_folder && layer_of(std::string_view(file.path).substr(4)) == layers.size())
      found.push_back(file.path + ": a folder of src that the dependency order does not name");
    if (file.lines.size() > longest_file)
      found.push_back(file.path + ": " + std::to_string(file.lines.size()) + " lines, more than " +
                      std::to_string(longest_file));
    const auto head = file.lines.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, file.lines.size()));
    if (std::none_of(file.lines.begin(), head,
                     [](const auto& line) { return line.find("SPDX-License-Identifier: ") != std::string::npos; }))
      found.push_back(file.path + ": no SPDX line at the top");
    for (const std::string& line : file.lines) {
      const std::string include = included(line);
      const std::string reason = include.empty() ? "" : include_violation(file, include);
      if (!reason.empty()) found.push_back(file.path + ": includes " + include.substr(1) + ": " + reason);
    }
  }
  return found;
}

/// The name after "namespace" where a line opens one, "-" for one without a name; empty for other lines.
std::string opened_namespace(const std::string& line) {
  if (!line.ends_with('{') || (!starts_with(line, "namespace ") && !starts_with(line, "inline namespace "))) return {};
  const std::size_t begin = line.find("namespace ") + 10;
  const std::string name = line.substr(begin, line.find_first_of(" {", begin) - begin);
  return name.empty() ? "-" : name;
}

/// The name of the type whose definition begins at the start of a line; empty for other lines.
std::string defined_type(const std::string& line) {
  for (const std::string_view keyword : {"struct ", "class ", "enum class "}) {
    if (!starts_with(line, keyword) || line.find('{') == std::string::npos) continue;
    const std::size_t begin = starts_with(line, "struct alignas(") ? line.find(") ") + 2 : keyword.size();
    return line.substr(begin, line.find_first_of(" {", begin) - begin);
  }
  return {};
}

/// Types of the library with a definition in more than one file. The linker takes the functions of either one for both,
/// without a word, unless they stand in namespaces without a name.
std::vector<std::string> types_defined_twice(const fs::path& root) {
  std::map<std::string, std::set<std::string>> files_of_type;
  for (const SourceFile& file : sources(root)) {
    if (!starts_with(file.path, "src/") && !starts_with(file.path, "include/")) continue;
    std::vector<std::string> namespaces;
    for (const std::string& line : file.lines) {
      const std::string opened = opened_namespace(line), type = defined_type(line);
      if (!opened.empty()) namespaces.push_back(opened);
      if (starts_with(line, "}  // namespace") && !namespaces.empty()) namespaces.pop_back();
      if (type.empty() || std::count(namespaces.begin(), namespaces.end(), "-") > 0) continue;
      std::string scope;
      for (const std::string& name : namespaces) scope += name + "::";
      files_of_type[scope + type].insert(file.path);
    }
  }
  std::vector<std::string> found;
  for (const auto& [type, files] : files_of_type)
    if (files.size() > 1) found.push_back(type + ": defined in " + *files.begin() + " and " + *files.rbegin());
  return found;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

/// A source tree in a temporary folder, to see each rule broken.
class Layering : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / ("meshbound_layering_" + std::to_string(::getpid()));
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text, const std::string& licence = "MIT") {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << "// SPDX-License-Identifier: " << licence << '\n' << text << '\n';
  }

  fs::path root_;
};

TEST(SourceTree, FollowsItsOwnRules) {
  ASSERT_GT(sources(MESHBOUND_SOURCE_DIR).size(), 10U) << "the source tree was not found";
  EXPECT_EQ(joined(violations(MESHBOUND_SOURCE_DIR)), "");
}

TEST(SourceTree, DefinesEveryTypeOnce) { EXPECT_EQ(joined(types_defined_twice(MESHBOUND_SOURCE_DIR)), ""); }

TEST(SourceTree, UmbrellaHeaderNamesEveryPublicHeaderOfTheCore) {
  const fs::path folder = fs::path(MESHBOUND_SOURCE_DIR) / "include/meshbound";
  const std::vector<std::string> umbrella = load(folder, folder / "meshbound.h").lines;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "meshbound.h" || name == "mpi.h") continue;
    EXPECT_NE(std::find(umbrella.begin(), umbrella.end(), "#include \"meshbound/" + name + "\""), umbrella.end())
        << name;
  }
}

TEST_F(Layering, AcceptsEarlierFoldersAndPublicHeaders) {
  write("src/distance/walk.cpp", "#include <vector>\n#include \"bvh/tree.h\"\n#include \"meshbound/distance.h\"");
  write("include/meshbound/cgal/monitor.h", "#include <CGAL/Surface_mesh.h>", "GPL-3.0-or-later");
  write("tests/oracle_test.cpp", "#include <CGAL/Surface_mesh.h>");
  EXPECT_EQ(joined(violations(root_)), "");
}

TEST_F(Layering, RefusesALaterFolder) {
  write("src/bvh/tree.cpp", "#include \"distance/walk.h\"");
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, OrdersTheRoomsOfDistance) {
  write("src/distance/search/steps.cpp", "#include \"distance/kernel/walk.h\"\n#include \"proof/piece.h\"");
  write("src/distance/distance.cpp", "#include \"distance/search/steps.h\"");
  write("src/distance/levels/checker.cpp", "#include \"distance/distance.h\"");
  EXPECT_EQ(joined(violations(root_)), "");
  write("src/distance/kernel/walk.cpp", "#include \"distance/search/steps.h\"");
  write("src/distance/paper/lemma.cpp", "#include \"distance/kernel/walk.h\"");
  write("src/distance/search/more.cpp", "#include \"distance/distance.h\"");
  write("src/distance/shortcuts/same.cpp", "#include \"distance/levels/checker.h\"");
  write("src/proof/piece.cpp", "#include \"distance/paper/lemma.h\"");
  EXPECT_EQ(violations(root_).size(), 5U);
}

TEST_F(Layering, RefusesAnUnknownFolder) {
  write("src/distance/attic/things.cpp", "");
  write("src/misc/things.cpp", "");
  write("src/mesh/a.cpp", "#include \"b.h\"");
  EXPECT_EQ(violations(root_).size(), 3U);
}

TEST_F(Layering, RefusesCgalInTheCore) {
  write("src/mesh/a.cpp", "#include <CGAL/Surface_mesh.h>", "GPL-3.0-or-later");
  write("include/meshbound/a.h", "#include <boost/optional.hpp>");
  write("include/meshbound/b.h", "#include \"meshbound/cgal/monitor.h\"");
  EXPECT_EQ(violations(root_).size(), 3U);
}

TEST_F(Layering, RefusesMpiOutsideItsComponent) {
  write("src/mpi/ranks.h", "#include <mpi.h>\n#include \"tiles/jobs.h\"");
  write("include/meshbound/mpi.h", "#include <mpi.h>");
  EXPECT_EQ(joined(violations(root_)), "");
  write("src/tiles/jobs.cpp", "#include \"mpi/ranks.h\"");
  write("src/mesh/a.cpp", "#include <mpi.h>");
  write("tools/common/a.cpp", "#include \"meshbound/mpi.h\"");
  EXPECT_EQ(violations(root_).size(), 3U);
}

TEST_F(Layering, RefusesCgalUnderTheMitLicence) {
  write("tools/simplify.cpp", "#include \"meshbound/cgal/monitor.h\"");
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, RefusesADocumentOfGltfInLevels) {
  write("src/levels/scene.cpp", "#include \"mesh/scene_layout.h\"");
  EXPECT_EQ(joined(violations(root_)), "");
  write("src/levels/other.cpp", "#include \"mesh/gltf_document.h\"");
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, RefusesAPublicHeaderThatNeedsAPrivateOne) {
  write("include/meshbound/a.h", "#include \"bvh/tree.h\"");
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, RefusesABindingThatNeedsAPrivateHeader) {
  write("bindings/c/src/a.cpp", "#include \"arguments.h\"\n#include \"meshbound/simplify.h\"");
  EXPECT_EQ(joined(violations(root_)), "");
  write("bindings/c/src/b.cpp", "#include \"bvh/tree.h\"");
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, RefusesTypesOfOneName) {
  write("src/mesh/a.h", "namespace meshbound {\nstruct Chart;\nstruct Chart {\n};\n}  // namespace meshbound");
  write("src/mesh/a.cpp",
        "namespace meshbound {\nnamespace {\nclass Chart {\n};\n}  // namespace\n}  // namespace meshbound");
  write("src/bvh/b.h", "namespace meshbound::other {\nclass Chart final {\n};\n}  // namespace meshbound::other");
  EXPECT_EQ(joined(types_defined_twice(root_)), "");
  write("src/bvh/c.cpp",
        "namespace meshbound {\nnamespace {\n}  // namespace\nclass Chart : Base {\n};\n}  // namespace meshbound");
  EXPECT_EQ(joined(types_defined_twice(root_)), "meshbound::Chart: defined in src/bvh/c.cpp and src/mesh/a.h\n");
}

TEST_F(Layering, RefusesAFileWithoutALicence) {
  std::ofstream(root_ / "CMakeLists.txt") << "project(x)\n";
  EXPECT_EQ(violations(root_).size(), 1U);
}

TEST_F(Layering, RefusesAFileThatGrewTooLong) {
  write("src/mesh/long.cpp", std::string(longest_file, '\n'));
  EXPECT_EQ(violations(root_).size(), 1U);
}

}  // namespace
