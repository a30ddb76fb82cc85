/* hexhex for C: hexahedral meshes from integer-grid maps.
 *
 * Conventions of this header
 *
 * - Functions that can fail return a hexhex_status and take a hexhex_error* as their last argument,
 *   which may be NULL. It receives the code, a sentence and the place; nothing else keeps them, so
 *   there is no global state. docs/errors.md explains each code.
 * - What such a function makes, it writes to an out parameter, only if it succeeds. Handles are
 *   opaque; each hexhex_..._create or similar has its hexhex_..._destroy, and destroying NULL is
 *   fine.
 * - Structs that may grow begin with `size`, the number of bytes that the caller knows. Make them
 *   with their _INIT macro; a program that was compiled with an older or newer header works with
 *   this library, and gets HEXHEX_INVALID_ARGUMENT if it sets what the library does not know.
 *   Options may be NULL for all defaults.
 * - No exception leaves the library, exhausted memory is HEXHEX_OUT_OF_MEMORY, and nothing is ever
 *   printed.
 * - Threads: functions may run at the same time as long as no two of them use the same handle,
 *   unless both only read it (parameters that are pointers to const). hexhex_context_cancel() and
 *   hexhex_context_cancelled() may be called at any time. docs/api-c.md says it function by
 *   function.
 * - Handles that are NULL, destroyed, of another kind, or in use elsewhere are
 *   HEXHEX_INVALID_ARGUMENT; functions without a status then return 0, NULL, or do nothing. What
 *   cannot be known is in docs/reliability.md.
 * - Enumerations are checked: a number that is none of theirs is HEXHEX_INVALID_ARGUMENT.
 *
 * Corners of a hexahedron are in the order of VTK_HEXAHEDRON: 0 1 2 3 around one face, 4 5 6 7
 * above them, so that 0-4, 1-5, 2-6, 3-7 are edges:
 *
 *          7--------6
 *         /|       /|
 *        4--------5 |        w
 *        | |      | |        |  v
 *        | 3------|-2        | /
 *        |/       |/         |/
 *        0--------1          0-----u
 *
 * with positive orientation: det(p1 - p0, p3 - p0, p4 - p0) > 0 for undistorted cells.
 */
#ifndef HEXHEX_H
#define HEXHEX_H

#include <stddef.h>
#include <stdint.h>

#include <hexhex/export.h>
#include <hexhex/version.h>

/* Enumerations are passed as an int, and a number that is none of theirs is an error. C++ would
 * otherwise regard the number itself as undefined behaviour. */
#ifdef __cplusplus
#define HEXHEX_AS_INT : int
extern "C" {
#else
#define HEXHEX_AS_INT
#endif

/* ---- Version and errors -------------------------------------------------------------------- */

/** The version of the library that runs, e.g. "0.1.0"; HEXHEX_VERSION is that of the headers. */
HEXHEX_API const char* hexhex_version(void);

/** What went wrong. Numbers never change their meaning; new ones may come. */
typedef enum hexhex_status HEXHEX_AS_INT {
  HEXHEX_OK = 0,
  HEXHEX_INVALID_ARGUMENT = 1,
  HEXHEX_FILE_NOT_FOUND = 2,
  HEXHEX_FILE_SYNTAX = 3,
  HEXHEX_FILE_UNSUPPORTED = 4,
  HEXHEX_FILE_WRITE = 5,
  HEXHEX_EMPTY_MESH = 6,
  HEXHEX_INDEX_OUT_OF_RANGE = 7,
  HEXHEX_REPEATED_VERTEX = 8,
  HEXHEX_NOT_FINITE = 9,
  HEXHEX_NON_MANIFOLD_FACE = 10,
  HEXHEX_NON_MANIFOLD_EDGE = 11,
  HEXHEX_NON_MANIFOLD_VERTEX = 12,
  HEXHEX_ORIENTATION = 13,
  HEXHEX_TRANSITION_RESIDUAL = 14,
  HEXHEX_BOUNDARY_OFF_LATTICE = 15,
  HEXHEX_SINGULARITY_OFF_LATTICE = 16,
  HEXHEX_FLIPPED_TET = 17,
  HEXHEX_HALF_INTEGER_FIXED_POINT = 18,
  HEXHEX_TOO_LARGE = 19,
  HEXHEX_CANCELLED = 20,
  HEXHEX_OUT_OF_MEMORY = 21,
  HEXHEX_VERIFICATION_FAILED = 22,
  HEXHEX_INTERNAL = 23,
  HEXHEX_AMBIGUOUS_MESH = 24,
  HEXHEX_NOT_MESHABLE = 25
} hexhex_status;

/** The name of a status as in docs/errors.md, e.g. "FlippedTet"; "Ok"; "Unknown". Never NULL. */
HEXHEX_API const char* hexhex_status_name(hexhex_status status);

/** What a place is: see hexhex_place. */
typedef enum hexhex_place_kind HEXHEX_AS_INT {
  HEXHEX_PLACE_NONE = 0,
  HEXHEX_PLACE_TET = 1,    /**< index: the tet */
  HEXHEX_PLACE_FACE = 2,   /**< index: a tet; second: the corner opposite the face, 0 to 3 */
  HEXHEX_PLACE_EDGE = 3,   /**< index, second: its vertices */
  HEXHEX_PLACE_VERTEX = 4, /**< index: the vertex */
  HEXHEX_PLACE_LINE = 5,   /**< index: a line of a file, from 1 */
  HEXHEX_PLACE_CELL = 6    /**< index: the hexahedron */
} hexhex_place_kind;

typedef struct hexhex_place {
  hexhex_place_kind kind;
  uint64_t index;
  uint64_t second;
} hexhex_place;

/** A place in words: "tet 12", "edge 3-17", "line 4"; "" for none, and for kinds that are none.
 * Writes at most `size` bytes with the final zero, like snprintf(); text may be NULL if size is 0.
 * @return the length of the whole text, without the final zero */
HEXHEX_API size_t hexhex_place_text(const hexhex_place* place, char* text, size_t size);

/** An error, complete in itself. Belongs to the caller. */
typedef struct hexhex_error {
  hexhex_status status;
  hexhex_place place;
  char message[1024]; /**< what is wrong, where, what to do; UTF-8, cut off if longer */
} hexhex_error;

/* ---- Context: threads, progress, cancellation ------------------------------------------------ */

/** What long work gets from its caller. Functions accept NULL: all cores, no progress.
 * One context serves one call at a time; another one, as from its own progress function, is
 * HEXHEX_INVALID_ARGUMENT. The progress function may call whatever uses other handles. */
typedef struct hexhex_context hexhex_context;

/** Called with the name of the stage and its finished share in [0, 1], at most a hundred times a
 * stage, from one thread at a time, which may be another one than the caller's. Returns 0 to go on,
 * anything else to cancel. Must return normally: no longjmp(), no exception. */
typedef int (*hexhex_progress)(void* user, const char* stage, double share);

typedef struct hexhex_context_options {
  size_t size;
  int threads;              /**< 0: all cores */
  hexhex_progress progress; /**< or NULL */
  void* user;               /**< given to progress */
} hexhex_context_options;
#define HEXHEX_CONTEXT_OPTIONS_INIT \
  { sizeof(hexhex_context_options), 0, NULL, NULL }

HEXHEX_API hexhex_status hexhex_context_create(const hexhex_context_options* options,
                                               hexhex_context** context, hexhex_error* error);
HEXHEX_API void hexhex_context_destroy(hexhex_context* context);

/** Asks running and later work of this context to end soon with HEXHEX_CANCELLED. From any thread,
 * and from a signal handler. */
HEXHEX_API void hexhex_context_cancel(hexhex_context* context);
/** 1 after hexhex_context_cancel(): for one's own sinks. From any thread. 0 for NULL. */
HEXHEX_API int hexhex_context_cancelled(const hexhex_context* context);
/** The number of threads it was made with; 0: all cores, and for NULL. */
HEXHEX_API int hexhex_context_threads(const hexhex_context* context);

/** The stages that have run through this context so far: their number, and the name and wall-clock
 * seconds of one. The name lives as long as the context, until its next call. */
HEXHEX_API size_t hexhex_context_stage_count(const hexhex_context* context);
HEXHEX_API hexhex_status hexhex_context_stage(const hexhex_context* context, size_t stage,
                                              const char** name, double* seconds,
                                              hexhex_error* error);

/* ---- Maps ------------------------------------------------------------------------------------ */

/** The valence offset of an edge: hexahedra around it minus 4 (inside) or 2 (on the boundary). */
typedef struct hexhex_edge_valence {
  uint32_t vertex0;
  uint32_t vertex1;
  int offset;
} hexhex_edge_valence;

/** Tagged vertices, edges, triangles of tet meshes and quads of hex meshes, as sharp curves and
 * named surfaces; vertices of edges and triangles in any order, those of quads in order around
 * them. <hexhex/extract.hpp> tells what tags of tets become, and docs/features.md more. */
typedef struct hexhex_feature_vertex {
  uint32_t vertex;
  int32_t tag;
} hexhex_feature_vertex;
typedef struct hexhex_feature_edge {
  uint32_t vertices[2];
  int32_t tag;
} hexhex_feature_edge;
typedef struct hexhex_feature_face {
  uint32_t vertices[3];
  int32_t tag;
} hexhex_feature_face;
typedef struct hexhex_feature_quad {
  uint32_t vertices[4];
  int32_t tag;
} hexhex_feature_quad;
/** What files call the elements with a tag. */
typedef struct hexhex_tag_name {
  int32_t dimension; /**< of the elements: 0 vertices, 1 edges, 2 faces, 3 cells (their region) */
  int32_t tag;
  const char* name;
} hexhex_tag_name;

/** The arrays of a tetrahedral mesh with an integer-grid map. */
typedef struct hexhex_map_arrays {
  size_t size;
  const double* points; /**< x, y, z of each vertex */
  size_t point_count;
  const uint32_t* tets; /**< four vertices of each tet, from 0 */
  size_t tet_count;
  const double* parameters; /**< u, v, w of corner 0, 1, 2, 3 of each tet, in the tet's own chart */
  const hexhex_edge_valence* edge_valences; /**< or NULL: computed. Edges not listed are regular */
  size_t edge_valence_count;
  const int8_t*
      rotations; /**< or NULL: computed. Four per tet: index 0 to 23 of the rotation across
                      the face opposite each corner, as in AlgoHex; -1 where unknown */
  const hexhex_feature_vertex* feature_vertices; /**< each element at most once */
  size_t feature_vertex_count;
  const hexhex_feature_edge* feature_edges;
  size_t feature_edge_count;
  const hexhex_feature_face* feature_faces;
  size_t feature_face_count;
  const int32_t* regions;           /**< or NULL: none. One per tet, which cells inherit */
  const hexhex_tag_name* tag_names; /**< of groups that have one */
  size_t tag_name_count;
} hexhex_map_arrays;
#define HEXHEX_MAP_ARRAYS_INIT                                                                   \
  {                                                                                              \
    sizeof(hexhex_map_arrays), NULL, 0, NULL, 0, NULL, NULL, 0, NULL, NULL, 0, NULL, 0, NULL, 0, \
        NULL, NULL, 0                                                                            \
  }

/** A tetrahedral mesh with an integer-grid map. */
typedef struct hexhex_map hexhex_map;

/** A map of the caller's arrays, without a copy: they must outlive the map and may not change. */
HEXHEX_API hexhex_status hexhex_map_borrow(const hexhex_map_arrays* arrays, hexhex_map** map,
                                           hexhex_error* error);

/** A map with copies of the arrays. */
HEXHEX_API hexhex_status hexhex_map_copy(const hexhex_map_arrays* arrays, hexhex_map** map,
                                         hexhex_error* error);

/** See ReadOptions in <hexhex/io.hpp>. */
typedef struct hexhex_read_options {
  size_t size;
  const char* format; /**< by its name, see hexhex_get_format(); NULL: what the extension means */
  const char* map_array; /**< that holds the map in .vtu and .vtk files; NULL: "igm" */
  int keep_walls;        /**< 1: walls inside, which .hexex files list, are features with tag 2 */
  int hexes_only; /**< 1: leaves out other volume cells of a mesh, which are an error otherwise */
} hexhex_read_options;
#define HEXHEX_READ_OPTIONS_INIT \
  { sizeof(hexhex_read_options), NULL, NULL, 0, 0 }

/** See WriteOptions in <hexhex/io.hpp>. */
typedef struct hexhex_write_options {
  size_t size;
  const char* format;             /**< by its name; NULL: what the extension means */
  const char* map_array;          /**< for .vtu and .vtk files; NULL: "igm" */
  double patch_angle;             /**< of boundary groups, in degrees from 0 to 180 */
  int compress;                   /**< 1: arrays of .vtu files with zlib */
  const double* scaled_jacobians; /**< one per cell, if the caller has them; NULL: computed */
} hexhex_write_options;
#define HEXHEX_WRITE_OPTIONS_INIT \
  { sizeof(hexhex_write_options), NULL, NULL, 40, 0, NULL }

/** A map from a file: .hexex, .ovm, .ovmb, .vtu, .vtk. */
HEXHEX_API hexhex_status hexhex_map_read(const char* file, const hexhex_read_options* options,
                                         hexhex_context* context, hexhex_map** map,
                                         hexhex_error* error);
/** Writes a map; the file appears complete or not at all. Of the options, format and map_array. */
HEXHEX_API hexhex_status hexhex_map_write(const hexhex_map* map, const char* file,
                                          const hexhex_write_options* options,
                                          hexhex_context* context, hexhex_error* error);
/** A tetrahedral mesh without a map from a file: the formats above, .mesh, .meshb and .msh. The
 * result has no parameters. */
HEXHEX_API hexhex_status hexhex_map_read_tets(const char* file, const hexhex_read_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** The map of two files with meshes of the same tets, as polycube tools write them: points of the
 * second are the parameters of the first. */
HEXHEX_API hexhex_status hexhex_map_read_pair(const char* tets, const char* polycube,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** The same of arrays, of which points and tets are used; copies. */
HEXHEX_API hexhex_status hexhex_map_from_pair(const hexhex_map_arrays* tets,
                                              const hexhex_map_arrays* polycube,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** The seamless map of a polycube, of which hexhex_quantize() makes an integer-grid map, from
 * labels of boundary triangles. See mapFromFlags() in <hexhex/quantize.hpp>.
 * @param tets   of which points and tets are used
 * @param flags  4 per tet, of the faces opposite its corners: 0 to 5 for +x, -x, +y, -y, +z, -z;
 *               -1 inside */
HEXHEX_API hexhex_status hexhex_map_from_flags(const hexhex_map_arrays* tets, const int8_t* flags,
                                               hexhex_context* context, hexhex_map** map,
                                               hexhex_error* error);
/** The same of files. See readFlags() in <hexhex/io.hpp>.
 * @param surface  NULL: none
 * @param array    NULL: "flags" */
HEXHEX_API hexhex_status hexhex_map_read_flags(const char* tets, const char* flags,
                                               const char* surface, const char* array,
                                               hexhex_context* context, hexhex_map** map,
                                               hexhex_error* error);

typedef enum hexhex_chart_style HEXHEX_AS_INT {
  HEXHEX_CHARTS_ALIGNED = 0,  /**< as many identity transitions as possible */
  HEXHEX_CHARTS_BLOCKS = 1,   /**< a random chart per block */
  HEXHEX_CHARTS_RANDOM = 2,   /**< a random chart per tet */
  HEXHEX_CHARTS_SCATTERED = 3 /**< a random chart for one tet in eight, aligned for the others */
} hexhex_chart_style;

/** How hexhex_map_generate() damages a map: see DefectKind in <hexhex/samples.hpp>. */
typedef enum hexhex_defect_kind HEXHEX_AS_INT {
  HEXHEX_DEFECTS_INTERIOR = 0,
  HEXHEX_DEFECTS_SINGULAR = 1,
  HEXHEX_DEFECTS_BOUNDARY = 2,
  HEXHEX_DEFECTS_SLIVER = 3
} hexhex_defect_kind;

/** See SampleOptions in <hexhex/samples.hpp> for the ranges. */
typedef struct hexhex_sample_options {
  size_t size;
  int cells;   /**< hexahedra along each block edge */
  int refine;  /**< tet sub-blocks along each block edge */
  int valence; /**< of "star" */
  hexhex_chart_style charts;
  double jitter;
  double on_lattice;
  double noise;
  double offset;
  uint64_t seed;
  int features; /**< 1: tags corners, curves and surfaces, and numbers the blocks as regions */
  int defects;  /**< at least so many tets are flipped or flat */
  hexhex_defect_kind defect_kind;
} hexhex_sample_options;
#define HEXHEX_SAMPLE_OPTIONS_INIT                                                      \
  {                                                                                     \
    sizeof(hexhex_sample_options), 4, 2, 5, HEXHEX_CHARTS_ALIGNED, 0, 0, 0, 0, 1, 0, 0, \
        HEXHEX_DEFECTS_INTERIOR                                                         \
  }

/** A map whose mesh is known in advance: see hexhex_map_get_answer().
 * @param kind  "box", "cylinder", "sphere", "star", "tetrahedron", "torus", "shell", "handle-body"
 */
HEXHEX_API hexhex_status hexhex_map_generate(const char* kind, const hexhex_sample_options* options,
                                             hexhex_map** map, hexhex_error* error);

/** The number of kinds of maps that can be generated. */
HEXHEX_API size_t hexhex_sample_kind_count(void);
/** The name and a description of a kind of maps. Strings live as long as the program.
 * @param[out] name, description  or NULL */
HEXHEX_API hexhex_status hexhex_get_sample_kind(size_t number, const char** name,
                                                const char** description, hexhex_error* error);
/** The name of a kind of defect, e.g. "interior"; "Unknown" for numbers that are none. */
HEXHEX_API const char* hexhex_defect_kind_name(hexhex_defect_kind kind);

/** What is known of the mesh of a generated map, at scale 1 and without its defects: see
 * SampleAnswer in <hexhex/samples.hpp>. */
typedef struct hexhex_sample_answer {
  size_t size;
  uint64_t cells;
  uint64_t vertices;
  uint64_t boundary_quads;
  int64_t euler_characteristic;
  uint64_t components;
  uint64_t boundary_components;
  uint64_t regions; /**< blocks; 0 without features */
} hexhex_sample_answer;
#define HEXHEX_SAMPLE_ANSWER_INIT \
  { sizeof(hexhex_sample_answer), 0, 0, 0, 0, 0, 0, 0 }

/** @param map             made by hexhex_map_generate(); others are HEXHEX_INVALID_ARGUMENT
 *  @param[in,out] answer  made with HEXHEX_SAMPLE_ANSWER_INIT */
HEXHEX_API hexhex_status hexhex_map_get_answer(const hexhex_map* map, hexhex_sample_answer* answer,
                                               hexhex_error* error);

/** Tables of an answer: how many elements of the mesh have a key. */
typedef enum hexhex_answer_table HEXHEX_AS_INT {
  HEXHEX_ANSWER_INNER_EDGES = 0,     /**< singular hex edges inside, by valence */
  HEXHEX_ANSWER_BOUNDARY_EDGES = 1,  /**< singular hex edges on the boundary, by valence */
  HEXHEX_ANSWER_TAGGED_VERTICES = 2, /**< hex vertices, by tag */
  HEXHEX_ANSWER_TAGGED_EDGES = 3,    /**< hex edges, by tag */
  HEXHEX_ANSWER_TAGGED_QUADS = 4     /**< hex faces, by tag */
} hexhex_answer_table;

/** @param[out] entries  number of entries of a table */
HEXHEX_API hexhex_status hexhex_map_count_answer(const hexhex_map* map, hexhex_answer_table table,
                                                 size_t* entries, hexhex_error* error);
/** One entry, in ascending order of keys.
 * @param[out] key, count  or NULL */
HEXHEX_API hexhex_status hexhex_map_get_answer_entry(const hexhex_map* map,
                                                     hexhex_answer_table table, size_t number,
                                                     int32_t* key, uint64_t* count,
                                                     hexhex_error* error);

/** The arrays of a map; they belong to it.
 * @param[in,out] arrays  made with HEXHEX_MAP_ARRAYS_INIT */
HEXHEX_API hexhex_status hexhex_map_get_arrays(const hexhex_map* map, hexhex_map_arrays* arrays,
                                               hexhex_error* error);
HEXHEX_API void hexhex_map_destroy(hexhex_map* map);

/* ---- Meshes ---------------------------------------------------------------------------------- */

/** The arrays of a hexahedral mesh. */
typedef struct hexhex_mesh_arrays {
  size_t size;
  const double* points; /**< x, y, z of each vertex */
  size_t point_count;
  const uint32_t* cells; /**< eight vertices of each cell, from 0, order as above */
  size_t cell_count;
  const uint32_t* generator_tet;    /**< per vertex, or NULL: a tet that contains its generator */
  const uint8_t* generator_corners; /**< per vertex, or NULL: the generator (the vertex, edge, face
                                         or tet in whose interior the vertex lies) by corners of
                                         that tet: bit i for corner i */
  const hexhex_feature_vertex* feature_vertices; /**< what of the mesh is tagged */
  size_t feature_vertex_count;
  const hexhex_feature_edge* feature_edges;
  size_t feature_edge_count;
  const hexhex_feature_quad* feature_quads;
  size_t feature_quad_count;
  const int32_t* regions;           /**< per cell, or NULL */
  const hexhex_tag_name* tag_names; /**< of groups that have one */
  size_t tag_name_count;
} hexhex_mesh_arrays;
#define HEXHEX_MESH_ARRAYS_INIT                                                                \
  {                                                                                            \
    sizeof(hexhex_mesh_arrays), NULL, 0, NULL, 0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, NULL, \
        NULL, 0                                                                                \
  }

/** A hexahedral mesh. */
typedef struct hexhex_mesh hexhex_mesh;

/** The dimension of a generator: 0 vertex, 1 edge, 2 face, 3 tet; -1 for what is none.
 * @param corners  as in hexhex_mesh_arrays, 1 to 15 */
HEXHEX_API int hexhex_generator_kind(uint8_t corners);

/** A mesh with copies of the arrays, e.g. to write or verify it. */
HEXHEX_API hexhex_status hexhex_mesh_copy(const hexhex_mesh_arrays* arrays, hexhex_mesh** mesh,
                                          hexhex_error* error);
/** A mesh from a file: .mesh, .meshb, .vtu, .vtk, .msh, .ovm, .ovmb. */
HEXHEX_API hexhex_status hexhex_mesh_read(const char* file, const hexhex_read_options* options,
                                          hexhex_context* context, hexhex_mesh** mesh,
                                          hexhex_error* error);
/** What a file holds: a mesh or, where there are no hexahedra, a map; the other one is NULL. */
HEXHEX_API hexhex_status hexhex_read(const char* file, const hexhex_read_options* options,
                                     hexhex_context* context, hexhex_map** map, hexhex_mesh** mesh,
                                     hexhex_error* error);
/** Writes a mesh; the file appears complete or not at all. */
HEXHEX_API hexhex_status hexhex_mesh_write(const hexhex_mesh* mesh, const char* file,
                                           const hexhex_write_options* options,
                                           hexhex_context* context, hexhex_error* error);

/** A file format: see FileFormat in <hexhex/io.hpp>. Strings live as long as the program. */
typedef struct hexhex_file_format {
  size_t size;
  const char* name;
  const char* extension; /**< with the dot; "": has to be asked for by name */
  const char* description;
  int reads_maps;
  int writes_maps;
  int reads_tets;
  int reads_meshes;
  int writes_meshes;
  int streams;
  int compresses;
} hexhex_file_format;
#define HEXHEX_FILE_FORMAT_INIT \
  { sizeof(hexhex_file_format), NULL, NULL, NULL, 0, 0, 0, 0, 0, 0, 0 }

/** The formats of this build. */
HEXHEX_API size_t hexhex_format_count(void);
HEXHEX_API hexhex_status hexhex_get_format(size_t number, hexhex_file_format* format,
                                           hexhex_error* error);

/** What may be written to a file. */
typedef enum hexhex_output HEXHEX_AS_INT {
  HEXHEX_OUTPUT_MAP = 0,
  HEXHEX_OUTPUT_MESH = 1,
  HEXHEX_OUTPUT_ARCS = 2,
  HEXHEX_OUTPUT_PATCHES = 3,
  HEXHEX_OUTPUT_LAGRANGE = 4
} hexhex_output;

/** HEXHEX_FILE_UNSUPPORTED unless the file's extension, or the format of the options, is known for
 * this: to fail before long work. */
HEXHEX_API hexhex_status hexhex_require_format(hexhex_output output, const char* file,
                                               const hexhex_write_options* options,
                                               hexhex_error* error);

/** The arrays of a mesh, borrowed: they belong to it. Empty ones are NULL.
 * @param[in,out] arrays  made with HEXHEX_MESH_ARRAYS_INIT */
HEXHEX_API hexhex_status hexhex_mesh_get_arrays(const hexhex_mesh* mesh, hexhex_mesh_arrays* arrays,
                                                hexhex_error* error);

/** What keeps an array alive that was taken out of a mesh. */
typedef struct hexhex_buffer hexhex_buffer;

typedef enum hexhex_mesh_array HEXHEX_AS_INT {
  HEXHEX_POINTS = 0,            /**< double, 3 per vertex */
  HEXHEX_CELLS = 1,             /**< uint32_t, 8 per cell */
  HEXHEX_GENERATOR_TET = 2,     /**< uint32_t, 1 per vertex */
  HEXHEX_GENERATOR_CORNERS = 3, /**< uint8_t, 1 per vertex */
  HEXHEX_REGIONS = 4,           /**< int32_t, 1 per cell */
  HEXHEX_FEATURE_VERTICES = 5,  /**< hexhex_feature_vertex */
  HEXHEX_FEATURE_EDGES = 6,     /**< hexhex_feature_edge */
  HEXHEX_FEATURE_QUADS = 7      /**< hexhex_feature_quad */
} hexhex_mesh_array;

/** Takes an array over, without a copy: the mesh has none afterwards, and the array lives until
 * hexhex_buffer_destroy(), whatever happens to the mesh. */
HEXHEX_API hexhex_status hexhex_mesh_take(hexhex_mesh* mesh, hexhex_mesh_array array,
                                          hexhex_buffer** buffer, hexhex_error* error);
/** The array's first element (NULL if it is empty), and its size in bytes. It may be written to. */
HEXHEX_API void* hexhex_buffer_data(hexhex_buffer* buffer);
HEXHEX_API size_t hexhex_buffer_bytes(const hexhex_buffer* buffer);
HEXHEX_API void hexhex_buffer_destroy(hexhex_buffer* buffer);

HEXHEX_API void hexhex_mesh_destroy(hexhex_mesh* mesh);

/** The boundary quads, facing outwards, tagged by smooth patch: see <hexhex/patches.hpp>.
 * @param angle       in degrees, 0 to 180: where the boundary turns by more, a patch ends
 * @param[out] quads  of hexhex_feature_quad */
HEXHEX_API hexhex_status hexhex_mesh_boundary_patches(const hexhex_mesh* mesh, double angle,
                                                      hexhex_context* context,
                                                      hexhex_buffer** quads, hexhex_error* error);

/** A singular edge of a hex mesh. */
typedef struct hexhex_singular_edge {
  uint32_t vertices[2]; /**< ascending */
  uint32_t valence;     /**< number of cells around */
  uint32_t boundary;    /**< 1 on the boundary */
} hexhex_singular_edge;

/** See MeshStructure in <hexhex/structure.hpp>. */
typedef struct hexhex_structure {
  size_t size;
  uint64_t faces;
  uint64_t edges;
  uint64_t boundary_quads;
  uint64_t components;
  uint64_t boundary_components;
  int64_t euler_characteristic;
} hexhex_structure;
#define HEXHEX_STRUCTURE_INIT \
  { sizeof(hexhex_structure), 0, 0, 0, 0, 0, 0 }

/** @param[out] structure       made with HEXHEX_STRUCTURE_INIT, or NULL
 *  @param[out] singular_edges  of hexhex_singular_edge, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_structure(const hexhex_mesh* mesh, hexhex_context* context,
                                               hexhex_structure* structure,
                                               hexhex_buffer** singular_edges, hexhex_error* error);

/* ---- Repair ---------------------------------------------------------------------------------- */

/** 1 if this build can repair (it was made with Eigen). */
HEXHEX_API int hexhex_can_repair(void);

/** See RepairOptions in <hexhex/repair.hpp>. */
typedef struct hexhex_repair_options {
  size_t size;
  double tolerance; /**< as in hexhex_extract_options */
  int scale;        /**< the map is going to be scaled by at most this */
  int round;        /**< 1: moves what is off integers by up to 0.1 onto them first */
  int refine;       /**< 1: may split edges of the tet mesh */
} hexhex_repair_options;
#define HEXHEX_REPAIR_OPTIONS_INIT \
  { sizeof(hexhex_repair_options), 1e-2, 1, 0, 1 }

/** What a repair did. */
typedef struct hexhex_repair_report hexhex_repair_report;

/** A valid map: the same where it was valid, bit for bit. See <hexhex/repair.hpp>.
 * @param[out] report  or NULL; also given if the repair fails with another code than
 *                     HEXHEX_INVALID_ARGUMENT and HEXHEX_OUT_OF_MEMORY; else it becomes NULL */
HEXHEX_API hexhex_status hexhex_repair(const hexhex_map* map, const hexhex_repair_options* options,
                                       hexhex_context* context, hexhex_map** repaired,
                                       hexhex_repair_report** report, hexhex_error* error);
HEXHEX_API void hexhex_repair_report_destroy(hexhex_repair_report* report);

typedef struct hexhex_repair_summary {
  size_t size;
  int changed; /**< 0 for a valid map */
  size_t region_count;
  uint64_t bad_tets;
  uint64_t moved_vertices;
  double largest_move; /**< of a coordinate, in parameter units */
  uint64_t split_edges;
  uint64_t added_tets;
  uint64_t rounded_vertices;
  double seconds;
} hexhex_repair_summary;
#define HEXHEX_REPAIR_SUMMARY_INIT \
  { sizeof(hexhex_repair_summary), 0, 0, 0, 0, 0, 0, 0, 0, 0 }

HEXHEX_API hexhex_status hexhex_repair_get_summary(const hexhex_repair_report* report,
                                                   hexhex_repair_summary* summary,
                                                   hexhex_error* error);

/** What a repair did to one place. */
typedef struct hexhex_repaired_region {
  size_t size;
  hexhex_place place; /**< a bad tet */
  double position[3]; /**< in space */
  uint64_t bad_tets;
  uint64_t tets; /**< in the patch that was optimized */
  uint64_t moved_vertices;
  double largest_move;
} hexhex_repaired_region;
#define HEXHEX_REPAIRED_REGION_INIT \
  { sizeof(hexhex_repaired_region), {HEXHEX_PLACE_NONE, 0, 0}, {0}, 0, 0, 0, 0 }

HEXHEX_API hexhex_status hexhex_repair_get_region(const hexhex_repair_report* report, size_t number,
                                                  hexhex_repaired_region* region,
                                                  hexhex_error* error);

/* ---- Quantization ---------------------------------------------------------------------------- */

/** 1 if this build can quantize (it was made with Eigen). */
HEXHEX_API int hexhex_can_quantize(void);

/** See QuantizeOptions in <hexhex/quantize.hpp>: exactly one of the first three is not 0. */
typedef struct hexhex_quantize_options {
  size_t size;
  double cells;       /**< hexahedra wanted */
  double scale;       /**< the map's parameters are to be multiplied by about so much */
  double edge_length; /**< of a hexahedron in space, on the average */
  int densify;        /**< 1: if no valid map is found so, takes the first denser one that works */
  int32_t wall_tag;   /**< inner triangles with this tag need not stay planes; 0: none */
  double tolerance;   /**< share of the map's size by which it may miss being seamless */
} hexhex_quantize_options;
#define HEXHEX_QUANTIZE_OPTIONS_INIT \
  { sizeof(hexhex_quantize_options), 0, 0, 0, 0, 0, 1e-5 }

/** What a quantization did. See QuantizeReport and MapDistortion in <hexhex/quantize.hpp>. */
typedef struct hexhex_quantize_report {
  size_t size;
  double cells_wanted;
  uint64_t cells;
  double scale;        /**< of the seamless map's parameters, finally */
  double displacement; /**< largest change of a parameter that made the map seamless */
  uint64_t blocks;     /**< of the motorcycle complex */
  uint64_t arcs;
  uint64_t shortest_arc; /**< in hexahedra */
  uint64_t longest_arc;
  char integers_by[16]; /**< "HiGHS", or "rounding" where it is missing */
  uint64_t attempts;    /**< numbers of cells that were tried */
  uint64_t split_edges; /**< each adds a vertex to the tet mesh */
  uint64_t added_tets;
  double worst_before; /**< distortion of the map as scaled Jacobian, at most 1 */
  double median_before;
  double worst_after;
  double median_after;
} hexhex_quantize_report;
#define HEXHEX_QUANTIZE_REPORT_INIT \
  { sizeof(hexhex_quantize_report), 0, 0, 0, 0, 0, 0, 0, 0, {0}, 0, 0, 0, 0, 0, 0, 0 }

/** An integer-grid map from a seamless one. See <hexhex/quantize.hpp>.
 * @param options      how fine the mesh is to be: not NULL
 * @param[out] report  made with HEXHEX_QUANTIZE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_quantize(const hexhex_map* map,
                                         const hexhex_quantize_options* options,
                                         hexhex_context* context, hexhex_map** quantized,
                                         hexhex_quantize_report* report, hexhex_error* error);

/** What lies between a map and an integer-grid map. */
typedef enum hexhex_seamless_kind HEXHEX_AS_INT {
  HEXHEX_SEAMLESS = 0,        /**< for hexhex_quantize() with its default tolerance */
  HEXHEX_ALMOST_SEAMLESS = 1, /**< up to a hundredth of its size */
  HEXHEX_NOT_SEAMLESS = 2     /**< also where hexhex_can_quantize() is 0 */
} hexhex_seamless_kind;

/** See SeamlessReport in <hexhex/quantize.hpp>. */
typedef struct hexhex_seamless_report {
  size_t size;
  hexhex_seamless_kind kind;
  double displacement; /**< of the nearest seamless map, in parameter units; 0 if there is none */
  double cells;        /**< volume of that in unit cubes */
  char problem[1024];  /**< why it is not seamless; UTF-8, cut off if longer */
} hexhex_seamless_report;
#define HEXHEX_SEAMLESS_REPORT_INIT                                  \
  {                                                                  \
    sizeof(hexhex_seamless_report), HEXHEX_NOT_SEAMLESS, 0, 0, { 0 } \
  }

/** Whether hexhex_quantize() can begin with a map.
 * @param[out] report  made with HEXHEX_SEAMLESS_REPORT_INIT */
HEXHEX_API hexhex_status hexhex_examine_seamless(const hexhex_map* map, hexhex_context* context,
                                                 hexhex_seamless_report* report,
                                                 hexhex_error* error);

/* ---- Extraction ------------------------------------------------------------------------------ */

typedef enum hexhex_engine HEXHEX_AS_INT {
  HEXHEX_ENGINE_ATLAS = 0,    /**< the fast one */
  HEXHEX_ENGINE_PROPELLER = 1 /**< the paper's algorithm: the same mesh, bit for bit */
} hexhex_engine;

/** Where nodes of cells of higher order are: CurvedNodes in <hexhex/extract.hpp>. */
typedef enum hexhex_curved_nodes {
  HEXHEX_NODES_BLENDED = 0, /**< on the surface; inside between these, so that no cell folds over */
  HEXHEX_NODES_EXACT = 1    /**< all where the map has them */
} hexhex_curved_nodes;

typedef struct hexhex_extract_options {
  size_t size;
  hexhex_engine engine;
  int scale;        /**< multiplies all parameters: scale^3 times as many cells; at least 1 */
  double epsilon;   /**< of the propeller engine; changes the time, never the result */
  double tolerance; /**< how far the map may be from its integer conditions, below 0.25 */
  int repair;       /**< 1: a map with flipped or flat tets is repaired first */
  int round;        /**< as in hexhex_repair_options, if there is a repair */
  hexhex_curved_nodes curved_nodes;
} hexhex_extract_options;
#define HEXHEX_EXTRACT_OPTIONS_INIT \
  { sizeof(hexhex_extract_options), HEXHEX_ENGINE_ATLAS, 1, 1e-6, 1e-2, 0, 0, HEXHEX_NODES_BLENDED }

/** What happened on the way. ExtractStatistics in <hexhex/extract.hpp> explains the fields; array
 * indices are kinds of generators: vertex, edge, face, cell. */
typedef struct hexhex_statistics {
  size_t size;
  double seconds;
  int threads;
  double epsilon;
  int epsilon_fallback;
  int mirrored;
  uint64_t tets_inverted_in_space;
  double max_displacement;
  double max_transition_residual;
  uint64_t chart_jumps;
  uint64_t inner_faces;
  uint64_t singular_edges;
  uint64_t generators[4];
  uint64_t vertices[4];
  uint64_t local_propellers;
  uint64_t global_propellers;
  uint64_t charts;
  uint64_t cut_faces;
  uint64_t overlapping_tets;
  uint64_t traced_cells;
  int repaired;                /**< 1 if the map was repaired: see hexhex_mesh_get_repair() */
  uint64_t straightened_cells; /**< so many have left the surface to be positive */
} hexhex_statistics;
#define HEXHEX_STATISTICS_INIT \
  { sizeof(hexhex_statistics), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, {0}, {0}, 0, 0, 0, 0, 0, 0, 0, 0 }

/** Extracts the hexahedral mesh of a map.
 * @param[out] statistics  made with HEXHEX_STATISTICS_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_extract(const hexhex_map* map,
                                        const hexhex_extract_options* options,
                                        hexhex_context* context, hexhex_mesh** mesh,
                                        hexhex_statistics* statistics, hexhex_error* error);

/** The map that was extracted instead of one that had to be repaired, and what the repair did. The
 * mesh's generators mean its tets. Handles of their own, to be destroyed; they are NULL if nothing
 * was repaired.
 * @param[out] map, report  or NULL */
HEXHEX_API hexhex_status hexhex_mesh_get_repair(const hexhex_mesh* mesh, hexhex_map** map,
                                                hexhex_repair_report** report, hexhex_error* error);
/** The same of the last extraction in pieces with this context, hexhex_extract_to() or
 * hexhex_extract_to_file(), which leave no mesh to ask. The context holds the map until the next
 * one. */
HEXHEX_API hexhex_status hexhex_context_get_repair(const hexhex_context* context, hexhex_map** map,
                                                   hexhex_repair_report** report,
                                                   hexhex_error* error);

/** What can be extracted of a map that is not valid: see <hexhex/partial.hpp>. */
typedef struct hexhex_partial_options {
  size_t size;
  int scale;
  double tolerance;
} hexhex_partial_options;
#define HEXHEX_PARTIAL_OPTIONS_INIT \
  { sizeof(hexhex_partial_options), 1, 1e-2 }

/** Places where cells are missing. */
typedef struct hexhex_holes hexhex_holes;

/** @param[out] mesh   its regions are 1 for cells at holes, 0 for others
 *  @param[out] holes  or NULL */
HEXHEX_API hexhex_status hexhex_extract_partial(const hexhex_map* map,
                                                const hexhex_partial_options* options,
                                                hexhex_context* context, hexhex_mesh** mesh,
                                                hexhex_holes** holes, hexhex_error* error);
HEXHEX_API void hexhex_holes_destroy(hexhex_holes* holes);

typedef struct hexhex_holes_summary {
  size_t size;
  size_t hole_count;
  uint64_t invalid_tets;
  double missing_cells;
  uint64_t face_conflicts;
} hexhex_holes_summary;
#define HEXHEX_HOLES_SUMMARY_INIT \
  { sizeof(hexhex_holes_summary), 0, 0, 0, 0 }

HEXHEX_API hexhex_status hexhex_holes_get_summary(const hexhex_holes* holes,
                                                  hexhex_holes_summary* summary,
                                                  hexhex_error* error);

/** See Hole in <hexhex/partial.hpp>. */
typedef struct hexhex_hole {
  size_t size;
  uint32_t tet; /**< the smallest */
  uint64_t tets;
  uint64_t invalid_tets;
  double position[3];
  double missing_cells;
} hexhex_hole;
#define HEXHEX_HOLE_INIT \
  { sizeof(hexhex_hole), 0, 0, 0, {0}, 0 }

/** Most missing cells first. */
HEXHEX_API hexhex_status hexhex_holes_get(const hexhex_holes* holes, size_t number,
                                          hexhex_hole* hole, hexhex_error* error);

/** A prepared map, for several meshes of it. See <hexhex/extractor.hpp>. */
typedef struct hexhex_extractor hexhex_extractor;

/** @param map        which the extractor keeps: its handle may be destroyed before; arrays that it
 *                    borrows may not
 *  @param tolerance  as in hexhex_extract_options
 *  @param max_scale  the largest scale that will be asked for, times the order; below 256, meshes
 *                    are the same as those of hexhex_extract(), bit for bit */
HEXHEX_API hexhex_status hexhex_extractor_create(const hexhex_map* map, double tolerance,
                                                 int max_scale, hexhex_context* context,
                                                 hexhex_extractor** extractor, hexhex_error* error);
/** As hexhex_extract(); options->tolerance is ignored. */
HEXHEX_API hexhex_status hexhex_extractor_extract(hexhex_extractor* extractor,
                                                  const hexhex_extract_options* options,
                                                  hexhex_context* context, hexhex_mesh** mesh,
                                                  hexhex_statistics* statistics,
                                                  hexhex_error* error);
HEXHEX_API void hexhex_extractor_destroy(hexhex_extractor* extractor);
/** Number of cells at scale 1; scale^3 times as many at others. 0 for NULL. */
HEXHEX_API uint64_t hexhex_extractor_cells(const hexhex_extractor* extractor);

/* ---- Extraction in pieces -------------------------------------------------------------------- */

/** Receives a mesh in pieces: begin, then all points in order, then all cells in order, then end;
 * from one thread at a time. Each returns 0 to go on, anything else to cancel, and must return
 * normally. Pointers are valid during the call. Members may be NULL. */
typedef struct hexhex_sink {
  size_t size;
  void* user; /**< given to all */
  int (*begin)(void* user, uint64_t point_count, uint64_t cell_count);
  /** Vertices from number `first` on; generator arrays as in hexhex_mesh_arrays, or NULL. */
  int (*points)(void* user, uint64_t first, size_t count, const double* points,
                const uint32_t* generator_tet, const uint8_t* generator_corners);
  /** Cells from number `first` on, in meshes of up to 2^32 - 2 vertices. */
  int (*cells)(void* user, uint64_t first, size_t count, const uint32_t* cells);
  /** The same in larger meshes. If NULL, these are HEXHEX_TOO_LARGE. */
  int (*cells64)(void* user, uint64_t first, size_t count, const uint64_t* cells);
  int (*end)(void* user);
} hexhex_sink;
#define HEXHEX_SINK_INIT \
  { sizeof(hexhex_sink), NULL, NULL, NULL, NULL, NULL, NULL }

/** Extracts the same mesh as hexhex_extract(), bit for bit, with the atlas engine, but never holds
 * all of it. */
HEXHEX_API hexhex_status hexhex_extract_to(const hexhex_sink* sink, const hexhex_map* map,
                                           const hexhex_extract_options* options,
                                           hexhex_context* context, hexhex_statistics* statistics,
                                           hexhex_error* error);
/** The same of a prepared map. */
HEXHEX_API hexhex_status hexhex_extractor_extract_to(
    hexhex_extractor* extractor, const hexhex_sink* sink, const hexhex_extract_options* options,
    hexhex_context* context, hexhex_statistics* statistics, hexhex_error* error);
/** The same into a file, .vtu or .mesh. */
HEXHEX_API hexhex_status hexhex_extract_to_file(const char* file, const hexhex_map* map,
                                                const hexhex_extract_options* options,
                                                hexhex_context* context,
                                                hexhex_statistics* statistics, hexhex_error* error);
/** Reads a mesh from a file and hands it over in pieces. */
HEXHEX_API hexhex_status hexhex_mesh_read_to(const hexhex_sink* sink, const char* file,
                                             const hexhex_read_options* options,
                                             hexhex_context* context, hexhex_error* error);

/** A file for a mesh that comes in pieces from the caller: see openMeshSink() in <hexhex/io.hpp>.
 */
typedef struct hexhex_mesh_writer hexhex_mesh_writer;

/** Then: begin, all points in order, all cells in order, end. The file appears, complete, with end;
 * a writer that is destroyed before leaves nothing.
 * @param context  serves this writer alone, which keeps it; or NULL */
HEXHEX_API hexhex_status hexhex_mesh_writer_create(const char* file,
                                                   const hexhex_write_options* options,
                                                   hexhex_context* context,
                                                   hexhex_mesh_writer** writer,
                                                   hexhex_error* error);
HEXHEX_API hexhex_status hexhex_mesh_writer_begin(hexhex_mesh_writer* writer, uint64_t point_count,
                                                  uint64_t cell_count, hexhex_error* error);
/** @param generator_tet, generator_corners  as in hexhex_mesh_arrays, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_writer_points(hexhex_mesh_writer* writer, uint64_t first,
                                                   size_t count, const double* points,
                                                   const uint32_t* generator_tet,
                                                   const uint8_t* generator_corners,
                                                   hexhex_error* error);
HEXHEX_API hexhex_status hexhex_mesh_writer_cells(hexhex_mesh_writer* writer, uint64_t first,
                                                  size_t count, const uint32_t* cells,
                                                  hexhex_error* error);
HEXHEX_API hexhex_status hexhex_mesh_writer_cells64(hexhex_mesh_writer* writer, uint64_t first,
                                                    size_t count, const uint64_t* cells,
                                                    hexhex_error* error);
HEXHEX_API hexhex_status hexhex_mesh_writer_end(hexhex_mesh_writer* writer, hexhex_error* error);
HEXHEX_API void hexhex_mesh_writer_destroy(hexhex_mesh_writer* writer);
/** The writer as a sink, for the functions above: pieces go to it directly, and what it refuses is
 * the error of the function.
 * @param[out] sink  made with HEXHEX_SINK_INIT; valid as long as the writer */
HEXHEX_API hexhex_status hexhex_mesh_writer_sink(hexhex_mesh_writer* writer, hexhex_sink* sink,
                                                 hexhex_error* error);

/** What a mesh adds up to: see MeshSurvey in <hexhex/survey.hpp>. */
typedef struct hexhex_survey {
  size_t size;
  uint64_t points;
  uint64_t cells;
  double lower[3]; /**< of the bounding box */
  double upper[3];
  uint64_t point_checksum;
  uint64_t cell_checksum;
} hexhex_survey;
#define HEXHEX_SURVEY_INIT \
  { sizeof(hexhex_survey), 0, 0, {0}, {0}, 0, 0 }

HEXHEX_API hexhex_status hexhex_mesh_survey(const hexhex_mesh* mesh, hexhex_context* context,
                                            hexhex_survey* survey, hexhex_error* error);
HEXHEX_API hexhex_status hexhex_file_survey(const char* file, const hexhex_read_options* options,
                                            hexhex_context* context, hexhex_survey* survey,
                                            hexhex_error* error);
/** A writer without a file: it adds up what comes, and is asked after its end.
 * @param context  as of hexhex_mesh_writer_create() */
HEXHEX_API hexhex_status hexhex_survey_writer_create(hexhex_context* context,
                                                     hexhex_mesh_writer** writer,
                                                     hexhex_error* error);
HEXHEX_API hexhex_status hexhex_survey_writer_get(const hexhex_mesh_writer* writer,
                                                  hexhex_survey* survey, hexhex_error* error);

/* ---- Checking maps --------------------------------------------------------------------------- */

/** What a map is, what its mesh will be, and what is wrong with it. */
typedef struct hexhex_check_report hexhex_check_report;

/** Collects every violated condition instead of stopping at the first; a map that violates some is
 * no error of this function.
 * @param tolerance  as in hexhex_extract_options
 * @param scale      of the mesh to expect */
HEXHEX_API hexhex_status hexhex_check(const hexhex_map* map, double tolerance, int scale,
                                      hexhex_context* context, hexhex_check_report** report,
                                      hexhex_error* error);
HEXHEX_API void hexhex_check_report_destroy(hexhex_check_report* report);

/** The numbers of a report: see CheckReport and Expectation in <hexhex/check.hpp>. */
typedef struct hexhex_check_summary {
  size_t size;
  int valid; /**< 1 if there are no defects */
  size_t defect_count;
  uint64_t points;
  uint64_t tets;
  uint64_t edges;
  uint64_t faces;
  uint64_t boundary_faces;
  uint64_t inner_faces;
  uint64_t chart_jumps;
  uint64_t isolated_vertices;
  uint64_t tets_inverted_in_space;
  int mirrored;
  int corners_reversed;
  double max_transition_residual;
  double max_displacement;
  uint64_t singular_nodes;
  /* Of the mesh to expect, if valid: */
  uint64_t cells;
  uint64_t boundary_quads;
  int64_t euler_characteristic;
  uint64_t components;
  uint64_t boundary_components;
} hexhex_check_summary;
#define HEXHEX_CHECK_SUMMARY_INIT \
  { sizeof(hexhex_check_summary), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

HEXHEX_API hexhex_status hexhex_check_get_summary(const hexhex_check_report* report,
                                                  hexhex_check_summary* summary,
                                                  hexhex_error* error);

/** One violated condition; what it points to belongs to the report. */
typedef struct hexhex_defect {
  size_t size;
  hexhex_status code;
  const char* sentence; /**< what is wrong and what to do */
  uint64_t count;       /**< all occurrences */
  size_t worst_count;   /**< places that can be asked for: at most ten, worst first */
} hexhex_defect;
#define HEXHEX_DEFECT_INIT \
  { sizeof(hexhex_defect), HEXHEX_OK, NULL, 0, 0 }

HEXHEX_API hexhex_status hexhex_check_get_defect(const hexhex_check_report* report, size_t defect,
                                                 hexhex_defect* out, hexhex_error* error);
/** @param[out] amount  in parameter units: a distance, or the volume of a flipped tet */
HEXHEX_API hexhex_status hexhex_check_get_occurrence(const hexhex_check_report* report,
                                                     size_t defect, size_t occurrence,
                                                     hexhex_place* place, double* amount,
                                                     hexhex_error* error);

/** Genus of each boundary component, in descending order, one by one.
 * @param[out] genus  -1 if there is no such component */
HEXHEX_API void hexhex_check_boundary_genus(const hexhex_check_report* report, size_t component,
                                            int64_t* genus);

/** Tables of edges by valence (hexahedra around an edge). */
typedef enum hexhex_valence_table HEXHEX_AS_INT {
  HEXHEX_INNER_HEX_EDGES = 0, /**< expected singular edges of the mesh */
  HEXHEX_BOUNDARY_HEX_EDGES = 1,
  HEXHEX_INNER_TET_EDGES = 2, /**< singular edges of the map */
  HEXHEX_BOUNDARY_TET_EDGES = 3
} hexhex_valence_table;

/** The number of edges of a valence; 0 if there are none. */
HEXHEX_API uint64_t hexhex_check_edges_of_valence(const hexhex_check_report* report,
                                                  hexhex_valence_table table, int valence);
/** The smallest valence in the table above `valence` (begin with -1), or -1 if there is none. */
HEXHEX_API int hexhex_check_next_valence(const hexhex_check_report* report,
                                         hexhex_valence_table table, int valence);

/** What one wants to see of a map: see <hexhex/map_structure.hpp>. */
typedef struct hexhex_map_structure hexhex_map_structure;

/** An inner face whose two tets have different charts: the transition takes parameters u in the
 * chart of tets[0] to R u + t in that of tets[1]. */
typedef struct hexhex_chart_jump {
  uint32_t tets[2];      /**< ascending */
  uint32_t vertices[3];  /**< of the face, in the order of the corners of tets[0] */
  int8_t rotation[9];    /**< R by rows */
  double translation[3]; /**< t; integers */
} hexhex_chart_jump;

/** An edge of the tets with another number of hexahedra around than 4 inside, 2 on the boundary. */
typedef struct hexhex_singular_tet_edge {
  uint32_t vertices[2]; /**< ascending */
  int32_t valence;      /**< number of hexahedra around */
  uint32_t boundary;    /**< 1 on the boundary */
} hexhex_singular_tet_edge;

/** Finds chart jumps and singular edges, also of a map with defects as far as they allow: a map
 * that violates conditions is no error of this function.
 * @param tolerance  as in hexhex_extract_options */
HEXHEX_API hexhex_status hexhex_map_find_structure(const hexhex_map* map, double tolerance,
                                                   hexhex_context* context,
                                                   hexhex_map_structure** structure,
                                                   hexhex_error* error);
HEXHEX_API void hexhex_map_structure_destroy(hexhex_map_structure* structure);

/** The lists, borrowed: they belong to the structure. Empty ones are NULL. */
typedef struct hexhex_map_structure_arrays {
  size_t size;
  const hexhex_chart_jump* chart_jumps; /**< by tets[0], then the corner opposite the face */
  size_t chart_jump_count;
  const hexhex_singular_tet_edge* singular_edges; /**< by vertices */
  size_t singular_edge_count;
  size_t defect_count; /**< what is wrong with the map; hexhex_check() tells it */
} hexhex_map_structure_arrays;
#define HEXHEX_MAP_STRUCTURE_ARRAYS_INIT \
  { sizeof(hexhex_map_structure_arrays), NULL, 0, NULL, 0, 0 }

HEXHEX_API hexhex_status hexhex_map_structure_get_arrays(const hexhex_map_structure* structure,
                                                         hexhex_map_structure_arrays* arrays,
                                                         hexhex_error* error);

/* ---- Verifying meshes ------------------------------------------------------------------------ */

/** Whether a mesh agrees with its map, check by check. */
typedef struct hexhex_verify_report hexhex_verify_report;

/** Passes the mesh of the map in any numbering, with cells in any orientation, and no other mesh.
 * One that does not agree is no error of this function.
 * @param tolerance  of the map, as in hexhex_extract_options
 * @param scale      that the mesh was extracted with */
HEXHEX_API hexhex_status hexhex_verify(const hexhex_map* map, const hexhex_mesh* mesh,
                                       double tolerance, int scale, hexhex_context* context,
                                       hexhex_verify_report** report, hexhex_error* error);
HEXHEX_API void hexhex_verify_report_destroy(hexhex_verify_report* report);

/** 1 if all checks passed. */
HEXHEX_API int hexhex_verify_passed(const hexhex_verify_report* report);
HEXHEX_API size_t hexhex_verify_item_count(const hexhex_verify_report* report);

/** One check; strings belong to the report. */
typedef struct hexhex_verify_item {
  size_t size;
  const char* name;     /**< stable key */
  const char* expected; /**< from the map */
  const char* found;    /**< in the mesh */
  int passed;
} hexhex_verify_item;
#define HEXHEX_VERIFY_ITEM_INIT \
  { sizeof(hexhex_verify_item), NULL, NULL, NULL, 0 }

HEXHEX_API hexhex_status hexhex_verify_get_item(const hexhex_verify_report* report, size_t item,
                                                hexhex_verify_item* out, hexhex_error* error);

/* ---- Quality --------------------------------------------------------------------------------- */

/** Scaled Jacobian of one hexahedron in [-1, 1]: see <hexhex/quality.hpp>.
 * @param corners  x, y, z of the eight corners; NULL: 0 */
HEXHEX_API double hexhex_scaled_jacobian(const double corners[24]);

typedef struct hexhex_quality {
  size_t size;
  double minimum;
  double mean;
  uint64_t not_positive;  /**< cells with scaled Jacobian <= 0 */
  uint64_t histogram[20]; /**< of [-1, 1] in steps of 0.1 */
} hexhex_quality;
#define HEXHEX_QUALITY_INIT                \
  {                                        \
    sizeof(hexhex_quality), 0, 0, 0, { 0 } \
  }

/** @param[out] scaled_jacobians  one per cell, or NULL
 *  @param[out] quality           made with HEXHEX_QUALITY_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_quality(const hexhex_mesh* mesh, hexhex_context* context,
                                             double* scaled_jacobians, hexhex_quality* quality,
                                             hexhex_error* error);

/** The same of numbers that the caller has, e.g. of a part of the cells.
 * @param values  `count` scaled Jacobians */
HEXHEX_API hexhex_status hexhex_summarize_quality(const double* values, size_t count,
                                                  hexhex_quality* quality, hexhex_error* error);

/** Whether the determinant of a cell's Jacobian matrix is positive everywhere: see Validity in
 * <hexhex/quality.hpp>. */
typedef enum hexhex_validity HEXHEX_AS_INT {
  HEXHEX_POSITIVE = 0,
  HEXHEX_REFUTED = 1,  /**< negative or zero somewhere, or not finite */
  HEXHEX_UNDECIDED = 2 /**< closer to zero than a search of bounded length tells */
} hexhex_validity;

/** A cell that is not positive, and where. */
typedef struct hexhex_refuted_cell {
  uint64_t cell;
  double place[3]; /**< in the cell: u, v, w in [0, 1], along the edges from corner 0 to 1, 3, 4 */
  double position[3];     /**< in space */
  double scaled_jacobian; /**< there; not positive */
} hexhex_refuted_cell;

/** What is proven of a mesh: see Certificate in <hexhex/quality.hpp>. */
typedef struct hexhex_certificate {
  size_t size;
  uint64_t positive; /**< numbers of cells */
  uint64_t refuted;
  uint64_t undecided;
  double minimum;     /**< the scaled Jacobian is nowhere less, inside of cells included */
  size_t worst_count; /**< at most 10 */
  hexhex_refuted_cell worst[10]; /**< the most negative first */
} hexhex_certificate;
#define HEXHEX_CERTIFICATE_INIT                  \
  {                                              \
    sizeof(hexhex_certificate), 0, 0, 0, 0, 0, { \
      { 0, {0, 0, 0}, {0, 0, 0}, 0 }             \
    }                                            \
  }

/** Whether cells are positive everywhere; one pass gives their quality, too.
 *  @param[out] validity          a hexhex_validity per cell, or NULL
 *  @param[out] scaled_jacobians  one per cell, as of hexhex_mesh_quality(), or NULL
 *  @param[out] certificate       made with HEXHEX_CERTIFICATE_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_certify(const hexhex_mesh* mesh, hexhex_context* context,
                                             uint8_t* validity, double* scaled_jacobians,
                                             hexhex_certificate* certificate, hexhex_error* error);

/* ---- Improvement ----------------------------------------------------------------------------- */

/** Whether a layer of cells is added under the boundary; see PillowMode in <hexhex/improve.hpp>. */
typedef enum hexhex_pillow_mode HEXHEX_AS_INT {
  HEXHEX_PILLOW_NEVER = 0,
  HEXHEX_PILLOW_AUTO = 1,  /**< where it makes the mesh better */
  HEXHEX_PILLOW_ALWAYS = 2 /**< an error where there cannot be one */
} hexhex_pillow_mode;

/** See ImproveOptions in <hexhex/improve.hpp>. */
typedef struct hexhex_improve_options {
  size_t size;
  double target;        /**< cells with a smaller scaled Jacobian are improved; 0 to 1 */
  int passes;           /**< over all vertices in the end; 0 to 1000 */
  int fix_boundary;     /**< 1: vertices on the surface stay */
  double feature_angle; /**< where the surface turns by more is a curve; degrees, 0 to 180 */
  double
      slack; /**< so far may vertices leave the surface if nothing else helps; diagonals, to 0.1 */
  hexhex_pillow_mode pillow; /**< of straight cells only */
  int snap_curves; /**< 1: edges are laid onto curves that none follows; of straight cells only */
} hexhex_improve_options;
#define HEXHEX_IMPROVE_OPTIONS_INIT \
  { sizeof(hexhex_improve_options), 0.3, 2, 0, 40, 1e-3, HEXHEX_PILLOW_NEVER, 0 }

/** What an improvement did. See ImproveReport in <hexhex/improve.hpp>; lengths are in diagonals of
 * the surface's bounding box. hexhex_mesh_certify() says which cells are not positive. */
typedef struct hexhex_improve_report {
  size_t size;
  uint64_t not_positive_before; /**< cells that are not certified positive everywhere */
  uint64_t not_positive_after;
  double minimum_before; /**< of scaled Jacobians */
  double minimum_after;
  double mean_before;
  double mean_after;
  double diagonal;
  double from_mesh_before;    /**< largest distance of the mesh's boundary from the object's, */
  double from_surface_before; /**< and of the object's from the mesh's */
  double from_mesh_after;
  double from_surface_after;
  uint64_t far_cells_before; /**< cells whose boundary is more than 1e-3 from the surface */
  uint64_t far_cells_after;
  uint64_t free_vertices;
  uint64_t patch_vertices; /**< that slide on the surface, */
  uint64_t curve_vertices; /**< on curves, */
  uint64_t fixed_vertices; /**< and not at all */
  uint64_t moved_vertices;
  double largest_move;
  double mean_move;     /**< of those that moved */
  uint64_t off_surface; /**< vertices that used the slack */
  double seconds;
  double inner_distance_before; /**< largest distance of faces inside, tagged or between regions, */
  double inner_distance_after;  /**< from such triangles; 0 if there are none */
  uint64_t tagged_vertices;     /**< of fixed_vertices: that have a tag, */
  uint64_t boundary_vertices;   /**< and that only fix_boundary holds; the rest are corners */
  uint64_t off_creases;   /**< vertices that left creases, where nothing else made cells positive */
  uint64_t added_cells;   /**< of a pillow, last in the mesh */
  double curve_length;    /**< of the object's sharp and tagged edges, */
  double curves_followed; /**< and the share of it that edges of the mesh follow */
  uint64_t snapped_curves; /**< pieces of curves onto which edges were laid */
} hexhex_improve_report;
#define HEXHEX_IMPROVE_REPORT_INIT                                                                \
  {                                                                                               \
    sizeof(hexhex_improve_report), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0                                                              \
  }

/** Moves vertices until cells are positive, and better. See <hexhex/improve.hpp>. With a pillow,
 * the mesh gets more vertices and cells: arrays that were asked for before are no longer there.
 * @param map          that the mesh was extracted from, or NULL: the surface is the mesh's boundary
 * @param options      or NULL
 * @param[out] report  made with HEXHEX_IMPROVE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_improve(hexhex_mesh* mesh, const hexhex_map* map,
                                             const hexhex_improve_options* options,
                                             hexhex_context* context, hexhex_improve_report* report,
                                             hexhex_error* error);

/* ---- From tets alone ------------------------------------------------------------------------- */

/** How a map is made: see ShapeMethod in <hexhex/shape.hpp>. */
typedef enum hexhex_shape_method HEXHEX_AS_INT {
  HEXHEX_METHOD_AUTO = 0,     /**< what fits best */
  HEXHEX_METHOD_POLYCUBE = 1, /**< the object becomes one of axis-aligned boxes */
  HEXHEX_METHOD_FRAMES = 2    /**< along a smooth field of frames */
} hexhex_shape_method;

/** See ShapeOptions in <hexhex/shape.hpp>. */
typedef struct hexhex_shape_options {
  size_t size;
  hexhex_shape_method method;
  double feature_angle; /**< where the surface turns by more is a feature; degrees, 0 to 180 */
  uint64_t seed;        /**< of random decisions: another one may find what this one does not */
} hexhex_shape_options;
#define HEXHEX_SHAPE_OPTIONS_INIT \
  { sizeof(hexhex_shape_options), HEXHEX_METHOD_AUTO, 40, 1 }

/** How a map was made. See ShapeReport and LabelReport in <hexhex/shape.hpp>. */
typedef struct hexhex_shape_report {
  size_t size;
  hexhex_shape_method method; /**< that made the map */
  double rotation[9];         /**< by rows: the axes in space that became those of the map */
  uint64_t charts;            /**< of a polycube, as the next eight: its faces */
  uint64_t corners;           /**< where three charts or more meet */
  uint64_t bad_loops;         /**< borders of charts with fewer than four corners, */
  uint64_t bad_corners;       /**< of more than three charts, or without room for their faces, */
  uint64_t opposite_edges;    /**< edges of the mesh between opposite labels, */
  uint64_t turning_points;    /**< places where edges of the polycube would run back, */
  uint64_t wrong_turns;   /**< charts whose right angles do not add up: labels are valid without */
  double deviation;       /**< mean of 1 minus the cosine between normals and labels */
  uint64_t label_moves;   /**< random changes that were tried */
  uint64_t added_tets;    /**< by splits */
  uint64_t feature_edges; /**< of the tets, beyond the angle */
  uint64_t tagged_edges;  /**< of these: edges of the map */
  double worst;           /**< distortion of the map as scaled Jacobian, at most 1 */
  double median;
  uint64_t inner_faces;   /**< triangles inside, with a tag or between regions, */
  uint64_t aligned_faces; /**< and those of them that are planes of the map, */
  double aligned_area;    /**< with that share of their area, 0 to 1 */
} hexhex_shape_report;
#define HEXHEX_SHAPE_REPORT_INIT                                                                 \
  {                                                                                              \
    sizeof(hexhex_shape_report), HEXHEX_METHOD_AUTO, {0}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
        0, 0, 0, 0                                                                               \
  }

/** A seamless map of tets that have none, for hexhex_quantize(). Where there is none, the status is
 * HEXHEX_NOT_MESHABLE, with the place that keeps the tets from it. See mapFromTets() in
 * <hexhex/shape.hpp>; hexhex_can_quantize() says whether this build can.
 * @param tets         of which points, tets, features and regions are used
 * @param options      or NULL
 * @param[out] report  made with HEXHEX_SHAPE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_map_from_tets(const hexhex_map_arrays* tets,
                                              const hexhex_shape_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_shape_report* report, hexhex_error* error);

/** What fills surfaces with tets. */
typedef enum hexhex_mesher HEXHEX_AS_INT {
  HEXHEX_MESHER_AUTO = 0, /**< the first of the others that is installed */
  HEXHEX_MESHER_TETWILD = 1,
  HEXHEX_MESHER_NETGEN = 2,
  HEXHEX_MESHER_GMSH = 3,
  HEXHEX_MESHER_TETGEN = 4
} hexhex_mesher;

/** See FillOptions in <hexhex/fill.hpp>. */
typedef struct hexhex_fill_options {
  size_t size;
  hexhex_mesher mesher;
  double tet_size;      /**< length of an edge; 0: as cells says */
  double cells;         /**< hexahedra that are wanted; 0: for 20,000 tets, about */
  double feature_angle; /**< degrees: edges where the surface turns by more stay */
} hexhex_fill_options;
#define HEXHEX_FILL_OPTIONS_INIT \
  { sizeof(hexhex_fill_options), HEXHEX_MESHER_AUTO, 0, 0, 40 }

/** See FillReport in <hexhex/fill.hpp>. */
typedef struct hexhex_fill_report {
  size_t size;
  char mesher[64]; /**< with its version; empty if the file held tets; UTF-8, cut off if longer */
  double tet_size;
  uint64_t tets;
  uint64_t triangles; /**< of a surface, as the rest */
  uint64_t bodies;
  uint64_t voids;
  double volume;
  double filled_volume;
} hexhex_fill_report;
#define HEXHEX_FILL_REPORT_INIT \
  { sizeof(hexhex_fill_report), {0}, 0, 0, 0, 0, 0, 0, 0 }

/** The tets of a part from a file that hexhex_map_read_tets() reads; or of a closed surface, .stl,
 * .obj, .ply or .off, or a STEP file, which a mesher that is installed fills. The result has no
 * parameters.
 * @param options      or NULL
 * @param[out] report  made with HEXHEX_FILL_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_map_read_part(const char* file, const hexhex_fill_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_fill_report* report, hexhex_error* error);

/** Options of the steps of hexhex_mesh_from_tets(); NULL for those of a step: all defaults. */
typedef struct hexhex_mesh_options {
  size_t size;
  const hexhex_shape_options* shape;
  const hexhex_quantize_options* quantize; /**< how fine the mesh is to be: not NULL */
  const hexhex_improve_options* improve; /**< NULL: with a pillow where it helps, and snap_curves */
} hexhex_mesh_options;
#define HEXHEX_MESH_OPTIONS_INIT \
  { sizeof(hexhex_mesh_options), NULL, NULL, NULL }

/** Where hexhex_mesh_from_tets() reports. Pointers are the caller's, to structs that are made with
 * their _INIT macro, or NULL. */
typedef struct hexhex_mesh_reports {
  size_t size;
  hexhex_shape_report* shape;
  hexhex_quantize_report* quantization;
  hexhex_improve_report* improvement;
  int tags_released; /**< 1: vertices may have left edges with a tag, to make cells positive */
  char why[512]; /**< with HEXHEX_METHOD_AUTO: why this way was taken; UTF-8, cut off if longer */
  uint64_t missing_curves; /**< pieces of tagged curves that no edges were found along */
} hexhex_mesh_reports;
#define HEXHEX_MESH_REPORTS_INIT \
  { sizeof(hexhex_mesh_reports), NULL, NULL, NULL, 0, {0}, 0 }

/** A hexahedral mesh of tets that have no map: hexhex_map_from_tets(), hexhex_quantize(),
 * hexhex_extract(), hexhex_verify() and hexhex_mesh_improve(). Cells may still not be positive in
 * the end: the report of the improvement says how many. See <hexhex/mesh.hpp>.
 * @param tets             of which points, tets, features and regions are used
 * @param options          not NULL
 * @param[out] map         the integer-grid map that the mesh is of, or NULL
 * @param[in,out] reports  made with HEXHEX_MESH_REPORTS_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_from_tets(const hexhex_map_arrays* tets,
                                               const hexhex_mesh_options* options,
                                               hexhex_context* context, hexhex_mesh** mesh,
                                               hexhex_map** map, hexhex_mesh_reports* reports,
                                               hexhex_error* error);

/* ---- Curved meshes --------------------------------------------------------------------------- */

/** A mesh with the exact shapes of its edges (arcs) and faces (patches), piece by piece: see
 * PiecewiseLinearMesh in <hexhex/curved.hpp>. */
typedef struct hexhex_piecewise_mesh hexhex_piecewise_mesh;

/** @param patches  0: arcs only; 1: and patches */
HEXHEX_API hexhex_status hexhex_extract_piecewise(const hexhex_map* map, int patches,
                                                  const hexhex_extract_options* options,
                                                  hexhex_context* context,
                                                  hexhex_piecewise_mesh** mesh,
                                                  hexhex_statistics* statistics,
                                                  hexhex_error* error);
HEXHEX_API void hexhex_piecewise_mesh_destroy(hexhex_piecewise_mesh* mesh);

/** The mesh of straight cells, which belongs to this one. NULL for NULL. */
HEXHEX_API const hexhex_mesh* hexhex_piecewise_mesh_straight(const hexhex_piecewise_mesh* mesh);

/** See Arcs in <hexhex/curved.hpp>. Empty arrays are NULL. */
typedef struct hexhex_arc_arrays {
  size_t size;
  size_t arc_count;
  const uint32_t* ends;        /**< 2 per arc */
  const uint64_t* point_begin; /**< per arc, +1: its inner points; segments from arc + this on */
  size_t point_count;
  const double* points;     /**< 3 per inner point */
  const double* parameters; /**< per inner point, in (0, 1) */
  const uint32_t* generator_tet;
  const uint8_t* generator_corners;
  size_t segment_count;
  const uint32_t* segment_tet;
  const uint8_t* segment_corners;
} hexhex_arc_arrays;
#define HEXHEX_ARC_ARRAYS_INIT \
  { sizeof(hexhex_arc_arrays), 0, NULL, NULL, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL }

/** See Patches in <hexhex/curved.hpp>. Points are numbered: hex vertices, inner points of arcs,
 * inner points of patches. */
typedef struct hexhex_patch_arrays {
  size_t size;
  size_t face_count;
  const uint32_t* vertices; /**< 4 per face */
  const uint32_t* arcs;     /**< 4 per face */
  const uint8_t* reversed_arcs;
  const uint64_t* polygon_begin; /**< per face, +1 */
  size_t polygon_count;
  const uint64_t* corner_begin; /**< per polygon, +1 */
  const uint32_t* polygon_tet;
  const uint8_t* polygon_corners;
  size_t corner_count;
  const uint32_t* corners;  /**< points */
  const double* parameters; /**< (u, v) per corner */
  size_t point_count;
  const double* points; /**< 3 per inner point of a face */
  const uint32_t* generator_tet;
  const uint8_t* generator_corners;
} hexhex_patch_arrays;
#define HEXHEX_PATCH_ARRAYS_INIT                                                                   \
  {                                                                                                \
    sizeof(hexhex_patch_arrays), 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL, 0, NULL, NULL, 0, \
        NULL, NULL, NULL                                                                           \
  }

/** The arrays belong to the mesh. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_get_arcs(const hexhex_piecewise_mesh* mesh,
                                                        hexhex_arc_arrays* arrays,
                                                        hexhex_error* error);
/** Without patches, all is empty. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_get_patches(const hexhex_piecewise_mesh* mesh,
                                                           hexhex_patch_arrays* arrays,
                                                           hexhex_error* error);
/** .vtu, .vtp, .ovmb. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_arcs(const hexhex_piecewise_mesh* mesh,
                                                          const char* file, hexhex_context* context,
                                                          hexhex_error* error);
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_patches(const hexhex_piecewise_mesh* mesh,
                                                             const char* file,
                                                             hexhex_context* context,
                                                             hexhex_error* error);
/** The same with the map that was extracted, so that .ovmb files tell the indices of the tet
 * simplices that points, edges and polygons lie in. A map that was repaired for the extraction is
 * replaced by the repaired one. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_arcs_with_map(
    const hexhex_piecewise_mesh* mesh, const hexhex_map* map, const char* file,
    hexhex_context* context, hexhex_error* error);
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_patches_with_map(
    const hexhex_piecewise_mesh* mesh, const hexhex_map* map, const char* file,
    hexhex_context* context, hexhex_error* error);

/** Hexahedra of a higher order: see LagrangeMesh in <hexhex/curved.hpp>. */
typedef struct hexhex_lagrange_mesh hexhex_lagrange_mesh;

/** The highest order. */
#define HEXHEX_MAX_ORDER 9

/** @param order  1 to HEXHEX_MAX_ORDER */
HEXHEX_API hexhex_status hexhex_extract_lagrange(const hexhex_map* map, int order,
                                                 const hexhex_extract_options* options,
                                                 hexhex_context* context,
                                                 hexhex_lagrange_mesh** mesh,
                                                 hexhex_statistics* statistics,
                                                 hexhex_error* error);
HEXHEX_API void hexhex_lagrange_mesh_destroy(hexhex_lagrange_mesh* mesh);

/** Both of a prepared map; scale times order is at most what the extractor was made for. */
HEXHEX_API hexhex_status hexhex_extractor_extract_piecewise(
    hexhex_extractor* extractor, int patches, const hexhex_extract_options* options,
    hexhex_context* context, hexhex_piecewise_mesh** mesh, hexhex_statistics* statistics,
    hexhex_error* error);
HEXHEX_API hexhex_status hexhex_extractor_extract_lagrange(hexhex_extractor* extractor, int order,
                                                           const hexhex_extract_options* options,
                                                           hexhex_context* context,
                                                           hexhex_lagrange_mesh** mesh,
                                                           hexhex_statistics* statistics,
                                                           hexhex_error* error);

/** As hexhex_mesh_get_repair(). */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_get_repair(const hexhex_lagrange_mesh* mesh,
                                                         hexhex_map** map,
                                                         hexhex_repair_report** report,
                                                         hexhex_error* error);

/** Cells of higher order from a file: see readLagrangeMesh() in <hexhex/curved.hpp>. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_read(const char* file, hexhex_context* context,
                                                   hexhex_lagrange_mesh** mesh,
                                                   hexhex_error* error);
/** @param[out] holds  1 if the file has such cells, else 0 */
HEXHEX_API hexhex_status hexhex_file_holds_lagrange(const char* file, hexhex_context* context,
                                                    int* holds, hexhex_error* error);

typedef struct hexhex_lagrange_arrays {
  size_t size;
  int order;
  const double* points; /**< 3 per node */
  size_t point_count;
  size_t vertex_count;   /**< the first so many nodes are the hex vertices */
  const uint32_t* nodes; /**< (order + 1)^3 per cell: node (i, j, k), i along 0-1, j along 0-3, k
                              along 0-4, is number i + (order + 1) (j + (order + 1) k) */
  size_t cell_count;
  const uint32_t* generator_tet; /**< per node, or NULL */
  const uint8_t* generator_corners;
  /* Of the straight mesh, as in hexhex_mesh_arrays: */
  const hexhex_feature_vertex* feature_vertices;
  size_t feature_vertex_count;
  const hexhex_feature_edge* feature_edges;
  size_t feature_edge_count;
  const hexhex_feature_quad* feature_quads;
  size_t feature_quad_count;
  const int32_t* regions; /**< per cell, or NULL */
} hexhex_lagrange_arrays;
#define HEXHEX_LAGRANGE_ARRAYS_INIT                                                                \
  {                                                                                                \
    sizeof(hexhex_lagrange_arrays), 0, NULL, 0, 0, NULL, 0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, \
        NULL                                                                                       \
  }

/** Cells with copies of the arrays, e.g. to write them.
 * @param arrays  order, points, vertex_count and nodes at least; what uses the mesh refuses arrays
 *                that do not fit each other with HEXHEX_INVALID_ARGUMENT */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_copy(const hexhex_lagrange_arrays* arrays,
                                                   hexhex_lagrange_mesh** mesh,
                                                   hexhex_error* error);

HEXHEX_API hexhex_status hexhex_lagrange_mesh_get_arrays(const hexhex_lagrange_mesh* mesh,
                                                         hexhex_lagrange_arrays* arrays,
                                                         hexhex_error* error);
/** Takes an array over, as hexhex_mesh_take(); HEXHEX_CELLS are the nodes. What needs the array is
 * HEXHEX_INVALID_ARGUMENT afterwards. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_take(hexhex_lagrange_mesh* mesh,
                                                   hexhex_mesh_array array, hexhex_buffer** buffer,
                                                   hexhex_error* error);
/** The straight mesh between the corners, with tags and regions, and the repair; a copy. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_straight(const hexhex_lagrange_mesh* mesh,
                                                       hexhex_mesh** straight, hexhex_error* error);
/** As hexhex_mesh_quality(), of curved cells: see scaledJacobians() in <hexhex/curved.hpp>. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_quality(const hexhex_lagrange_mesh* mesh,
                                                      hexhex_context* context,
                                                      double* scaled_jacobians,
                                                      hexhex_quality* quality, hexhex_error* error);

/** As hexhex_mesh_certify(), of curved cells. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_certify(const hexhex_lagrange_mesh* mesh,
                                                      hexhex_context* context, uint8_t* validity,
                                                      double* scaled_jacobians,
                                                      hexhex_certificate* certificate,
                                                      hexhex_error* error);
/** As hexhex_mesh_improve(), of cells of order 1 to 3: all nodes move, and vertices in the report
 * are nodes. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_improve(
    hexhex_lagrange_mesh* mesh, const hexhex_map* map, const hexhex_improve_options* options,
    hexhex_context* context, hexhex_improve_report* report, hexhex_error* error);
/** .vtu, .msh, .mesh (MFEM). */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_write(const hexhex_lagrange_mesh* mesh,
                                                    const char* file,
                                                    const hexhex_write_options* options,
                                                    hexhex_context* context, hexhex_error* error);

#ifdef __cplusplus
}
#endif
#undef HEXHEX_AS_INT

#endif
