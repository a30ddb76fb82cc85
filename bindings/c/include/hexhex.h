/* hexhex for C: hexahedral meshes from integer-grid maps.
 *
 * Conventions of this header
 *
 * - Functions that can fail return a hexhex_status and take a hexhex_error* as their last argument,
 *   which may be NULL. It receives the code, a message and the place. Errors are stored nowhere
 *   else: there is no global state. docs/user/errors.md explains each code.
 * - Functions return results through out parameters, which they set only on success. Handles are
 *   opaque; each hexhex_..._create or similar has a matching hexhex_..._destroy, and destroying
 *   NULL is allowed.
 * - Structs that may grow begin with `size`, the number of bytes known to the caller. Initialize
 *   them with their _INIT macro. A program compiled with an older or newer header works with this
 *   library, and gets HEXHEX_INVALID_ARGUMENT if it sets a member that the library does not know.
 *   Options may be NULL for all defaults.
 * - No exception leaves the library, running out of memory yields HEXHEX_OUT_OF_MEMORY, and nothing
 *   is ever printed.
 * - Threads: functions may run concurrently as long as no two of them use the same handle, unless
 *   both only read it (parameters that are pointers to const). hexhex_context_cancel() and
 *   hexhex_context_cancelled() may be called at any time. docs/user/api-c.md has the details
 *   for each function.
 * - Handles that are NULL, destroyed, of the wrong kind, or in use elsewhere yield
 *   HEXHEX_INVALID_ARGUMENT; functions without a status return 0 or NULL, or do nothing.
 *   docs/developer/reliability.md lists what cannot be detected.
 * - Enumerations are checked: values outside their range yield HEXHEX_INVALID_ARGUMENT.
 *
 * The corners of a hexahedron are in the order of VTK_HEXAHEDRON: 0 1 2 3 around one face, 4 5 6 7
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

/* Enumerations are passed as int, so that a value outside their range is an error. In C++, such a
 * value would be undefined behaviour otherwise. */
#ifdef __cplusplus
#define HEXHEX_AS_INT : int
extern "C" {
#else
#define HEXHEX_AS_INT
#endif

/* ---- Version and errors -------------------------------------------------------------------- */

/** Version of the library at run time, e.g. "1.0.0"; HEXHEX_VERSION is that of the headers. */
HEXHEX_API const char* hexhex_version(void);

/** Status codes. Values never change their meaning; new ones may be added. */
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

/** Name of a status as in docs/user/errors.md, e.g. "FlippedTet"; "Ok"; "Unknown". Never NULL. */
HEXHEX_API const char* hexhex_status_name(hexhex_status status);

/** Kinds of places: see hexhex_place. */
typedef enum hexhex_place_kind HEXHEX_AS_INT {
  HEXHEX_PLACE_NONE = 0,
  HEXHEX_PLACE_TET = 1,    /**< index: tet */
  HEXHEX_PLACE_FACE = 2,   /**< index: tet; second: the corner opposite the face, 0 to 3 */
  HEXHEX_PLACE_EDGE = 3,   /**< index, second: the vertices of the edge */
  HEXHEX_PLACE_VERTEX = 4, /**< index: vertex */
  HEXHEX_PLACE_LINE = 5,   /**< index: line of a file, starting at 1 */
  HEXHEX_PLACE_CELL = 6    /**< index: hexahedron */
} hexhex_place_kind;

typedef struct hexhex_place {
  hexhex_place_kind kind;
  uint64_t index;
  uint64_t second;
} hexhex_place;

/** Formats a place as text: "tet 12", "edge 3-17", "line 4"; "" if there is no place, and for
 * unknown kinds. Writes at most `size` bytes including the terminating zero, like snprintf(); text
 * may be NULL if size is 0.
 * @return the length of the full text, without the terminating zero */
HEXHEX_API size_t hexhex_place_text(const hexhex_place* place, char* text, size_t size);

/** An error with all its data. Owned by the caller. */
typedef struct hexhex_error {
  hexhex_status status;
  hexhex_place place;
  char message[1024]; /**< what is wrong, where, and what to do; UTF-8, truncated if longer */
} hexhex_error;

/* ---- Context: threads, progress, cancellation ------------------------------------------------ */

/** Execution context of long-running functions. They accept NULL: all cores, no progress. A context
 * serves one call at a time; using it for another call, even from its own progress function, yields
 * HEXHEX_INVALID_ARGUMENT. The progress function may call anything that uses other handles. */
typedef struct hexhex_context hexhex_context;

/** Called with the name of the stage and its completed fraction in [0, 1], at most a hundred times
 * per stage, from one thread at a time, which need not be the caller's. Returns 0 to continue,
 * anything else to cancel. Must return normally: no longjmp(), no exception. */
typedef int (*hexhex_progress)(void* user, const char* stage, double share);

typedef struct hexhex_context_options {
  size_t size;
  int threads;              /**< 0: all cores */
  hexhex_progress progress; /**< or NULL */
  void* user;               /**< passed to progress */
} hexhex_context_options;
#define HEXHEX_CONTEXT_OPTIONS_INIT \
  { sizeof(hexhex_context_options), 0, NULL, NULL }

HEXHEX_API hexhex_status hexhex_context_create(const hexhex_context_options* options,
                                               hexhex_context** context, hexhex_error* error);
HEXHEX_API void hexhex_context_destroy(hexhex_context* context);

/** Requests that current and future work of this context end soon with HEXHEX_CANCELLED. Safe to
 * call from any thread, and from a signal handler. */
HEXHEX_API void hexhex_context_cancel(hexhex_context* context);
/** 1 after hexhex_context_cancel(), otherwise 0; useful in your own sinks. Safe to call from any
 * thread. 0 for NULL. */
HEXHEX_API int hexhex_context_cancelled(const hexhex_context* context);
/** Number of threads that the context was created with; 0: all cores. 0 for NULL. */
HEXHEX_API int hexhex_context_threads(const hexhex_context* context);

/** Stages completed in this context so far: their number, and the name and wall-clock seconds of
 * one of them. The name is valid until the next call with this context or its destruction. */
HEXHEX_API size_t hexhex_context_stage_count(const hexhex_context* context);
HEXHEX_API hexhex_status hexhex_context_stage(const hexhex_context* context, size_t stage,
                                              const char** name, double* seconds,
                                              hexhex_error* error);

/* ---- Maps ------------------------------------------------------------------------------------ */

/** Valence offset of an edge: hexahedra around it minus 4 (inside) or 2 (on the boundary). */
typedef struct hexhex_edge_valence {
  uint32_t vertex0;
  uint32_t vertex1;
  int offset;
} hexhex_edge_valence;

/** Tagged vertices, edges and triangles of tet meshes, and quads of hex meshes, such as sharp
 * curves and named surfaces. Vertices of edges and triangles are in any order, those of quads in
 * cyclic order. <hexhex/extract.hpp> explains how tags of tets are transferred, and
 * docs/user/features.md tells more. */
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

/** Arrays of a tetrahedral mesh with an integer-grid map. */
typedef struct hexhex_map_arrays {
  size_t size;
  const double* points; /**< x, y, z of each vertex */
  size_t point_count;
  const uint32_t* tets; /**< four vertices of each tet, 0-based */
  size_t tet_count;
  const double* parameters; /**< u, v, w of corners 0, 1, 2, 3 of each tet, in its own chart */
  const hexhex_edge_valence* edge_valences; /**< or NULL: computed. Unlisted edges are regular */
  size_t edge_valence_count;
  const int8_t* rotations; /**< or NULL: computed. Four per tet: index 0 to 23 of the rotation
                              across the face opposite each corner, as in AlgoHex; -1 if unknown */
  const hexhex_feature_vertex* feature_vertices; /**< each element at most once */
  size_t feature_vertex_count;
  const hexhex_feature_edge* feature_edges;
  size_t feature_edge_count;
  const hexhex_feature_face* feature_faces;
  size_t feature_face_count;
  const int32_t* regions;           /**< or NULL: none. One per tet, inherited by cells */
  const hexhex_tag_name* tag_names; /**< names of groups that have one */
  size_t tag_name_count;
} hexhex_map_arrays;
#define HEXHEX_MAP_ARRAYS_INIT                                                                   \
  {                                                                                              \
    sizeof(hexhex_map_arrays), NULL, 0, NULL, 0, NULL, NULL, 0, NULL, NULL, 0, NULL, 0, NULL, 0, \
        NULL, NULL, 0                                                                            \
  }

/** A tetrahedral mesh with an integer-grid map. */
typedef struct hexhex_map hexhex_map;

/** Creates a map that uses the caller's arrays without copying them: they must outlive the map and
 * must not change. */
HEXHEX_API hexhex_status hexhex_map_borrow(const hexhex_map_arrays* arrays, hexhex_map** map,
                                           hexhex_error* error);

/** Creates a map with copies of the arrays. */
HEXHEX_API hexhex_status hexhex_map_copy(const hexhex_map_arrays* arrays, hexhex_map** map,
                                         hexhex_error* error);

/** See ReadOptions in <hexhex/io.hpp>. */
typedef struct hexhex_read_options {
  size_t size;
  const char* format;    /**< its name, see hexhex_get_format(); NULL: that of the extension */
  const char* map_array; /**< array that holds the map in .vtu and .vtk files; NULL: "igm" */
  int keep_walls;        /**< 1: interior walls listed in .hexex files become features with tag 2 */
  int hexes_only;        /**< 1: skips other volume cells of a mesh, which are an error otherwise */
} hexhex_read_options;
#define HEXHEX_READ_OPTIONS_INIT \
  { sizeof(hexhex_read_options), NULL, NULL, 0, 0 }

/** See WriteOptions in <hexhex/io.hpp>. */
typedef struct hexhex_write_options {
  size_t size;
  const char* format;             /**< name of the format; NULL: that of the extension */
  const char* map_array;          /**< for .vtu and .vtk files; NULL: "igm" */
  double patch_angle;             /**< for boundary groups, in degrees, 0 to 180 */
  int compress;                   /**< the arrays of .vtu files. 1: with zlib; 2: with LZ4 */
  const double* scaled_jacobians; /**< one per cell, if already available; NULL: computed */
} hexhex_write_options;
#define HEXHEX_WRITE_OPTIONS_INIT \
  { sizeof(hexhex_write_options), NULL, NULL, 40, 0, NULL }

/** Reads a map from a file: .hexex, .ovm, .ovmb, .vtu, .vtk. */
HEXHEX_API hexhex_status hexhex_map_read(const char* file, const hexhex_read_options* options,
                                         hexhex_context* context, hexhex_map** map,
                                         hexhex_error* error);
/** Writes a map; the file appears complete or not at all. Uses only the options format and
 * map_array. */
HEXHEX_API hexhex_status hexhex_map_write(const hexhex_map* map, const char* file,
                                          const hexhex_write_options* options,
                                          hexhex_context* context, hexhex_error* error);
/** Reads a tetrahedral mesh without a map from a file: the formats above, .mesh, .meshb and .msh.
 * The result has no parameters. */
HEXHEX_API hexhex_status hexhex_map_read_tets(const char* file, const hexhex_read_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** Reads a map from two files with meshes of the same tets, as written by polycube tools: the
 * points of the second mesh are the parameters of the first. */
HEXHEX_API hexhex_status hexhex_map_read_pair(const char* tets, const char* polycube,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** The same from arrays, of which only points and tets are used; copies them. */
HEXHEX_API hexhex_status hexhex_map_from_pair(const hexhex_map_arrays* tets,
                                              const hexhex_map_arrays* polycube,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_error* error);
/** Computes the seamless map of a polycube from labels of boundary triangles, as input for
 * hexhex_quantize(). See mapFromFlags() in <hexhex/quantize.hpp>.
 * @param tets   only points and tets are used
 * @param flags  4 per tet, for the faces opposite its corners: 0 to 5 for +x, -x, +y, -y, +z, -z;
 *               -1 inside */
HEXHEX_API hexhex_status hexhex_map_from_flags(const hexhex_map_arrays* tets, const int8_t* flags,
                                               hexhex_context* context, hexhex_map** map,
                                               hexhex_error* error);
/** The same from files. See readFlags() in <hexhex/io.hpp>.
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
  HEXHEX_CHARTS_SCATTERED = 3 /**< random for one tet in eight, aligned for the others */
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
  int cells;   /**< number of hexahedra along each block edge */
  int refine;  /**< number of tet sub-blocks along each block edge */
  int valence; /**< for "star" */
  hexhex_chart_style charts;
  double jitter;
  double on_lattice;
  double noise;
  double offset;
  uint64_t seed;
  int features; /**< 1: tag corners, curves and surfaces, and number the blocks as regions */
  int defects;  /**< minimum number of flipped or flat tets */
  hexhex_defect_kind defect_kind;
} hexhex_sample_options;
#define HEXHEX_SAMPLE_OPTIONS_INIT                                                      \
  {                                                                                     \
    sizeof(hexhex_sample_options), 4, 2, 5, HEXHEX_CHARTS_ALIGNED, 0, 0, 0, 0, 1, 0, 0, \
        HEXHEX_DEFECTS_INTERIOR                                                         \
  }

/** Generates a map whose mesh is known in advance: see hexhex_map_get_answer().
 * @param kind  "box", "cylinder", "sphere", "star", "tetrahedron", "torus", "shell", "handle-body"
 */
HEXHEX_API hexhex_status hexhex_map_generate(const char* kind, const hexhex_sample_options* options,
                                             hexhex_map** map, hexhex_error* error);

/** Number of kinds of maps that can be generated. */
HEXHEX_API size_t hexhex_sample_kind_count(void);
/** Name and description of a kind of map. The strings are valid for the lifetime of the program.
 * @param[out] name, description  or NULL */
HEXHEX_API hexhex_status hexhex_get_sample_kind(size_t number, const char** name,
                                                const char** description, hexhex_error* error);
/** Name of a kind of defect, e.g. "interior"; "Unknown" for invalid values. */
HEXHEX_API const char* hexhex_defect_kind_name(hexhex_defect_kind kind);

/** Known properties of the mesh of a generated map, at scale 1 and without its defects: see
 * SampleAnswer in <hexhex/samples.hpp>. */
typedef struct hexhex_sample_answer {
  size_t size;
  uint64_t cells;
  uint64_t vertices;
  uint64_t boundary_quads;
  int64_t euler_characteristic;
  uint64_t components;
  uint64_t boundary_components;
  uint64_t regions; /**< number of blocks; 0 without features */
} hexhex_sample_answer;
#define HEXHEX_SAMPLE_ANSWER_INIT \
  { sizeof(hexhex_sample_answer), 0, 0, 0, 0, 0, 0, 0 }

/** @param map             made by hexhex_map_generate(); others yield HEXHEX_INVALID_ARGUMENT
 *  @param[in,out] answer  initialized with HEXHEX_SAMPLE_ANSWER_INIT */
HEXHEX_API hexhex_status hexhex_map_get_answer(const hexhex_map* map, hexhex_sample_answer* answer,
                                               hexhex_error* error);

/** Tables of an answer: number of mesh elements for each key. */
typedef enum hexhex_answer_table HEXHEX_AS_INT {
  HEXHEX_ANSWER_INNER_EDGES = 0,     /**< singular hex edges inside, by valence */
  HEXHEX_ANSWER_BOUNDARY_EDGES = 1,  /**< singular hex edges on the boundary, by valence */
  HEXHEX_ANSWER_TAGGED_VERTICES = 2, /**< hex vertices, by tag */
  HEXHEX_ANSWER_TAGGED_EDGES = 3,    /**< hex edges, by tag */
  HEXHEX_ANSWER_TAGGED_QUADS = 4     /**< hex faces, by tag */
} hexhex_answer_table;

/** @param[out] entries  number of entries in the table */
HEXHEX_API hexhex_status hexhex_map_count_answer(const hexhex_map* map, hexhex_answer_table table,
                                                 size_t* entries, hexhex_error* error);
/** Returns one entry; entries are in ascending order of keys.
 * @param[out] key, count  or NULL */
HEXHEX_API hexhex_status hexhex_map_get_answer_entry(const hexhex_map* map,
                                                     hexhex_answer_table table, size_t number,
                                                     int32_t* key, uint64_t* count,
                                                     hexhex_error* error);

/** Returns the arrays of a map, which owns them.
 * @param[in,out] arrays  initialized with HEXHEX_MAP_ARRAYS_INIT */
HEXHEX_API hexhex_status hexhex_map_get_arrays(const hexhex_map* map, hexhex_map_arrays* arrays,
                                               hexhex_error* error);
HEXHEX_API void hexhex_map_destroy(hexhex_map* map);

/* ---- Meshes ---------------------------------------------------------------------------------- */

/** Arrays of a hexahedral mesh. */
typedef struct hexhex_mesh_arrays {
  size_t size;
  const double* points; /**< x, y, z of each vertex */
  size_t point_count;
  const uint32_t* cells; /**< eight vertices of each cell, 0-based, ordered as above */
  size_t cell_count;
  const uint32_t* generator_tet;    /**< per vertex, or NULL: a tet that contains its generator */
  const uint8_t* generator_corners; /**< per vertex, or NULL: the generator (the vertex, edge, face
                                       or tet whose interior contains the vertex) as corners of that
                                       tet: bit i for corner i */
  const hexhex_feature_vertex* feature_vertices; /**< tagged elements of the mesh */
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

/** Dimension of a generator: 0 vertex, 1 edge, 2 face, 3 tet; -1 for invalid values.
 * @param corners  as in hexhex_mesh_arrays, 1 to 15 */
HEXHEX_API int hexhex_generator_kind(uint8_t corners);

/** Creates a mesh with copies of the arrays, e.g. to write or verify it. */
HEXHEX_API hexhex_status hexhex_mesh_copy(const hexhex_mesh_arrays* arrays, hexhex_mesh** mesh,
                                          hexhex_error* error);
/** Reads a mesh from a file: see readHexMesh() in <hexhex/io.hpp>. */
HEXHEX_API hexhex_status hexhex_mesh_read(const char* file, const hexhex_read_options* options,
                                          hexhex_context* context, hexhex_mesh** mesh,
                                          hexhex_error* error);
/** Reads whatever a file holds: a mesh or, if there are no hexahedra, a map; the other one is set
 * to NULL. */
HEXHEX_API hexhex_status hexhex_read(const char* file, const hexhex_read_options* options,
                                     hexhex_context* context, hexhex_map** map, hexhex_mesh** mesh,
                                     hexhex_error* error);
/** Writes a mesh; the file appears complete or not at all. */
HEXHEX_API hexhex_status hexhex_mesh_write(const hexhex_mesh* mesh, const char* file,
                                           const hexhex_write_options* options,
                                           hexhex_context* context, hexhex_error* error);

/** A file format: see FileFormat in <hexhex/io.hpp>. The strings are valid for the lifetime of the
 * program. */
typedef struct hexhex_file_format {
  size_t size;
  const char* name;
  const char* extension; /**< including the dot; "": the format must be requested by name */
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

/** Formats of this build. */
HEXHEX_API size_t hexhex_format_count(void);
HEXHEX_API hexhex_status hexhex_get_format(size_t number, hexhex_file_format* format,
                                           hexhex_error* error);

/** Kinds of output files. */
typedef enum hexhex_output HEXHEX_AS_INT {
  HEXHEX_OUTPUT_MAP = 0,
  HEXHEX_OUTPUT_MESH = 1,
  HEXHEX_OUTPUT_ARCS = 2,
  HEXHEX_OUTPUT_PATCHES = 3,
  HEXHEX_OUTPUT_LAGRANGE = 4
} hexhex_output;

/** Returns HEXHEX_FILE_UNSUPPORTED unless the file's extension, or the format of the options,
 * supports this output, so that unsupported formats are detected before long work. */
HEXHEX_API hexhex_status hexhex_require_format(hexhex_output output, const char* file,
                                               const hexhex_write_options* options,
                                               hexhex_error* error);

/** Returns the arrays of a mesh, which owns them. Empty arrays are NULL.
 * @param[in,out] arrays  initialized with HEXHEX_MESH_ARRAYS_INIT */
HEXHEX_API hexhex_status hexhex_mesh_get_arrays(const hexhex_mesh* mesh, hexhex_mesh_arrays* arrays,
                                                hexhex_error* error);

/** Owner of an array that was taken from a mesh. */
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

/** Takes over an array without a copy: the mesh loses it, and the array lives until
 * hexhex_buffer_destroy(), whatever happens to the mesh. */
HEXHEX_API hexhex_status hexhex_mesh_take(hexhex_mesh* mesh, hexhex_mesh_array array,
                                          hexhex_buffer** buffer, hexhex_error* error);
/** First element of the array (NULL if it is empty), which is writable, and its size in bytes. */
HEXHEX_API void* hexhex_buffer_data(hexhex_buffer* buffer);
HEXHEX_API size_t hexhex_buffer_bytes(const hexhex_buffer* buffer);
HEXHEX_API void hexhex_buffer_destroy(hexhex_buffer* buffer);

HEXHEX_API void hexhex_mesh_destroy(hexhex_mesh* mesh);

/** Returns the boundary quads, facing outwards and tagged by smooth patch: see
 * <hexhex/patches.hpp>.
 * @param angle       in degrees, 0 to 180: patches end where the boundary turns by more
 * @param[out] quads  array of hexhex_feature_quad */
HEXHEX_API hexhex_status hexhex_mesh_boundary_patches(const hexhex_mesh* mesh, double angle,
                                                      hexhex_context* context,
                                                      hexhex_buffer** quads, hexhex_error* error);

/** A singular edge of a hex mesh. */
typedef struct hexhex_singular_edge {
  uint32_t vertices[2]; /**< ascending */
  uint32_t valence;     /**< number of cells around the edge */
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

/** @param[out] structure       initialized with HEXHEX_STRUCTURE_INIT, or NULL
 *  @param[out] singular_edges  array of hexhex_singular_edge, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_structure(const hexhex_mesh* mesh, hexhex_context* context,
                                               hexhex_structure* structure,
                                               hexhex_buffer** singular_edges, hexhex_error* error);

/* ---- Repair ---------------------------------------------------------------------------------- */

/** 1 if this build supports repair (requires Eigen). */
HEXHEX_API int hexhex_can_repair(void);

/** See RepairOptions in <hexhex/repair.hpp>. */
typedef struct hexhex_repair_options {
  size_t size;
  double tolerance; /**< as in hexhex_extract_options */
  int scale;        /**< upper bound for later scaling of the map */
  int round;        /**< 1: first round coordinates that deviate from integers by up to 0.1 */
  int refine;       /**< 1: allow splitting edges of the tet mesh */
} hexhex_repair_options;
#define HEXHEX_REPAIR_OPTIONS_INIT \
  { sizeof(hexhex_repair_options), 1e-2, 1, 0, 1 }

/** Report of a repair. */
typedef struct hexhex_repair_report hexhex_repair_report;

/** Returns a valid map that is identical, bit for bit, where the input was valid. See
 * <hexhex/repair.hpp>.
 * @param[out] report  or NULL; also set if the repair fails, unless the code is
 *                     HEXHEX_INVALID_ARGUMENT or HEXHEX_OUT_OF_MEMORY, in which case it is set to
 *                     NULL */
HEXHEX_API hexhex_status hexhex_repair(const hexhex_map* map, const hexhex_repair_options* options,
                                       hexhex_context* context, hexhex_map** repaired,
                                       hexhex_repair_report** report, hexhex_error* error);
HEXHEX_API void hexhex_repair_report_destroy(hexhex_repair_report* report);

typedef struct hexhex_repair_summary {
  size_t size;
  int changed; /**< 0 if the map was valid */
  size_t region_count;
  uint64_t bad_tets;
  uint64_t moved_vertices;
  double largest_move; /**< largest change of a coordinate, in parameter units */
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

/** Result of a repair at one place. */
typedef struct hexhex_repaired_region {
  size_t size;
  hexhex_place place; /**< a bad tet */
  double position[3]; /**< in space */
  uint64_t bad_tets;
  uint64_t tets; /**< in the optimized patch */
  uint64_t moved_vertices;
  double largest_move;
} hexhex_repaired_region;
#define HEXHEX_REPAIRED_REGION_INIT \
  { sizeof(hexhex_repaired_region), {HEXHEX_PLACE_NONE, 0, 0}, {0}, 0, 0, 0, 0 }

HEXHEX_API hexhex_status hexhex_repair_get_region(const hexhex_repair_report* report, size_t number,
                                                  hexhex_repaired_region* region,
                                                  hexhex_error* error);

/* ---- Quantization ---------------------------------------------------------------------------- */

/** 1 if this build supports quantization (requires Eigen). */
HEXHEX_API int hexhex_can_quantize(void);

/** See QuantizeOptions in <hexhex/quantize.hpp>. Set exactly one of the first three. */
typedef struct hexhex_quantize_options {
  size_t size;
  double cells;       /**< desired number of hexahedra */
  double scale;       /**< approximate scale factor for the parameters of the map */
  double edge_length; /**< average edge length of a hexahedron in space */
  int densify;        /**< 1: if no valid map is found, use the first finer one that works */
  int32_t wall_tag;   /**< interior triangles with this tag need not remain planes; 0: none */
  double tolerance;   /**< maximum deviation from seamlessness, relative to the extent of the map */
} hexhex_quantize_options;
#define HEXHEX_QUANTIZE_OPTIONS_INIT \
  { sizeof(hexhex_quantize_options), 0, 0, 0, 0, 0, 1e-5 }

/** Report of a quantization. See QuantizeReport and MapDistortion in <hexhex/quantize.hpp>. */
typedef struct hexhex_quantize_report {
  size_t size;
  double cells_wanted;
  uint64_t cells;
  double scale;        /**< final scale of the seamless map's parameters */
  double displacement; /**< largest change of a parameter needed to make the map seamless */
  uint64_t blocks;     /**< in the motorcycle complex */
  uint64_t arcs;
  uint64_t shortest_arc; /**< in hexahedra */
  uint64_t longest_arc;
  char integers_by[16]; /**< "HiGHS", or "rounding" if HiGHS is not available */
  uint64_t attempts;    /**< number of target cell counts tried */
  uint64_t split_edges; /**< each split adds a vertex to the tet mesh */
  uint64_t added_tets;
  double worst_before; /**< distortion of the map as a scaled Jacobian, at most 1 */
  double median_before;
  double worst_after;
  double median_after;
} hexhex_quantize_report;
#define HEXHEX_QUANTIZE_REPORT_INIT \
  { sizeof(hexhex_quantize_report), 0, 0, 0, 0, 0, 0, 0, 0, {0}, 0, 0, 0, 0, 0, 0, 0 }

/** Computes an integer-grid map from a seamless one. See <hexhex/quantize.hpp>.
 * @param options      include the target resolution: not NULL
 * @param[out] report  initialized with HEXHEX_QUANTIZE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_quantize(const hexhex_map* map,
                                         const hexhex_quantize_options* options,
                                         hexhex_context* context, hexhex_map** quantized,
                                         hexhex_quantize_report* report, hexhex_error* error);

/** How far a map is from an integer-grid map. */
typedef enum hexhex_seamless_kind HEXHEX_AS_INT {
  HEXHEX_SEAMLESS = 0,        /**< suitable for hexhex_quantize() with its default tolerance */
  HEXHEX_ALMOST_SEAMLESS = 1, /**< seamless to within a hundredth of its extent */
  HEXHEX_NOT_SEAMLESS = 2     /**< also if hexhex_can_quantize() is 0 */
} hexhex_seamless_kind;

/** See SeamlessReport in <hexhex/quantize.hpp>. */
typedef struct hexhex_seamless_report {
  size_t size;
  hexhex_seamless_kind kind;
  double displacement; /**< of the nearest seamless map, in parameter units; 0 if there is none */
  double cells;        /**< its volume, in unit cubes */
  char problem[1024];  /**< why it is not seamless; UTF-8, truncated if longer */
} hexhex_seamless_report;
#define HEXHEX_SEAMLESS_REPORT_INIT                                  \
  {                                                                  \
    sizeof(hexhex_seamless_report), HEXHEX_NOT_SEAMLESS, 0, 0, { 0 } \
  }

/** Checks whether a map is suitable for hexhex_quantize().
 * @param[out] report  initialized with HEXHEX_SEAMLESS_REPORT_INIT */
HEXHEX_API hexhex_status hexhex_examine_seamless(const hexhex_map* map, hexhex_context* context,
                                                 hexhex_seamless_report* report,
                                                 hexhex_error* error);

/* ---- Extraction ------------------------------------------------------------------------------ */

typedef enum hexhex_engine HEXHEX_AS_INT {
  HEXHEX_ENGINE_ATLAS = 0,    /**< the fast engine */
  HEXHEX_ENGINE_PROPELLER = 1 /**< the algorithm of the paper: the same mesh, bit for bit */
} hexhex_engine;

/** Placement of the nodes of higher-order cells: see CurvedNodes in <hexhex/extract.hpp>. */
typedef enum hexhex_curved_nodes HEXHEX_AS_INT {
  HEXHEX_NODES_BLENDED = 0, /**< on the surface; blended inside, so that no cell folds over */
  HEXHEX_NODES_EXACT = 1    /**< all where the map puts them */
} hexhex_curved_nodes;

typedef struct hexhex_extract_options {
  size_t size;
  hexhex_engine engine;
  int scale; /**< factor for all parameters: yields scale^3 times as many cells; at least 1 */
  double tolerance; /**< maximum violation of the integer conditions by the map, below 0.25 */
  int repair;       /**< 1: repair a map with flipped or flat tets first */
  int round;        /**< as in hexhex_repair_options, if the map is repaired */
  hexhex_curved_nodes curved_nodes;
} hexhex_extract_options;
#define HEXHEX_EXTRACT_OPTIONS_INIT \
  { sizeof(hexhex_extract_options), HEXHEX_ENGINE_ATLAS, 1, 1e-2, 0, 0, HEXHEX_NODES_BLENDED }

/** Statistics of an extraction. ExtractStatistics in <hexhex/extract.hpp> explains the fields;
 * arrays are indexed by kind of generator: vertex, edge, face, cell. */
typedef struct hexhex_statistics {
  size_t size;
  double seconds;
  int threads;
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
} hexhex_statistics;
#define HEXHEX_STATISTICS_INIT \
  { sizeof(hexhex_statistics), 0, 0, 0, 0, 0, 0, 0, 0, 0, {0}, {0}, 0, 0, 0, 0, 0, 0 }

/** Extracts the hexahedral mesh of a map.
 * @param[out] statistics  initialized with HEXHEX_STATISTICS_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_extract(const hexhex_map* map,
                                        const hexhex_extract_options* options,
                                        hexhex_context* context, hexhex_mesh** mesh,
                                        hexhex_statistics* statistics, hexhex_error* error);

/** Returns the repaired map, from which the mesh was extracted and to whose tets its generators
 * refer, and the report of the repair. These are separate handles that the caller must destroy;
 * they are NULL if nothing was repaired.
 * @param[out] map, report  or NULL */
HEXHEX_API hexhex_status hexhex_mesh_get_repair(const hexhex_mesh* mesh, hexhex_map** map,
                                                hexhex_repair_report** report, hexhex_error* error);
/** The same for the last extraction in pieces with this context, by hexhex_extract_to() or
 * hexhex_extract_to_file(), which return no mesh. The context keeps the map until the next one. */
HEXHEX_API hexhex_status hexhex_context_get_repair(const hexhex_context* context, hexhex_map** map,
                                                   hexhex_repair_report** report,
                                                   hexhex_error* error);

/** Options for partial extraction from invalid maps: see <hexhex/partial.hpp>. */
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
  uint32_t tet; /**< the smallest tet of the hole */
  uint64_t tets;
  uint64_t invalid_tets;
  double position[3];
  double missing_cells;
} hexhex_hole;
#define HEXHEX_HOLE_INIT \
  { sizeof(hexhex_hole), 0, 0, 0, {0}, 0 }

/** Returns a hole; those with the most missing cells come first. */
HEXHEX_API hexhex_status hexhex_holes_get(const hexhex_holes* holes, size_t number,
                                          hexhex_hole* hole, hexhex_error* error);

/** A prepared map for extracting several meshes. See <hexhex/extractor.hpp>. */
typedef struct hexhex_extractor hexhex_extractor;

/** @param map        kept by the extractor: its handle may be destroyed earlier, but arrays that it
 *                    borrows must remain valid
 *  @param tolerance  as in hexhex_extract_options
 *  @param max_scale  the largest scale that will be requested, times the order; below 256, meshes
 *                    are identical to those of hexhex_extract(), bit for bit */
HEXHEX_API hexhex_status hexhex_extractor_create(const hexhex_map* map, double tolerance,
                                                 int max_scale, hexhex_context* context,
                                                 hexhex_extractor** extractor, hexhex_error* error);
/** Like hexhex_extract(); ignores options->tolerance, repair and round. */
HEXHEX_API hexhex_status hexhex_extractor_extract(hexhex_extractor* extractor,
                                                  const hexhex_extract_options* options,
                                                  hexhex_context* context, hexhex_mesh** mesh,
                                                  hexhex_statistics* statistics,
                                                  hexhex_error* error);
HEXHEX_API void hexhex_extractor_destroy(hexhex_extractor* extractor);
/** Number of cells at scale 1; there are scale^3 times as many at other scales. 0 for NULL. */
HEXHEX_API uint64_t hexhex_extractor_cells(const hexhex_extractor* extractor);

/* ---- Extraction in pieces -------------------------------------------------------------------- */

/** Receives a mesh in pieces: begin, then all points in order, then all cells in order, then end;
 * from one thread at a time. Each function returns 0 to continue, anything else to cancel, and must
 * return normally. Pointers are valid only during the call. Members may be NULL. */
typedef struct hexhex_sink {
  size_t size;
  void* user; /**< passed to all functions */
  int (*begin)(void* user, uint64_t point_count, uint64_t cell_count);
  /** Vertices starting at number `first`; generator arrays as in hexhex_mesh_arrays, or NULL. */
  int (*points)(void* user, uint64_t first, size_t count, const double* points,
                const uint32_t* generator_tet, const uint8_t* generator_corners);
  /** Cells starting at number `first`, for meshes of up to 2^32 - 2 vertices. */
  int (*cells)(void* user, uint64_t first, size_t count, const uint32_t* cells);
  /** The same for larger meshes. If NULL, these yield HEXHEX_TOO_LARGE. */
  int (*cells64)(void* user, uint64_t first, size_t count, const uint64_t* cells);
  int (*end)(void* user);
} hexhex_sink;
#define HEXHEX_SINK_INIT \
  { sizeof(hexhex_sink), NULL, NULL, NULL, NULL, NULL, NULL }

/** Extracts the same mesh as hexhex_extract(), bit for bit, using the atlas engine, but never holds
 * all of it in memory. */
HEXHEX_API hexhex_status hexhex_extract_to(const hexhex_sink* sink, const hexhex_map* map,
                                           const hexhex_extract_options* options,
                                           hexhex_context* context, hexhex_statistics* statistics,
                                           hexhex_error* error);
/** The same for a prepared map. */
HEXHEX_API hexhex_status hexhex_extractor_extract_to(
    hexhex_extractor* extractor, const hexhex_sink* sink, const hexhex_extract_options* options,
    hexhex_context* context, hexhex_statistics* statistics, hexhex_error* error);
/** The same, to a file, .vtu or .mesh. */
HEXHEX_API hexhex_status hexhex_extract_to_file(const char* file, const hexhex_map* map,
                                                const hexhex_extract_options* options,
                                                hexhex_context* context,
                                                hexhex_statistics* statistics, hexhex_error* error);
/** Reads a mesh from a file and passes it on in pieces. */
HEXHEX_API hexhex_status hexhex_mesh_read_to(const hexhex_sink* sink, const char* file,
                                             const hexhex_read_options* options,
                                             hexhex_context* context, hexhex_error* error);

/** Writes a mesh to a file in pieces from the caller: see openMeshSink() in <hexhex/io.hpp>. */
typedef struct hexhex_mesh_writer hexhex_mesh_writer;

/** Call this, then begin, all points in order, all cells in order, and end. The complete file
 * appears at end; a writer destroyed earlier leaves nothing behind.
 * @param context  used by this writer only, which keeps it; or NULL */
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
/** Returns the writer as a sink for the functions above. Pieces go directly to it; whatever it
 * rejects becomes the error of the calling function.
 * @param[out] sink  initialized with HEXHEX_SINK_INIT; valid as long as the writer */
HEXHEX_API hexhex_status hexhex_mesh_writer_sink(hexhex_mesh_writer* writer, hexhex_sink* sink,
                                                 hexhex_error* error);

/** Summary of a mesh: see MeshSummary in <hexhex/summary.hpp>. */
typedef struct hexhex_mesh_summary {
  size_t size;
  uint64_t points;
  uint64_t cells;
  double lower[3]; /**< corners of the bounding box */
  double upper[3];
  uint64_t point_checksum;
  uint64_t cell_checksum;
} hexhex_mesh_summary;
#define HEXHEX_MESH_SUMMARY_INIT \
  { sizeof(hexhex_mesh_summary), 0, 0, {0}, {0}, 0, 0 }

HEXHEX_API hexhex_status hexhex_summarize_mesh(const hexhex_mesh* mesh, hexhex_context* context,
                                               hexhex_mesh_summary* summary, hexhex_error* error);
HEXHEX_API hexhex_status hexhex_summarize_file(const char* file, const hexhex_read_options* options,
                                               hexhex_context* context,
                                               hexhex_mesh_summary* summary, hexhex_error* error);
/** Creates a writer without a file that summarizes what it receives; query it after end.
 * @param context  as for hexhex_mesh_writer_create() */
HEXHEX_API hexhex_status hexhex_summary_writer_create(hexhex_context* context,
                                                      hexhex_mesh_writer** writer,
                                                      hexhex_error* error);
HEXHEX_API hexhex_status hexhex_summary_writer_get(const hexhex_mesh_writer* writer,
                                                   hexhex_mesh_summary* summary,
                                                   hexhex_error* error);

/* ---- Checking maps --------------------------------------------------------------------------- */

/** Properties of a map, the mesh to expect, and the defects of the map. */
typedef struct hexhex_check_report hexhex_check_report;

/** Collects all violated conditions instead of stopping at the first. A map that violates some is
 * not an error of this function.
 * @param tolerance  as in hexhex_extract_options
 * @param scale      of the expected mesh */
HEXHEX_API hexhex_status hexhex_check(const hexhex_map* map, double tolerance, int scale,
                                      hexhex_context* context, hexhex_check_report** report,
                                      hexhex_error* error);
HEXHEX_API void hexhex_check_report_destroy(hexhex_check_report* report);

/** Numbers in a report: see CheckReport and Expectation in <hexhex/check.hpp>. */
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
  /* Of the expected mesh, if valid: */
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

/** A violated condition; the report owns what it points to. */
typedef struct hexhex_defect {
  size_t size;
  hexhex_status code;
  const char* sentence; /**< what is wrong and what to do */
  uint64_t count;       /**< number of all occurrences */
  size_t worst_count;   /**< number of places available: at most ten, worst first */
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

/** Returns the genus of one boundary component; components are in descending order of genus.
 * @param[out] genus  -1 if there is no such component */
HEXHEX_API void hexhex_check_boundary_genus(const hexhex_check_report* report, size_t component,
                                            int64_t* genus);

/** Tables of edges by valence (number of hexahedra around an edge). */
typedef enum hexhex_valence_table HEXHEX_AS_INT {
  HEXHEX_INNER_HEX_EDGES = 0, /**< expected singular edges of the mesh */
  HEXHEX_BOUNDARY_HEX_EDGES = 1,
  HEXHEX_INNER_TET_EDGES = 2, /**< singular edges of the map */
  HEXHEX_BOUNDARY_TET_EDGES = 3
} hexhex_valence_table;

/** Number of edges with a valence; 0 if there are none. */
HEXHEX_API uint64_t hexhex_check_edges_of_valence(const hexhex_check_report* report,
                                                  hexhex_valence_table table, int valence);
/** The smallest valence in the table above `valence` (start with -1), or -1 if there is none. */
HEXHEX_API int hexhex_check_next_valence(const hexhex_check_report* report,
                                         hexhex_valence_table table, int valence);

/** Structure of a map, for visualization: see <hexhex/map_structure.hpp>. */
typedef struct hexhex_map_structure hexhex_map_structure;

/** An inner face between tets with different charts. Its transition maps parameters u in the chart
 * of tets[0] to R u + t in the chart of tets[1]. */
typedef struct hexhex_chart_jump {
  uint32_t tets[2];      /**< ascending */
  uint32_t vertices[3];  /**< of the face, in the order of the corners of tets[0] */
  int8_t rotation[9];    /**< R, row by row */
  double translation[3]; /**< t; integers */
} hexhex_chart_jump;

/** An edge of the tet mesh whose number of hexahedra is not 4 (inside) or 2 (on the boundary). */
typedef struct hexhex_singular_tet_edge {
  uint32_t vertices[2]; /**< ascending */
  int32_t valence;      /**< number of hexahedra around the edge */
  uint32_t boundary;    /**< 1 on the boundary */
} hexhex_singular_tet_edge;

/** Finds chart jumps and singular edges, as far as possible even for a map with defects: a map that
 * violates conditions is not an error of this function.
 * @param tolerance  as in hexhex_extract_options */
HEXHEX_API hexhex_status hexhex_map_find_structure(const hexhex_map* map, double tolerance,
                                                   hexhex_context* context,
                                                   hexhex_map_structure** structure,
                                                   hexhex_error* error);
HEXHEX_API void hexhex_map_structure_destroy(hexhex_map_structure* structure);

/** The lists of a structure, which owns them. Empty lists are NULL. */
typedef struct hexhex_map_structure_arrays {
  size_t size;
  const hexhex_chart_jump* chart_jumps; /**< sorted by tets[0], then the corner opposite the face */
  size_t chart_jump_count;
  const hexhex_singular_tet_edge* singular_edges; /**< sorted by vertices */
  size_t singular_edge_count;
  size_t defect_count; /**< number of defects of the map; hexhex_check() describes them */
} hexhex_map_structure_arrays;
#define HEXHEX_MAP_STRUCTURE_ARRAYS_INIT \
  { sizeof(hexhex_map_structure_arrays), NULL, 0, NULL, 0, 0 }

HEXHEX_API hexhex_status hexhex_map_structure_get_arrays(const hexhex_map_structure* structure,
                                                         hexhex_map_structure_arrays* arrays,
                                                         hexhex_error* error);

/* ---- Verifying meshes ------------------------------------------------------------------------ */

/** Result of comparing a mesh with its map, check by check. */
typedef struct hexhex_verify_report hexhex_verify_report;

/** Passes for the mesh of the map, in any numbering and with cells in any orientation, and for no
 * other mesh. A mesh that does not match is not an error of this function.
 * @param tolerance  of the map, as in hexhex_extract_options
 * @param scale      with which the mesh was extracted */
HEXHEX_API hexhex_status hexhex_verify(const hexhex_map* map, const hexhex_mesh* mesh,
                                       double tolerance, int scale, hexhex_context* context,
                                       hexhex_verify_report** report, hexhex_error* error);
HEXHEX_API void hexhex_verify_report_destroy(hexhex_verify_report* report);

/** 1 if all checks passed. */
HEXHEX_API int hexhex_verify_passed(const hexhex_verify_report* report);
HEXHEX_API size_t hexhex_verify_item_count(const hexhex_verify_report* report);

/** One check; the report owns the strings. */
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

/** Scaled Jacobian of a hexahedron, in [-1, 1]: see <hexhex/quality.hpp>.
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
 *  @param[out] quality           initialized with HEXHEX_QUALITY_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_quality(const hexhex_mesh* mesh, hexhex_context* context,
                                             double* scaled_jacobians, hexhex_quality* quality,
                                             hexhex_error* error);

/** The same for values that the caller provides, e.g. for a subset of the cells.
 * @param values  `count` scaled Jacobians */
HEXHEX_API hexhex_status hexhex_summarize_quality(const double* values, size_t count,
                                                  hexhex_quality* quality, hexhex_error* error);

/** Whether the Jacobian determinant of a cell is positive everywhere: see Validity in
 * <hexhex/quality.hpp>. */
typedef enum hexhex_validity HEXHEX_AS_INT {
  HEXHEX_POSITIVE = 0,
  HEXHEX_REFUTED = 1,  /**< negative or zero somewhere, or not finite */
  HEXHEX_UNDECIDED = 2 /**< closer to zero than a search of bounded length can resolve */
} hexhex_validity;

/** A cell that is not positive, and where. */
typedef struct hexhex_refuted_cell {
  uint64_t cell;
  double place[3]; /**< in the cell: u, v, w in [0, 1], along the edges from corner 0 to 1, 3, 4 */
  double position[3];     /**< in space */
  double scaled_jacobian; /**< the value there; not positive */
} hexhex_refuted_cell;

/** What is proven about a mesh: see Certificate in <hexhex/quality.hpp>. */
typedef struct hexhex_certificate {
  size_t size;
  uint64_t positive; /**< number of cells */
  uint64_t refuted;
  uint64_t undecided;
  double minimum;     /**< lower bound of the scaled Jacobian, including the interior of cells */
  size_t worst_count; /**< at most 10 */
  hexhex_refuted_cell worst[10]; /**< most negative first */
} hexhex_certificate;
#define HEXHEX_CERTIFICATE_INIT                  \
  {                                              \
    sizeof(hexhex_certificate), 0, 0, 0, 0, 0, { \
      { 0, {0, 0, 0}, {0, 0, 0}, 0 }             \
    }                                            \
  }

/** Determines whether cells are positive everywhere, and their quality, in a single pass.
 * @param[out] validity          a hexhex_validity per cell, or NULL
 * @param[out] scaled_jacobians  one per cell, as in hexhex_mesh_quality(), or NULL
 * @param[out] certificate       initialized with HEXHEX_CERTIFICATE_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_certify(const hexhex_mesh* mesh, hexhex_context* context,
                                             uint8_t* validity, double* scaled_jacobians,
                                             hexhex_certificate* certificate, hexhex_error* error);

/* ---- Improvement ----------------------------------------------------------------------------- */

/** Whether to add a layer of cells under the boundary; see PillowMode in <hexhex/improve.hpp>. */
typedef enum hexhex_pillow_mode HEXHEX_AS_INT {
  HEXHEX_PILLOW_NEVER = 0,
  HEXHEX_PILLOW_AUTO = 1,  /**< if it improves the mesh */
  HEXHEX_PILLOW_ALWAYS = 2 /**< report an error if it is impossible */
} hexhex_pillow_mode;

/** See ImproveOptions in <hexhex/improve.hpp>. */
typedef struct hexhex_improve_options {
  size_t size;
  double target;        /**< improve cells with a smaller scaled Jacobian; 0 to 1 */
  int passes;           /**< final passes over all vertices; 0 to 1000 */
  int fix_boundary;     /**< 1: keep vertices on the surface fixed */
  double feature_angle; /**< sharper edges of the surface are curves; degrees, 0 to 180 */
  double slack;         /**< how far vertices may leave the surface, if needed; diagonals, to 0.1 */
  hexhex_pillow_mode pillow; /**< straight cells only */
  int snap_curves; /**< 1: snap mesh edges to curves that none follows; straight cells only */
  /** File of the surface that the mesh approximates, onto which its boundary is pulled: .stl, .obj,
   * .ply, .off or tets; see readSurfaceOf() in <hexhex/fill.hpp>. NULL: none. Only without a map.
   */
  const char* surface;
} hexhex_improve_options;
#define HEXHEX_IMPROVE_OPTIONS_INIT \
  { sizeof(hexhex_improve_options), 0.3, 2, 0, 40, 1e-3, HEXHEX_PILLOW_NEVER, 0, NULL }

/** What limits the quality of a cell; see CellHolder in <hexhex/improve.hpp>. */
typedef enum hexhex_cell_holder HEXHEX_AS_INT {
  HEXHEX_HELD_BY_NEIGHBOURS = 0,  /**< only the cells around it */
  HEXHEX_HELD_BY_SURFACE = 1,     /**< two of its faces are on the boundary, nearly in a plane */
  HEXHEX_HELD_BY_CURVE = 2,       /**< an edge of the object */
  HEXHEX_HELD_BY_CORNER = 3,      /**< a corner of the object */
  HEXHEX_HELD_BY_OPTION = 4,      /**< fix_boundary, or a cell that cannot be positive */
  HEXHEX_HELD_BY_SHARED_FACES = 5 /**< two adjacent faces shared with another cell */
} hexhex_cell_holder;

/** Report of an improvement. See ImproveReport in <hexhex/improve.hpp>; lengths are in diagonals of
 * the surface's bounding box. hexhex_mesh_certify() finds the cells that are not positive. */
typedef struct hexhex_improve_report {
  size_t size;
  uint64_t not_positive_before; /**< cells that are not certified as positive everywhere */
  uint64_t not_positive_after;
  double minimum_before; /**< minimum scaled Jacobian */
  double minimum_after;
  double mean_before;
  double mean_after;
  double diagonal;
  double from_mesh_before;    /**< maximum distance from the mesh boundary to the object's */
  double from_surface_before; /**< maximum distance from the object's boundary to the mesh's */
  double from_mesh_after;
  double from_surface_after;
  uint64_t far_cells_before; /**< cells whose boundary is more than 1e-3 from the surface */
  uint64_t far_cells_after;
  uint64_t free_vertices;
  uint64_t patch_vertices; /**< vertices that slide on the surface */
  uint64_t curve_vertices; /**< vertices that slide on curves */
  uint64_t fixed_vertices; /**< vertices that do not move */
  uint64_t moved_vertices;
  double largest_move;
  double mean_move;     /**< mean over the moved vertices */
  uint64_t off_surface; /**< vertices that used the slack */
  double seconds;
  double inner_distance_before; /**< maximum, of interior faces with a tag or between regions, */
  double inner_distance_after;  /**< from the corresponding triangles; 0 if there are none */
  uint64_t tagged_vertices;     /**< fixed vertices with a tag */
  uint64_t boundary_vertices;   /**< fixed only by fix_boundary; all others are corners */
  uint64_t off_creases; /**< vertices that left creases because nothing else made cells good */
  uint64_t added_cells; /**< cells of a pillow; they come last in the mesh */
  double curve_length;  /**< total length of the object's sharp and tagged edges */
  double curves_followed;      /**< share of that length that mesh edges follow */
  uint64_t snapped_curves;     /**< curve segments to which edges were snapped */
  uint64_t cannot_be_positive; /**< cells that share two faces with another, so that one is not */
  uint64_t paired_vertices;    /**< vertices fixed only because of these cells */
  /** The cell with the least scaled Jacobian at the end, and what limits it. */
  uint64_t worst_cell;
  hexhex_cell_holder worst_held_by;
  int worst_tagged;      /**< 1: the curve or corner has a tag */
  uint32_t worst_vertex; /**< at the worst corner of that cell */
  double worst_angle;    /**< between the two boundary faces there, in degrees; 0 without two */
} hexhex_improve_report;
#define HEXHEX_IMPROVE_REPORT_INIT                                                                \
  {                                                                                               \
    sizeof(hexhex_improve_report), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, HEXHEX_HELD_BY_NEIGHBOURS, 0, 0, 0                 \
  }

/** Moves vertices to make cells positive, then better. See <hexhex/improve.hpp>. A pillow adds
 * vertices and cells to the mesh: arrays requested earlier become invalid.
 * @param map          the map that the mesh was extracted from, or NULL: the surface is that of
 *                     the options or, without one, the boundary of the mesh
 * @param options      or NULL
 * @param[out] report  initialized with HEXHEX_IMPROVE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_improve(hexhex_mesh* mesh, const hexhex_map* map,
                                             const hexhex_improve_options* options,
                                             hexhex_context* context, hexhex_improve_report* report,
                                             hexhex_error* error);

/* ---- From tets alone ------------------------------------------------------------------------- */

/** Method for computing a map: see ShapeMethod in <hexhex/shape.hpp>. */
typedef enum hexhex_shape_method HEXHEX_AS_INT {
  HEXHEX_METHOD_AUTO = 0,     /**< whichever fits best */
  HEXHEX_METHOD_POLYCUBE = 1, /**< deforms the object into axis-aligned boxes */
  HEXHEX_METHOD_FRAMES = 2    /**< follows a smooth frame field */
} hexhex_shape_method;

/** See ShapeOptions in <hexhex/shape.hpp>. */
typedef struct hexhex_shape_options {
  size_t size;
  hexhex_shape_method method;
  double feature_angle; /**< sharper edges of the surface are features; degrees, 0 to 180 */
  uint64_t seed;        /**< random seed: another one may succeed where this one fails */
} hexhex_shape_options;
#define HEXHEX_SHAPE_OPTIONS_INIT \
  { sizeof(hexhex_shape_options), HEXHEX_METHOD_AUTO, 40, 1 }

/** Report on the computation of a map. See ShapeReport and LabelReport in <hexhex/shape.hpp>. */
typedef struct hexhex_shape_report {
  size_t size;
  hexhex_shape_method method; /**< method that produced the map */
  double rotation[9];         /**< row by row: the axes in space that became the axes of the map */
  uint64_t charts;    /**< faces of the polycube; this and the next eight are for polycubes only */
  uint64_t corners;   /**< where at least three charts meet */
  uint64_t bad_loops; /**< invalid: chart borders with fewer than four corners */
  /** invalid: corners of more than three charts or without room for their faces, and points around
   * which labels wind otherwise than normals */
  uint64_t bad_corners;
  uint64_t opposite_edges; /**< invalid: mesh edges between opposite labels */
  uint64_t turning_points; /**< invalid: where edges of the polycube would reverse direction */
  uint64_t wrong_turns;    /**< invalid: charts whose right angles do not add up */
  double deviation;        /**< mean of 1 minus the cosine between normals and labels */
  uint64_t label_moves;    /**< random changes tried */
  uint64_t added_tets;     /**< by splits */
  uint64_t feature_edges;  /**< edges of the tets above the angle */
  uint64_t tagged_edges;   /**< those of them that are edges of the map */
  double worst;            /**< distortion of the map as a scaled Jacobian, at most 1 */
  double median;
  uint64_t inner_faces;   /**< interior triangles with a tag or between regions */
  uint64_t aligned_faces; /**< those of them that lie in planes of the map */
  uint64_t flat_charts;   /**< invalid: charts with two edges that would coincide */
  double aligned_area; /**< share of the area of inner faces that the aligned ones have, 0 to 1 */
} hexhex_shape_report;
#define HEXHEX_SHAPE_REPORT_INIT                                                                 \
  {                                                                                              \
    sizeof(hexhex_shape_report), HEXHEX_METHOD_AUTO, {0}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, \
        0, 0, 0, 0, 0                                                                            \
  }

/** Computes a seamless map for tets without one, as input for hexhex_quantize(). If none is found,
 * the status is HEXHEX_NOT_MESHABLE, with the place that prevents it. See mapFromTets() in
 * <hexhex/shape.hpp>; requires hexhex_can_quantize().
 * @param tets         only points, tets, features and regions are used
 * @param options      or NULL
 * @param[out] report  initialized with HEXHEX_SHAPE_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_map_from_tets(const hexhex_map_arrays* tets,
                                              const hexhex_shape_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_shape_report* report, hexhex_error* error);

/** Meshers that fill surfaces with tets. */
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
  double tet_size;      /**< edge length; 0: derived from cells */
  double cells;         /**< desired number of hexahedra; 0: about 20,000 tets */
  double feature_angle; /**< degrees: preserve edges where the surface turns by more */
} hexhex_fill_options;
#define HEXHEX_FILL_OPTIONS_INIT \
  { sizeof(hexhex_fill_options), HEXHEX_MESHER_AUTO, 0, 0, 40 }

/** See FillReport in <hexhex/fill.hpp>. */
typedef struct hexhex_fill_report {
  size_t size;
  char mesher[64]; /**< with its version; empty if the file held tets; UTF-8, truncated if longer */
  double tet_size;
  uint64_t tets;
  uint64_t triangles; /**< of a surface, like the following */
  uint64_t bodies;
  uint64_t voids;
  double volume;
  double filled_volume;
  uint64_t flat_triangles; /**< removed first, as they have no area */
} hexhex_fill_report;
#define HEXHEX_FILL_REPORT_INIT \
  { sizeof(hexhex_fill_report), {0}, 0, 0, 0, 0, 0, 0, 0, 0 }

/** Reads the tets of a part from a file in a format of hexhex_map_read_tets(), or uses an installed
 * mesher to fill a closed surface, .stl, .obj, .ply or .off, or a STEP file. The result has no
 * parameters.
 * @param options      or NULL
 * @param[out] report  initialized with HEXHEX_FILL_REPORT_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_map_read_part(const char* file, const hexhex_fill_options* options,
                                              hexhex_context* context, hexhex_map** map,
                                              hexhex_fill_report* report, hexhex_error* error);

/** Options for the steps of hexhex_mesh_from_tets(); NULL for a step: all defaults. */
typedef struct hexhex_mesh_options {
  size_t size;
  const hexhex_shape_options* shape;
  const hexhex_quantize_options* quantize; /**< include the target resolution: not NULL */
  const hexhex_improve_options* improve;   /**< NULL: with a pillow if it helps, and snap_curves */
} hexhex_mesh_options;
#define HEXHEX_MESH_OPTIONS_INIT \
  { sizeof(hexhex_mesh_options), NULL, NULL, NULL }

/** Reports of hexhex_mesh_from_tets(). The pointers refer to structs of the caller, initialized
 * with their _INIT macro, or are NULL. */
typedef struct hexhex_mesh_reports {
  size_t size;
  hexhex_shape_report* shape;
  hexhex_quantize_report* quantization;
  hexhex_improve_report* improvement;
  int tags_released; /**< 1: vertices were allowed to leave tagged edges to make cells positive */
  char why[512];     /**< with HEXHEX_METHOD_AUTO: why this mesh; UTF-8, truncated if longer */
  uint64_t missing_curves; /**< segments of tagged curves for which no mesh edges were found */
  uint64_t missing_groups; /**< regions and tagged surfaces that no cell or quad has */
} hexhex_mesh_reports;
#define HEXHEX_MESH_REPORTS_INIT \
  { sizeof(hexhex_mesh_reports), NULL, NULL, NULL, 0, {0}, 0, 0 }

/** Computes a hexahedral mesh from tets without a map: hexhex_map_from_tets(), hexhex_quantize(),
 * hexhex_extract(), hexhex_verify() and hexhex_mesh_improve(). Some cells may not be positive even
 * at the end: the report of the improvement has their number. See <hexhex/mesh.hpp>.
 * @param tets             only points, tets, features and regions are used
 * @param options          not NULL
 * @param[out] map         the integer-grid map of the mesh, or NULL
 * @param[in,out] reports  initialized with HEXHEX_MESH_REPORTS_INIT, or NULL */
HEXHEX_API hexhex_status hexhex_mesh_from_tets(const hexhex_map_arrays* tets,
                                               const hexhex_mesh_options* options,
                                               hexhex_context* context, hexhex_mesh** mesh,
                                               hexhex_map** map, hexhex_mesh_reports* reports,
                                               hexhex_error* error);

/* ---- Curved meshes --------------------------------------------------------------------------- */

/** A mesh with the exact shapes of its edges (arcs) and faces (patches), piece by piece: see
 * PiecewiseLinearMesh in <hexhex/curved.hpp>. */
typedef struct hexhex_piecewise_mesh hexhex_piecewise_mesh;

/** @param patches  0: arcs only; 1: arcs and patches */
HEXHEX_API hexhex_status hexhex_extract_piecewise(const hexhex_map* map, int patches,
                                                  const hexhex_extract_options* options,
                                                  hexhex_context* context,
                                                  hexhex_piecewise_mesh** mesh,
                                                  hexhex_statistics* statistics,
                                                  hexhex_error* error);
HEXHEX_API void hexhex_piecewise_mesh_destroy(hexhex_piecewise_mesh* mesh);

/** The mesh of straight cells, owned by this mesh. NULL for NULL. */
HEXHEX_API const hexhex_mesh* hexhex_piecewise_mesh_straight(const hexhex_piecewise_mesh* mesh);

/** See Arcs in <hexhex/curved.hpp>. Empty arrays are NULL. */
typedef struct hexhex_arc_arrays {
  size_t size;
  size_t arc_count;
  const uint32_t* ends;        /**< 2 per arc */
  const uint64_t* point_begin; /**< per arc, +1: its inner points; its segments: add arc */
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

/** See Patches in <hexhex/curved.hpp>. Points are numbered in the order hex vertices, inner points
 * of arcs, inner points of patches. */
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
  const uint32_t* corners;  /**< numbers of points */
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

/** The mesh owns the arrays. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_get_arcs(const hexhex_piecewise_mesh* mesh,
                                                        hexhex_arc_arrays* arrays,
                                                        hexhex_error* error);
/** All arrays are empty if the mesh has no patches. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_get_patches(const hexhex_piecewise_mesh* mesh,
                                                           hexhex_patch_arrays* arrays,
                                                           hexhex_error* error);
/** Formats: .vtu, .vtp, .ovmb. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_arcs(const hexhex_piecewise_mesh* mesh,
                                                          const char* file, hexhex_context* context,
                                                          hexhex_error* error);
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_patches(const hexhex_piecewise_mesh* mesh,
                                                             const char* file,
                                                             hexhex_context* context,
                                                             hexhex_error* error);
/** The same with the map that the mesh was extracted from, so that .ovmb files include the indices
 * of the tet simplices that contain points, edges and polygons. If the map was repaired for the
 * extraction, the repaired map is used instead. */
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_arcs_with_map(
    const hexhex_piecewise_mesh* mesh, const hexhex_map* map, const char* file,
    hexhex_context* context, hexhex_error* error);
HEXHEX_API hexhex_status hexhex_piecewise_mesh_write_patches_with_map(
    const hexhex_piecewise_mesh* mesh, const hexhex_map* map, const char* file,
    hexhex_context* context, hexhex_error* error);

/** Hexahedra of higher order: see LagrangeMesh in <hexhex/curved.hpp>. */
typedef struct hexhex_lagrange_mesh hexhex_lagrange_mesh;

/** The maximum order. */
#define HEXHEX_MAX_ORDER 9

/** @param order  1 to HEXHEX_MAX_ORDER */
HEXHEX_API hexhex_status hexhex_extract_lagrange(const hexhex_map* map, int order,
                                                 const hexhex_extract_options* options,
                                                 hexhex_context* context,
                                                 hexhex_lagrange_mesh** mesh,
                                                 hexhex_statistics* statistics,
                                                 hexhex_error* error);
HEXHEX_API void hexhex_lagrange_mesh_destroy(hexhex_lagrange_mesh* mesh);

/** Both for a prepared map; scale times order must not exceed the extractor's max_scale. */
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

/** Like hexhex_mesh_get_repair(). */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_get_repair(const hexhex_lagrange_mesh* mesh,
                                                         hexhex_map** map,
                                                         hexhex_repair_report** report,
                                                         hexhex_error* error);

/** Reads higher-order cells from a file: see readLagrangeMesh() in <hexhex/curved.hpp>. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_read(const char* file, hexhex_context* context,
                                                   hexhex_lagrange_mesh** mesh,
                                                   hexhex_error* error);
/** @param[out] holds  1 if the file has such cells, otherwise 0 */
HEXHEX_API hexhex_status hexhex_file_holds_lagrange(const char* file, hexhex_context* context,
                                                    int* holds, hexhex_error* error);

typedef struct hexhex_lagrange_arrays {
  size_t size;
  int order;
  const double* points; /**< 3 per node */
  size_t point_count;
  size_t vertex_count;   /**< number of nodes that are hex vertices; these come first */
  const uint32_t* nodes; /**< (order + 1)^3 per cell: node (i, j, k), i along 0-1, j along 0-3, k
                            along 0-4, has index i + (order + 1) (j + (order + 1) k) */
  size_t cell_count;
  const uint32_t* generator_tet; /**< per node, or NULL */
  const uint8_t* generator_corners;
  /* From the straight mesh, as in hexhex_mesh_arrays: */
  const hexhex_feature_vertex* feature_vertices;
  size_t feature_vertex_count;
  const hexhex_feature_edge* feature_edges;
  size_t feature_edge_count;
  const hexhex_feature_quad* feature_quads;
  size_t feature_quad_count;
  const int32_t* regions; /**< per cell, or NULL */
  /** Cells that left the surface in order to be positive, ascending: set by
   * hexhex_extract_lagrange(). */
  const uint32_t* straightened_cells;
  size_t straightened_cell_count;
} hexhex_lagrange_arrays;
#define HEXHEX_LAGRANGE_ARRAYS_INIT                                                                \
  {                                                                                                \
    sizeof(hexhex_lagrange_arrays), 0, NULL, 0, 0, NULL, 0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, \
        NULL, NULL, 0                                                                              \
  }

/** Creates a mesh with copies of the arrays, e.g. to write it.
 * @param arrays  at least order, points, vertex_count and nodes; functions that use the mesh reject
 *                arrays of inconsistent sizes with HEXHEX_INVALID_ARGUMENT */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_copy(const hexhex_lagrange_arrays* arrays,
                                                   hexhex_lagrange_mesh** mesh,
                                                   hexhex_error* error);

HEXHEX_API hexhex_status hexhex_lagrange_mesh_get_arrays(const hexhex_lagrange_mesh* mesh,
                                                         hexhex_lagrange_arrays* arrays,
                                                         hexhex_error* error);
/** Takes over an array, like hexhex_mesh_take(); HEXHEX_CELLS are the nodes. Functions that need
 * the array yield HEXHEX_INVALID_ARGUMENT afterwards. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_take(hexhex_lagrange_mesh* mesh,
                                                   hexhex_mesh_array array, hexhex_buffer** buffer,
                                                   hexhex_error* error);
/** Returns a copy of the straight mesh of the corners, with its tags, regions and repair. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_straight(const hexhex_lagrange_mesh* mesh,
                                                       hexhex_mesh** straight, hexhex_error* error);
/** Like hexhex_mesh_quality(), for curved cells: see scaledJacobians() in <hexhex/curved.hpp>. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_quality(const hexhex_lagrange_mesh* mesh,
                                                      hexhex_context* context,
                                                      double* scaled_jacobians,
                                                      hexhex_quality* quality, hexhex_error* error);

/** Like hexhex_mesh_certify(), for curved cells. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_certify(const hexhex_lagrange_mesh* mesh,
                                                      hexhex_context* context, uint8_t* validity,
                                                      double* scaled_jacobians,
                                                      hexhex_certificate* certificate,
                                                      hexhex_error* error);
/** Like hexhex_mesh_improve(), for cells of order 1 to 3: moves all nodes, and vertices in the
 * report are nodes. */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_improve(
    hexhex_lagrange_mesh* mesh, const hexhex_map* map, const hexhex_improve_options* options,
    hexhex_context* context, hexhex_improve_report* report, hexhex_error* error);
/** Formats: .vtu, .msh, .mesh (MFEM). */
HEXHEX_API hexhex_status hexhex_lagrange_mesh_write(const hexhex_lagrange_mesh* mesh,
                                                    const char* file,
                                                    const hexhex_write_options* options,
                                                    hexhex_context* context, hexhex_error* error);

#ifdef __cplusplus
}
#endif
#undef HEXHEX_AS_INT

#endif
