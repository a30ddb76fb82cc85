/* The C functions with wrong arguments: handles that are NULL, destroyed, of another kind, or in
 * use by another thread; sizes that are too small or overflow. An error comes out, never a crash,
 * and nothing changes. Prints what fails; exit code 0 if nothing does. */
#include <hexhex.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

#define REFUSED(call)                                                             \
  do {                                                                            \
    hexhex_error error;                                                           \
    memset(&error, 0, sizeof error);                                              \
    CHECK((call) == HEXHEX_INVALID_ARGUMENT);                                     \
    CHECK(error.status == HEXHEX_INVALID_ARGUMENT && strlen(error.message) > 20); \
  } while (0)

/* One handle of every kind. */
enum kind {
  k_context = 1 << 0,
  k_map = 1 << 1,
  k_map_structure = 1 << 2,
  k_mesh = 1 << 3,
  k_buffer = 1 << 4,
  k_extractor = 1 << 5,
  k_check_report = 1 << 6,
  k_verify_report = 1 << 7,
  k_repair_report = 1 << 8,
  k_holes = 1 << 9,
  k_piecewise_mesh = 1 << 10,
  k_lagrange_mesh = 1 << 11,
  k_mesh_writer = 1 << 12,
  k_count = 13
};
typedef union handles {
  struct {
    hexhex_context* context;
    hexhex_map* map;
    hexhex_map_structure* map_structure;
    hexhex_mesh* mesh;
    hexhex_buffer* buffer;
    hexhex_extractor* extractor;
    hexhex_check_report* check_report;
    hexhex_verify_report* verify_report;
    hexhex_repair_report* repair_report;
    hexhex_holes* holes;
    hexhex_piecewise_mesh* piecewise_mesh;
    hexhex_lagrange_mesh* lagrange_mesh;
    hexhex_mesh_writer* mesh_writer;
  };
  void* any[k_count];
} handles;

static int answer_no(void* user) { return user != NULL; }

static void make(handles* h, const char* file) {
  memset(h, 0, sizeof *h);
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  sample.cells = 2;
  sample.refine = 1;
  CHECK_OK(hexhex_context_create(NULL, &h->context, NULL));
  CHECK_OK(hexhex_map_generate("box", &sample, &h->map, NULL));
  CHECK_OK(hexhex_map_find_structure(h->map, 1e-2, NULL, &h->map_structure, NULL));
  CHECK_OK(hexhex_extract(h->map, NULL, NULL, &h->mesh, NULL, NULL));
  CHECK_OK(hexhex_mesh_boundary_patches(h->mesh, 40, NULL, &h->buffer, NULL));
  CHECK_OK(hexhex_extractor_create(h->map, 1e-2, 2, NULL, &h->extractor, NULL));
  CHECK_OK(hexhex_check(h->map, 1e-2, 1, NULL, &h->check_report, NULL));
  CHECK_OK(hexhex_verify(h->map, h->mesh, 1e-2, 1, NULL, &h->verify_report, NULL));
  hexhex_map* same = NULL;
  CHECK_OK(hexhex_repair(h->map, NULL, NULL, &same, &h->repair_report, NULL));
  hexhex_map_destroy(same);
  hexhex_mesh* part = NULL;
  CHECK_OK(hexhex_extract_partial(h->map, NULL, NULL, &part, &h->holes, NULL));
  hexhex_mesh_destroy(part);
  CHECK_OK(hexhex_extract_piecewise(h->map, 1, NULL, NULL, &h->piecewise_mesh, NULL, NULL));
  CHECK_OK(hexhex_extract_lagrange(h->map, 2, NULL, NULL, &h->lagrange_mesh, NULL, NULL));
  CHECK_OK(hexhex_mesh_writer_create(file, NULL, NULL, &h->mesh_writer, NULL));
}

static void destroy_all(handles* h) {
  hexhex_mesh_writer_destroy(h->mesh_writer);
  hexhex_lagrange_mesh_destroy(h->lagrange_mesh);
  hexhex_piecewise_mesh_destroy(h->piecewise_mesh);
  hexhex_holes_destroy(h->holes);
  hexhex_repair_report_destroy(h->repair_report);
  hexhex_verify_report_destroy(h->verify_report);
  hexhex_check_report_destroy(h->check_report);
  hexhex_extractor_destroy(h->extractor);
  hexhex_buffer_destroy(h->buffer);
  hexhex_mesh_destroy(h->mesh);
  hexhex_map_structure_destroy(h->map_structure);
  hexhex_map_destroy(h->map);
  hexhex_context_destroy(h->context);
}

static hexhex_arc_arrays out_arc_arrays = HEXHEX_ARC_ARRAYS_INIT;
static hexhex_check_summary out_check_summary = HEXHEX_CHECK_SUMMARY_INIT;
static hexhex_defect out_defect = HEXHEX_DEFECT_INIT;
static double out_double;
static hexhex_hole out_hole = HEXHEX_HOLE_INIT;
static hexhex_holes_summary out_holes_summary = HEXHEX_HOLES_SUMMARY_INIT;
static int out_int;
static int32_t out_int32;
static int64_t out_int64;
static hexhex_lagrange_arrays out_lagrange_arrays = HEXHEX_LAGRANGE_ARRAYS_INIT;
static hexhex_map_arrays out_map_arrays = HEXHEX_MAP_ARRAYS_INIT;
static const double tet_points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t tet_corners[4] = {0, 1, 2, 3};
static const hexhex_map_arrays one_tet = {.size = sizeof(hexhex_map_arrays),
                                          .points = tet_points,
                                          .point_count = 4,
                                          .tets = tet_corners,
                                          .tet_count = 1};
static hexhex_map_structure_arrays out_map_structure_arrays = HEXHEX_MAP_STRUCTURE_ARRAYS_INIT;
static hexhex_mesh_arrays out_mesh_arrays = HEXHEX_MESH_ARRAYS_INIT;
static hexhex_patch_arrays out_patch_arrays = HEXHEX_PATCH_ARRAYS_INIT;
static hexhex_place out_place;
static hexhex_quality out_quality = HEXHEX_QUALITY_INIT;
static hexhex_certificate out_certificate = HEXHEX_CERTIFICATE_INIT;
static hexhex_repair_summary out_repair_summary = HEXHEX_REPAIR_SUMMARY_INIT;
static hexhex_repaired_region out_repaired_region = HEXHEX_REPAIRED_REGION_INIT;
static hexhex_sample_answer out_sample_answer = HEXHEX_SAMPLE_ANSWER_INIT;
static hexhex_seamless_report out_seamless_report = HEXHEX_SEAMLESS_REPORT_INIT;
static hexhex_sink out_sink = HEXHEX_SINK_INIT;
static size_t out_size;
static hexhex_structure out_structure = HEXHEX_STRUCTURE_INIT;
static hexhex_mesh_summary out_summary = HEXHEX_MESH_SUMMARY_INIT;
static const char* out_text;
static uint64_t out_uint64;
static hexhex_verify_item out_verify_item = HEXHEX_VERIFY_ITEM_INIT;

/* All functions that take a handle of one kind; each has to refuse what h has there. */
static void call_all(const handles* h, enum kind kind, const char* file) {
#define concerns(kinds) (((kinds) & (int)kind) != 0)
  handles made;
  memset(&made, 0, sizeof made);
  hexhex_sink sink = HEXHEX_SINK_INIT;
  sink.end = answer_no;
  if (concerns(k_context)) {
    hexhex_context_destroy(h->context);
  }
  if (concerns(k_context)) {
    hexhex_context_cancel(h->context);
  }
  if (concerns(k_context)) {
    CHECK(!hexhex_context_cancelled(h->context));
  }
  if (concerns(k_context)) {
    CHECK(!hexhex_context_threads(h->context));
  }
  if (concerns(k_context)) {
    CHECK(!hexhex_context_stage_count(h->context));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_context_stage(h->context, 0, &out_text, &out_double, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_map_read(file, NULL, h->context, &made.map, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_map_write(h->map, file, NULL, h->context, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_map_read_tets(file, NULL, h->context, &made.map, &error));
    REFUSED(hexhex_map_read_part(file, NULL, h->context, &made.map, NULL, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_map_read_pair(file, file, h->context, &made.map, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_map_from_pair(NULL, NULL, h->context, &made.map, &error));
    REFUSED(hexhex_map_from_flags(NULL, NULL, h->context, &made.map, &error));
    REFUSED(hexhex_map_read_flags(file, file, NULL, NULL, h->context, &made.map, &error));
  }
  if (concerns(k_map)) {
    REFUSED(hexhex_map_get_answer(h->map, &out_sample_answer, &error));
  }
  if (concerns(k_map)) {
    REFUSED(hexhex_map_count_answer(h->map, HEXHEX_ANSWER_INNER_EDGES, &out_size, &error));
  }
  if (concerns(k_map)) {
    REFUSED(hexhex_map_get_answer_entry(h->map, HEXHEX_ANSWER_INNER_EDGES, 0, &out_int32,
                                        &out_uint64, &error));
  }
  if (concerns(k_map)) {
    REFUSED(hexhex_map_get_arrays(h->map, &out_map_arrays, &error));
  }
  if (concerns(k_map)) {
    hexhex_map_destroy(h->map);
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_mesh_read(file, NULL, h->context, &made.mesh, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_read(file, NULL, h->context, &made.map, &made.mesh, &error));
  }
  if (concerns(k_mesh | k_context)) {
    REFUSED(hexhex_mesh_write(h->mesh, file, NULL, h->context, &error));
  }
  if (concerns(k_mesh)) {
    REFUSED(hexhex_mesh_get_arrays(h->mesh, &out_mesh_arrays, &error));
  }
  if (concerns(k_mesh)) {
    REFUSED(hexhex_mesh_take(h->mesh, HEXHEX_POINTS, &made.buffer, &error));
  }
  if (concerns(k_buffer)) {
    CHECK(!hexhex_buffer_data(h->buffer));
  }
  if (concerns(k_buffer)) {
    CHECK(!hexhex_buffer_bytes(h->buffer));
  }
  if (concerns(k_buffer)) {
    hexhex_buffer_destroy(h->buffer);
  }
  if (concerns(k_mesh)) {
    hexhex_mesh_destroy(h->mesh);
  }
  if (concerns(k_mesh | k_context)) {
    REFUSED(hexhex_mesh_boundary_patches(h->mesh, 40, h->context, &made.buffer, &error));
  }
  if (concerns(k_mesh | k_context)) {
    REFUSED(hexhex_mesh_structure(h->mesh, h->context, &out_structure, &made.buffer, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_repair(h->map, NULL, h->context, &made.map, &made.repair_report, &error));
  }
  if (concerns(k_map | k_context)) {
    hexhex_quantize_options quantize = HEXHEX_QUANTIZE_OPTIONS_INIT;
    quantize.scale = 1;
    REFUSED(hexhex_quantize(h->map, &quantize, h->context, &made.map, NULL, &error));
    REFUSED(hexhex_examine_seamless(h->map, h->context, &out_seamless_report, &error));
  }
  if (concerns(k_context)) {
    hexhex_quantize_options fineness = HEXHEX_QUANTIZE_OPTIONS_INIT;
    hexhex_mesh_options meshing = {sizeof(hexhex_mesh_options), NULL, &fineness, NULL};
    fineness.cells = 10;
    REFUSED(hexhex_map_from_tets(&one_tet, NULL, h->context, &made.map, NULL, &error));
    REFUSED(
        hexhex_mesh_from_tets(&one_tet, &meshing, h->context, &made.mesh, &made.map, NULL, &error));
  }
  if (concerns(k_mesh | k_context)) { /* a map may be NULL */
    REFUSED(hexhex_mesh_improve(h->mesh, h->map, NULL, h->context, NULL, &error));
  }
  if (concerns(k_repair_report)) {
    hexhex_repair_report_destroy(h->repair_report);
  }
  if (concerns(k_repair_report)) {
    REFUSED(hexhex_repair_get_summary(h->repair_report, &out_repair_summary, &error));
  }
  if (concerns(k_repair_report)) {
    REFUSED(hexhex_repair_get_region(h->repair_report, 0, &out_repaired_region, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_extract(h->map, NULL, h->context, &made.mesh, NULL, &error));
  }
  if (concerns(k_mesh)) {
    REFUSED(hexhex_mesh_get_repair(h->mesh, &made.map, &made.repair_report, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_context_get_repair(h->context, &made.map, &made.repair_report, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_extract_partial(h->map, NULL, h->context, &made.mesh, &made.holes, &error));
  }
  if (concerns(k_holes)) {
    hexhex_holes_destroy(h->holes);
  }
  if (concerns(k_holes)) {
    REFUSED(hexhex_holes_get_summary(h->holes, &out_holes_summary, &error));
  }
  if (concerns(k_holes)) {
    REFUSED(hexhex_holes_get(h->holes, 0, &out_hole, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_extractor_create(h->map, 1e-2, 1, h->context, &made.extractor, &error));
  }
  if (concerns(k_extractor | k_context)) {
    REFUSED(hexhex_extractor_extract(h->extractor, NULL, h->context, &made.mesh, NULL, &error));
  }
  if (concerns(k_extractor)) {
    hexhex_extractor_destroy(h->extractor);
  }
  if (concerns(k_extractor)) {
    CHECK(!hexhex_extractor_cells(h->extractor));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_extract_to(&sink, h->map, NULL, h->context, NULL, &error));
  }
  if (concerns(k_extractor | k_context)) {
    REFUSED(hexhex_extractor_extract_to(h->extractor, &sink, NULL, h->context, NULL, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_extract_to_file(file, h->map, NULL, h->context, NULL, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_mesh_read_to(&sink, file, NULL, h->context, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_mesh_writer_create(file, NULL, h->context, &made.mesh_writer, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_begin(h->mesh_writer, 0, 0, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_points(h->mesh_writer, 0, 0, NULL, NULL, NULL, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_cells(h->mesh_writer, 0, 0, NULL, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_cells64(h->mesh_writer, 0, 0, NULL, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_end(h->mesh_writer, &error));
  }
  if (concerns(k_mesh_writer)) {
    hexhex_mesh_writer_destroy(h->mesh_writer);
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_mesh_writer_sink(h->mesh_writer, &out_sink, &error));
  }
  if (concerns(k_mesh | k_context)) {
    REFUSED(hexhex_summarize_mesh(h->mesh, h->context, &out_summary, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_summarize_file(file, NULL, h->context, &out_summary, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_summary_writer_create(h->context, &made.mesh_writer, &error));
  }
  if (concerns(k_mesh_writer)) {
    REFUSED(hexhex_summary_writer_get(h->mesh_writer, &out_summary, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_check(h->map, 1e-2, 1, h->context, &made.check_report, &error));
  }
  if (concerns(k_check_report)) {
    hexhex_check_report_destroy(h->check_report);
  }
  if (concerns(k_check_report)) {
    REFUSED(hexhex_check_get_summary(h->check_report, &out_check_summary, &error));
  }
  if (concerns(k_check_report)) {
    REFUSED(hexhex_check_get_defect(h->check_report, 0, &out_defect, &error));
  }
  if (concerns(k_check_report)) {
    REFUSED(hexhex_check_get_occurrence(h->check_report, 0, 0, &out_place, &out_double, &error));
  }
  if (concerns(k_check_report)) {
    hexhex_check_boundary_genus(h->check_report, 0, &out_int64);
    CHECK(out_int64 == -1);
  }
  if (concerns(k_check_report)) {
    CHECK(!hexhex_check_edges_of_valence(h->check_report, HEXHEX_INNER_HEX_EDGES, 0));
  }
  if (concerns(k_check_report)) {
    CHECK(hexhex_check_next_valence(h->check_report, HEXHEX_INNER_HEX_EDGES, 0) == -1);
  }
  if (concerns(k_map | k_context)) {
    REFUSED(hexhex_map_find_structure(h->map, 1e-2, h->context, &made.map_structure, &error));
  }
  if (concerns(k_map_structure)) {
    hexhex_map_structure_destroy(h->map_structure);
  }
  if (concerns(k_map_structure)) {
    REFUSED(hexhex_map_structure_get_arrays(h->map_structure, &out_map_structure_arrays, &error));
  }
  if (concerns(k_map | k_mesh | k_context)) {
    REFUSED(hexhex_verify(h->map, h->mesh, 1e-2, 1, h->context, &made.verify_report, &error));
  }
  if (concerns(k_verify_report)) {
    hexhex_verify_report_destroy(h->verify_report);
  }
  if (concerns(k_verify_report)) {
    CHECK(!hexhex_verify_passed(h->verify_report));
  }
  if (concerns(k_verify_report)) {
    CHECK(!hexhex_verify_item_count(h->verify_report));
  }
  if (concerns(k_verify_report)) {
    REFUSED(hexhex_verify_get_item(h->verify_report, 0, &out_verify_item, &error));
  }
  if (concerns(k_mesh | k_context)) {
    REFUSED(hexhex_mesh_quality(h->mesh, h->context, NULL, &out_quality, &error));
    REFUSED(hexhex_mesh_certify(h->mesh, h->context, NULL, NULL, &out_certificate, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(
        hexhex_extract_piecewise(h->map, 1, NULL, h->context, &made.piecewise_mesh, NULL, &error));
  }
  if (concerns(k_piecewise_mesh)) {
    hexhex_piecewise_mesh_destroy(h->piecewise_mesh);
  }
  if (concerns(k_piecewise_mesh)) {
    CHECK(!hexhex_piecewise_mesh_straight(h->piecewise_mesh));
  }
  if (concerns(k_piecewise_mesh)) {
    REFUSED(hexhex_piecewise_mesh_get_arcs(h->piecewise_mesh, &out_arc_arrays, &error));
  }
  if (concerns(k_piecewise_mesh)) {
    REFUSED(hexhex_piecewise_mesh_get_patches(h->piecewise_mesh, &out_patch_arrays, &error));
  }
  if (concerns(k_piecewise_mesh | k_context)) {
    REFUSED(hexhex_piecewise_mesh_write_arcs(h->piecewise_mesh, file, h->context, &error));
  }
  if (concerns(k_piecewise_mesh | k_context)) {
    REFUSED(hexhex_piecewise_mesh_write_patches(h->piecewise_mesh, file, h->context, &error));
  }
  if (concerns(k_piecewise_mesh | k_map | k_context)) {
    REFUSED(hexhex_piecewise_mesh_write_arcs_with_map(h->piecewise_mesh, h->map, file, h->context,
                                                      &error));
  }
  if (concerns(k_piecewise_mesh | k_map | k_context)) {
    REFUSED(hexhex_piecewise_mesh_write_patches_with_map(h->piecewise_mesh, h->map, file,
                                                         h->context, &error));
  }
  if (concerns(k_map | k_context)) {
    REFUSED(
        hexhex_extract_lagrange(h->map, 2, NULL, h->context, &made.lagrange_mesh, NULL, &error));
  }
  if (concerns(k_lagrange_mesh)) {
    hexhex_lagrange_mesh_destroy(h->lagrange_mesh);
  }
  if (concerns(k_extractor | k_context)) {
    REFUSED(hexhex_extractor_extract_piecewise(h->extractor, 1, NULL, h->context,
                                               &made.piecewise_mesh, NULL, &error));
  }
  if (concerns(k_extractor | k_context)) {
    REFUSED(hexhex_extractor_extract_lagrange(h->extractor, 2, NULL, h->context,
                                              &made.lagrange_mesh, NULL, &error));
  }
  if (concerns(k_lagrange_mesh)) {
    REFUSED(
        hexhex_lagrange_mesh_get_repair(h->lagrange_mesh, &made.map, &made.repair_report, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_lagrange_mesh_read(file, h->context, &made.lagrange_mesh, &error));
  }
  if (concerns(k_context)) {
    REFUSED(hexhex_file_holds_lagrange(file, h->context, &out_int, &error));
  }
  if (concerns(k_lagrange_mesh)) {
    REFUSED(hexhex_lagrange_mesh_get_arrays(h->lagrange_mesh, &out_lagrange_arrays, &error));
  }
  if (concerns(k_lagrange_mesh)) {
    REFUSED(hexhex_lagrange_mesh_take(h->lagrange_mesh, HEXHEX_POINTS, &made.buffer, &error));
  }
  if (concerns(k_lagrange_mesh)) {
    REFUSED(hexhex_lagrange_mesh_straight(h->lagrange_mesh, &made.mesh, &error));
  }
  if (concerns(k_lagrange_mesh | k_context)) {
    REFUSED(hexhex_lagrange_mesh_quality(h->lagrange_mesh, h->context, NULL, &out_quality, &error));
    REFUSED(hexhex_lagrange_mesh_certify(h->lagrange_mesh, h->context, NULL, NULL, &out_certificate,
                                         &error));
  }
  if (concerns(k_lagrange_mesh | k_context)) { /* a map may be NULL */
    REFUSED(hexhex_lagrange_mesh_improve(h->lagrange_mesh, h->map, NULL, h->context, NULL, &error));
  }
  if (concerns(k_lagrange_mesh | k_context)) {
    REFUSED(hexhex_lagrange_mesh_write(h->lagrange_mesh, file, NULL, h->context, &error));
  }
  /* Nothing was made. */
  for (int i = 0; i < k_count; ++i) CHECK(made.any[i] == NULL);
#undef concerns
}

/* All handles still are what they were. */
static void check_alive(const handles* h) {
  CHECK(hexhex_context_cancelled(h->context) == 0);
  CHECK(hexhex_context_threads(h->context) == 0);
  CHECK_OK(hexhex_map_get_arrays(h->map, &out_map_arrays, NULL));
  CHECK_OK(hexhex_map_structure_get_arrays(h->map_structure, &out_map_structure_arrays, NULL));
  CHECK_OK(hexhex_mesh_get_arrays(h->mesh, &out_mesh_arrays, NULL));
  CHECK(out_mesh_arrays.cell_count == 64 && out_mesh_arrays.point_count == 125);
  CHECK(hexhex_buffer_bytes(h->buffer) == 96 * sizeof(hexhex_feature_quad));
  CHECK(hexhex_extractor_cells(h->extractor) == 64);
  CHECK_OK(hexhex_check_get_summary(h->check_report, &out_check_summary, NULL));
  CHECK(hexhex_verify_passed(h->verify_report) == 1);
  CHECK_OK(hexhex_repair_get_summary(h->repair_report, &out_repair_summary, NULL));
  CHECK_OK(hexhex_holes_get_summary(h->holes, &out_holes_summary, NULL));
  CHECK_OK(hexhex_mesh_get_arrays(hexhex_piecewise_mesh_straight(h->piecewise_mesh),
                                  &out_mesh_arrays, NULL));
  CHECK_OK(hexhex_lagrange_mesh_get_arrays(h->lagrange_mesh, &out_lagrange_arrays, NULL));
  CHECK(out_lagrange_arrays.cell_count == 64);
  CHECK_OK(hexhex_mesh_writer_sink(h->mesh_writer, &out_sink, NULL));
}

static void test_handles(const char* file) {
  handles good;
  handles dead;
  make(&good, file);
  make(&dead, file);
  destroy_all(&dead);
  for (int i = 0; i < k_count; ++i) {
    handles bad = good;
    /* A context may be NULL: all cores, no progress. */
    bad.any[i] = NULL;
    if (1 << i != k_context) call_all(&bad, (enum kind)(1 << i), file);
    bad.any[i] = dead.any[i];
    call_all(&bad, (enum kind)(1 << i), file);
    for (int other = 0; other < k_count; ++other) {
      if (other == i) continue;
      bad.any[i] = good.any[other]; /* swapped, or of another kind */
      call_all(&bad, (enum kind)(1 << i), file);
    }
    /* Neither an object of this library nor a pointer to one. */
    max_align_t zeros[16] = {0};
    bad.any[i] = zeros + 8;
    call_all(&bad, (enum kind)(1 << i), file);
    bad.any[i] = (char*)good.any[i] + 1;
    call_all(&bad, (enum kind)(1 << i), file);
  }
  check_alive(&good);
  destroy_all(&dead); /* a second time */
  check_alive(&good);
  destroy_all(&good);
}

/* Freed handles are known for long: their memory is nothing else's so soon. */
static void test_dead_for_long(void) {
  hexhex_context* dead = NULL;
  CHECK_OK(hexhex_context_create(NULL, &dead, NULL));
  hexhex_context_destroy(dead);
  for (int i = 0; i < 1000; ++i) {
    hexhex_context* other = NULL;
    CHECK_OK(hexhex_context_create(NULL, &other, NULL));
    CHECK(other != dead);
    REFUSED(hexhex_context_stage(dead, 0, NULL, NULL, &error));
    hexhex_context_destroy(other);
  }
}

/* What others are made of may be destroyed before them. */
static void test_order_of_ends(const char* file) {
  handles h;
  make(&h, file);
  hexhex_mesh_writer* writer = NULL;
  CHECK_OK(hexhex_mesh_writer_create(file, NULL, h.context, &writer, NULL));
  hexhex_context_destroy(h.context);
  h.context = NULL;
  CHECK_OK(hexhex_mesh_writer_begin(writer, 0, 0, NULL));
  CHECK_OK(hexhex_mesh_writer_end(writer, NULL));
  hexhex_mesh_writer_destroy(writer);
  hexhex_map_destroy(h.map);
  h.map = NULL;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_extractor_extract(h.extractor, NULL, NULL, &mesh, NULL, NULL));
  hexhex_mesh_destroy(mesh);
  /* The straight mesh belongs to the other one, with which it ends. */
  hexhex_mesh* straight = (hexhex_mesh*)(uintptr_t)hexhex_piecewise_mesh_straight(h.piecewise_mesh);
  hexhex_mesh_destroy(straight);
  CHECK_OK(hexhex_mesh_get_arrays(straight, &out_mesh_arrays, NULL));
  hexhex_piecewise_mesh_destroy(h.piecewise_mesh);
  h.piecewise_mesh = NULL;
  REFUSED(hexhex_mesh_get_arrays(straight, &out_mesh_arrays, &error));
  destroy_all(&h);
}

static void test_sizes_of_structs(const char* file) {
  static const size_t sizes[] = {
      0, 1, sizeof(size_t) - 1, 4097, (size_t)INT_MAX, SIZE_MAX / 2, SIZE_MAX};
  handles h;
  make(&h, file);
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_lagrange_mesh* curved = NULL;
  hexhex_context* context = NULL;
  hexhex_mesh_writer* writer = NULL;
  hexhex_file_format format = HEXHEX_FILE_FORMAT_INIT;
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
#define WRONG(type, INIT, call) \
  do {                          \
    hexhex_##type s = INIT;     \
    s.size = sizes[i];          \
    REFUSED(call);              \
    CHECK(s.size == sizes[i]);  \
  } while (0)
    WRONG(context_options, HEXHEX_CONTEXT_OPTIONS_INIT,
          hexhex_context_create(&s, &context, &error));
    WRONG(map_arrays, HEXHEX_MAP_ARRAYS_INIT, hexhex_map_borrow(&s, &map, &error));
    WRONG(map_arrays, HEXHEX_MAP_ARRAYS_INIT, hexhex_map_copy(&s, &map, &error));
    WRONG(map_arrays, HEXHEX_MAP_ARRAYS_INIT, hexhex_map_from_pair(&s, &s, NULL, &map, &error));
    WRONG(map_arrays, HEXHEX_MAP_ARRAYS_INIT, hexhex_map_get_arrays(h.map, &s, &error));
    WRONG(sample_options, HEXHEX_SAMPLE_OPTIONS_INIT, hexhex_map_generate("box", &s, &map, &error));
    WRONG(sample_answer, HEXHEX_SAMPLE_ANSWER_INIT, hexhex_map_get_answer(h.map, &s, &error));
    WRONG(read_options, HEXHEX_READ_OPTIONS_INIT, hexhex_map_read("a.vtu", &s, NULL, &map, &error));
    WRONG(write_options, HEXHEX_WRITE_OPTIONS_INIT,
          hexhex_map_write(h.map, file, &s, NULL, &error));
    WRONG(write_options, HEXHEX_WRITE_OPTIONS_INIT,
          hexhex_mesh_write(h.mesh, file, &s, NULL, &error));
    WRONG(write_options, HEXHEX_WRITE_OPTIONS_INIT,
          hexhex_mesh_writer_create(file, &s, NULL, &writer, &error));
    WRONG(write_options, HEXHEX_WRITE_OPTIONS_INIT,
          hexhex_require_format(HEXHEX_OUTPUT_MESH, file, &s, &error));
    hexhex_write_options compressed = HEXHEX_WRITE_OPTIONS_INIT;
    for (compressed.compress = -1; compressed.compress <= 3; compressed.compress += 4)
      REFUSED(hexhex_mesh_write(h.mesh, file, &compressed, NULL, &error));
    WRONG(mesh_arrays, HEXHEX_MESH_ARRAYS_INIT, hexhex_mesh_copy(&s, &mesh, &error));
    WRONG(mesh_arrays, HEXHEX_MESH_ARRAYS_INIT, hexhex_mesh_get_arrays(h.mesh, &s, &error));
    WRONG(file_format, format, hexhex_get_format(0, &s, &error));
    WRONG(structure, HEXHEX_STRUCTURE_INIT, hexhex_mesh_structure(h.mesh, NULL, &s, NULL, &error));
    WRONG(repair_options, HEXHEX_REPAIR_OPTIONS_INIT,
          hexhex_repair(h.map, &s, NULL, &map, NULL, &error));
    WRONG(repair_summary, HEXHEX_REPAIR_SUMMARY_INIT,
          hexhex_repair_get_summary(h.repair_report, &s, &error));
    WRONG(quantize_options, HEXHEX_QUANTIZE_OPTIONS_INIT,
          hexhex_quantize(h.map, &s, NULL, &map, NULL, &error));
    hexhex_quantize_options unscaled = HEXHEX_QUANTIZE_OPTIONS_INIT;
    unscaled.scale = 1;
    WRONG(quantize_report, HEXHEX_QUANTIZE_REPORT_INIT,
          hexhex_quantize(h.map, &unscaled, NULL, &map, &s, &error));
    WRONG(improve_options, HEXHEX_IMPROVE_OPTIONS_INIT,
          hexhex_mesh_improve(h.mesh, NULL, &s, NULL, NULL, &error));
    WRONG(improve_report, HEXHEX_IMPROVE_REPORT_INIT,
          hexhex_mesh_improve(h.mesh, NULL, NULL, NULL, &s, &error));
    WRONG(fill_options, HEXHEX_FILL_OPTIONS_INIT,
          hexhex_map_read_part("part.stl", &s, NULL, &map, NULL, &error));
    WRONG(fill_report, HEXHEX_FILL_REPORT_INIT,
          hexhex_map_read_part("part.stl", NULL, NULL, &map, &s, &error));
    WRONG(map_arrays, one_tet, hexhex_map_from_tets(&s, NULL, NULL, &map, NULL, &error));
    WRONG(shape_options, HEXHEX_SHAPE_OPTIONS_INIT,
          hexhex_map_from_tets(&one_tet, &s, NULL, &map, NULL, &error));
    WRONG(shape_report, HEXHEX_SHAPE_REPORT_INIT,
          hexhex_map_from_tets(&one_tet, NULL, NULL, &map, &s, &error));
    hexhex_mesh_options meshing = {sizeof(hexhex_mesh_options), NULL, &unscaled, NULL};
    hexhex_mesh_options of_meshing = meshing;
    hexhex_mesh_reports reports = HEXHEX_MESH_REPORTS_INIT;
    WRONG(mesh_options, meshing,
          hexhex_mesh_from_tets(&one_tet, &s, NULL, &mesh, &map, NULL, &error));
    WRONG(shape_options, HEXHEX_SHAPE_OPTIONS_INIT,
          (of_meshing.shape = &s,
           hexhex_mesh_from_tets(&one_tet, &of_meshing, NULL, &mesh, &map, NULL, &error)));
    WRONG(mesh_reports, HEXHEX_MESH_REPORTS_INIT,
          hexhex_mesh_from_tets(&one_tet, &meshing, NULL, &mesh, &map, &s, &error));
    WRONG(improve_report, HEXHEX_IMPROVE_REPORT_INIT,
          (reports.improvement = &s,
           hexhex_mesh_from_tets(&one_tet, &meshing, NULL, &mesh, &map, &reports, &error)));
    WRONG(seamless_report, HEXHEX_SEAMLESS_REPORT_INIT,
          hexhex_examine_seamless(h.map, NULL, &s, &error));
    WRONG(extract_options, HEXHEX_EXTRACT_OPTIONS_INIT,
          hexhex_extract(h.map, &s, NULL, &mesh, NULL, &error));
    WRONG(statistics, HEXHEX_STATISTICS_INIT, hexhex_extract(h.map, NULL, NULL, &mesh, &s, &error));
    WRONG(partial_options, HEXHEX_PARTIAL_OPTIONS_INIT,
          hexhex_extract_partial(h.map, &s, NULL, &mesh, NULL, &error));
    WRONG(holes_summary, HEXHEX_HOLES_SUMMARY_INIT, hexhex_holes_get_summary(h.holes, &s, &error));
    WRONG(sink, HEXHEX_SINK_INIT, hexhex_extract_to(&s, h.map, NULL, NULL, NULL, &error));
    WRONG(sink, HEXHEX_SINK_INIT, hexhex_mesh_writer_sink(h.mesh_writer, &s, &error));
    WRONG(mesh_summary, HEXHEX_MESH_SUMMARY_INIT, hexhex_summarize_mesh(h.mesh, NULL, &s, &error));
    WRONG(check_summary, HEXHEX_CHECK_SUMMARY_INIT,
          hexhex_check_get_summary(h.check_report, &s, &error));
    WRONG(map_structure_arrays, HEXHEX_MAP_STRUCTURE_ARRAYS_INIT,
          hexhex_map_structure_get_arrays(h.map_structure, &s, &error));
    WRONG(verify_item, HEXHEX_VERIFY_ITEM_INIT,
          hexhex_verify_get_item(h.verify_report, 0, &s, &error));
    WRONG(quality, HEXHEX_QUALITY_INIT, hexhex_mesh_quality(h.mesh, NULL, NULL, &s, &error));
    WRONG(quality, HEXHEX_QUALITY_INIT, hexhex_summarize_quality(NULL, 0, &s, &error));
    WRONG(certificate, HEXHEX_CERTIFICATE_INIT,
          hexhex_mesh_certify(h.mesh, NULL, NULL, NULL, &s, &error));
    WRONG(arc_arrays, HEXHEX_ARC_ARRAYS_INIT,
          hexhex_piecewise_mesh_get_arcs(h.piecewise_mesh, &s, &error));
    WRONG(patch_arrays, HEXHEX_PATCH_ARRAYS_INIT,
          hexhex_piecewise_mesh_get_patches(h.piecewise_mesh, &s, &error));
    WRONG(lagrange_arrays, HEXHEX_LAGRANGE_ARRAYS_INIT,
          hexhex_lagrange_mesh_copy(&s, &curved, &error));
    WRONG(lagrange_arrays, HEXHEX_LAGRANGE_ARRAYS_INIT,
          hexhex_lagrange_mesh_get_arrays(h.lagrange_mesh, &s, &error));
#undef WRONG
  }
  CHECK(map == NULL && mesh == NULL && curved == NULL && context == NULL && writer == NULL);
  check_alive(&h);
  destroy_all(&h);
}

/* Counts whose arrays no memory can hold: multiplied with the size of an element they overflow. */
static void test_counts(const char* file) {
  static const size_t counts[] = {SIZE_MAX,     SIZE_MAX / 2,      SIZE_MAX / 3 + 1,
                                  SIZE_MAX / 8, SIZE_MAX / 16 + 1, SIZE_MAX / 24 + 1};
  static double numbers[96];
  static uint32_t indices[32];
  handles h;
  make(&h, file);
  CHECK_OK(hexhex_mesh_writer_begin(h.mesh_writer, 8, 1, NULL));
  for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
    const size_t n = counts[i];
    hexhex_map* map = NULL;
    hexhex_map_arrays a = HEXHEX_MAP_ARRAYS_INIT;
    a.points = numbers;
    a.tets = indices;
    a.parameters = numbers;
    a.edge_valences = (const hexhex_edge_valence*)(const void*)indices;
    a.feature_vertices = (const hexhex_feature_vertex*)(const void*)indices;
    a.feature_edges = (const hexhex_feature_edge*)(const void*)indices;
    a.feature_faces = (const hexhex_feature_face*)(const void*)indices;
    size_t* const map_counts[] = {&a.point_count,        &a.tet_count,
                                  &a.edge_valence_count, &a.feature_vertex_count,
                                  &a.feature_edge_count, &a.feature_face_count};
    for (size_t k = 0; k < sizeof map_counts / sizeof *map_counts; ++k) {
      if (n <= SIZE_MAX / 16 + 1 && k > 1) continue; /* of smaller elements it could be true */
      *map_counts[k] = n;
      REFUSED(hexhex_map_borrow(&a, &map, &error));
      REFUSED(hexhex_map_copy(&a, &map, &error));
      if (k < 2) REFUSED(hexhex_map_from_pair(&a, &a, NULL, &map, &error));
      *map_counts[k] = 0;
    }
    hexhex_mesh* mesh = NULL;
    hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
    m.points = numbers;
    m.cells = indices;
    m.point_count = n;
    REFUSED(hexhex_mesh_copy(&m, &mesh, &error));
    m.point_count = 0;
    m.cell_count = n;
    REFUSED(hexhex_mesh_copy(&m, &mesh, &error));
    hexhex_lagrange_mesh* curved = NULL;
    hexhex_lagrange_arrays l = HEXHEX_LAGRANGE_ARRAYS_INIT;
    l.order = 9;
    l.points = numbers;
    l.nodes = indices;
    l.cell_count = n;
    hexhex_status status = hexhex_lagrange_mesh_copy(&l, &curved, NULL);
    CHECK(status == HEXHEX_INVALID_ARGUMENT || status == HEXHEX_TOO_LARGE);
    l.cell_count = 0;
    l.point_count = n;
    REFUSED(hexhex_lagrange_mesh_copy(&l, &curved, &error));
    CHECK(map == NULL && mesh == NULL && curved == NULL);
    hexhex_quality quality = HEXHEX_QUALITY_INIT;
    if (n >= SIZE_MAX / 8) REFUSED(hexhex_summarize_quality(numbers, n, &quality, &error));
    hexhex_mesh_writer* writer = NULL;
    CHECK_OK(hexhex_summary_writer_create(NULL, &writer, NULL));
    CHECK_OK(hexhex_mesh_writer_begin(writer, 1, 1, NULL));
    REFUSED(hexhex_mesh_writer_points(writer, 0, n, numbers, NULL, NULL, &error));
    REFUSED(hexhex_mesh_writer_cells(writer, 0, n, indices, &error));
    REFUSED(
        hexhex_mesh_writer_cells64(writer, 0, n, (const uint64_t*)(const void*)numbers, &error));
    hexhex_mesh_writer_destroy(writer);
    /* Arrays that are missing. */
    m.points = NULL;
    m.cell_count = 0;
    m.point_count = 1;
    REFUSED(hexhex_mesh_copy(&m, &mesh, &error));
  }
  destroy_all(&h);
}

/* Numbers that are far from anything sensible: some error, or a result. */
static void test_numbers(const char* file) {
  static const int numbers[] = {INT_MIN, -1, 0, 1 << 20, INT_MAX};
  handles h;
  make(&h, file);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    const int n = numbers[i];
    hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
    options.scale = n;
    hexhex_mesh* mesh = NULL;
    hexhex_status status = hexhex_extract(h.map, &options, NULL, &mesh, NULL, NULL);
    CHECK(status == HEXHEX_INVALID_ARGUMENT || status == HEXHEX_TOO_LARGE);
    hexhex_extractor* extractor = NULL;
    status = hexhex_extractor_create(h.map, 1e-2, n, NULL, &extractor, NULL);
    CHECK(status == HEXHEX_OK || status == HEXHEX_INVALID_ARGUMENT || status == HEXHEX_TOO_LARGE);
    hexhex_extractor_destroy(extractor);
    hexhex_lagrange_mesh* curved = NULL;
    REFUSED(hexhex_extract_lagrange(h.map, n, NULL, NULL, &curved, NULL, &error));
    hexhex_context_options how = HEXHEX_CONTEXT_OPTIONS_INIT;
    how.threads = n;
    hexhex_context* context = NULL;
    status = hexhex_context_create(&how, &context, NULL);
    CHECK((status == HEXHEX_OK) == (n >= 0));
    if (n >= 0) {
      hexhex_mesh_summary summary = HEXHEX_MESH_SUMMARY_INIT;
      status = hexhex_summarize_mesh(h.mesh, context, &summary, NULL);
      CHECK(status == HEXHEX_OK || status == HEXHEX_INVALID_ARGUMENT ||
            status == HEXHEX_OUT_OF_MEMORY);
    }
    hexhex_context_destroy(context);
    REFUSED(
        hexhex_verify_get_item(h.verify_report, (size_t)n | 1U << 30, &out_verify_item, &error));
    REFUSED(hexhex_get_format((size_t)n | 1U << 30, &(hexhex_file_format)HEXHEX_FILE_FORMAT_INIT,
                              &error));
    CHECK(hexhex_generator_kind((uint8_t)n) >= -1);
  }
  check_alive(&h);
  destroy_all(&h);
}

/* Densities that are none, several, or beyond all indices; and none at all. */
static void test_densities(const char* file) {
  static const double numbers[] = {0, -1, NAN, INFINITY, -INFINITY};
  handles h;
  make(&h, file);
  hexhex_map* map = NULL;
  hexhex_quantize_report report = HEXHEX_QUANTIZE_REPORT_INIT;
  report.cells = 17;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    for (int which = 0; which < 3; ++which) {
      hexhex_quantize_options options = HEXHEX_QUANTIZE_OPTIONS_INIT;
      double* const densities[] = {&options.cells, &options.scale, &options.edge_length};
      *densities[which] = numbers[i];
      REFUSED(hexhex_quantize(h.map, &options, NULL, &map, &report, &error));
      *densities[which] = 1;
      *densities[(which + 1) % 3] = numbers[i] == 0 ? 2 : numbers[i];
      REFUSED(hexhex_quantize(h.map, &options, NULL, &map, &report, &error));
      *densities[(which + 1) % 3] = 0;
      options.tolerance = numbers[i] == 0 ? 0.5 : numbers[i];
      REFUSED(hexhex_quantize(h.map, &options, NULL, &map, &report, &error));
    }
  }
  hexhex_quantize_options many = HEXHEX_QUANTIZE_OPTIONS_INIT;
  many.cells = 1e12;
  hexhex_status status = hexhex_quantize(h.map, &many, NULL, &map, &report, NULL);
  CHECK(status == (hexhex_can_quantize() ? HEXHEX_TOO_LARGE : HEXHEX_INVALID_ARGUMENT));
  REFUSED(hexhex_quantize(h.map, NULL, NULL, &map, &report, &error));
  CHECK(map == NULL && report.cells == 17); /* as nothing was quantized */
  hexhex_quantize_options options = HEXHEX_QUANTIZE_OPTIONS_INIT;
  options.scale = 1;
  REFUSED(hexhex_quantize(h.map, &options, NULL, NULL, &report, &error));
  check_alive(&h);
  destroy_all(&h);
}

/* Options of meshes from tets that are out of range, and what is missing. */
static void test_shapes(void) {
  static const double angles[] = {-1, 181, NAN, INFINITY};
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_quantize_options fineness = HEXHEX_QUANTIZE_OPTIONS_INIT;
  fineness.cells = 10;
  for (size_t i = 0; i < 6; ++i) {
    hexhex_shape_options shape = HEXHEX_SHAPE_OPTIONS_INIT;
    hexhex_mesh_options options = {sizeof(hexhex_mesh_options), &shape, &fineness, NULL};
    if (i < 4) shape.feature_angle = angles[i];
    if (i >= 4) shape.method = i == 4 ? (hexhex_shape_method)3 : (hexhex_shape_method)-1;
    REFUSED(hexhex_map_from_tets(&one_tet, &shape, NULL, &map, NULL, &error));
    REFUSED(hexhex_mesh_from_tets(&one_tet, &options, NULL, &mesh, &map, NULL, &error));
  }
  hexhex_mesh_options options = {sizeof(hexhex_mesh_options), NULL, &fineness, NULL};
  REFUSED(hexhex_map_from_tets(NULL, NULL, NULL, &map, NULL, &error));
  REFUSED(hexhex_map_from_tets(&one_tet, NULL, NULL, NULL, NULL, &error));
  REFUSED(hexhex_mesh_from_tets(&one_tet, NULL, NULL, &mesh, NULL, NULL, &error));
  REFUSED(hexhex_mesh_from_tets(&one_tet, &options, NULL, NULL, &map, NULL, &error));
  fineness.scale = 1; /* one of both */
  REFUSED(hexhex_mesh_from_tets(&one_tet, &options, NULL, &mesh, &map, NULL, &error));
  options.quantize = NULL;
  REFUSED(hexhex_mesh_from_tets(&one_tet, &options, NULL, &mesh, &map, NULL, &error));
  CHECK(map == NULL && mesh == NULL);
}

/* Improvements that are refused leave the mesh alone, even if only the report cannot be filled. */
static void test_improvements(const char* file) {
  static const double numbers[] = {-1, NAN, INFINITY, -INFINITY, 1e300};
  handles h;
  make(&h, file);
  hexhex_improve_report report = HEXHEX_IMPROVE_REPORT_INIT;
  report.moved_vertices = 17;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    for (int which = 0; which < 3; ++which) {
      hexhex_improve_options options = HEXHEX_IMPROVE_OPTIONS_INIT;
      double* const members[] = {&options.target, &options.feature_angle, &options.slack};
      *members[which] = numbers[i];
      REFUSED(hexhex_mesh_improve(h.mesh, NULL, &options, NULL, &report, &error));
    }
  }
  hexhex_improve_options options = HEXHEX_IMPROVE_OPTIONS_INIT;
  options.passes = -1;
  REFUSED(hexhex_mesh_improve(h.mesh, NULL, &options, NULL, &report, &error));
  options.passes = INT_MAX;
  REFUSED(hexhex_mesh_improve(h.mesh, NULL, &options, NULL, &report, &error));
  options.passes = 2;
  options.pillow = (hexhex_pillow_mode)3;
  REFUSED(hexhex_mesh_improve(h.mesh, NULL, &options, NULL, &report, &error));
  CHECK(report.moved_vertices == 17);

  /* Vertices inside of a cube, which would be moved. */
  hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(h.mesh, &arrays, NULL));
  double low = arrays.points[0];
  double high = low;
  for (size_t i = 0; i < 3 * arrays.point_count; ++i) {
    low = fmin(low, arrays.points[i]);
    high = fmax(high, arrays.points[i]);
  }
  double* const points = malloc(arrays.point_count * 3 * sizeof(double));
  memcpy(points, arrays.points, arrays.point_count * 3 * sizeof(double));
  for (size_t v = 0; v < arrays.point_count; ++v) {
    const double* const p = arrays.points + 3 * v;
    int inside = 1;
    for (int k = 0; k < 3; ++k) inside &= p[k] > low + 1e-9 && p[k] < high - 1e-9;
    if (inside) points[3 * v] += 0.3 * (high - low) / 4;
  }
  hexhex_mesh_arrays moved = arrays;
  moved.points = points;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_mesh_copy(&moved, &mesh, NULL));
  report.size = 1;
  REFUSED(hexhex_mesh_improve(mesh, NULL, NULL, NULL, &report, &error));
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &arrays, NULL));
  CHECK(memcmp(points, arrays.points, arrays.point_count * 3 * sizeof(double)) == 0);
  report.size = sizeof report;
  CHECK_OK(hexhex_mesh_improve(mesh, NULL, NULL, NULL, &report, NULL));
  CHECK(report.moved_vertices > 0);
  hexhex_mesh_destroy(mesh);
  free(points);
  check_alive(&h);
  destroy_all(&h);
}

/* ---- Threads -------------------------------------------------------------------------------- */

typedef struct shared {
  const handles* h;
  const char* file;
  unsigned seed;
  int refused;
} shared;

static void note(shared* s, hexhex_status status) {
  if (status == HEXHEX_OK || status == HEXHEX_CANCELLED) return;
  if (status == HEXHEX_INVALID_ARGUMENT) {
    ++s->refused;
    return;
  }
  fprintf(stderr, "a thread got %s\n", hexhex_status_name(status));
  s->refused = -1000000;
}

/* Uses handles that others use, change and destroy at the same time. */
static void* use_handles(void* argument) {
  shared* const s = argument;
  const handles* const h = s->h;
  for (int i = 0; i < 300; ++i) {
    s->seed = s->seed * 1664525U + 1013904223U;
    handles made;
    memset(&made, 0, sizeof made);
    hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
    hexhex_quality quality = HEXHEX_QUALITY_INIT;
    hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
    hexhex_sink sink = HEXHEX_SINK_INIT;
    switch (s->seed >> 16 & 15) {
      case 0:
        note(s, hexhex_extract(h->map, &options, h->context, &made.mesh, NULL, NULL));
        break;
      case 1:
        note(s, hexhex_extractor_extract(h->extractor, &options, NULL, &made.mesh, NULL, NULL));
        break;
      case 2:
        note(s, hexhex_mesh_get_arrays(h->mesh, &arrays, NULL));
        break;
      case 3:
        note(s, hexhex_mesh_take(h->mesh, HEXHEX_REGIONS, &made.buffer, NULL));
        break;
      case 4:
        note(s, hexhex_mesh_quality(h->mesh, h->context, NULL, &quality, NULL));
        break;
      case 5:
        note(s, hexhex_verify(h->map, h->mesh, 1e-2, 1, NULL, &made.verify_report, NULL));
        break;
      case 6:
        note(s, hexhex_mesh_writer_begin(h->mesh_writer, 1, 1, NULL));
        break;
      case 7:
        note(s, hexhex_lagrange_mesh_take(h->lagrange_mesh, HEXHEX_REGIONS, &made.buffer, NULL));
        break;
      case 8:
        note(s, hexhex_lagrange_mesh_straight(h->lagrange_mesh, &made.mesh, NULL));
        break;
      case 9:
        note(s, hexhex_mesh_get_arrays(hexhex_piecewise_mesh_straight(h->piecewise_mesh), &arrays,
                                       NULL));
        break;
      case 10:
        (void)hexhex_context_cancelled(h->context);
        break;
      case 11:
        (void)hexhex_verify_item_count(h->verify_report);
        break;
      case 12:
        (void)hexhex_buffer_bytes(h->buffer);
        break;
      case 13:
        note(s, hexhex_summarize_mesh(h->mesh, h->context,
                                      &(hexhex_mesh_summary)HEXHEX_MESH_SUMMARY_INIT, NULL));
        break;
      case 14:
        note(s, hexhex_mesh_writer_sink(h->mesh_writer, &sink, NULL));
        if (sink.end != NULL) note(s, hexhex_extract_to(&sink, h->map, NULL, NULL, NULL, NULL));
        break;
      default:
        (void)hexhex_context_stage_count(h->context);
    }
    hexhex_mesh_destroy(made.mesh);
    hexhex_buffer_destroy(made.buffer);
    hexhex_verify_report_destroy(made.verify_report);
  }
  return NULL;
}

static void test_threads(const char* file) {
  enum { kThreads = 3 };
  int refused = 0;
  for (unsigned round = 0; round < 4; ++round) {
    handles h;
    make(&h, file);
    pthread_t threads[kThreads];
    shared shares[kThreads];
    for (unsigned i = 0; i < kThreads; ++i) {
      shares[i] = (shared){&h, file, 17 * round + i, 0};
      CHECK(pthread_create(&threads[i], NULL, use_handles, &shares[i]) == 0);
    }
    /* In the last two rounds the handles are destroyed under their users. */
    if (round >= 2) {
      const handles doomed = h;
      hexhex_context_cancel(h.context);
      handles each = doomed;
      destroy_all(&each);
    }
    for (unsigned i = 0; i < kThreads; ++i) {
      pthread_join(threads[i], NULL);
      CHECK(shares[i].refused >= 0);
      refused += shares[i].refused;
    }
    if (round < 2) destroy_all(&h);
  }
  CHECK(refused > 0); /* or nothing met */
}

int main(void) {
  char folder[] = "/tmp/hexhex-c-XXXXXX";
  if (mkdtemp(folder) == NULL) return 1;
  char file[64];
  snprintf(file, sizeof file, "%s/a.vtu", folder);
  test_handles(file);
  test_dead_for_long();
  test_order_of_ends(file);
  test_sizes_of_structs(file);
  test_counts(file);
  test_numbers(file);
  test_densities(file);
  test_shapes();
  test_improvements(file);
  test_threads(file);
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  CHECK(system(command) == 0);
  if (failures > 0) fprintf(stderr, "%d failures\n", failures);
  return failures > 0;
}
