// SPDX-License-Identifier: MIT
// The README says what is there: its program is the one the tests compile, its commands and files exist.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"

namespace {

namespace fs = std::filesystem;
const fs::path root = MESHBOUND_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Readme, ShowsTheProgramsThatTheTestsCompile) {
  for (const char* name : {"measure_two_meshes.cpp", "simplify_in_memory.cpp", "check_levels.cpp", "deform.cpp"}) {
    std::string program = text_of(root / "examples" / name);
    ASSERT_EQ(program.rfind("// SPDX", 0), 0U);
    program.erase(0, program.find('\n') + 1);
    EXPECT_NE(text_of(root / "README.md").find("```cpp\n" + program + "```"), std::string::npos) << name;
  }
}

TEST(Readme, ProgramTellsACubeFromALargerOne) {
  const fs::path folder = fs::temp_directory_path() / ("meshbound_readme_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  meshbound::write_mesh(folder / "cube.off", meshbound::datasets::cube(1, 1));
  meshbound::write_mesh(folder / "fine.off", meshbound::datasets::cube(1, 8));
  meshbound::write_mesh(folder / "large.off", meshbound::datasets::cube(1.5, 1));
  const auto run = [&](const char* other) {
    const std::string files = " " + (folder / "cube.off").string() + " " + (folder / other).string();
    const int status = std::system((MEASURE_TWO_MESHES + files + " >/dev/null").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(run("fine.off"), 0);
  EXPECT_EQ(run("large.off"), 1);
  fs::remove_all(folder);
}

TEST(Readme, ProgramsForLevelsAndMovingMeshesRun) {
  const fs::path folder = fs::temp_directory_path() / ("meshbound_levels_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  meshbound::write_mesh(folder / "cube.off", meshbound::datasets::cube(1, 4));
  meshbound::write_mesh(folder / "fine.off", meshbound::datasets::cube(1, 8));
  meshbound::write_mesh(folder / "large.off", meshbound::datasets::cube(1.5, 1));
  const auto run = [&](const std::string& program, const std::vector<const char*>& files) {
    std::string command = program;
    for (const char* file : files) command += " " + (folder / file).string();
    const int status = std::system((command + " >/dev/null").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(run(CHECK_LEVELS, {"cube.off", "fine.off", "cube.off"}), 0);
  EXPECT_EQ(run(CHECK_LEVELS, {"cube.off", "fine.off", "large.off"}), 1);
  EXPECT_EQ(run(DEFORM, {"cube.off"}), 0);
  fs::remove_all(folder);
}

TEST(Readme, ProgramSimplifiesACube) {
  const fs::path folder = fs::temp_directory_path() / ("meshbound_simplify_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  meshbound::write_mesh(folder / "cube.off", meshbound::datasets::cube(1, 8));
  const std::string files = " " + (folder / "cube.off").string() + " " + (folder / "small.off").string();
  EXPECT_EQ(std::system((SIMPLIFY_IN_MEMORY + files + " >/dev/null").c_str()), 0);
  EXPECT_EQ(meshbound::read_mesh(folder / "small.off").mesh.triangles.size(), 12u);
  fs::remove_all(folder);
}

TEST(Readme, NamesOnlyFilesThatExist) {
  const std::string readme = text_of(root / "README.md");
  const std::regex path(R"(`((?:tools|tests|datasets|src|include|examples|cmake|docs|LICENSES)/[\w./-]*)[^`]*`)");
  std::size_t found = 0;
  for (std::sregex_iterator it(readme.begin(), readme.end(), path), end; it != end; ++it) {
    EXPECT_TRUE(fs::exists(root / (*it)[1].str())) << (*it)[1];
    ++found;
  }
  EXPECT_GT(found, 8U);
}

}  // namespace
