// SPDX-License-Identifier: MIT
#include "simplify/mesh/array_mesh.h"

#include <utility>

#include "numeric/no_index.h"

namespace meshbound {

ArrayMesh::ArrayMesh(std::vector<Vec3> positions, std::vector<Triangle> faces,
                     std::vector<std::array<std::uint32_t, 3>> twins)
    : positions_(std::move(positions)),
      corner_of_(positions_.size(), no_index),
      removed_(faces.size(), 0),
      vertices_(std::move(faces)),
      twins_(std::move(twins)) {
  for (Corner c = 0; c < 3 * face_count(); ++c) corner_of_[vertices_[c]] = c;
}

bool ArrayMesh::is_border(std::uint32_t v) const {
  const Corner first = corner_of_[v];
  Corner c = first;
  do {
    c = twins_[previous_corner(c)];
    if (c == no_index) return true;
  } while (c != first);
  return false;
}

void ArrayMesh::glue(Corner c, Corner d) {
  if (c != no_index) twins_[c] = d;
  if (d != no_index) twins_[d] = c;
}

/// The face at the edge goes, and the faces across its two other edges become neighbours. `edge` starts at `kept` or
/// ends there.
///
///            apex                     apex
///           /  |  \                  /    \                     ///
///          / t | t' \      ---->    /  ..  \                    ///
///       kept -edge- gone          kept = gone
void ArrayMesh::remove_face(Corner edge, std::uint32_t kept) {
  const Corner c = twins_[next_corner(edge)], d = twins_[previous_corner(edge)];
  const std::uint32_t apex = vertices_[previous_corner(edge)];
  removed_[edge / 3] = 1;
  glue(c, d);
  const auto take = [&](Corner across) {  // a face that stays has a corner at both
    if (across == no_index) return;
    const Corner following = next_corner(across);
    if (vertices_[across] == apex) {
      corner_of_[apex] = across, corner_of_[kept] = following;
    } else {
      corner_of_[apex] = following, corner_of_[kept] = across;
    }
  };
  take(c);
  take(d);
}

void ArrayMesh::collapse(Corner edge) {
  const std::uint32_t kept = start(edge), gone = end(edge);
  const Corner other = twins_[edge];
  for_each_corner(gone, [&](Corner c) {
    vertices_[c] = kept;
    return true;
  });
  // The faces that go keep their corners for `undo_collapse`.
  vertices_[next_corner(edge)] = gone;
  if (other != no_index) vertices_[other] = gone;
  remove_face(edge, kept);
  if (other != no_index) remove_face(other, kept);
  corner_of_[gone] = no_index;
}

void ArrayMesh::restore_face(Corner edge) {
  const Corner c = next_corner(edge), d = previous_corner(edge);
  removed_[edge / 3] = 0;
  if (twins_[c] != no_index) twins_[twins_[c]] = c;
  if (twins_[d] != no_index) twins_[twins_[d]] = d;
  corner_of_[vertices_[d]] = d;
}

void ArrayMesh::undo_collapse(Corner edge) {
  const std::uint32_t kept = start(edge), gone = end(edge);
  const Corner other = twins_[edge];
  restore_face(edge);
  if (other != no_index) restore_face(other);
  corner_of_[kept] = edge;
  corner_of_[gone] = next_corner(edge);
  for_each_corner(gone, [&](Corner c) {
    vertices_[c] = gone;
    return true;
  });
}

/// The faces (a, b, c) and (b, a, d) become (c, d, b) and (d, c, a); forth and back keep their numbers:
///
///          c                    c
///        /   \                / | \                             ///
///       a --- b    ---->     a  |  b
///        \   /                \ | /                             ///
///          d                    d
void ArrayMesh::turn(Corner edge, bool back) {
  const Corner e = edge, f = twins_[edge];
  const Corner e1 = next_corner(e), e2 = previous_corner(e), f1 = next_corner(f), f2 = previous_corner(f);
  const std::uint32_t a = vertices_[e], b = vertices_[e1], c = vertices_[e2], d = vertices_[f2];
  const Corner bc = twins_[e1], ca = twins_[e2], ad = twins_[f1], db = twins_[f2];
  if (!back) {
    vertices_[e] = c, vertices_[e1] = d, vertices_[e2] = b;
    vertices_[f] = d, vertices_[f1] = c, vertices_[f2] = a;
    glue(e1, db), glue(e2, bc), glue(f1, ca), glue(f2, ad);
  } else {
    vertices_[e] = d, vertices_[e1] = c, vertices_[e2] = a;
    vertices_[f] = c, vertices_[f1] = d, vertices_[f2] = b;
    glue(e1, ca), glue(e2, ad), glue(f1, db), glue(f2, bc);
  }
  for (const Corner corner : {e, e1, e2, f, f1, f2}) corner_of_[vertices_[corner]] = corner;
}

void ArrayMesh::flip(Corner edge) { turn(edge, false); }
void ArrayMesh::undo_flip(Corner edge) { turn(edge, true); }

void ArrayMesh::remove_component(std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) {
    removed_[f] = 1;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) corner_of_[vertices_[c]] = no_index;
  }
}

void ArrayMesh::restore_component(std::span<const std::uint32_t> faces) {
  for (const std::uint32_t f : faces) {
    removed_[f] = 0;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) corner_of_[vertices_[c]] = c;
  }
}

}  // namespace meshbound
