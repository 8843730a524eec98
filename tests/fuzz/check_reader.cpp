// SPDX-License-Identifier: MIT
#include <stdexcept>
#include <utility>

#include "fuzz/claims.h"
#include "mesh/gltf_content.h"
#include "mesh/readers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_view.h"

namespace meshbound::fuzz {

namespace {

/// The content of a glTF file, or one exception that says why there is none.
void check_gltf_content(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  try {
    (void)gltf_content(mesh, attributes);
  } catch (const InvalidInput&) {
    return;
  }
}

/// Attributes fit the triangles, and can be written as glTF: into the document that they come from, and into a new one.
void check_attributes(const MeshFile& file) {
  (void)seams(file.mesh, file.attributes);
  DroppedAttributes lost;
  (void)carried_by(FileFormat::Stl, file.attributes, lost);
  check_gltf_content(file.mesh, file.attributes);
  MeshAttributes without_document = file.attributes;
  without_document.document.reset();
  without_document.part.clear();
  check_gltf_content(file.mesh, carried_by(FileFormat::Glb, std::move(without_document), lost));
}

}  // namespace

void check_reader(const std::string& extension, Bytes content) {
  const std::string name = "fuzz" + extension;
  const std::string_view bytes(reinterpret_cast<const char*>(content.data()), content.size());
  try {
    const TriangleMesh mesh = parse_mesh(name, bytes).mesh;
    validate(mesh);
    ReadOptions options;
    options.attributes = true;
    const MeshFile file = parse_mesh(name, bytes, options);
    if (file.mesh.triangles != mesh.triangles) throw std::logic_error("the triangles depend on the attributes");
    check_attributes(file);
  } catch (const IoError&) {
    return;  // a file that a glTF names and that is not there
  } catch (const InvalidInput& refusal) {
    const std::string line = refusal.what();
    if (line.find(name) == std::string::npos) throw std::logic_error("the refusal does not name the file: " + line);
    if (line.find('\n') != std::string::npos) throw std::logic_error("the refusal is not one line: " + line);
  }
}

}  // namespace meshbound::fuzz
