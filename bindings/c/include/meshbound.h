/* SPDX-License-Identifier: MIT */
/*
 * meshbound for C and for every language that calls C: certified Hausdorff distances between triangle meshes, and
 * simplification with a proven bound. The C++ interface is <meshbound/meshbound.h>; this header is <meshbound.h>.
 *
 * Promise. For the original A, a simplified mesh M, and their symmetric Hausdorff distance H,
 *
 *     lower <= H(A, M) <= upper
 *
 * holds in real arithmetic for the coordinates in the buffers, rounding errors of the library included. A verdict is
 * MB_WITHIN only where upper <= tolerance.
 *
 * Units. Lengths are in the unit of the coordinates, angles in radians, times in seconds, strides and sizes in bytes.
 *
 * Ownership. Meshes and arrays that are passed in are only read, and only during the call. What a function named
 * ..._new or mb_simplify hands out is freed by the function named ..._free, which takes NULL too.
 *
 * Errors. No exception leaves a function. Whatever is not MB_OK leaves all outputs as they were, and mb_error_message
 * says in one line what is wrong, where, and what to do.
 *
 * Threads. Functions may be called from any number of threads at once; an object with a name of its own (a checker, a
 * simplification) is used by one thread at a time, except mb_cancel. Results are the same for every number of threads,
 * but for time limits and cancelling.
 *
 * Versions. Functions and structures of one MB_ABI_VERSION, which is the number in the name of the shared library, are
 * never changed. Structures of options may grow at their end: mb_..._options_init notes the size that the caller knows.
 */
#ifndef MESHBOUND_H
#define MESHBOUND_H

#include <stddef.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

/* Number of this interface; that of the library is mb_abi_version(). */
#define MB_ABI_VERSION 1

/* MB_ABI_VERSION of the library that the program runs with. */
int mb_abi_version(void);

/* Version of the library, such as "0.1.0". A constant. */
const char* mb_version(void);

/* How a call ended. */
typedef enum mb_status {
  MB_OK = 0,
  MB_INVALID_INPUT = 1, /* a mesh or an option that no bound can be given for */
  MB_CANCELLED = 2,     /* by mb_cancel_request, or by the progress function */
  MB_OUT_OF_MEMORY = 3,
  MB_FAILED = 4 /* everything else, such as a certificate for meshes that are too far apart */
} mb_status;

/* What is wrong with the last call of this thread that failed: one line, "" where none has. Valid until the next call
 * of this thread. */
const char* mb_error_message(void);

/* ---- meshes ---- */

typedef enum mb_coordinate_type { MB_FLOAT32 = 0, MB_FLOAT64 = 1 } mb_coordinate_type;
typedef enum mb_index_type { MB_UINT16 = 0, MB_UINT32 = 1 } mb_index_type;

/* A triangle mesh in the caller's memory, any soup: open, non-manifold, with degenerate triangles. Coordinates must be
 * finite and at most 2^1000 in magnitude where a triangle uses them. */
typedef struct mb_mesh {
  const void* positions;  /* x, y, z of the first vertex, of `coordinate_type`; need not be aligned */
  size_t position_stride; /* from one vertex to the next; 0: packed */
  size_t vertex_count;
  const void* indices; /* 3 * triangle_count indices of `index_type`, packed */
  size_t triangle_count;
  int coordinate_type; /* an mb_coordinate_type */
  int index_type;      /* an mb_index_type */
} mb_mesh;

typedef struct mb_mesh_facts {
  size_t vertices;      /* unused ones included */
  size_t triangles;     /* degenerate ones included */
  size_t components;    /* sets of triangles connected through shared vertices */
  double bbox_diagonal; /* of the bounding box of the vertices that triangles use */
  int closed;           /* 1: every edge has exactly two triangles, and no triangle repeats a vertex; else 0 */
} mb_mesh_facts;

/* Facts about a mesh, for instance to ask for a tolerance as a share of its diagonal. O(n). */
mb_status mb_describe(const mb_mesh* mesh, mb_mesh_facts* facts);

/* ---- ending a call early ---- */

/* A flag that ends the calls it is passed to. All its functions may be called from any thread; mb_cancel_request also
 * from a signal handler. */
typedef struct mb_cancel mb_cancel;
mb_cancel* mb_cancel_new(void); /* NULL when memory has run out */
void mb_cancel_request(mb_cancel* cancel);
void mb_cancel_reset(mb_cancel* cancel);
void mb_cancel_free(mb_cancel* cancel); /* after the calls that it was passed to have returned */

/* Called from the thread of the call with a guess between 0 and 1: at most ten times a second, and at last with 1
 * before a call returns MB_OK, however short it was. What it returns other than 0 ends the call with MB_CANCELLED, and
 * no other call that has the same mb_cancel. Must not throw or jump out of the call. */
typedef int (*mb_progress)(double fraction, void* user);

/* ---- files ---- */

/* The mesh of a file. */
typedef struct mb_mesh_file mb_mesh_file;

/* Reads OFF, OBJ, PLY, STL or glTF 2, as the end of `path` says: .off, .obj, .ply, .stl, .glb, .gltf. Polygons are
 * split into triangles; of glTF all triangles of the default scene are read, placed by their nodes. What a file holds
 * beyond geometry is left out. MB_INVALID_INPUT for a malformed file or another name, with the line or byte in the
 * message; MB_FAILED for a file that cannot be read. `cancel` may be NULL. O(size of the file). */
mb_status mb_mesh_file_read(const char* path, const mb_cancel* cancel, mb_mesh_file** file);
/* The mesh: doubles and 32-bit indices, packed. Its pointers hold until the file is freed. */
mb_status mb_mesh_file_mesh(const mb_mesh_file* file, mb_mesh* mesh);
void mb_mesh_file_free(mb_mesh_file* file);

/* Writes a mesh in the format that the end of `path` says; the file appears whole or not at all. Text has the digits
 * that read back as the same doubles. STL and glTF hold floats, as PLY, OFF and OBJ do where `single_precision` is 1:
 * coordinates are rounded, and a bound that is to hold for the file must be one of the mesh as it reads (see
 * mb_simplify_options.single_precision, or measure again). `cancel` may be NULL. O(n). */
mb_status mb_mesh_file_write(const char* path, const mb_mesh* mesh, int single_precision, const mb_cancel* cancel);

/* ---- distances ---- */

typedef enum mb_verdict { MB_WITHIN = 0, MB_EXCEEDS = 1, MB_UNDECIDED = 2 } mb_verdict;

typedef enum mb_outcome {
  MB_CONVERGED = 0,         /* upper - lower <= error bound */
  MB_EXCEEDS_TOLERANCE = 1, /* a point further than the tolerance was found, and the search ended there */
  MB_TIME_LIMIT = 2,        /* the bounds hold, but are wider than wanted */
  MB_PRECISION = 3,         /* doubles cannot narrow the interval further; the bounds hold */
  MB_NOT_SEARCHED = 4       /* the bounds are 0 and infinity */
} mb_outcome;

/* lower <= value <= upper in real arithmetic. */
typedef struct mb_bounds {
  double lower;
  double upper; /* infinite where nothing is proven */
} mb_bounds;

typedef struct mb_surface_point {
  double position[3];
  uint32_t triangle;
} mb_surface_point;

/* One direction: how far a mesh is from another. `from` on the first mesh and `nearest`, its closest point on the
 * second, realise the lower bound up to rounding; they mean nothing where the direction was not searched. */
typedef struct mb_direction {
  mb_bounds bounds;
  mb_surface_point from;
  mb_surface_point nearest;
  mb_outcome outcome;
} mb_direction;

/* The symmetric Hausdorff distance: the larger of both directions. */
typedef struct mb_distance {
  mb_bounds bounds;
  mb_direction a_to_b;
  mb_direction b_to_a;
} mb_distance;

typedef struct mb_distance_options {
  size_t struct_size;   /* set by mb_distance_options_init */
  double error_bound;   /* wanted width of the interval; negative: 1e-6 of the diagonal of A */
  double time_limit;    /* of the whole call; infinite: none */
  int one_sided;        /* 1: only from A to B, whose bounds are then those of the result */
  int threads;          /* 0: as many as OpenMP has */
  mb_cancel* cancel;    /* may be NULL */
  mb_progress progress; /* may be NULL */
  void* user;           /* for `progress` */
  double tolerance;     /* for measurements: the upper bound is also refined until it is at most this, wherever the
                           truth allows it; negative: none. Decisions have a tolerance of their own */
} mb_distance_options;

/* Sets the defaults: the values named above first, no limit, both directions. `size` is sizeof(mb_distance_options). */
mb_status mb_distance_options_init(mb_distance_options* options, size_t size);

/* Measures the distance between two meshes. `options` may be NULL: the defaults. O(n log n) where the surfaces are
 * close or far apart for their size. Source: Tang, Lee, Kim, "Interactive Hausdorff Distance Computation for General
 * Polygonal Models", 2009. */
mb_status mb_measure(const mb_mesh* a, const mb_mesh* b, const mb_distance_options* options, mb_distance* distance);

/* Decides whether the distance is at most `tolerance`, which is faster than measuring it. `options` (its error bound is
 * not looked at) and `distance` (bounds as far as they had to be narrowed) may be NULL. */
mb_status mb_check(const mb_mesh* a, const mb_mesh* b, double tolerance, const mb_distance_options* options,
                   mb_verdict* verdict, mb_distance* distance);

/* ---- one original against many levels ---- */

/* Keeps the tree of an original, and from level to level what did not change, so that it is not checked again. */
typedef struct mb_level_checker mb_level_checker;

/* The geometry is copied. `options` may be NULL; only `threads`, `cancel` and `progress` are looked at, and `progress`
 * is told nothing but 1 at the end. O(n log n). */
mb_status mb_level_checker_new(const mb_mesh* original, const mb_distance_options* options, mb_level_checker** checker);
/* mb_check(original, level); `one_sided` must be 0. */
mb_status mb_level_checker_check(mb_level_checker* checker, const mb_mesh* level, double tolerance,
                                 const mb_distance_options* options, mb_verdict* verdict, mb_distance* distance);
/* mb_measure(original, level); `one_sided` must be 0. */
mb_status mb_level_checker_measure(mb_level_checker* checker, const mb_mesh* level, const mb_distance_options* options,
                                   mb_distance* distance);
void mb_level_checker_free(mb_level_checker* checker);

/* ---- simplification ---- */

typedef enum mb_on_exceed {
  MB_SKIP = 0, /* a collapse that would exceed the tolerance is refused, and decimation goes on */
  MB_STOP = 1  /* decimation ends there */
} mb_on_exceed;

typedef enum mb_effort {
  MB_EFFORT_NORMAL = 0,
  MB_EFFORT_HIGH = 1 /* vertices are moved and edges flipped to make room for further collapses */
} mb_effort;

typedef enum mb_placement {
  MB_OPTIMAL = 0,
  MB_SUBSET = 1 /* every vertex of every level is one of the original */
} mb_placement;

typedef enum mb_ended_by {
  MB_ENDED_NOTHING_FITS = 0, /* no further collapse keeps the bound */
  MB_ENDED_TARGET = 1,
  MB_ENDED_TOLERANCE = 2, /* MB_STOP: the next collapse would exceed */
  MB_ENDED_TIME_LIMIT = 3,
  MB_ENDED_ROUNDING = 4 /* the tolerance is too small for doubles at these coordinates: nothing was collapsed */
} mb_ended_by;

#define MB_NO_TARGET ((size_t)-1)

typedef struct mb_simplify_options {
  size_t struct_size;   /* set by mb_simplify_options_init */
  double tolerance;     /* largest symmetric Hausdorff distance to the original; must be given */
  const double* levels; /* smaller tolerances at which the mesh is handed out as well, in any order; may be NULL */
  size_t level_count;
  size_t target_faces;            /* decimation ends at this many triangles; MB_NO_TARGET: as few as possible */
  double target_ratio;            /* the same as a share of the original's triangles, 0 to 1; negative: none */
  const uint8_t* locked_vertices; /* vertex_count bytes; 1 keeps that vertex where it is, to the bit (or to the
                                     nearest floats, see single_precision); may be NULL */
  const double* face_tolerances;  /* by triangle, a tolerance of its own beside that of all; may be NULL */
  const uint32_t* feature_edges;  /* pairs of vertices whose edges are lines as well; may be NULL */
  size_t feature_edge_count;      /* number of pairs */
  double feature_angle;           /* edges whose normals are further apart are creases, 0 to pi; negative: no creases */
  double line_tolerance;          /* borders and creases stay within it, both ways; negative: creases are locked */
  double time_limit;              /* after which decimation ends; infinite: none */
  int on_exceed;                  /* an mb_on_exceed */
  int effort;                     /* an mb_effort */
  int placement;                  /* an mb_placement */
  int prune;                      /* 1: components whose every point is within the tolerance of the rest are dropped */
  int preserve_boundary;          /* 1: edges with one triangle stay as they are */
  int single_precision; /* 1: every coordinate of a result is a float, and the bound is that of the rounded mesh */
  int certificate;      /* 1: make the certificate of each level that is within its tolerance */
  int threads;          /* 0: as many as OpenMP has */
  mb_cancel* cancel;    /* may be NULL */
  mb_progress progress; /* may be NULL */
  void* user;           /* for `progress` */
  int keep_sides; /* 1: every triangle shows the side that its original shows, and edges between triangles of opposite
                     winding are lines; 0: neighbours turn until they agree (mb_simplification_turned_faces) */
} mb_simplify_options;

/* Sets the defaults: nothing is locked, no target, no limit, optimal placement of doubles. `size` is
 * sizeof(mb_simplify_options). */
mb_status mb_simplify_options_init(mb_simplify_options* options, size_t size);

/* The levels of one simplification. */
typedef struct mb_simplification mb_simplification;

/* Simplifies a triangle soup while its symmetric Hausdorff distance to the original stays within the tolerance. Each
 * level is measured afresh. Expected O(n log n) time, O(n) memory. */
mb_status mb_simplify(const mb_mesh* original, const mb_simplify_options* options, mb_simplification** result);
void mb_simplification_free(mb_simplification* simplification);

/* Number of levels, ascending by tolerance; the last is that of mb_simplify_options.tolerance. */
size_t mb_simplification_level_count(const mb_simplification* simplification);

/* A simplified mesh. The pointers belong to the simplification and hold until it is freed. */
typedef struct mb_level {
  double tolerance;
  mb_verdict verdict;   /* on `distance`, and on `line_distance` where there is one */
  mb_ended_by ended_by; /* why decimation did not go further */
  mb_distance distance; /* between the original (a) and this mesh (b) */
  int has_lines;        /* 1: the mesh has feature lines, and `line_distance` is that between them; else 0 */
  mb_bounds line_distance;
  size_t vertex_count;
  size_t triangle_count;
  const double* positions;          /* 3 * vertex_count */
  const uint32_t* indices;          /* 3 * triangle_count */
  const uint32_t* source_vertices;  /* by vertex: the vertex of the original that it comes from */
  const uint32_t* source_triangles; /* by triangle: one of the triangles of the original that it stands for */
  const uint8_t* certificate;       /* NULL where there is none */
  size_t certificate_size;
} mb_level;

/* Level `index`, 0 for the smallest tolerance. */
mb_status mb_simplification_level(const mb_simplification* simplification, size_t index, mb_level* level);
/* Of level `index`: number of triangles that face the other way than their source triangle; 0 where it is no level. */
size_t mb_simplification_turned_faces(const mb_simplification* simplification, size_t index);

/* ---- certificates ---- */

/* A proof that two meshes are within a tolerance, which the tool verify_certificate checks without this library. */
typedef struct mb_certificate mb_certificate;

/* Proves it for vertices and triangles as they are in memory; files of them must give back the same ones, which STL and
 * glTF do not: they weld and renumber vertices (prove what mb_mesh_file_read gives). `options` may be NULL; its error
 * bound and `one_sided` are not looked at. MB_FAILED where no proof was found, or not within the time limit. Expected
 * O(n log n). */
mb_status mb_certificate_new(const mb_mesh* original, const mb_mesh* simplified, double tolerance,
                             const mb_distance_options* options, mb_certificate** certificate);
/* The bytes of the file. They hold until the certificate is freed. */
const uint8_t* mb_certificate_data(const mb_certificate* certificate);
size_t mb_certificate_size(const mb_certificate* certificate);
void mb_certificate_free(mb_certificate* certificate);

#if defined(__cplusplus)
}
#endif

#endif
