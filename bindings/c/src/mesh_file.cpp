// SPDX-License-Identifier: MIT
#include <memory>

#include "arguments.h"
#include "cancel.h"
#include "guard.h"
#include "meshbound/io.h"

using namespace meshbound;
using namespace meshbound::c_interface;

struct mb_mesh_file {
  TriangleMesh mesh;
};

namespace {

const std::atomic<bool>* flag_of(const mb_cancel* cancel) { return cancel == nullptr ? nullptr : &cancel->requested; }

}  // namespace

mb_status mb_mesh_file_read(const char* path, const mb_cancel* cancel, mb_mesh_file** file) {
  return guarded([&] {
    require(path, "path");
    require(file, "file");
    ReadOptions options;
    options.cancel = flag_of(cancel);
    *file = new mb_mesh_file{read_mesh(path, options).mesh};
  });
}

mb_status mb_mesh_file_mesh(const mb_mesh_file* file, mb_mesh* mesh) {
  return guarded([&] {
    require(file, "file");
    require(mesh, "mesh");
    const TriangleMesh& content = file->mesh;
    *mesh = {content.vertices.data(),
             0,
             content.vertices.size(),
             content.triangles.data(),
             content.triangles.size(),
             MB_FLOAT64,
             MB_UINT32};
  });
}

mb_status mb_mesh_file_write(const char* path, const mb_mesh* mesh, int single_precision, const mb_cancel* cancel) {
  return guarded([&] {
    require(path, "path");
    WriteOptions options;
    options.single_precision = single_precision != 0;
    options.cancel = flag_of(cancel);
    write_mesh(path, to_triangle_mesh(valid_view_of(mesh, "mesh")), options);
  });
}

void mb_mesh_file_free(mb_mesh_file* file) { delete file; }
