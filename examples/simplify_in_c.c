/* SPDX-License-Identifier: MIT */
/* Simplifies float positions inside larger vertices, with 16-bit indices, and checks the result against the original.
 */
#include <math.h>
#include <meshbound.h>
#include <stdio.h>

#define SIDE 60 /* vertices along each side of a wavy sheet */

struct vertex {
  float normal[3];
  float position[3];
};

static struct vertex vertices[SIDE * SIDE];
static uint16_t indices[(SIDE - 1) * (SIDE - 1) * 6];

static void make_sheet(void) {
  uint16_t* next = indices;
  for (int i = 0; i < SIDE * SIDE; ++i) {
    float* p = vertices[i].position;
    p[0] = (float)(i % SIDE);
    p[1] = (float)(i / SIDE);
    p[2] = 4 * sinf(p[0] / 10) * cosf(p[1] / 10);
    if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1) continue;
    const uint16_t a = (uint16_t)i, b = (uint16_t)(i + 1), c = (uint16_t)(i + SIDE), d = (uint16_t)(i + SIDE + 1);
    *next++ = a, *next++ = b, *next++ = d, *next++ = a, *next++ = d, *next++ = c;
  }
}

static int failed(void) {
  fprintf(stderr, "%s\n", mb_error_message());
  return 2;
}

int main(void) {
  make_sheet();
  mb_mesh original = {0};
  original.positions = vertices[0].position;
  original.coordinate_type = MB_FLOAT32;
  original.position_stride = sizeof(struct vertex);
  original.vertex_count = SIDE * SIDE;
  original.indices = indices;
  original.index_type = MB_UINT16;
  original.triangle_count = sizeof indices / sizeof indices[0] / 3;

  mb_mesh_facts facts;
  if (mb_describe(&original, &facts) != MB_OK) return failed();

  mb_simplify_options options;
  mb_simplify_options_init(&options, sizeof options);
  options.tolerance = 0.001 * facts.bbox_diagonal;
  mb_simplification* simplification;
  if (mb_simplify(&original, &options, &simplification) != MB_OK) return failed();

  mb_level level;
  if (mb_simplification_level(simplification, 0, &level) != MB_OK) return failed();
  printf("%zu -> %zu triangles, H <= %.17g\n", facts.triangles, level.triangle_count, level.distance.bounds.upper);

  mb_mesh simplified = {0};
  simplified.positions = level.positions;
  simplified.coordinate_type = MB_FLOAT64;
  simplified.vertex_count = level.vertex_count;
  simplified.indices = level.indices;
  simplified.index_type = MB_UINT32;
  simplified.triangle_count = level.triangle_count;
  mb_verdict verdict;
  if (mb_check(&original, &simplified, options.tolerance, NULL, &verdict, NULL) != MB_OK) return failed();
  mb_simplification_free(simplification);
  return verdict == MB_WITHIN ? 0 : 1;
}
