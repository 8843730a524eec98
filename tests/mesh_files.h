// SPDX-License-Identifier: MIT
// Small mesh files typed inline, written to a folder that goes away with the test.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "meshbound/error.h"
#include "meshbound/io.h"
#include "temporary_folder.h"

namespace meshbound::test {

inline void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

inline std::string content_of(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

/// What the reader makes of a file `name` with this content.
inline MeshFile read_content(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  write_file(folder / name, content);
  return read_mesh(folder / name);
}

/// The one line with which the reader refuses the content; it must name the file. Empty, and a failure, when it is
/// read.
inline std::string refusal(const std::string& name, const std::string& content) {
  try {
    const MeshFile file = read_content(name, content);
    ADD_FAILURE() << "read " << file.mesh.triangles.size() << " triangles from " << content.substr(0, 200);
  } catch (const InvalidInput& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find(name + ": "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return {};
}

/// The file holds the unit right triangle, however it was written down.
inline void expect_triangle(const MeshFile& file) {
  ASSERT_EQ(file.mesh.vertices.size(), 3u);
  EXPECT_EQ(file.mesh.vertices[0], Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(file.mesh.vertices[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(file.mesh.vertices[2], Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Shows the text when it does not contain the part.
#define EXPECT_CONTAINS(text, part) EXPECT_TRUE(::meshbound::test::contains((text), (part))) << (text)

}  // namespace meshbound::test
