// SPDX-License-Identifier: MIT
// The documents say what is there: their programs are those that the tests compile, their commands run, and the files
// and tests that they name exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace {

namespace fs = std::filesystem;
using meshbound::testing_tools::content_of;
using meshbound::testing_tools::run_shell;
using meshbound::testing_tools::run_tool;
using meshbound::testing_tools::TemporaryFolder;
using meshbound::testing_tools::ToolRun;

const fs::path root = MESHBOUND_SOURCE_DIR;

std::vector<fs::path> documents() {
  std::vector<fs::path> all{root / "README.md", root / "CONTRIBUTING.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// What stands between "```language" and "```".
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  std::vector<std::string> found;
  const std::string begin = "```" + language + "\n", end = "\n```";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t stop = text.find(end, at);
    found.push_back(text.substr(at, stop + 1 - at));
    at = stop;
  }
  return found;
}

TEST(Readme, IsShort) { EXPECT_LE(meshbound::testing_tools::line_count(content_of(root / "README.md")), 200); }

/// A program that the tests compile is in examples/, below its licence.
TEST(Documents, ShowOnlyProgramsThatTheTestsCompile) {
  std::vector<std::string> programs;
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "examples")) {
    if (!entry.is_regular_file()) continue;
    const std::string program = content_of(entry.path());
    programs.push_back(program.substr(program.find('\n') + 1));
  }
  std::size_t shown = 0;
  for (const fs::path& document : documents()) {
    for (const std::string& block : blocks(content_of(document), "cpp")) {
      EXPECT_NE(std::find(programs.begin(), programs.end(), block), programs.end()) << document << ":\n" << block;
      ++shown;
    }
  }
  EXPECT_GE(shown, 4u);
}

/// The lines of `text` that call one of our tools, without their comments: in blocks of sh, and indented ones.
std::vector<std::string> commands(const std::string& text) {
  std::vector<std::string> found;
  const std::regex line(
      "(^|\n)(    |  )?((simplify_with_bound|lod_chain|verify_certificate|hausdorff_distance|penetration_depth|"
      "generate_mesh) [^\n#]*)");
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) found.push_back((*it)[3]);
  return found;
}

TEST(Documents, CommandsRunAsTheyAreWritten) {
  const TemporaryFolder folder;
  meshbound::write_mesh(folder / "bunny.ply", meshbound::datasets::torus(1, 0.3, 60, 24));
  meshbound::write_mesh(folder / "terrain.ply", meshbound::datasets::torus(1, 0.3, 60, 24));
  const meshbound::TriangleMesh torus = meshbound::datasets::torus(1, 0.3, 60, 24);
  meshbound::MeshAttributes textured;
  textured.texture_coordinates = {torus.vertices, torus.triangles};  // x and y are u and v
  meshbound::write_mesh(folder / "torus.obj", torus, {}, textured);
  fs::create_directory(folder / "models");
  meshbound::write_mesh(folder / "models/cube.off", meshbound::datasets::cube(1, 4));
  std::size_t count = 0;
  const auto run_all = [&](const std::string& source, const std::string& text) {
    const std::vector<std::string> found = commands(text);
    for (const std::string& command : found) {
      const ToolRun run = run_shell("cd '" + folder.path().string() +
                                    "' && PATH='" TOOLS_FOLDER ":" BUILD_FOLDER "/datasets':$PATH && " + command);
      const bool has_no_page = run.err.find("npm") != std::string::npos;  // this build, for --report
      EXPECT_TRUE(run.exit_code == 0 || has_no_page) << source << ": " << command << run.err;
    }
    count += found.size();
    return found.size();
  };
  for (const fs::path& document : documents()) run_all(document.string(), content_of(document));
  for (const char* const tool :
       {"simplify_with_bound", "lod_chain", "hausdorff_distance", "penetration_depth", "verify_certificate"})
    EXPECT_GE(run_all(tool, run_tool(std::string(TOOLS_FOLDER "/") + tool, {"--help"}).out), 1u) << tool;
  EXPECT_GE(count, 20u);
}

/// help2man, which makes the manual pages, runs indented lines into one paragraph.
TEST(ManualPages, BreakLinesAfterEachExampleAndKind) {
  const fs::path folder = fs::path(BUILD_FOLDER) / "shell";
  if (!fs::exists(folder / "lod_chain.1")) GTEST_SKIP() << "the build has no manual pages, since help2man is missing";
  const auto expect_breaks = [&](const std::string& page, const std::vector<std::string>& beginnings) {
    const std::string text = content_of(folder / page);
    for (const std::string& beginning : beginnings) {
      const std::size_t line = text.find("\n" + beginning);
      ASSERT_NE(line, std::string::npos) << page << ": " << beginning << "\n" << text;
      EXPECT_EQ(text.compare(text.find('\n', line + 1), 5, "\n.br\n"), 0) << page << ": " << beginning;
    }
  };
  expect_breaks("simplify_with_bound.1", {"simplify_with_bound bunny.ply small", "simplify_with_bound bunny.ply part"});
  expect_breaks("lod_chain.1", {"lod_chain bunny.ply lods \\-\\-levels", "lod_chain bunny.ply lods \\-\\-pixels"});
  expect_breaks("generate_mesh.1", {"icosphere: ", "torus: ", "terrain: "});
}

/// The commands of the README's first steps in a folder like a checkout that has been built. Programs that show a file,
/// and apt-get, are stand-ins: those look for the file, this one unpacks.
class FirstSteps : public testing::Test {
 protected:
  FirstSteps() {
    for (const char* name : {"bindings", "packaging"}) fs::create_symlink(root / name, folder_ / name);
    fs::create_symlink(BUILD_FOLDER, folder_ / "build");
    fs::copy(root / "examples", folder_ / "examples");
    fs::create_directory(folder_ / "models");
    meshbound::write_mesh(folder_ / "models/cube.off", meshbound::datasets::cube(1, 4));
    fs::create_directory(folder_ / "bin");
    for (const char* viewer : {"xdg-open", "meshlab"}) add_program(viewer, "test -s \"$1\"");
    add_program("apt-get", "shift; for p in \"$@\"; do dpkg-deb -x \"$p\" installed || exit 1; done");
    for (const std::string& block : blocks(content_of(root / "README.md"), "sh"))
      if (block.find("export PATH") != std::string::npos) steps_ = block;
  }
  void add_program(const std::string& name, const std::string& script) const {
    std::ofstream(folder_ / ("bin/" + name)) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(folder_ / ("bin/" + name), fs::perms::owner_all);
  }
  /// Runs the lines from the one that has `first` to the one that has `last`, as they stand.
  [[nodiscard]] ToolRun run(const std::string& first, const std::string& last) const {
    const std::size_t from = steps_.rfind('\n', steps_.find(first)) + 1, to = steps_.find('\n', steps_.find(last));
    EXPECT_NE(steps_.find(last), std::string::npos) << last;
    return run_shell(
        "cd '" + folder_.path().string() +
        "' && export PATH=\"$PWD/bin:$PWD/installed/usr/bin:$PWD/build/tools:$PWD/build/datasets:$PATH\" && "
        "set -e\n" +
        steps_.substr(from, to - from));
  }

  TemporaryFolder folder_;
  std::string steps_;
};

TEST_F(FirstSteps, ShowAReportAndADeviationMap) {
  const ToolRun shown = run("generate_mesh", "meshlab");
  if (shown.err.find("npm") != std::string::npos) GTEST_SKIP() << "the tools were built without the page of reports";
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_TRUE(fs::exists(folder_ / "report.html") && fs::exists(folder_ / "colours.ply"));
}

TEST_F(FirstSteps, SimplifyAFolder) {
  EXPECT_EQ(run("--batch", "--batch").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "small/cube.off"));
}

TEST_F(FirstSteps, CallPython) {
  if (!fs::exists(folder_ / "build/python/meshbound")) GTEST_SKIP() << "the build has no Python package";
  const ToolRun called = run("python3", "python3");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_NE(called.out.find("triangles, H <= "), std::string::npos);
}

TEST_F(FirstSteps, CompileAProgramInC) {
  if (!fs::exists(folder_ / "build/bindings/c")) GTEST_SKIP() << "the build has no C library";
  const ToolRun compiled = run("cc -I", "LD_LIBRARY_PATH");
  EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
  EXPECT_NE(compiled.out.find("triangles, H <= "), std::string::npos);
}

TEST_F(FirstSteps, CallNode) {
  if (std::string(NPM_PACKAGE).empty()) GTEST_SKIP() << "the build has no npm package, since Emscripten is missing";
  fs::create_directory_symlink(root / "build-wasm", folder_ / "build-wasm");
  ASSERT_EQ(run("generate_mesh", "generate_mesh").exit_code, 0);
  const ToolRun called = run("npm install", "node examples");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_NE(called.out.find("triangles, H <= "), std::string::npos);
  EXPECT_GT(fs::file_size(folder_ / "small.ply"), 1000U);
}

TEST_F(FirstSteps, InstallPackages) {
  if (run_shell("command -v dpkg-deb").exit_code != 0) GTEST_SKIP() << "this is no Debian machine";
  const ToolRun installed = run("cpack", "apt-get");
  EXPECT_EQ(installed.exit_code, 0) << installed.err << installed.out;
  EXPECT_TRUE(fs::exists(folder_ / "installed/usr/bin/simplify_with_bound"));
}

/// The steps of a container file's first RUN.
std::vector<std::string> container_steps() {
  const std::string file = content_of(root / "packaging/Containerfile");
  const std::size_t from = file.find("RUN ") + 4, to = file.find("\n\n", from);
  const std::string run = std::regex_replace(file.substr(from, to - from), std::regex("\\s*\\\\\n\\s*"), " ");
  const std::regex between(" && ");
  return {std::sregex_token_iterator(run.begin(), run.end(), between, -1), {}};
}

TEST(Container, IsBuiltByTheStepsOfTheDocuments) {
  const std::vector<std::string> known = {"tools/install_dependencies", "cmake --preset release",
                                          "cmake --build --preset release",
                                          "cpack -G DEB --config build/CPackConfig.cmake -B "};
  const std::vector<std::string> steps = container_steps();
  const std::string building = content_of(root / "docs/building.md") + content_of(root / "docs/packages.md");
  ASSERT_EQ(steps.size(), known.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_TRUE(steps[i].starts_with(known[i])) << steps[i];
    EXPECT_NE(building.find(known[i]), std::string::npos) << known[i];
  }
}

/// The packages that the image installs are some that the build makes.
TEST(Container, InstallsPackagesOfThisBuild) {
  const std::string file = content_of(root / "packaging/Containerfile");
  const std::string made = content_of(root / "cmake/Packages.cmake");
  const std::regex package("/packages/([a-z0-9-]+)[_*]");
  std::size_t found = 0;
  for (std::sregex_iterator it(file.begin(), file.end(), package), end; it != end; ++it, ++found)
    EXPECT_NE(made.find((*it)[1].str()), std::string::npos) << (*it)[1];
  EXPECT_EQ(found, 3U);
}

TEST(Documents, NameOnlyFilesThatExist) {
  const std::regex in_ticks(
      R"(`((?:tools|tests|datasets|src|include|examples|bindings|cmake|docs|LICENSES)/[\w./-]*[\w/])[^`]*`)");
  const std::regex linked(R"(\]\(([^)#:]+)\))");
  std::size_t found = 0;
  for (const fs::path& document : documents()) {
    const std::string text = content_of(document);
    for (std::sregex_iterator it(text.begin(), text.end(), in_ticks), end; it != end; ++it, ++found)
      EXPECT_TRUE(fs::exists(root / (*it)[1].str())) << document << ": " << (*it)[1];
    for (std::sregex_iterator it(text.begin(), text.end(), linked), end; it != end; ++it, ++found)
      EXPECT_TRUE(fs::exists(document.parent_path() / (*it)[1].str())) << document << ": " << (*it)[1];
  }
  EXPECT_GT(found, 40U);
}

/// Each field of a schema, at any depth, says what it holds or refers to a part that does.
void expect_descriptions(const nlohmann::json& part, const std::string& where) {
  if (!part.is_structured()) return;
  if (part.is_object() && part.contains("properties")) {
    for (const auto& [name, field] : part["properties"].items())
      EXPECT_TRUE(field.contains("description") || field.contains("$ref")) << where << "/" << name;
  }
  for (const auto& [name, inner] : part.items()) expect_descriptions(inner, where + "/" + name);
}

TEST(Schemas, DescribeEachField) {
  std::size_t schemas = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(root / "tools/schema")) {
    if (entry.path().extension() != ".json") continue;
    ++schemas;
    expect_descriptions(nlohmann::json::parse(content_of(entry.path())), entry.path().filename().string());
  }
  EXPECT_GE(schemas, 11U);
}

/// "`Lemma3_...`" stands for every test whose name begins so.
TEST(PageOfThePaper, NamesOnlyTestsThatExist) {
  const std::string page = content_of(root / "docs/paper.md"), tests = content_of(root / "tests/paper_test.cpp");
  const std::regex name("`((?:Lemma|Theorem|Eq|Section|Table)\\d\\w*?)(?:\\.\\.\\.)?`");
  std::size_t found = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), name), end; it != end; ++it, ++found)
    EXPECT_NE(tests.find("TEST(Paper, " + (*it)[1].str()), std::string::npos) << (*it)[1];
  EXPECT_GE(found, 10u);
}

class Programs : public testing::Test {
 protected:
  Programs() {
    meshbound::write_mesh(in("cube.off"), meshbound::datasets::cube(1, 4));
    meshbound::write_mesh(in("fine.off"), meshbound::datasets::cube(1, 8));
    meshbound::write_mesh(in("large.off"), meshbound::datasets::cube(1.5, 1));
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }

  TemporaryFolder folder_;
};

TEST_F(Programs, TellACubeFromALargerOne) {
  EXPECT_EQ(run_tool(MEASURE_TWO_MESHES, {in("cube.off"), in("fine.off")}).exit_code, 0);
  EXPECT_EQ(run_tool(MEASURE_TWO_MESHES, {in("cube.off"), in("large.off")}).exit_code, 1);
  EXPECT_EQ(run_tool(CHECK_LEVELS, {in("cube.off"), in("fine.off"), in("cube.off")}).exit_code, 0);
  const ToolRun levels = run_tool(CHECK_LEVELS, {in("cube.off"), in("fine.off"), in("large.off")});
  EXPECT_EQ(levels.exit_code, 1);
  EXPECT_NE(levels.out.find("fine.off: at most "), std::string::npos) << levels.out;
  EXPECT_NE(levels.out.find("large.off: at least 0."), std::string::npos) << levels.out;
  EXPECT_EQ(levels.out.find("inf"), std::string::npos) << levels.out;
  EXPECT_EQ(run_tool(DEFORM, {in("cube.off")}).exit_code, 0);
}

TEST_F(Programs, SimplifyACube) {
  EXPECT_EQ(run_tool(SIMPLIFY_IN_MEMORY, {in("fine.off"), in("small.off")}).exit_code, 0);
  EXPECT_EQ(meshbound::read_mesh(in("small.off")).mesh.triangles.size(), 12u);
}

/// None ends in an exception that nobody catches.
TEST_F(Programs, SayInOneLineWhatTheyCannotRead) {
  for (const auto& [program, more] :
       {std::pair<std::string, std::vector<std::string>>{MEASURE_TWO_MESHES, {"absent.off"}},
        {SIMPLIFY_IN_MEMORY, {"absent.off"}},
        {CHECK_LEVELS, {"absent.off"}},
        {DEFORM, {}}}) {
    std::vector<std::string> arguments{in("absent.off")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ToolRun run = run_tool(program, arguments);
    EXPECT_EQ(run.exit_code, 2) << program;
    EXPECT_NE(run.err.find("absent.off"), std::string::npos) << run.err;
    EXPECT_EQ(meshbound::testing_tools::line_count(run.err), 1) << run.err;
  }
}

/// Before minutes of compiling.
TEST(Benchmarks, RefuseWrongUsageAtOnce) {
  const auto refused = [](const std::string& arguments, const std::string& reason) {
    const ToolRun run = run_shell("'" MESHBOUND_SOURCE_DIR "/tools/bench/run' " + arguments, 20);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
    EXPECT_EQ(meshbound::testing_tools::line_count(run.err), 1) << run.err;
  };
  refused("nosuch", "usage: ");
  refused("--pair only_one", "usage: ");
  refused("--pair absent_a.ply absent_b.ply", "absent_a.ply is not there");
  const std::string file = "'" MESHBOUND_SOURCE_DIR "/README.md'";
  refused("--pair " + file + " " + file + " scaling", "not with scaling");
}

TEST(Fetch, RefusesNamesThatTheManifestDoesNotHave) {
  for (const char* const name : {"nosuch", "--unknown", "cgal"}) {
    const ToolRun run = run_shell(std::string("'" MESHBOUND_SOURCE_DIR "/datasets/fetch' ") + name, 20);
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_NE(run.err.find("'" + std::string(name) + "' is not in manifest.tsv"), std::string::npos) << run.err;
    EXPECT_EQ(meshbound::testing_tools::line_count(run.err), 1) << run.err;
  }
}

/// The steps of packaging/ci/github-actions.yml that check levels, as they stand there.
std::string gate_steps() {
  const std::string file = content_of(root / "packaging/ci/github-actions.yml"), indent(10, ' ');
  std::size_t at = file.find("run: |\n", file.find("- name: Check every level"));
  std::string steps;
  for (at = file.find('\n', at) + 1; file.compare(at, indent.size(), indent) == 0; at = file.find('\n', at) + 1)
    steps += file.substr(at, file.find('\n', at) + 1 - at);
  return steps;
}

class PullRequestGate : public testing::Test {
 protected:
  PullRequestGate() {
    fs::create_directory(folder_ / "models");
    meshbound::write_mesh(folder_ / "models/wheel.obj", wheel(1));
  }
  static meshbound::TriangleMesh wheel(double radius) { return meshbound::datasets::torus(radius, 0.3, 40, 16); }
  [[nodiscard]] ToolRun run() const {
    return run_shell("cd '" + folder_.path().string() + "' && PATH='" TOOLS_FOLDER "':$PATH && set -e\n" +
                     gate_steps());
  }
  [[nodiscard]] bool has_report(const std::string& name) const { return fs::exists(folder_ / ("report/" + name)); }

  TemporaryFolder folder_;
};

TEST_F(PullRequestGate, FailsWhereALevelIsTooFarAndAttachesReports) {
  meshbound::write_mesh(folder_ / "models/wheel.lod1.obj", wheel(1.001));
  const ToolRun passed = run();
  if (passed.err.find("npm") != std::string::npos) GTEST_SKIP() << "the tools were built without the page of reports";
  EXPECT_EQ(passed.exit_code, 0) << passed.err;
  EXPECT_TRUE(has_report("wheel.lod1.obj.json") && has_report("wheel.lod1.obj.html"));
  meshbound::write_mesh(folder_ / "models/wheel.lod2.obj", wheel(1.1));
  EXPECT_EQ(run().exit_code, 1);
  EXPECT_NE(content_of(folder_ / "report/wheel.lod2.obj.json").find("\"exceeds\""), std::string::npos);
  EXPECT_TRUE(has_report("wheel.lod2.obj.html"));
}

}  // namespace
