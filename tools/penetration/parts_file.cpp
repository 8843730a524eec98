// SPDX-License-Identifier: MIT
#include "penetration/parts_file.h"

#include <array>
#include <cctype>
#include <filesystem>

#include "common/length.h"
#include "common/output.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string coordinates(const Eigen::Vector3d& p) {
  return exact_number(p.x()) + " " + exact_number(p.y()) + " " + exact_number(p.z());
}

/// One part of a volume, or its witness line, whose vertices are the two points.
struct Section {
  std::string name;
  const TriangleMesh* mesh;  ///< null: the line
  std::array<Eigen::Vector3d, 2> line;
  const char* colour;
};

/// All sections, in the order they are written in.
std::vector<Section> sections(const PenetrationDepth& depth) {
  std::vector<Section> all;
  for (std::size_t i = 0; i < depth.volumes.size(); ++i) {
    const PenetrationVolume& volume = depth.volumes[i];
    const std::string name = "volume_" + std::to_string(i);
    all.push_back({name + "_on_a", &volume.parts->on_a, {}, "40 80 220"});
    all.push_back({name + "_on_b", &volume.parts->on_b, {}, "220 50 40"});
    all.push_back({name + "_witness", nullptr, {volume.on_a.position, volume.on_b.position}, "30 180 60"});
  }
  return all;
}

void append_vertices(std::string& text, const std::string& prefix, const Section& section, const std::string& suffix) {
  if (section.mesh == nullptr) {
    for (const Eigen::Vector3d& p : section.line) text += prefix + coordinates(p) + suffix + "\n";
  } else {
    for (const Eigen::Vector3d& p : section.mesh->vertices) text += prefix + coordinates(p) + suffix + "\n";
  }
}

std::size_t vertex_count(const Section& section) { return section.mesh == nullptr ? 2 : section.mesh->vertices.size(); }

}  // namespace

void require_parts_format(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".obj" && extension != ".ply")
    throw InvalidInput("--output: " + path + " is neither .obj nor .ply; other formats hold no lines");
}

std::string parts_as_obj(const PenetrationDepth& depth) {
  std::string text = "# parts of two surfaces inside each other, and the lines between their deepest points\n";
  std::size_t first = 1;
  for (const Section& section : sections(depth)) {
    text += "g " + section.name + "\n";
    append_vertices(text, "v ", section, "");
    if (section.mesh == nullptr) {
      text += "l " + std::to_string(first) + " " + std::to_string(first + 1) + "\n";
    } else {
      for (const auto& [a, b, c] : section.mesh->triangles)
        text +=
            "f " + std::to_string(first + a) + " " + std::to_string(first + b) + " " + std::to_string(first + c) + "\n";
    }
    first += vertex_count(section);
  }
  return text;
}

std::string parts_as_ply(const PenetrationDepth& depth) {
  const std::vector<Section> all = sections(depth);
  std::size_t vertices = 0, faces = 0, edges = 0;
  for (const Section& section : all) {
    vertices += vertex_count(section);
    faces += section.mesh == nullptr ? 0 : section.mesh->triangles.size();
    edges += section.mesh == nullptr ? 1 : 0;
  }
  const std::string colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  std::string text =
      "ply\nformat ascii 1.0\ncomment blue: on A, red: on B, green: from the deepest point to the other\n";
  text += "element vertex " + std::to_string(vertices) + "\nproperty double x\nproperty double y\nproperty double z\n" +
          colour + "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" +
          "element edge " + std::to_string(edges) + "\nproperty int vertex1\nproperty int vertex2\n" + colour +
          "end_header\n";
  std::string face_lines, edge_lines;
  std::size_t first = 0;
  for (const Section& section : all) {
    append_vertices(text, "", section, " " + std::string(section.colour));
    if (section.mesh == nullptr) {
      edge_lines += std::to_string(first) + " " + std::to_string(first + 1) + " " + section.colour + "\n";
    } else {
      for (const auto& [a, b, c] : section.mesh->triangles)
        face_lines +=
            "3 " + std::to_string(first + a) + " " + std::to_string(first + b) + " " + std::to_string(first + c) + "\n";
    }
    first += vertex_count(section);
  }
  return text + face_lines + edge_lines;
}

void write_parts(const std::string& path, const PenetrationDepth& depth) {
  write_text(path, extension_of(path) == ".obj" ? parts_as_obj(depth) : parts_as_ply(depth));
}

}  // namespace meshbound::tools
