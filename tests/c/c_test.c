/* The C functions, used from C. Prints what fails; exit code 0 if nothing does. */
#include <float.h>
#include <hexhex.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"

static hexhex_map* sphere(int refine) {
  hexhex_sample_options options = HEXHEX_SAMPLE_OPTIONS_INIT;
  hexhex_map* map = NULL;
  hexhex_error error;
  options.refine = refine;
  options.charts = HEXHEX_CHARTS_RANDOM;
  CHECK_OK(hexhex_map_generate("sphere", &options, &map, &error));
  return map;
}

/* Meshes that are none get a verdict. */
static void test_verify_of_bad_meshes(void) {
  hexhex_error error;
  hexhex_map* map = sphere(1);
  const double nan_points[24] = {NAN, NAN, NAN, NAN};
  const double far_points[24] = {1e308, -1e308, INFINITY};
  const double zeros[24] = {0};
  const double* points[3] = {nan_points, far_points, zeros};
  const uint32_t cells[4][8] = {{0, 1, 2, 3, 4, 5, 6, 7},
                                {0, 0, 1, 1, 2, 2, 3, 3},
                                {0, 0, 0, 0, 0, 0, 0, 0},
                                {0, 1, 2, 3, 4, 5, 6, 8}};
  for (int p = 0; p < 3; ++p) {
    for (int c = 0; c <= 4; ++c) {
      hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
      hexhex_mesh* mesh = NULL;
      hexhex_verify_report* report = NULL;
      arrays.point_count = 8;
      arrays.points = points[p];
      arrays.cell_count = c < 4; /* the last one has no cells */
      arrays.cells = cells[c % 4];
      CHECK_OK(hexhex_mesh_copy(&arrays, &mesh, &error));
      CHECK_OK(hexhex_verify(map, mesh, 1e-2, 1, NULL, &report, &error));
      CHECK(!hexhex_verify_passed(report));
      hexhex_verify_report_destroy(report);
      hexhex_mesh_destroy(mesh);
    }
  }
  hexhex_map_destroy(map);
}

static double corner_determinant(const double* p, const uint32_t* cell) {
  const double* o = p + 3 * cell[0];
  double e[3][3];
  static const int ends[3] = {1, 3, 4};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) e[i][k] = p[3 * cell[ends[i]] + k] - o[k];
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
         e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* The corner order that hexhex.h documents: orientation, and that 0-4, 1-5, 2-6, 3-7 are edges. A
 * unit cube from its own coordinates has edges of length 1/2 at scale 2 and no others. */
static void test_corner_order(void) {
  double points[24];
  static const uint32_t tets[] = {0, 1, 3, 7, 0, 3, 2, 7, 0, 2, 6, 7,
                                  0, 6, 4, 7, 0, 4, 5, 7, 0, 5, 1, 7};
  double parameters[72];
  for (int v = 0; v < 8; ++v) {
    for (int k = 0; k < 3; ++k) points[3 * v + k] = v >> k & 1;
  }
  for (int i = 0; i < 24; ++i) {
    memcpy(parameters + 3 * i, points + 3 * tets[i], 3 * sizeof(double));
  }
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  arrays.points = points;
  arrays.point_count = 8;
  arrays.tets = tets;
  arrays.tet_count = 6;
  arrays.parameters = parameters;
  const hexhex_tag_name names[] = {{3, 1, "steel"}, {2, -4, "contact"}};
  arrays.tag_names = names;
  arrays.tag_name_count = 2;
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_error error;
  CHECK_OK(hexhex_map_borrow(&arrays, &map, &error));
  hexhex_map_arrays seen = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(map, &seen, NULL));
  CHECK(seen.points == points && seen.tets == tets && seen.parameters == parameters);
  CHECK(seen.tag_name_count == 2 && strcmp(seen.tag_names[0].name, "steel") == 0);
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  options.scale = 2;
  CHECK_OK(hexhex_extract(map, &options, NULL, &mesh, NULL, &error));
  hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &m, &error));
  CHECK(m.cell_count == 8 && m.point_count == 27);
  CHECK(m.generator_tet != NULL && m.generator_corners != NULL);
  /* Names go into a mesh and come back. */
  m.tag_names = names;
  m.tag_name_count = 2;
  hexhex_mesh* copy = NULL;
  hexhex_mesh_arrays copied = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_copy(&m, &copy, &error));
  CHECK_OK(hexhex_mesh_get_arrays(copy, &copied, &error));
  CHECK(copied.tag_name_count == 2 && copied.tag_names[1].dimension == 2);
  CHECK(copied.tag_names[1].tag == -4 && strcmp(copied.tag_names[1].name, "contact") == 0);
  hexhex_mesh_destroy(copy);
  for (size_t c = 0; c < m.cell_count; ++c) {
    const uint32_t* cell = m.cells + 8 * c;
    CHECK(corner_determinant(m.points, cell) > 0);
    for (int i = 0; i < 8; ++i) {
      const int next = i < 4 ? (i + 1) % 4 : 4 + (i + 1) % 4;
      const int ends[2] = {next, (i + 4) % 8};
      for (int j = 0; j < 2; ++j) {
        double length = 0;
        for (int k = 0; k < 3; ++k) {
          length += fabs(m.points[3 * cell[i] + k] - m.points[3 * cell[ends[j]] + k]);
        }
        CHECK(length == 0.5);
      }
    }
  }
  double corners[24];
  for (int i = 0; i < 24; ++i) corners[i] = m.points[3 * m.cells[i / 3] + i % 3];
  CHECK(fabs(hexhex_scaled_jacobian(corners) - 1) < 1e-12);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
}

static void test_everything_once(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = sphere(2);
  snprintf(file, sizeof file, "%s/map.hexex", folder);
  CHECK_OK(hexhex_map_write(map, file, NULL, NULL, &error));
  hexhex_map_destroy(map);
  CHECK_OK(hexhex_map_read(file, NULL, NULL, &map, &error));
  /* A borrowed map writes the same file. */
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  hexhex_map* borrowed = NULL;
  CHECK_OK(hexhex_map_get_arrays(map, &arrays, &error));
  CHECK_OK(hexhex_map_borrow(&arrays, &borrowed, &error));
  CHECK_OK(hexhex_map_write(borrowed, file, NULL, NULL, &error));

  hexhex_check_report* report = NULL;
  hexhex_check_summary summary = HEXHEX_CHECK_SUMMARY_INIT;
  CHECK_OK(hexhex_check(borrowed, 1e-2, 2, NULL, &report, &error));
  CHECK_OK(hexhex_check_get_summary(report, &summary, &error));
  CHECK(summary.valid && summary.defect_count == 0 && summary.cells == 3584);
  CHECK(hexhex_check_edges_of_valence(report, HEXHEX_INNER_HEX_EDGES, 3) == 160);
  CHECK(hexhex_check_edges_of_valence(report, HEXHEX_INNER_HEX_EDGES, 5) == 0);
  CHECK(hexhex_check_next_valence(report, HEXHEX_INNER_TET_EDGES, -1) == 3);
  CHECK(hexhex_check_next_valence(report, HEXHEX_INNER_TET_EDGES, 3) == -1);
  hexhex_check_report_destroy(report);

  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  options.scale = 2;
  hexhex_statistics statistics = HEXHEX_STATISTICS_INIT;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_extract(map, &options, NULL, &mesh, &statistics, &error));
  CHECK(statistics.charts > 0 && statistics.seconds > 0 && statistics.singular_edges > 0);
  hexhex_verify_report* verified = NULL;
  CHECK_OK(hexhex_verify(map, mesh, 1e-2, 2, NULL, &verified, &error));
  CHECK(hexhex_verify_passed(verified) && hexhex_verify_item_count(verified) >= 10);
  hexhex_verify_item item = HEXHEX_VERIFY_ITEM_INIT;
  CHECK_OK(hexhex_verify_get_item(verified, 2, &item, &error));
  CHECK(strcmp(item.name, "cells") == 0 && strcmp(item.found, "3584") == 0 && item.passed);
  CHECK(hexhex_verify_get_item(verified, 999, &item, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_verify_report_destroy(verified);
  CHECK_OK(hexhex_verify(map, mesh, 1e-2, 3, NULL, &verified, &error));
  CHECK(!hexhex_verify_passed(verified));
  hexhex_verify_report_destroy(verified);

  hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &m, &error));
  double* jacobians = malloc(m.cell_count * sizeof(double));
  hexhex_quality quality = HEXHEX_QUALITY_INIT;
  CHECK_OK(hexhex_mesh_quality(mesh, NULL, jacobians, &quality, &error));
  double minimum = 1;
  for (size_t c = 0; c < m.cell_count; ++c) minimum = fmin(minimum, jacobians[c]);
  CHECK(minimum == quality.minimum && quality.not_positive == 0);

  uint8_t* validity = malloc(m.cell_count);
  hexhex_certificate certificate = HEXHEX_CERTIFICATE_INIT;
  CHECK_OK(hexhex_mesh_certify(mesh, NULL, validity, jacobians, &certificate, &error));
  CHECK(certificate.positive == m.cell_count && certificate.refuted == 0);
  CHECK(certificate.undecided == 0 && certificate.worst_count == 0);
  CHECK(certificate.minimum > 0 && certificate.minimum <= minimum);
  for (size_t c = 0; c < m.cell_count; ++c) CHECK(validity[c] == HEXHEX_POSITIVE);
  CHECK_OK(hexhex_mesh_certify(mesh, NULL, NULL, NULL, NULL, &error));
  free(validity);
  free(jacobians);

  const double points[24] = {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1,
                             0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const uint32_t corners[8] = {0, 1, 2, 3, 4, 5, 6, 7}; /* upside down */
  hexhex_mesh_arrays inverted = HEXHEX_MESH_ARRAYS_INIT;
  inverted.point_count = 8;
  inverted.points = points;
  inverted.cell_count = 1;
  inverted.cells = corners;
  hexhex_mesh* bad = NULL;
  CHECK_OK(hexhex_mesh_copy(&inverted, &bad, &error));
  uint8_t verdict = HEXHEX_POSITIVE;
  CHECK_OK(hexhex_mesh_certify(bad, NULL, &verdict, NULL, &certificate, &error));
  CHECK(verdict == HEXHEX_REFUTED && certificate.refuted == 1 && certificate.worst_count == 1);
  CHECK(certificate.worst[0].cell == 0 && certificate.worst[0].scaled_jacobian == -1);
  hexhex_mesh_destroy(bad);

  hexhex_mesh_summary whole = HEXHEX_MESH_SUMMARY_INIT;
  hexhex_mesh_summary other = HEXHEX_MESH_SUMMARY_INIT;
  CHECK_OK(hexhex_summarize_mesh(mesh, NULL, &whole, &error));
  snprintf(file, sizeof file, "%s/mesh.vtu", folder);
  CHECK_OK(hexhex_mesh_write(mesh, file, NULL, NULL, &error));
  CHECK_OK(hexhex_summarize_file(file, NULL, NULL, &other, &error));
  CHECK(whole.cells == 3584 && memcmp(&whole, &other, sizeof whole) == 0);
  CHECK_OK(hexhex_extract_to_file(file, map, &options, NULL, NULL, &error));
  CHECK_OK(hexhex_summarize_file(file, NULL, NULL, &other, &error));
  CHECK(memcmp(&whole, &other, sizeof whole) == 0);
  hexhex_mesh* copy = NULL;
  CHECK_OK(hexhex_mesh_copy(&m, &copy, &error));
  CHECK_OK(hexhex_summarize_mesh(copy, NULL, &other, &error));
  CHECK(memcmp(&whole, &other, sizeof whole) == 0);
  hexhex_mesh_destroy(copy);
  CHECK_OK(hexhex_mesh_read(file, NULL, NULL, &copy, &error));
  hexhex_mesh_destroy(copy);

  /* Several scales of one map. */
  hexhex_extractor* extractor = NULL;
  CHECK_OK(hexhex_extractor_create(map, 1e-2, 3, NULL, &extractor, &error));
  for (int scale = 3; scale > 0; --scale) {
    options.scale = scale;
    CHECK_OK(hexhex_extractor_extract(extractor, &options, NULL, &copy, &statistics, &error));
    CHECK_OK(hexhex_summarize_mesh(copy, NULL, &other, &error));
    CHECK((scale == 2) == (other.point_checksum == whole.point_checksum));
    hexhex_mesh_destroy(copy);
  }
  options.scale = 4;
  CHECK(hexhex_extractor_extract(extractor, &options, NULL, &copy, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  hexhex_extractor_destroy(extractor);

  /* An array outlives its mesh. */
  hexhex_buffer* buffer = NULL;
  CHECK_OK(hexhex_mesh_take(mesh, HEXHEX_POINTS, &buffer, &error));
  CHECK(hexhex_buffer_data(buffer) == m.points);
  CHECK(hexhex_buffer_bytes(buffer) == 24 * m.point_count);
  hexhex_mesh_arrays left = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &left, &error));
  CHECK(left.points == NULL && left.point_count == 0 && left.cells == m.cells);
  hexhex_mesh_destroy(mesh);
  CHECK(isfinite(((double*)hexhex_buffer_data(buffer))[0]));
  hexhex_buffer_destroy(buffer);
  hexhex_map_destroy(borrowed);
  hexhex_map_destroy(map);
}

static void test_errors(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = NULL;
  CHECK(hexhex_map_read("/nowhere/at/all.hexex", NULL, NULL, &map, &error) ==
        HEXHEX_FILE_NOT_FOUND);
  CHECK(map == NULL && error.status == HEXHEX_FILE_NOT_FOUND && strlen(error.message) > 20);
  snprintf(file, sizeof file, "%s/bad.hexex", folder);
  FILE* out = fopen(file, "w");
  fputs("2\n0 0 0\n0 x 0\n", out);
  fclose(out);
  CHECK(hexhex_map_read(file, NULL, NULL, &map, &error) == HEXHEX_FILE_SYNTAX);
  CHECK(error.place.kind == HEXHEX_PLACE_LINE && error.place.index == 3);
  CHECK(hexhex_map_generate("banana", NULL, &map, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(strstr(error.message, "banana") != NULL);
  CHECK(hexhex_map_generate(NULL, NULL, &map, NULL) == HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_map_read("x", NULL, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_extract(NULL, NULL, NULL, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);

  /* A flat tet: found by extraction with its place, and by the check with all places. */
  hexhex_map* good = sphere(1);
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(good, &arrays, &error));
  double* parameters = malloc(12 * arrays.tet_count * sizeof(double));
  memcpy(parameters, arrays.parameters, 12 * arrays.tet_count * sizeof(double));
  memcpy(parameters + 12 * 5, parameters + 12 * 5 + 3, 3 * sizeof(double));
  arrays.parameters = parameters;
  CHECK_OK(hexhex_map_borrow(&arrays, &map, &error));
  hexhex_mesh* mesh = NULL;
  CHECK(hexhex_extract(map, NULL, NULL, &mesh, NULL, &error) == HEXHEX_FLIPPED_TET);
  CHECK(mesh == NULL && error.place.kind == HEXHEX_PLACE_TET);
  const uint64_t flipped = error.place.index;
  CHECK(flipped < arrays.tet_count);
  CHECK(strcmp(hexhex_status_name(error.status), "FlippedTet") == 0);
  hexhex_check_report* report = NULL;
  hexhex_check_summary summary = HEXHEX_CHECK_SUMMARY_INIT;
  hexhex_defect defect = HEXHEX_DEFECT_INIT;
  hexhex_place place;
  double amount = -1;
  CHECK_OK(hexhex_check(map, 1e-2, 1, NULL, &report, &error));
  CHECK_OK(hexhex_check_get_summary(report, &summary, &error));
  CHECK(!summary.valid && summary.defect_count > 0);
  CHECK_OK(hexhex_check_get_defect(report, 0, &defect, &error));
  CHECK(defect.code == HEXHEX_FLIPPED_TET && defect.worst_count > 0 && strlen(defect.sentence) > 0);
  CHECK_OK(hexhex_check_get_occurrence(report, 0, 0, &place, &amount, &error));
  CHECK(place.kind == HEXHEX_PLACE_TET && place.index == flipped && amount >= 0);
  CHECK(hexhex_check_get_defect(report, 99, &defect, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_check_report_destroy(report);
  hexhex_map_destroy(map);
  free(parameters);

  /* Structs of other versions. */
  struct {
    hexhex_extract_options known;
    uint64_t unknown;
  } newer = {HEXHEX_EXTRACT_OPTIONS_INIT, 0};
  newer.known.size = sizeof newer;
  CHECK_OK(hexhex_extract(good, &newer.known, NULL, &mesh, NULL, &error));
  hexhex_mesh_destroy(mesh);
  newer.unknown = 1;
  CHECK(hexhex_extract(good, &newer.known, NULL, &mesh, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_extract_options older = {0, HEXHEX_ENGINE_ATLAS, 1, -1, 0, 0, HEXHEX_NODES_BLENDED};
  older.size = offsetof(hexhex_extract_options, tolerance); /* so that is the default */
  CHECK_OK(hexhex_extract(good, &older, NULL, &mesh, NULL, &error));
  hexhex_mesh_destroy(mesh);
  older.size = 0;
  CHECK(hexhex_extract(good, &older, NULL, &mesh, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_statistics small = HEXHEX_STATISTICS_INIT;
  small.size = offsetof(hexhex_statistics, max_displacement);
  small.max_displacement = 77; /* beyond what the caller says it knows */
  CHECK_OK(hexhex_extract(good, NULL, NULL, &mesh, &small, &error));
  CHECK(small.threads > 0 && small.max_displacement == 77);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(good);

  /* Names of all numbers, and of those that are none. */
  for (int s = 0; s <= HEXHEX_INTERNAL; ++s) {
    CHECK(strcmp(hexhex_status_name((hexhex_status)s), "Unknown") != 0);
  }
  CHECK(strcmp(hexhex_status_name((hexhex_status)(HEXHEX_INTERNAL + 1)), "Unknown") == 0);
  /* Destroying nothing. */
  hexhex_map_destroy(NULL);
  hexhex_mesh_destroy(NULL);
  hexhex_buffer_destroy(NULL);
  hexhex_context_destroy(NULL);
  hexhex_extractor_destroy(NULL);
  hexhex_check_report_destroy(NULL);
  hexhex_verify_report_destroy(NULL);
  hexhex_repair_report_destroy(NULL);
  hexhex_holes_destroy(NULL);
  hexhex_piecewise_mesh_destroy(NULL);
  hexhex_lagrange_mesh_destroy(NULL);
  hexhex_mesh_writer_destroy(NULL);
  CHECK(hexhex_piecewise_mesh_straight(NULL) == NULL && hexhex_extractor_cells(NULL) == 0);
}

struct progress {
  int calls;
  int stop_after;
  double last;
};

static int on_progress(void* user, const char* stage, double share) {
  struct progress* p = user;
  CHECK(stage != NULL && strlen(stage) > 0 && share >= 0 && share <= 1);
  p->last = share;
  return ++p->calls > p->stop_after;
}

/* A hexahedron and a pyramid. */
static void test_mixed_cells(const char* folder) {
  hexhex_error error;
  char name[512];
  hexhex_mesh* mesh = NULL;
  hexhex_read_options options = HEXHEX_READ_OPTIONS_INIT;
  snprintf(name, sizeof name, "%s/mixed.mesh", folder);
  FILE* out = fopen(name, "w");
  fputs(
      "MeshVersionFormatted 2 Dimension 3 Vertices 9 0 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0\n"
      "0 0 1 0 1 0 1 0 1 1 1 0 0 1 1 0 0 0 2 0 Hexahedra 1 1 2 3 4 5 6 7 8 0\n"
      "Pyramids 1 5 6 7 8 9 0 End\n",
      out);
  fclose(out);
  CHECK(hexhex_mesh_read(name, &options, NULL, &mesh, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK(strstr(error.message, "1 hexahedron and 1 pyramid") != NULL);
  options.hexes_only = 1;
  CHECK_OK(hexhex_mesh_read(name, &options, NULL, &mesh, &error));
  hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &arrays, &error));
  CHECK(arrays.cell_count == 1);
  hexhex_mesh_destroy(mesh);
}

static void test_context(void) {
  hexhex_error error;
  hexhex_map* map = sphere(2);
  hexhex_mesh* mesh = NULL;
  struct progress progress = {0, 1000000, -1};
  hexhex_context_options options = HEXHEX_CONTEXT_OPTIONS_INIT;
  hexhex_context* context = NULL;
  options.threads = 1;
  options.progress = on_progress;
  options.user = &progress;
  CHECK_OK(hexhex_context_create(&options, &context, &error));
  CHECK_OK(hexhex_extract(map, NULL, context, &mesh, NULL, &error));
  CHECK(progress.calls > 5);
  hexhex_mesh_destroy(mesh);
  mesh = NULL;
  const char* name = NULL;
  double seconds = -1;
  CHECK(hexhex_context_stage_count(context) > 5);
  CHECK_OK(hexhex_context_stage(context, 0, &name, &seconds, &error));
  CHECK(strcmp(name, "input") == 0 && seconds >= 0);
  CHECK(hexhex_context_stage(context, 999, &name, &seconds, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_context_destroy(context);

  progress.calls = 0;
  progress.stop_after = 3;
  CHECK_OK(hexhex_context_create(&options, &context, &error));
  CHECK(hexhex_extract(map, NULL, context, &mesh, NULL, &error) == HEXHEX_CANCELLED);
  CHECK(mesh == NULL);
  hexhex_context_destroy(context);

  CHECK_OK(hexhex_context_create(NULL, &context, &error));
  hexhex_context_cancel(context);
  CHECK(hexhex_extract(map, NULL, context, &mesh, NULL, &error) == HEXHEX_CANCELLED);
  hexhex_context_destroy(context);
  options.threads = -1;
  CHECK(hexhex_context_create(&options, &context, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_map_destroy(map);
}

/* Tags and regions go in and come out, and options reach writers. */
static void test_features(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  sample.features = 1;
  hexhex_map* map = NULL;
  hexhex_map* borrowed = NULL;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_map_generate("box", &sample, &map, &error));
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(map, &arrays, &error));
  CHECK(arrays.feature_vertex_count == 8 && arrays.feature_edge_count == 12 * 4);
  CHECK(arrays.feature_faces != NULL && arrays.regions != NULL);
  CHECK_OK(hexhex_map_borrow(&arrays, &borrowed, &error));
  CHECK_OK(hexhex_extract(borrowed, NULL, NULL, &mesh, NULL, &error));
  hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &m, &error));
  CHECK(m.feature_vertex_count == 8 && m.feature_edge_count == 12 * 8);
  CHECK(m.feature_quad_count == 6 * 64 && m.regions != NULL);
  for (size_t c = 0; c < m.cell_count; ++c) CHECK(m.regions[c] >= 1 && m.regions[c] <= 8);
  hexhex_mesh* copy = NULL;
  hexhex_mesh_arrays copied = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_copy(&m, &copy, &error));
  CHECK_OK(hexhex_mesh_get_arrays(copy, &copied, &error));
  CHECK(memcmp(copied.feature_quads, m.feature_quads,
               m.feature_quad_count * sizeof(*m.feature_quads)) == 0);
  CHECK(memcmp(copied.regions, m.regions, m.cell_count * sizeof(*m.regions)) == 0);
  hexhex_buffer* taken = NULL;
  CHECK_OK(hexhex_mesh_take(copy, HEXHEX_FEATURE_QUADS, &taken, &error));
  CHECK(hexhex_buffer_data(taken) == copied.feature_quads);
  hexhex_buffer_destroy(taken);
  hexhex_mesh_destroy(copy);
  /* A region that is not there for each tet cannot be said in C; a vertex that is not there can. */
  const hexhex_feature_vertex nowhere = {4000000000U, 1};
  hexhex_map* bad = NULL;
  arrays.feature_vertices = &nowhere;
  arrays.feature_vertex_count = 1;
  CHECK_OK(hexhex_map_borrow(&arrays, &bad, &error));
  copy = NULL;
  CHECK(hexhex_extract(bad, NULL, NULL, &copy, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(copy == NULL);
  hexhex_map_destroy(bad);
  arrays.feature_vertices = NULL;
  CHECK(hexhex_map_borrow(&arrays, &bad, &error) == HEXHEX_INVALID_ARGUMENT);

  hexhex_buffer* quads = NULL;
  CHECK_OK(hexhex_mesh_boundary_patches(mesh, 40, NULL, &quads, &error));
  CHECK(hexhex_buffer_bytes(quads) == 6 * 64 * sizeof(hexhex_feature_quad));
  hexhex_buffer_destroy(quads);
  CHECK(hexhex_mesh_boundary_patches(mesh, 500, NULL, &quads, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_structure structure = HEXHEX_STRUCTURE_INIT;
  CHECK_OK(hexhex_mesh_structure(mesh, NULL, &structure, &quads, &error));
  CHECK(structure.boundary_quads == 6 * 64 && structure.euler_characteristic == 1);
  hexhex_buffer_destroy(quads);

  hexhex_write_options write = HEXHEX_WRITE_OPTIONS_INIT;
  write.format = "no such format";
  snprintf(file, sizeof file, "%s/features.vtu", folder);
  CHECK(hexhex_mesh_write(mesh, file, &write, NULL, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK(hexhex_require_format(HEXHEX_OUTPUT_MESH, file, &write, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK_OK(hexhex_require_format(HEXHEX_OUTPUT_MESH, file, NULL, &error));
  CHECK(hexhex_require_format(HEXHEX_OUTPUT_PATCHES, "x.stl", NULL, &error) ==
        HEXHEX_FILE_UNSUPPORTED);
  write.format = NULL;
  write.map_array = "theirs";
  hexhex_read_options read = HEXHEX_READ_OPTIONS_INIT;
  CHECK_OK(hexhex_map_write(map, file, &write, NULL, &error));
  CHECK(hexhex_map_read(file, NULL, NULL, &bad, &error) != HEXHEX_OK);
  read.map_array = "theirs";
  CHECK_OK(hexhex_map_read(file, &read, NULL, &bad, &error));
  hexhex_map_destroy(bad);
  read.keep_walls = 1;  // there are none
  hexhex_mesh* none = NULL;
  CHECK_OK(hexhex_read(file, &read, NULL, &bad, &none, &error));
  CHECK(bad != NULL && none == NULL);
  hexhex_map_destroy(bad);
  CHECK_OK(hexhex_map_read_tets(file, &read, NULL, &bad, &error));
  hexhex_map_arrays tets = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(bad, &tets, &error));
  CHECK(tets.tet_count == arrays.tet_count && tets.parameters == NULL);
  /* As they are, they are no map, which is an error and no crash. */
  CHECK(hexhex_extract(bad, NULL, NULL, &copy, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  /* With points for parameters, which here is one. */
  hexhex_map* pair = NULL;
  CHECK_OK(hexhex_map_from_pair(&tets, &tets, NULL, &pair, &error));
  hexhex_map_destroy(pair);
  hexhex_map_destroy(bad);
  CHECK(hexhex_format_count() > 5);
  hexhex_file_format format = HEXHEX_FILE_FORMAT_INIT;
  CHECK_OK(hexhex_get_format(0, &format, &error));
  CHECK(strlen(format.name) > 0 && format.description != NULL);
  CHECK(hexhex_get_format(999, &format, &error) == HEXHEX_INVALID_ARGUMENT);

  /* A file from pieces of the caller's. */
  hexhex_mesh_writer* writer = NULL;
  CHECK_OK(hexhex_mesh_writer_create(file, NULL, NULL, &writer, &error));
  CHECK_OK(hexhex_mesh_writer_begin(writer, m.point_count, m.cell_count, &error));
  CHECK_OK(hexhex_mesh_writer_points(writer, 0, m.point_count, m.points, m.generator_tet,
                                     m.generator_corners, &error));
  CHECK_OK(hexhex_mesh_writer_cells(writer, 0, m.cell_count, m.cells, &error));
  CHECK_OK(hexhex_mesh_writer_end(writer, &error));
  hexhex_mesh_writer_destroy(writer);
  writer = NULL;
  hexhex_mesh_writer* early = NULL;
  char other[512];
  snprintf(other, sizeof other, "%s/early.vtu", folder);
  CHECK_OK(hexhex_mesh_writer_create(other, NULL, NULL, &early, &error));
  CHECK_OK(hexhex_mesh_writer_begin(early, m.point_count, m.cell_count, &error));
  CHECK(hexhex_mesh_writer_points(early, 0, 1, NULL, NULL, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_mesh_writer_end(early, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_mesh_writer_destroy(early);
  CHECK(access(other, F_OK) != 0);
  hexhex_mesh_summary mine = HEXHEX_MESH_SUMMARY_INIT;
  hexhex_mesh_summary theirs = HEXHEX_MESH_SUMMARY_INIT;
  CHECK_OK(hexhex_summarize_file(file, NULL, NULL, &mine, &error));
  CHECK_OK(hexhex_summarize_mesh(mesh, NULL, &theirs, &error));
  CHECK(memcmp(&mine, &theirs, sizeof mine) == 0);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(borrowed);
  hexhex_map_destroy(map);
}

static void test_repair(void) {
  hexhex_error error;
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  sample.cells = 8;
  sample.refine = 4;
  sample.defects = 2;
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_map_generate("sphere", &sample, &map, &error));
  CHECK(hexhex_extract(map, NULL, NULL, &mesh, NULL, &error) == HEXHEX_FLIPPED_TET);
  CHECK(mesh == NULL);

  hexhex_holes* holes = NULL;
  CHECK_OK(hexhex_extract_partial(map, NULL, NULL, &mesh, &holes, &error));
  hexhex_holes_summary lost = HEXHEX_HOLES_SUMMARY_INIT;
  CHECK_OK(hexhex_holes_get_summary(holes, &lost, &error));
  CHECK(lost.hole_count > 0 && lost.missing_cells > 0 && lost.invalid_tets >= 2);
  hexhex_hole hole = HEXHEX_HOLE_INIT;
  CHECK_OK(hexhex_holes_get(holes, 0, &hole, &error));
  CHECK(hole.invalid_tets > 0 && isfinite(hole.position[2]));
  CHECK(hexhex_holes_get(holes, lost.hole_count, &hole, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &m, &error));
  CHECK(m.cell_count > 0 && m.cell_count < 3584 && m.regions != NULL);
  hexhex_mesh_destroy(mesh);
  hexhex_holes_destroy(holes);

  hexhex_map* repaired = NULL;
  hexhex_repair_report* report = NULL;
  if (hexhex_can_repair()) {
    CHECK_OK(hexhex_repair(map, NULL, NULL, &repaired, &report, &error));
    hexhex_repair_summary summary = HEXHEX_REPAIR_SUMMARY_INIT;
    hexhex_repaired_region region = HEXHEX_REPAIRED_REGION_INIT;
    CHECK_OK(hexhex_repair_get_summary(report, &summary, &error));
    CHECK(summary.changed && summary.bad_tets >= 2 && summary.region_count > 0);
    CHECK_OK(hexhex_repair_get_region(report, 0, &region, &error));
    CHECK(region.place.kind == HEXHEX_PLACE_TET && region.bad_tets > 0 && region.largest_move > 0);
    CHECK(hexhex_repair_get_region(report, 999, &region, &error) == HEXHEX_INVALID_ARGUMENT);
    hexhex_repair_report_destroy(report);
    CHECK_OK(hexhex_extract(repaired, NULL, NULL, &mesh, NULL, &error));
    hexhex_mesh_destroy(mesh);
    hexhex_map_destroy(repaired);
    /* In one go; the map is that of the mesh, and outlives it. */
    hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
    hexhex_statistics statistics = HEXHEX_STATISTICS_INIT;
    hexhex_verify_report* verified = NULL;
    options.repair = 1;
    CHECK_OK(hexhex_extract(map, &options, NULL, &mesh, &statistics, &error));
    CHECK_OK(hexhex_mesh_get_repair(mesh, &repaired, &report, &error));
    CHECK(repaired != NULL && report != NULL);
    CHECK_OK(hexhex_verify(repaired, mesh, 1e-2, 1, NULL, &verified, &error));
    CHECK(hexhex_verify_passed(verified));
    hexhex_verify_report_destroy(verified);
    hexhex_mesh_destroy(mesh);
    hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
    CHECK_OK(hexhex_map_get_arrays(repaired, &arrays, &error));
    CHECK(arrays.tet_count > 0 && isfinite(arrays.parameters[0]));
    hexhex_map_destroy(repaired);
    hexhex_repair_report_destroy(report);
  } else {
    CHECK(hexhex_repair(map, NULL, NULL, &repaired, &report, &error) == HEXHEX_INVALID_ARGUMENT);
  }
  hexhex_map_destroy(map);
}

/* Its parameters multiplied by an irrational number, a map is seamless, and no integer-grid map;
 * its charts sheared, it is neither. */
static hexhex_map* seamless_sphere(int refine, double shear) {
  hexhex_error error;
  hexhex_map* map = sphere(refine);
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  hexhex_map* seamless = NULL;
  CHECK_OK(hexhex_map_get_arrays(map, &arrays, &error));
  double* const parameters = malloc(12 * arrays.tet_count * sizeof *parameters);
  for (size_t i = 0; i < 12 * arrays.tet_count; ++i) {
    const double* const of_corner = arrays.parameters + i / 3 * 3;
    parameters[i] = sqrt(2.0) * (arrays.parameters[i] + shear * of_corner[(i + 1) % 3]);
  }
  arrays.parameters = parameters;
  CHECK_OK(hexhex_map_copy(&arrays, &seamless, &error));
  free(parameters);
  hexhex_map_destroy(map);
  return seamless;
}

static void test_improve(void) {
  hexhex_error error;
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  sample.cells = 2;
  sample.jitter = 0.6;
  CHECK_OK(hexhex_map_generate("torus", &sample, &map, &error));
  hexhex_extract_options extraction = HEXHEX_EXTRACT_OPTIONS_INIT;
  extraction.scale = 2;
  CHECK_OK(hexhex_extract(map, &extraction, NULL, &mesh, NULL, &error));
  hexhex_improve_options options = HEXHEX_IMPROVE_OPTIONS_INIT;
  hexhex_improve_report report = HEXHEX_IMPROVE_REPORT_INIT;
  options.target = 2;
  CHECK(hexhex_mesh_improve(mesh, map, &options, NULL, &report, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK_OK(hexhex_mesh_improve(mesh, map, NULL, NULL, &report, &error));
  CHECK(report.size == sizeof report && report.not_positive_after == 0);
  CHECK(report.minimum_after >= report.minimum_before && report.minimum_after > 0);
  CHECK(report.mean_after > 0 && report.mean_before > 0 && report.diagonal > 0);
  CHECK((report.far_cells_before > 0) == (report.from_mesh_before > 1e-3));
  CHECK((report.far_cells_after > 0) == (report.from_mesh_after > 1e-3));
  CHECK(report.moved_vertices > 0 && report.largest_move >= report.mean_move);
  CHECK(report.patch_vertices > 0 && report.free_vertices > 0 &&
        report.off_surface <= report.moved_vertices);
  CHECK(report.inner_distance_before == 0 && report.inner_distance_after == 0);
  hexhex_certificate proven = HEXHEX_CERTIFICATE_INIT;
  CHECK_OK(hexhex_mesh_certify(mesh, NULL, NULL, NULL, &proven, &error));
  CHECK(proven.refuted == 0 && proven.undecided == 0);
  /* Once more, with the boundary as the surface: it changes little. */
  options.target = 0;
  options.fix_boundary = 1;
  CHECK_OK(hexhex_mesh_improve(mesh, NULL, &options, NULL, &report, &error));
  CHECK(report.patch_vertices == 0 && report.curve_vertices == 0 && report.fixed_vertices > 0);
  CHECK(report.tagged_vertices == 0 && report.boundary_vertices > 0);
  CHECK(report.boundary_vertices <= report.fixed_vertices);
  CHECK(report.added_cells == 0);
  /* A layer under the boundary. */
  hexhex_mesh_arrays before = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &before, &error));
  const size_t cells = before.cell_count;
  options.pillow = HEXHEX_PILLOW_ALWAYS;
  CHECK_OK(hexhex_mesh_improve(mesh, map, &options, NULL, &report, &error));
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &before, &error));
  CHECK(report.added_cells > 0 && before.cell_count == cells + report.added_cells);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
}

/* Writes the bounding box of a mesh, a little larger, as a surface. */
static void write_box(const hexhex_mesh_arrays* mesh, const char* file) {
  static const int triangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                       {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                       {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  double box[2][3] = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
  for (size_t i = 0; i < 3 * mesh->point_count; ++i) {
    box[0][i % 3] = fmin(box[0][i % 3], mesh->points[i]);
    box[1][i % 3] = fmax(box[1][i % 3], mesh->points[i]);
  }
  FILE* out = fopen(file, "w");
  fprintf(out, "OFF\n8 12 0\n");
  for (int c = 0; c < 8; ++c) {
    for (int k = 0; k < 3; ++k) {
      const int side = c >> k & 1;
      const double width = box[1][k] - box[0][k];
      fprintf(out, "%.17g ", box[side][k] + (side - 0.5) * 0.02 * width);
    }
    fprintf(out, "\n");
  }
  for (int t = 0; t < 12; ++t)
    fprintf(out, "3 %d %d %d\n", triangles[t][0], triangles[t][1], triangles[t][2]);
  fclose(out);
}

/* Onto a surface that a file has. */
static void test_improve_on_surface(const char* folder) {
  hexhex_error error;
  char file[512];
  snprintf(file, sizeof file, "%s/box.off", folder);
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_map_generate("box", NULL, &map, &error));
  CHECK_OK(hexhex_extract(map, NULL, NULL, &mesh, NULL, &error));
  hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_mesh_get_arrays(mesh, &arrays, &error));
  hexhex_improve_options options = HEXHEX_IMPROVE_OPTIONS_INIT;
  hexhex_improve_report report = HEXHEX_IMPROVE_REPORT_INIT;
  options.surface = file;
  CHECK(hexhex_mesh_improve(mesh, NULL, &options, NULL, &report, &error) == HEXHEX_FILE_NOT_FOUND);
  write_box(&arrays, file);
  CHECK(hexhex_mesh_improve(mesh, map, &options, NULL, &report, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK_OK(hexhex_mesh_improve(mesh, NULL, &options, NULL, &report, &error));
  CHECK(report.from_mesh_before > 1e-3 && report.from_mesh_after < 1e-9);
  CHECK(report.cannot_be_positive == 0 && report.paired_vertices == 0);
  /* A box of boxes is held by its corners, if by anything. */
  CHECK(report.worst_cell < arrays.cell_count && report.worst_vertex < arrays.point_count);
  CHECK(report.worst_tagged == 0 && report.worst_held_by <= HEXHEX_HELD_BY_CORNER);
  CHECK(report.worst_angle == 0 || fabs(report.worst_angle - 90) < 1e-6);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
}

/* Curved cells: extracted, improved, written, and read again. */
static void test_improve_curved(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = NULL;
  hexhex_lagrange_mesh* mesh = NULL;
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  sample.cells = 1;
  sample.jitter = 0.2;
  CHECK_OK(hexhex_map_generate("sphere", &sample, &map, &error));
  hexhex_improve_options options = HEXHEX_IMPROVE_OPTIONS_INIT;
  options.passes = 1;
  for (int order = 2; order <= 4; ++order) {
    hexhex_improve_report report = HEXHEX_IMPROVE_REPORT_INIT;
    hexhex_certificate before = HEXHEX_CERTIFICATE_INIT;
    hexhex_certificate after = HEXHEX_CERTIFICATE_INIT;
    hexhex_extract_options nodes = HEXHEX_EXTRACT_OPTIONS_INIT;
    hexhex_lagrange_arrays arrays = HEXHEX_LAGRANGE_ARRAYS_INIT;
    CHECK_OK(hexhex_extract_lagrange(map, order, &nodes, NULL, &mesh, NULL, &error));
    CHECK_OK(hexhex_lagrange_mesh_certify(mesh, NULL, NULL, NULL, &before, &error));
    CHECK_OK(hexhex_lagrange_mesh_get_arrays(mesh, &arrays, &error));
    CHECK(before.refuted + before.undecided == 0 &&
          arrays.straightened_cell_count < before.positive);
    hexhex_lagrange_mesh_destroy(mesh);
    nodes.curved_nodes = (hexhex_curved_nodes)2;
    CHECK(hexhex_extract_lagrange(map, order, &nodes, NULL, &mesh, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    nodes.curved_nodes = HEXHEX_NODES_EXACT;
    CHECK_OK(hexhex_extract_lagrange(map, order, &nodes, NULL, &mesh, NULL, &error));
    CHECK_OK(hexhex_lagrange_mesh_get_arrays(mesh, &arrays, &error));
    CHECK(arrays.straightened_cell_count == 0);
    CHECK_OK(hexhex_lagrange_mesh_certify(mesh, NULL, NULL, NULL, &before, &error));
    if (order == 4) {
      CHECK(hexhex_lagrange_mesh_improve(mesh, map, &options, NULL, &report, &error) ==
            HEXHEX_INVALID_ARGUMENT);
      hexhex_lagrange_mesh_destroy(mesh);
      continue;
    }
    CHECK_OK(hexhex_lagrange_mesh_improve(mesh, map, &options, NULL, &report, &error));
    CHECK(report.not_positive_before == before.refuted + before.undecided);
    CHECK(report.minimum_after >= report.minimum_before && report.moved_vertices > 0);
    snprintf(file, sizeof file, "%s/improved%d.vtu", folder, order);
    CHECK_OK(hexhex_lagrange_mesh_write(mesh, file, NULL, NULL, &error));
    hexhex_lagrange_mesh_destroy(mesh);
    CHECK_OK(hexhex_lagrange_mesh_read(file, NULL, &mesh, &error));
    CHECK_OK(hexhex_lagrange_mesh_certify(mesh, NULL, NULL, NULL, &after, &error));
    CHECK(report.not_positive_after == after.refuted + after.undecided);
    CHECK(before.positive <= after.positive && after.refuted == 0 && before.refuted > 0);
    /* Its own boundary as the surface: no worse. */
    CHECK_OK(hexhex_lagrange_mesh_improve(mesh, NULL, &options, NULL, NULL, &error));
    hexhex_lagrange_mesh_destroy(mesh);
  }
  hexhex_map_destroy(map);
}

static void test_quantize(void) {
  hexhex_error error;
  hexhex_map* seamless = seamless_sphere(2, 0);
  hexhex_map* quantized = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_context* context = NULL;
  struct progress progress = {0, 1000000, -1};
  hexhex_context_options context_options = HEXHEX_CONTEXT_OPTIONS_INIT;
  context_options.progress = on_progress;
  context_options.user = &progress;
  CHECK_OK(hexhex_context_create(&context_options, &context, &error));
  hexhex_quantize_options options = HEXHEX_QUANTIZE_OPTIONS_INIT;
  hexhex_quantize_report report = HEXHEX_QUANTIZE_REPORT_INIT;
  options.scale = sqrt(0.5);
  CHECK(hexhex_extract(seamless, NULL, NULL, &mesh, NULL, &error) == HEXHEX_TRANSITION_RESIDUAL);
  if (!hexhex_can_quantize()) {
    CHECK(hexhex_quantize(seamless, &options, context, &quantized, &report, &error) ==
          HEXHEX_INVALID_ARGUMENT);
  } else {
    hexhex_seamless_report found = HEXHEX_SEAMLESS_REPORT_INIT;
    CHECK_OK(hexhex_examine_seamless(seamless, context, &found, &error));
    CHECK(found.kind == HEXHEX_SEAMLESS && found.displacement < 1e-9 && found.problem[0] == 0);
    CHECK(fabs(found.cells - 448 * pow(2, 1.5)) < 1e-6);
    CHECK_OK(hexhex_quantize(seamless, &options, context, &quantized, &report, &error));
    CHECK(progress.calls > 0 && hexhex_context_stage_count(context) > 2);
    CHECK(report.size == sizeof report && report.blocks > 0 && report.attempts > 0);
    CHECK(report.arcs > 0 && report.shortest_arc > 0 && report.longest_arc >= report.shortest_arc);
    CHECK(fabs(report.cells_wanted - 448) < 1e-6 && report.cells == 448);
    CHECK(fabs(report.scale / options.scale - 1) < 0.1 && report.displacement < 1e-9);
    CHECK(strcmp(report.integers_by, "HiGHS") == 0 || strcmp(report.integers_by, "rounding") == 0);
    CHECK(report.worst_before > 0 && report.worst_before <= report.median_before);
    CHECK(report.worst_after > 0 && report.median_after <= 1);
    CHECK_OK(hexhex_extract(quantized, NULL, NULL, &mesh, NULL, &error));
    hexhex_verify_report* verified = NULL;
    CHECK_OK(hexhex_verify(quantized, mesh, 1e-2, 1, NULL, &verified, &error));
    CHECK(hexhex_verify_passed(verified));
    hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
    CHECK_OK(hexhex_mesh_get_arrays(mesh, &arrays, &error));
    CHECK(arrays.cell_count == report.cells);
    hexhex_verify_report_destroy(verified);
    hexhex_mesh_destroy(mesh);
    hexhex_map_destroy(quantized);
    quantized = NULL;
    progress.stop_after = progress.calls + 2;
    CHECK(hexhex_quantize(seamless, &options, context, &quantized, NULL, &error) ==
          HEXHEX_CANCELLED);
    CHECK(quantized == NULL);
    hexhex_map* sheared = seamless_sphere(2, 0.1);
    CHECK_OK(hexhex_examine_seamless(sheared, NULL, &found, &error));
    CHECK(found.kind == HEXHEX_NOT_SEAMLESS && strlen(found.problem) > 20 && found.cells == 0);
    CHECK(hexhex_quantize(sheared, &options, NULL, &quantized, &report, &error) ==
          HEXHEX_TRANSITION_RESIDUAL);
    CHECK(quantized == NULL);
    hexhex_map_destroy(sheared);
    /* Flipped tets, with densify as without. */
    hexhex_map* flipped = NULL;
    hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
    sample.cells = 8;
    sample.refine = 6;
    sample.defects = 5;
    CHECK_OK(hexhex_map_generate("sphere", &sample, &flipped, &error));
    for (options.densify = 0; options.densify < 2; ++options.densify) {
      CHECK(hexhex_quantize(flipped, &options, NULL, &quantized, &report, &error) ==
            HEXHEX_FLIPPED_TET);
      CHECK(quantized == NULL && strlen(error.message) > 20);
    }
    hexhex_map_destroy(flipped);
  }
  hexhex_context_destroy(context);
  hexhex_map_destroy(seamless);
}

/* From the tets of a generated map, without the map: once more a map, and a mesh. */
static void test_shape(void) {
  hexhex_error error;
  hexhex_map* given = NULL;
  hexhex_map* seamless = NULL;
  hexhex_map* integer = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_context* context = NULL;
  struct progress progress = {0, 1000000, -1};
  hexhex_context_options context_options = HEXHEX_CONTEXT_OPTIONS_INIT;
  context_options.progress = on_progress;
  context_options.user = &progress;
  CHECK_OK(hexhex_context_create(&context_options, &context, &error));
  CHECK_OK(hexhex_map_generate("cylinder", NULL, &given, &error));
  hexhex_map_arrays tets = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(given, &tets, &error));
  tets.parameters = NULL;
  hexhex_shape_options shape = HEXHEX_SHAPE_OPTIONS_INIT;
  hexhex_quantize_options fineness = HEXHEX_QUANTIZE_OPTIONS_INIT;
  hexhex_mesh_options options = HEXHEX_MESH_OPTIONS_INIT;
  fineness.cells = 300;
  fineness.densify = 1;
  shape.method = HEXHEX_METHOD_POLYCUBE;
  hexhex_improve_options plain = HEXHEX_IMPROVE_OPTIONS_INIT; /* no more cells than the map's */
  options.quantize = &fineness;
  options.shape = &shape;
  options.improve = &plain;
  hexhex_shape_report made = HEXHEX_SHAPE_REPORT_INIT;
  if (!hexhex_can_quantize()) {
    CHECK(hexhex_map_from_tets(&tets, &shape, context, &seamless, &made, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_mesh_from_tets(&tets, &options, context, &mesh, NULL, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
  } else {
    CHECK_OK(hexhex_map_from_tets(&tets, &shape, context, &seamless, &made, &error));
    CHECK(progress.calls > 0 && hexhex_context_stage_count(context) > 2);
    CHECK(made.size == sizeof made && made.method == HEXHEX_METHOD_POLYCUBE);
    /* As many faces as a box has, at least; and two rims, where the surface turns. */
    CHECK(made.charts >= 6 && made.corners >= 8 && made.bad_loops == 0);
    CHECK(made.feature_edges > 0 && made.tagged_edges <= made.feature_edges);
    CHECK(made.deviation > 0 && made.deviation < 0.5 && made.worst > 0 && made.median <= 1);
    for (int i = 0; i < 9; ++i) {
      double product = 0; /* of two rows: a rotation */
      for (int k = 0; k < 3; ++k) {
        product += made.rotation[3 * (i / 3) + k] * made.rotation[3 * (i % 3) + k];
      }
      CHECK(fabs(product - (i / 3 == i % 3)) < 1e-9);
    }
    hexhex_seamless_report found = HEXHEX_SEAMLESS_REPORT_INIT;
    CHECK_OK(hexhex_examine_seamless(seamless, NULL, &found, &error));
    CHECK(found.kind == HEXHEX_SEAMLESS);
    hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
    CHECK_OK(hexhex_map_get_arrays(seamless, &arrays, &error));
    CHECK(memcmp(arrays.points, tets.points, 3 * sizeof(double) * tets.point_count) == 0);
    CHECK(arrays.tet_count == tets.tet_count + made.added_tets);
    CHECK(arrays.feature_edge_count == made.tagged_edges);

    hexhex_quantize_report quantized = HEXHEX_QUANTIZE_REPORT_INIT;
    hexhex_improve_report improved = HEXHEX_IMPROVE_REPORT_INIT;
    hexhex_mesh_reports reports = HEXHEX_MESH_REPORTS_INIT;
    hexhex_shape_report again = HEXHEX_SHAPE_REPORT_INIT;
    reports.shape = &again;
    reports.quantization = &quantized;
    reports.improvement = &improved;
    CHECK_OK(hexhex_mesh_from_tets(&tets, &options, context, &mesh, &integer, &reports, &error));
    /* Between method and rotation there may be bytes of nothing. */
    const size_t behind = offsetof(hexhex_shape_report, rotation);
    CHECK(again.size == made.size && again.method == made.method);
    CHECK(memcmp(again.rotation, made.rotation, sizeof made - behind) == 0);
    CHECK(reports.shape == &again);
    CHECK(quantized.cells_wanted == 300 && quantized.cells > 30 && quantized.cells < 3000);
    CHECK(improved.minimum_after > 0 && improved.not_positive_after == 0);
    hexhex_certificate certificate = HEXHEX_CERTIFICATE_INIT;
    CHECK_OK(hexhex_mesh_certify(mesh, NULL, NULL, NULL, &certificate, &error));
    CHECK(certificate.positive == quantized.cells && certificate.refuted == 0);
    /* The map is the mesh's, up to where the improvement moved vertices. */
    hexhex_mesh* extracted = NULL;
    hexhex_mesh_arrays theirs = HEXHEX_MESH_ARRAYS_INIT;
    hexhex_mesh_arrays ours = HEXHEX_MESH_ARRAYS_INIT;
    CHECK_OK(hexhex_extract(integer, NULL, NULL, &extracted, NULL, &error));
    CHECK_OK(hexhex_mesh_get_arrays(extracted, &theirs, &error));
    CHECK_OK(hexhex_mesh_get_arrays(mesh, &ours, &error));
    CHECK(ours.cell_count == theirs.cell_count && ours.cell_count == quantized.cells);
    CHECK(memcmp(ours.cells, theirs.cells, 8 * sizeof(uint32_t) * ours.cell_count) == 0);
    hexhex_mesh_destroy(extracted);
    hexhex_mesh_destroy(mesh);
    hexhex_map_destroy(integer);
    mesh = NULL;
    integer = NULL;
    CHECK(reports.why[0] == 0); /* there was no choice */
    shape.method = HEXHEX_METHOD_AUTO;
    CHECK_OK(hexhex_mesh_from_tets(&tets, &options, NULL, &mesh, NULL, &reports, &error));
    CHECK(again.method != HEXHEX_METHOD_AUTO && strlen(reports.why) > 10);
    hexhex_mesh_destroy(mesh);
    mesh = NULL;
    shape.method = HEXHEX_METHOD_POLYCUBE;
    /* What is not asked for need not be there. */
    CHECK_OK(hexhex_mesh_from_tets(&tets, &options, NULL, &mesh, NULL, NULL, &error));
    hexhex_mesh_destroy(mesh);
    mesh = NULL;
    progress.stop_after = progress.calls + 2;
    CHECK(hexhex_mesh_from_tets(&tets, &options, context, &mesh, &integer, &reports, &error) ==
          HEXHEX_CANCELLED);
    /* No solid: a tet without volume. */
    double flat[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    uint32_t corners[4] = {0, 1, 2, 3};
    hexhex_map_arrays one = HEXHEX_MAP_ARRAYS_INIT;
    one.points = flat;
    one.point_count = 4;
    one.tets = corners;
    one.tet_count = 1;
    CHECK(hexhex_mesh_from_tets(&one, &options, NULL, &mesh, &integer, &reports, &error) ==
          HEXHEX_FLIPPED_TET);
    CHECK(mesh == NULL && integer == NULL && strlen(error.message) > 20);
    hexhex_map_destroy(seamless);
  }
  hexhex_context_destroy(context);
  hexhex_map_destroy(given);
}

/* Tags of a file come along; a file of tets needs no mesher. */
static void test_read_part(void) {
  const char* const file = "tagged.mesh";
  FILE* const out = fopen(file, "w");
  CHECK(out != NULL);
  if (out == NULL) return;
  fputs(
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "Triangles\n1\n1 2 3 7\nTetrahedra\n1\n1 2 3 4 5\nEnd\n",
      out);
  fclose(out);
  hexhex_error error;
  hexhex_map* part = NULL;
  hexhex_fill_report report = HEXHEX_FILL_REPORT_INIT;
  CHECK_OK(hexhex_map_read_part(file, NULL, NULL, &part, &report, &error));
  CHECK(report.size == sizeof report && report.mesher[0] == 0 && report.tets == 0);
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(part, &arrays, &error));
  CHECK(arrays.tet_count == 1 && arrays.regions != NULL && arrays.regions[0] == 5);
  CHECK(arrays.feature_face_count == 1 && arrays.feature_faces[0].tag == 7);
  hexhex_map_destroy(part);
  hexhex_fill_options options = HEXHEX_FILL_OPTIONS_INIT;
  options.tet_size = 1;
  CHECK(hexhex_map_read_part(file, &options, NULL, &part, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  options.mesher = (hexhex_mesher)9;
  CHECK(hexhex_map_read_part(file, &options, NULL, &part, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_map_read_part("nothing.stl", NULL, NULL, &part, NULL, &error) ==
        HEXHEX_FILE_NOT_FOUND);
  remove(file);
}

static void test_curved(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = sphere(2);
  hexhex_piecewise_mesh* pieces = NULL;
  CHECK_OK(hexhex_extract_piecewise(map, 1, NULL, NULL, &pieces, NULL, &error));
  hexhex_arc_arrays arcs = HEXHEX_ARC_ARRAYS_INIT;
  hexhex_patch_arrays patches = HEXHEX_PATCH_ARRAYS_INIT;
  hexhex_mesh_arrays straight = HEXHEX_MESH_ARRAYS_INIT;
  CHECK_OK(hexhex_piecewise_mesh_get_arcs(pieces, &arcs, &error));
  CHECK_OK(hexhex_piecewise_mesh_get_patches(pieces, &patches, &error));
  CHECK_OK(hexhex_mesh_get_arrays(hexhex_piecewise_mesh_straight(pieces), &straight, &error));
  CHECK(straight.cell_count == 448 && arcs.point_begin[arcs.arc_count] == arcs.point_count);
  CHECK(arcs.segment_count == arcs.point_count + arcs.arc_count);
  CHECK(patches.face_count > 3 * 448 &&
        patches.polygon_begin[patches.face_count] == patches.polygon_count);
  CHECK(patches.corner_begin[patches.polygon_count] == patches.corner_count);
  for (size_t i = 0; i < patches.corner_count; ++i) {
    CHECK(patches.corners[i] < straight.point_count + arcs.point_count + patches.point_count);
  }
  snprintf(file, sizeof file, "%s/arcs.vtu", folder);
  CHECK_OK(hexhex_piecewise_mesh_write_arcs(pieces, file, NULL, &error));
  CHECK_OK(hexhex_piecewise_mesh_write_patches(pieces, file, NULL, &error));
  CHECK(hexhex_piecewise_mesh_write_arcs(pieces, "x.stl", NULL, &error) == HEXHEX_FILE_UNSUPPORTED);
  snprintf(file, sizeof file, "%s/patches.ovmb", folder);
  CHECK_OK(hexhex_piecewise_mesh_write_arcs_with_map(pieces, map, file, NULL, &error));
  CHECK_OK(hexhex_piecewise_mesh_write_patches_with_map(pieces, map, file, NULL, &error));
  CHECK(hexhex_piecewise_mesh_write_arcs_with_map(pieces, NULL, file, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  hexhex_map* other = sphere(1);
  CHECK(hexhex_piecewise_mesh_write_patches_with_map(pieces, other, file, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  hexhex_map_destroy(other);
  hexhex_piecewise_mesh_destroy(pieces);
  CHECK_OK(hexhex_extract_piecewise(map, 0, NULL, NULL, &pieces, NULL, &error));
  CHECK_OK(hexhex_piecewise_mesh_get_patches(pieces, &patches, &error));
  CHECK(patches.face_count == 0);
  hexhex_piecewise_mesh_destroy(pieces);

  hexhex_lagrange_mesh* curved = NULL;
  CHECK(hexhex_extract_lagrange(map, 0, NULL, NULL, &curved, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_extract_lagrange(map, 10, NULL, NULL, &curved, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  CHECK_OK(hexhex_extract_lagrange(map, 2, NULL, NULL, &curved, NULL, &error));
  hexhex_lagrange_arrays nodes = HEXHEX_LAGRANGE_ARRAYS_INIT;
  CHECK_OK(hexhex_lagrange_mesh_get_arrays(curved, &nodes, &error));
  CHECK(nodes.order == 2 && nodes.cell_count == 448 && nodes.vertex_count == straight.point_count);
  double* jacobians = malloc(nodes.cell_count * sizeof(double));
  hexhex_quality quality = HEXHEX_QUALITY_INIT;
  CHECK_OK(hexhex_lagrange_mesh_quality(curved, NULL, jacobians, &quality, &error));
  CHECK(quality.minimum <= jacobians[0]);
  hexhex_certificate certificate = HEXHEX_CERTIFICATE_INIT;
  CHECK_OK(hexhex_lagrange_mesh_certify(curved, NULL, NULL, NULL, &certificate, &error));
  CHECK(certificate.positive + certificate.refuted + certificate.undecided == nodes.cell_count);
  CHECK(certificate.minimum <= quality.minimum);
  free(jacobians);
  snprintf(file, sizeof file, "%s/curved.vtu", folder);
  CHECK_OK(hexhex_lagrange_mesh_write(curved, file, NULL, NULL, &error));
  hexhex_mesh* corners = NULL;
  CHECK_OK(hexhex_lagrange_mesh_straight(curved, &corners, &error));
  CHECK_OK(hexhex_mesh_get_arrays(corners, &straight, &error));
  CHECK(straight.cell_count == 448);
  hexhex_mesh_destroy(corners);
  hexhex_buffer* buffer = NULL;
  CHECK_OK(hexhex_lagrange_mesh_take(curved, HEXHEX_CELLS, &buffer, &error));
  CHECK(hexhex_buffer_bytes(buffer) == 27 * 448 * sizeof(uint32_t));
  hexhex_lagrange_mesh_destroy(curved);
  CHECK(((uint32_t*)hexhex_buffer_data(buffer))[0] < nodes.point_count);
  hexhex_buffer_destroy(buffer);
  hexhex_map_destroy(map);
}

/* A progress function that uses the library itself, and misuses it. */
struct reentry {
  hexhex_map* map;
  hexhex_context* context;
  int done;
};
static int on_reentry(void* user, const char* stage, double share) {
  struct reentry* r = user;
  hexhex_error error;
  hexhex_mesh* mesh = NULL;
  (void)stage;
  (void)share;
  if (r->done) return 0;
  r->done = 1;
  CHECK_OK(hexhex_extract(r->map, NULL, NULL, &mesh, NULL, &error));
  hexhex_mesh_destroy(mesh);
  mesh = NULL;
  CHECK(hexhex_extract(r->map, NULL, r->context, &mesh, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(mesh == NULL && strstr(error.message, "in use") != NULL);
  return 0;
}

static void test_reentry(void) {
  hexhex_error error;
  struct reentry reentry = {sphere(2), NULL, 0};
  hexhex_context_options options = HEXHEX_CONTEXT_OPTIONS_INIT;
  options.progress = on_reentry;
  options.user = &reentry;
  CHECK_OK(hexhex_context_create(&options, &reentry.context, &error));
  hexhex_mesh* mesh = NULL;
  CHECK_OK(hexhex_extract(reentry.map, NULL, reentry.context, &mesh, NULL, &error));
  CHECK(reentry.done);
  hexhex_mesh_destroy(mesh);
  hexhex_context_destroy(reentry.context);
  hexhex_map_destroy(reentry.map);
}

struct counts {
  uint64_t points;
  uint64_t cells;
  uint64_t stop_at;
  int ended;
};
static int on_begin(void* user, uint64_t points, uint64_t cells) {
  (void)user;
  CHECK(points > 0);
  CHECK(cells == 3584);
  return 0;
}
static int on_points(void* user, uint64_t first, size_t count, const double* points,
                     const uint32_t* tets, const uint8_t* corners) {
  struct counts* c = user;
  CHECK(first == c->points && isfinite(points[3 * count - 1]));
  CHECK(tets != NULL && corners[count - 1] >= 1 && corners[count - 1] <= 15);
  c->points += count;
  return 0;
}
static int on_cells(void* user, uint64_t first, size_t count, const uint32_t* cells) {
  struct counts* c = user;
  CHECK(first == c->cells && cells[8 * count - 1] < c->points);
  c->cells += count;
  return c->cells >= c->stop_at;
}
static int on_end(void* user) {
  ((struct counts*)user)->ended = 1;
  return 0;
}

static void test_sink(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = sphere(2);
  struct counts counts = {0, 0, UINT64_MAX, 0};
  hexhex_sink sink = HEXHEX_SINK_INIT;
  sink.user = &counts;
  sink.begin = on_begin;
  sink.points = on_points;
  sink.cells = on_cells;
  sink.end = on_end;
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  options.scale = 2;
  CHECK_OK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error));
  CHECK(counts.cells == 3584 && counts.points > 3584 && counts.ended);
  struct counts stopped = {0, 0, 1, 0};
  sink.user = &stopped;
  CHECK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error) == HEXHEX_CANCELLED);
  CHECK(!stopped.ended);
  struct counts read = {0, 0, UINT64_MAX, 0};
  sink.user = &read;
  snprintf(file, sizeof file, "%s/sink.vtu", folder);
  CHECK_OK(hexhex_extract_to_file(file, map, &options, NULL, NULL, &error));
  CHECK_OK(hexhex_mesh_read_to(&sink, file, NULL, NULL, &error));
  CHECK(read.cells == counts.cells && read.points == counts.points && read.ended);
  hexhex_map_destroy(map);
}

/* One map, read by several threads at once, each with a context and an error of its own. */
static void* extract_in_thread(void* argument) {
  const hexhex_map* map = argument;
  hexhex_error error;
  for (int i = 0; i < 5; ++i) {
    hexhex_mesh* mesh = NULL;
    hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
    if (hexhex_extract(map, NULL, NULL, &mesh, NULL, &error) != HEXHEX_OK ||
        hexhex_mesh_get_arrays(mesh, &arrays, &error) != HEXHEX_OK || arrays.cell_count != 448) {
      return argument;
    }
    hexhex_mesh_destroy(mesh);
    if (hexhex_map_read("/nowhere.hexex", NULL, NULL, NULL, &error) == HEXHEX_OK) return argument;
  }
  return NULL;
}

static void test_threads(void) {
  hexhex_map* map = sphere(2);
  pthread_t threads[4];
  for (int i = 0; i < 4; ++i) {
    CHECK(pthread_create(&threads[i], NULL, extract_in_thread, map) == 0);
  }
  for (int i = 0; i < 4; ++i) {
    void* result = map;
    pthread_join(threads[i], &result);
    CHECK(result == NULL);
  }
  hexhex_map_destroy(map);
}

/* Numbers that no enumeration has, in every function and every struct that takes one: never more
 * than an error, also for the sanitizers, which watch what C++ reads. */
static void test_numbers_that_are_none(void) {
  static const int numbers[] = {-1, 8, 24, 1000, INT_MAX, INT_MIN};
  hexhex_error error;
  hexhex_map* map = sphere(1);
  hexhex_mesh* mesh = NULL;
  hexhex_lagrange_mesh* curved = NULL;
  hexhex_check_report* report = NULL;
  CHECK_OK(hexhex_extract(map, NULL, NULL, &mesh, NULL, &error));
  CHECK_OK(hexhex_extract_lagrange(map, 2, NULL, NULL, &curved, NULL, &error));
  CHECK_OK(hexhex_check(map, 1e-2, 1, NULL, &report, &error));
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    const int n = numbers[i];
    hexhex_map* none = NULL;
    hexhex_mesh* no_mesh = NULL;
    hexhex_lagrange_mesh* no_curved = NULL;
    hexhex_piecewise_mesh* no_pieces = NULL;
    hexhex_buffer* buffer = NULL;
    hexhex_extractor* extractor = NULL;
    size_t entries = 77;
    char text[8] = "unused";
    CHECK(strcmp(hexhex_status_name((hexhex_status)n), "Unknown") == 0 || n == 8);
    CHECK(strcmp(hexhex_defect_kind_name((hexhex_defect_kind)n), "Unknown") == 0);
    const hexhex_place place = {(hexhex_place_kind)n, 1, 2};
    CHECK(hexhex_place_text(&place, text, sizeof text) == 0 && text[0] == 0);

    hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
    sample.charts = (hexhex_chart_style)n;
    CHECK(hexhex_map_generate("box", &sample, &none, &error) == HEXHEX_INVALID_ARGUMENT);
    sample.charts = HEXHEX_CHARTS_ALIGNED;
    sample.defect_kind = (hexhex_defect_kind)n;
    CHECK(hexhex_map_generate("box", &sample, &none, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(none == NULL);
    CHECK(hexhex_map_count_answer(map, (hexhex_answer_table)n, &entries, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_map_get_answer_entry(map, (hexhex_answer_table)n, 0, NULL, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(entries == 77);

    hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
    hexhex_sink sink = HEXHEX_SINK_INIT;
    options.engine = (hexhex_engine)n;
    CHECK(hexhex_extract(map, &options, NULL, &no_mesh, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extract_lagrange(map, 2, &options, NULL, &no_curved, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extract_piecewise(map, 1, &options, NULL, &no_pieces, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extract_to_file("/nowhere/x.vtu", map, &options, NULL, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK_OK(hexhex_extractor_create(map, 1e-2, 1, NULL, &extractor, &error));
    CHECK(hexhex_extractor_extract(extractor, &options, NULL, &no_mesh, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extractor_extract_to(extractor, &sink, &options, NULL, NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extractor_extract_lagrange(extractor, 1, &options, NULL, &no_curved, NULL,
                                            &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_extractor_extract_piecewise(extractor, 0, &options, NULL, &no_pieces, NULL,
                                             &error) == HEXHEX_INVALID_ARGUMENT);
    hexhex_extractor_destroy(extractor);
    CHECK(no_mesh == NULL && no_curved == NULL && no_pieces == NULL);

    CHECK(hexhex_mesh_take(mesh, (hexhex_mesh_array)n, &buffer, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_lagrange_mesh_take(curved, (hexhex_mesh_array)n, &buffer, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    CHECK(buffer == NULL);
    CHECK(hexhex_require_format((hexhex_output)n, "x.vtu", NULL, &error) ==
          HEXHEX_INVALID_ARGUMENT);
    /* These have no status: nothing is in a table that there is not. */
    CHECK(hexhex_check_edges_of_valence(report, (hexhex_valence_table)n, 3) == 0);
    CHECK(hexhex_check_next_valence(report, (hexhex_valence_table)n, -1) == -1);
  }
  hexhex_check_report_destroy(report);
  hexhex_lagrange_mesh_destroy(curved);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
}

static void test_answers(void) {
  hexhex_error error;
  hexhex_map* map = NULL;
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  hexhex_sample_answer answer = HEXHEX_SAMPLE_ANSWER_INIT;
  CHECK(hexhex_sample_kind_count() == 8);
  for (size_t i = 0; i < hexhex_sample_kind_count(); ++i) {
    const char* name = NULL;
    const char* description = NULL;
    hexhex_mesh* mesh = NULL;
    hexhex_mesh_arrays m = HEXHEX_MESH_ARRAYS_INIT;
    CHECK_OK(hexhex_get_sample_kind(i, &name, &description, &error));
    CHECK(strlen(description) > 3);
    sample.features = 1;
    CHECK_OK(hexhex_map_generate(name, &sample, &map, &error));
    CHECK_OK(hexhex_map_get_answer(map, &answer, &error));
    CHECK_OK(hexhex_extract(map, NULL, NULL, &mesh, NULL, &error));
    CHECK_OK(hexhex_mesh_get_arrays(mesh, &m, &error));
    CHECK(answer.cells == m.cell_count && answer.vertices == m.point_count);
    CHECK(answer.regions * 64 == m.cell_count);
    /* Tables and counts are those of the mesh. */
    hexhex_structure structure = HEXHEX_STRUCTURE_INIT;
    hexhex_buffer* singular = NULL;
    CHECK_OK(hexhex_mesh_structure(mesh, NULL, &structure, &singular, &error));
    CHECK(answer.boundary_quads == structure.boundary_quads);
    CHECK(answer.euler_characteristic == structure.euler_characteristic);
    CHECK(answer.components == 1 && answer.boundary_components == structure.boundary_components);
    const uint64_t in_mesh[] = {hexhex_buffer_bytes(singular) / sizeof(hexhex_singular_edge), 0,
                                m.feature_vertex_count, m.feature_edge_count, m.feature_quad_count};
    uint64_t sums[5] = {0};
    for (int table = 0; table < 5; ++table) {
      size_t entries = 0;
      int32_t last = -1;
      CHECK_OK(hexhex_map_count_answer(map, (hexhex_answer_table)table, &entries, &error));
      for (size_t e = 0; e < entries; ++e) {
        int32_t key = -1;
        uint64_t count = 0;
        CHECK_OK(
            hexhex_map_get_answer_entry(map, (hexhex_answer_table)table, e, &key, &count, &error));
        CHECK(key > last && count > 0);
        last = key;
        sums[table < 2 ? 0 : table] += count;
      }
      CHECK(hexhex_map_get_answer_entry(map, (hexhex_answer_table)table, entries, NULL, NULL,
                                        &error) == HEXHEX_INVALID_ARGUMENT);
    }
    for (int table = 0; table < 5; ++table) CHECK(sums[table] == in_mesh[table]);
    hexhex_buffer_destroy(singular);
    hexhex_mesh_destroy(mesh);
    hexhex_map_destroy(map);
  }
  CHECK(hexhex_get_sample_kind(8, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(strcmp(hexhex_defect_kind_name(HEXHEX_DEFECTS_SLIVER), "sliver") == 0);

  /* A copy owns its arrays, and nobody knows its answer. */
  double points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const uint32_t tet[4] = {0, 1, 2, 3};
  hexhex_map_arrays arrays = HEXHEX_MAP_ARRAYS_INIT;
  arrays.points = arrays.parameters = points;
  arrays.point_count = 4;
  arrays.tets = tet;
  arrays.tet_count = 1;
  CHECK_OK(hexhex_map_copy(&arrays, &map, &error));
  points[3] = 7;
  CHECK_OK(hexhex_map_get_arrays(map, &arrays, &error));
  CHECK(arrays.points != points && arrays.points[3] == 1 && arrays.parameters[3] == 1);
  CHECK(hexhex_map_get_answer(map, &answer, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_map_copy(NULL, &map, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_map_destroy(map);
}

static void test_small_things(void) {
  char text[32];
  hexhex_place place = {HEXHEX_PLACE_EDGE, 3, 17};
  CHECK(hexhex_place_text(&place, text, sizeof text) == 9 && strcmp(text, "edge 3-17") == 0);
  CHECK(hexhex_place_text(&place, text, 5) == 9 && strcmp(text, "edge") == 0);
  CHECK(hexhex_place_text(&place, NULL, 0) == 9 && hexhex_place_text(NULL, text, 5) == 0);
  place.kind = HEXHEX_PLACE_NONE;
  CHECK(hexhex_place_text(&place, text, sizeof text) == 0 && text[0] == 0);
  static const int kinds[16] = {-1, 0, 0, 1, 0, 1, 1, 2, 0, 1, 1, 2, 1, 2, 2, 3};
  for (int corners = 0; corners < 256; ++corners) {
    CHECK(hexhex_generator_kind((uint8_t)corners) == (corners < 16 ? kinds[corners] : -1));
  }
  CHECK(strcmp(hexhex_version(), HEXHEX_VERSION) == 0 && HEXHEX_VERSION_MAJOR >= 0);
  CHECK(hexhex_scaled_jacobian(NULL) == 0);
  CHECK(!hexhex_context_cancelled(NULL) && hexhex_context_threads(NULL) == 0);
  hexhex_context_options options = HEXHEX_CONTEXT_OPTIONS_INIT;
  hexhex_context* context = NULL;
  options.threads = 3;
  CHECK_OK(hexhex_context_create(&options, &context, NULL));
  CHECK(!hexhex_context_cancelled(context) && hexhex_context_threads(context) == 3);
  hexhex_context_cancel(context);
  CHECK(hexhex_context_cancelled(context));
  hexhex_context_destroy(context);
  const double values[] = {-0.5, 0, 0.25, 1};
  hexhex_quality quality = HEXHEX_QUALITY_INIT;
  CHECK_OK(hexhex_summarize_quality(values, 4, &quality, NULL));
  CHECK(quality.minimum == -0.5 && quality.mean == 0.1875 && quality.not_positive == 2);
  CHECK(quality.histogram[19] == 1);
  CHECK(hexhex_summarize_quality(NULL, 4, &quality, NULL) == HEXHEX_INVALID_ARGUMENT);
}

static void test_map_structure(void) {
  hexhex_error error;
  hexhex_map* map = sphere(2);
  hexhex_map_arrays m = HEXHEX_MAP_ARRAYS_INIT;
  hexhex_map_structure* structure = NULL;
  hexhex_map_structure_arrays s = HEXHEX_MAP_STRUCTURE_ARRAYS_INIT;
  CHECK_OK(hexhex_map_get_arrays(map, &m, &error));
  CHECK_OK(hexhex_map_find_structure(map, 1e-2, NULL, &structure, &error));
  CHECK_OK(hexhex_map_structure_get_arrays(structure, &s, &error));
  CHECK(s.defect_count == 0 && s.chart_jump_count > 1000);
  hexhex_check_report* report = NULL;
  hexhex_check_summary summary = HEXHEX_CHECK_SUMMARY_INIT;
  CHECK_OK(hexhex_check(map, 1e-2, 1, NULL, &report, &error));
  CHECK_OK(hexhex_check_get_summary(report, &summary, &error));
  CHECK(s.chart_jump_count == summary.chart_jumps);
  CHECK(s.singular_edge_count == hexhex_check_edges_of_valence(report, HEXHEX_INNER_TET_EDGES, 3));
  hexhex_check_report_destroy(report);
  for (size_t e = 0; e < s.singular_edge_count; ++e) {
    const hexhex_singular_tet_edge edge = s.singular_edges[e];
    CHECK(edge.vertices[0] < edge.vertices[1] && edge.valence == 3 && !edge.boundary);
  }
  /* Transitions carry the parameters of the face's corners over. */
  for (size_t j = 0; j < s.chart_jump_count; ++j) {
    const hexhex_chart_jump jump = s.chart_jumps[j];
    double u[2][3] = {{0}};
    for (int side = 0; side < 2; ++side) {
      for (int corner = 0; corner < 4; ++corner) {
        if (m.tets[4 * jump.tets[side] + corner] != jump.vertices[0]) continue;
        memcpy(u[side], m.parameters + 12 * jump.tets[side] + 3 * corner, sizeof u[side]);
      }
    }
    for (int row = 0; row < 3; ++row) {
      double image = jump.translation[row];
      for (int k = 0; k < 3; ++k) image += jump.rotation[3 * row + k] * u[0][k];
      CHECK(fabs(image - u[1][row]) < 1e-9);
    }
  }
  hexhex_map_structure_destroy(structure);
  hexhex_map_structure_destroy(NULL);
  CHECK(hexhex_map_find_structure(map, 7, NULL, &structure, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_map_destroy(map);
}

/* Cells of higher order of one's own, from files, and without what was taken. */
static void test_lagrange(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_map* map = NULL;
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  hexhex_lagrange_mesh* mesh = NULL;
  hexhex_lagrange_mesh* other = NULL;
  hexhex_lagrange_arrays a = HEXHEX_LAGRANGE_ARRAYS_INIT;
  hexhex_lagrange_arrays b = HEXHEX_LAGRANGE_ARRAYS_INIT;
  int holds = -1;
  sample.features = 1;
  CHECK_OK(hexhex_map_generate("box", &sample, &map, &error));
  CHECK_OK(hexhex_extract_lagrange(map, 3, NULL, NULL, &mesh, NULL, &error));
  CHECK_OK(hexhex_lagrange_mesh_get_arrays(mesh, &a, &error));
  CHECK(a.regions != NULL && a.feature_quad_count > 0 && a.feature_vertex_count == 8);
  snprintf(file, sizeof file, "%s/order3.vtu", folder);
  CHECK_OK(hexhex_lagrange_mesh_write(mesh, file, NULL, NULL, &error));
  CHECK_OK(hexhex_file_holds_lagrange(file, NULL, &holds, &error));
  CHECK(holds == 1);
  CHECK_OK(hexhex_lagrange_mesh_read(file, NULL, &other, &error));
  CHECK_OK(hexhex_lagrange_mesh_get_arrays(other, &b, &error));
  CHECK(b.order == 3 && b.cell_count == a.cell_count && b.vertex_count == a.vertex_count);
  CHECK(memcmp(a.points, b.points, 24 * a.point_count) == 0);
  CHECK(memcmp(a.nodes, b.nodes, 64 * 4 * a.cell_count) == 0);
  CHECK(memcmp(a.generator_tet, b.generator_tet, 4 * a.point_count) == 0);
  hexhex_lagrange_mesh_destroy(other);
  CHECK_OK(hexhex_map_write(map, file, NULL, NULL, &error));
  CHECK_OK(hexhex_file_holds_lagrange(file, NULL, &holds, &error));
  CHECK(holds == 0);
  other = NULL;
  CHECK(hexhex_lagrange_mesh_read(file, NULL, &other, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK(hexhex_lagrange_mesh_read("/nowhere.vtu", NULL, &other, &error) == HEXHEX_FILE_NOT_FOUND);
  CHECK(other == NULL);

  CHECK_OK(hexhex_lagrange_mesh_copy(&a, &other, &error));
  CHECK_OK(hexhex_lagrange_mesh_get_arrays(other, &b, &error));
  CHECK(b.nodes != a.nodes && memcmp(a.nodes, b.nodes, 64 * 4 * a.cell_count) == 0);
  CHECK(memcmp(a.feature_quads, b.feature_quads, 20 * a.feature_quad_count) == 0);
  CHECK(memcmp(a.regions, b.regions, 4 * a.cell_count) == 0);
  /* Whatever is taken, the rest works, or is refused. */
  for (int array = 0; array < 8; ++array) {
    hexhex_buffer* buffer = NULL;
    hexhex_mesh* straight = NULL;
    const hexhex_status wanted =
        array <= HEXHEX_GENERATOR_CORNERS ? HEXHEX_INVALID_ARGUMENT : HEXHEX_OK;
    CHECK_OK(hexhex_lagrange_mesh_take(other, (hexhex_mesh_array)array, &buffer, &error));
    CHECK(hexhex_buffer_bytes(buffer) > 0);
    CHECK(hexhex_lagrange_mesh_straight(other, &straight, &error) == wanted);
    CHECK(hexhex_lagrange_mesh_quality(other, NULL, NULL, NULL, &error) == wanted);
    CHECK(hexhex_lagrange_mesh_write(other, file, NULL, NULL, &error) == wanted);
    hexhex_mesh_destroy(straight);
    hexhex_buffer_destroy(buffer);
    hexhex_lagrange_mesh_destroy(other);
    CHECK_OK(hexhex_lagrange_mesh_copy(&a, &other, &error));
  }
  hexhex_lagrange_mesh_destroy(other);

  /* Arrays that do not fit each other. */
  uint32_t* nodes = malloc(64 * 4 * a.cell_count);
  for (int kind = 0; kind < 5; ++kind) {
    b = a;
    memcpy(nodes, a.nodes, 64 * 4 * a.cell_count);
    b.nodes = nodes;
    if (kind == 0) nodes[100] = (uint32_t)a.point_count;
    if (kind == 1) nodes[64] = (uint32_t)a.vertex_count; /* a corner */
    if (kind == 2) b.vertex_count = b.point_count + 1;
    if (kind == 3) b.vertex_count = 8;
    if (kind == 4) b.point_count = a.vertex_count;
    hexhex_mesh* straight = NULL;
    CHECK_OK(hexhex_lagrange_mesh_copy(&b, &other, &error));
    CHECK(hexhex_lagrange_mesh_straight(other, &straight, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_lagrange_mesh_quality(other, NULL, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
    CHECK(hexhex_lagrange_mesh_write(other, file, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
    hexhex_lagrange_mesh_destroy(other);
  }
  free(nodes);
  other = NULL;
  b = a;
  b.order = 10;
  CHECK(hexhex_lagrange_mesh_copy(&b, &other, &error) == HEXHEX_INVALID_ARGUMENT);
  b.order = 3;
  b.cell_count = SIZE_MAX / 2;
  CHECK(hexhex_lagrange_mesh_copy(&b, &other, &error) == HEXHEX_TOO_LARGE && other == NULL);
  /* Of an extractor, which has another scale before and after. */
  hexhex_extractor* extractor = NULL;
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  hexhex_piecewise_mesh* pieces = NULL;
  hexhex_arc_arrays arcs = HEXHEX_ARC_ARRAYS_INIT;
  CHECK_OK(hexhex_extractor_create(map, 1e-2, 5, NULL, &extractor, &error));
  for (int i = 0; i < 2; ++i) {
    b.cell_count = 0;
    CHECK_OK(hexhex_extractor_extract_lagrange(extractor, 3, NULL, NULL, &other, NULL, &error));
    CHECK_OK(hexhex_lagrange_mesh_get_arrays(other, &b, &error));
    CHECK(b.point_count == a.point_count && b.cell_count == a.cell_count);
    CHECK(memcmp(a.points, b.points, 24 * a.point_count) == 0);
    CHECK(memcmp(a.nodes, b.nodes, 64 * 4 * a.cell_count) == 0);
    CHECK(memcmp(a.regions, b.regions, 4 * a.cell_count) == 0);
    hexhex_lagrange_mesh_destroy(other);
    options.scale = 2;
    CHECK_OK(
        hexhex_extractor_extract_piecewise(extractor, 0, &options, NULL, &pieces, NULL, &error));
    CHECK_OK(hexhex_piecewise_mesh_get_arcs(pieces, &arcs, &error));
    CHECK(arcs.arc_count == 3 * 16 * 17 * 17);
    hexhex_piecewise_mesh_destroy(pieces);
  }
  other = NULL;
  CHECK(hexhex_extractor_extract_lagrange(extractor, 3, &options, NULL, &other, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  CHECK(hexhex_extractor_extract_lagrange(extractor, 10, NULL, NULL, &other, NULL, &error) ==
        HEXHEX_INVALID_ARGUMENT);
  CHECK(other == NULL);
  hexhex_extractor_destroy(extractor);
  hexhex_lagrange_mesh_destroy(mesh);
  hexhex_map_destroy(map);
}

static void test_writer_as_sink(const char* folder) {
  hexhex_error error;
  char file[512];
  char copy[512];
  hexhex_map* map = sphere(2);
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  hexhex_mesh_writer* writer = NULL;
  hexhex_sink sink = HEXHEX_SINK_INIT;
  hexhex_mesh_summary mine = HEXHEX_MESH_SUMMARY_INIT;
  hexhex_mesh_summary theirs = HEXHEX_MESH_SUMMARY_INIT;
  options.scale = 2;
  snprintf(file, sizeof file, "%s/as_sink.data", folder);
  snprintf(copy, sizeof copy, "%s/as_sink.mesh", folder);
  hexhex_write_options writing = HEXHEX_WRITE_OPTIONS_INIT;
  hexhex_read_options reading = HEXHEX_READ_OPTIONS_INIT;
  writing.format = reading.format = "vtu";
  CHECK_OK(hexhex_mesh_writer_create(file, &writing, NULL, &writer, &error));
  CHECK_OK(hexhex_mesh_writer_sink(writer, &sink, &error));
  CHECK_OK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error));
  CHECK(hexhex_summary_writer_get(writer, &mine, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_mesh_writer_destroy(writer);
  CHECK(hexhex_summarize_file(file, NULL, NULL, &mine, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK_OK(hexhex_summarize_file(file, &reading, NULL, &mine, &error));
  CHECK(mine.cells == 3584);

  CHECK_OK(hexhex_mesh_writer_create(copy, NULL, NULL, &writer, &error));
  CHECK_OK(hexhex_mesh_writer_sink(writer, &sink, &error));
  CHECK(hexhex_mesh_read_to(&sink, file, NULL, NULL, &error) == HEXHEX_FILE_UNSUPPORTED);
  CHECK_OK(hexhex_mesh_read_to(&sink, file, &reading, NULL, &error));
  hexhex_mesh_writer_destroy(writer);
  CHECK_OK(hexhex_summarize_file(copy, NULL, NULL, &theirs, &error));
  CHECK(memcmp(&mine, &theirs, sizeof mine) == 0);

  CHECK_OK(hexhex_summary_writer_create(NULL, &writer, &error));
  CHECK(hexhex_summary_writer_get(writer, &theirs, &error) == HEXHEX_INVALID_ARGUMENT);
  CHECK_OK(hexhex_mesh_writer_sink(writer, &sink, &error));
  CHECK_OK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error));
  memset(&theirs.points, 0, sizeof theirs - offsetof(hexhex_mesh_summary, points));
  CHECK_OK(hexhex_summary_writer_get(writer, &theirs, &error));
  CHECK(memcmp(&mine, &theirs, sizeof mine) == 0);
  /* What the writer refuses is the error: it has had a mesh already. */
  CHECK(hexhex_extract_to(&sink, map, &options, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_mesh_writer_destroy(writer);
  /* Its functions work on their own, too. */
  const double points[24] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                             0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
  const uint32_t cell[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const uint64_t wide[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  hexhex_mesh_summary sums[2] = {HEXHEX_MESH_SUMMARY_INIT, HEXHEX_MESH_SUMMARY_INIT};
  for (int i = 0; i < 2; ++i) {
    CHECK_OK(hexhex_summary_writer_create(NULL, &writer, &error));
    CHECK_OK(hexhex_mesh_writer_sink(writer, &sink, &error));
    CHECK(sink.begin(sink.user, 8, 1) == 0);
    CHECK(sink.points(sink.user, 0, 8, points, NULL, NULL) == 0);
    CHECK((i == 0 ? sink.cells(sink.user, 0, 1, cell) : sink.cells64(sink.user, 0, 1, wide)) == 0);
    CHECK(sink.end(sink.user) == 0 && sink.end(sink.user) != 0);
    CHECK_OK(hexhex_summary_writer_get(writer, &sums[i], &error));
    hexhex_mesh_writer_destroy(writer);
  }
  CHECK(sums[0].cells == 1 && memcmp(&sums[0], &sums[1], sizeof *sums) == 0);
  hexhex_map_destroy(map);
}

/* The repair of extractions that leave no mesh, or one of higher order. */
static void test_repair_of_others(const char* folder) {
  hexhex_error error;
  char file[512];
  hexhex_sample_options sample = HEXHEX_SAMPLE_OPTIONS_INIT;
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  hexhex_context* context = NULL;
  hexhex_map* map = NULL;
  hexhex_map* good = sphere(2);
  hexhex_map* repaired = NULL;
  hexhex_repair_report* report = NULL;
  if (!hexhex_can_repair()) {
    hexhex_map_destroy(good);
    return;
  }
  sample.cells = 8;
  sample.refine = 4;
  sample.defects = 2;
  options.repair = 1;
  CHECK_OK(hexhex_map_generate("sphere", &sample, &map, &error));
  hexhex_repair_summary summary = HEXHEX_REPAIR_SUMMARY_INIT;
  hexhex_verify_report* verified = NULL;

  hexhex_lagrange_mesh* curved = NULL;
  hexhex_mesh* straight = NULL;
  CHECK_OK(hexhex_extract_lagrange(map, 2, &options, NULL, &curved, NULL, &error));
  CHECK_OK(hexhex_lagrange_mesh_get_repair(curved, &repaired, &report, &error));
  CHECK_OK(hexhex_repair_get_summary(report, &summary, &error));
  CHECK(summary.changed && summary.bad_tets >= 2);
  CHECK_OK(hexhex_lagrange_mesh_straight(curved, &straight, &error));
  CHECK_OK(hexhex_verify(repaired, straight, 1e-2, 1, NULL, &verified, &error));
  CHECK(hexhex_verify_passed(verified));
  hexhex_verify_report_destroy(verified);
  hexhex_repair_report_destroy(report);
  hexhex_map_destroy(repaired);
  CHECK_OK(hexhex_mesh_get_repair(straight, &repaired, &report, &error));
  CHECK(repaired != NULL && report != NULL);
  hexhex_repair_report_destroy(report);
  hexhex_map_destroy(repaired);
  hexhex_mesh_destroy(straight);
  hexhex_lagrange_mesh_destroy(curved);

  hexhex_sink sink = HEXHEX_SINK_INIT;
  snprintf(file, sizeof file, "%s/repaired.vtu", folder);
  CHECK_OK(hexhex_context_create(NULL, &context, &error));
  CHECK_OK(hexhex_context_get_repair(context, &repaired, &report, &error));
  CHECK(repaired == NULL && report == NULL);
  for (int to_file = 0; to_file < 2; ++to_file) {
    CHECK_OK(to_file ? hexhex_extract_to_file(file, map, &options, context, NULL, &error)
                     : hexhex_extract_to(&sink, map, &options, context, NULL, &error));
    CHECK_OK(hexhex_context_get_repair(context, &repaired, &report, &error));
    CHECK(repaired != NULL && report != NULL);
    hexhex_repair_report_destroy(report);
    if (to_file) {
      CHECK_OK(hexhex_mesh_read(file, NULL, NULL, &straight, &error));
      CHECK_OK(hexhex_verify(repaired, straight, 1e-2, 1, NULL, &verified, &error));
      CHECK(hexhex_verify_passed(verified));
      hexhex_verify_report_destroy(verified);
      hexhex_mesh_destroy(straight);
    }
    hexhex_map_destroy(repaired);
    CHECK_OK(hexhex_extract_to(&sink, good, &options, context, NULL, &error));
    CHECK_OK(hexhex_context_get_repair(context, &repaired, &report, &error));
    CHECK(repaired == NULL && report == NULL);
  }
  CHECK(hexhex_context_get_repair(NULL, NULL, NULL, &error) == HEXHEX_INVALID_ARGUMENT);
  hexhex_context_destroy(context);
  hexhex_map_destroy(good);
  hexhex_map_destroy(map);
}

#if defined(HEXHEX_SANITIZED)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

/* Kilobytes of address space that this process has. */
static long address_space(void) {
  long pages = 0;
  FILE* file = fopen("/proc/self/statm", "r");
  if (file == NULL || fscanf(file, "%ld", &pages) != 1) pages = 0;
  if (file != NULL) fclose(file);
  return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Everything that works on a map, once, until something fails. */
static hexhex_status work_on(const hexhex_map* map, const hexhex_extract_options* options,
                             hexhex_context* context, int curved, hexhex_error* error) {
  hexhex_mesh* mesh = NULL;
  hexhex_check_report* report = NULL;
  hexhex_verify_report* verified = NULL;
  hexhex_map_structure* in_map = NULL;
  hexhex_piecewise_mesh* pieces = NULL;
  hexhex_lagrange_mesh* lagrange = NULL;
  hexhex_extractor* extractor = NULL;
  hexhex_structure structure = HEXHEX_STRUCTURE_INIT;
  hexhex_quality quality = HEXHEX_QUALITY_INIT;
  hexhex_sink sink = HEXHEX_SINK_INIT;
  hexhex_status status = hexhex_extract(map, options, context, &mesh, NULL, error);
  CHECK((status == HEXHEX_OK) == (mesh != NULL));
  if (!status) status = hexhex_check(map, 1e-2, 3, context, &report, error);
  if (!status) status = hexhex_map_find_structure(map, 1e-2, context, &in_map, error);
  if (!status) status = hexhex_verify(map, mesh, 1e-2, 3, context, &verified, error);
  if (!status) status = hexhex_mesh_structure(mesh, context, &structure, NULL, error);
  if (!status) status = hexhex_mesh_quality(mesh, context, NULL, &quality, error);
  if (!status) status = hexhex_extract_to(&sink, map, options, context, NULL, error);
  if (!status) status = hexhex_extractor_create(map, 1e-2, 8, context, &extractor, error);
  if (!status && curved) {
    status =
        hexhex_extractor_extract_piecewise(extractor, 1, options, context, &pieces, NULL, error);
  }
  if (!status && curved) {
    status =
        hexhex_extractor_extract_lagrange(extractor, 2, options, context, &lagrange, NULL, error);
  }
  if (!status && curved) {
    status = hexhex_lagrange_mesh_quality(lagrange, context, NULL, &quality, error);
  }
  CHECK(status || hexhex_verify_passed(verified));
  hexhex_extractor_destroy(extractor);
  hexhex_lagrange_mesh_destroy(lagrange);
  hexhex_piecewise_mesh_destroy(pieces);
  hexhex_map_structure_destroy(in_map);
  hexhex_verify_report_destroy(verified);
  hexhex_check_report_destroy(report);
  hexhex_mesh_destroy(mesh);
  return status;
}

/* Works with ever more address space, from hardly any: each attempt ends well or with OutOfMemory,
 * soon, and the process lives and works when it has memory again. */
static int run_out_of_memory(int threads, hexhex_engine engine, long first) {
  hexhex_error error;
  hexhex_map* map = sphere(4);
  hexhex_mesh* mesh = NULL;
  hexhex_extract_options options = HEXHEX_EXTRACT_OPTIONS_INIT;
  hexhex_context_options context_options = HEXHEX_CONTEXT_OPTIONS_INIT;
  int exhausted = 0;
  context_options.threads = threads;
  options.scale = 3;
  options.engine = engine;
  for (long extra = first; extra <= 64 * 1024; extra = extra * 2 + 500) {
    hexhex_context* context = NULL;
    CHECK_OK(hexhex_context_create(&context_options, &context, &error));
    struct rlimit limit;
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = (rlim_t)(address_space() + extra) * 1024;
    CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
    const hexhex_status status =
        work_on(map, &options, context, engine == HEXHEX_ENGINE_ATLAS, &error);
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_AS, &limit);
    CHECK(status == HEXHEX_OK || status == HEXHEX_OUT_OF_MEMORY);
    if (status == HEXHEX_OUT_OF_MEMORY) {
      ++exhausted;
      CHECK(strlen(error.message) > 20);
    }
    hexhex_context_destroy(context);
  }
  CHECK(exhausted > 0 || first > 4000);
  CHECK_OK(hexhex_extract(map, &options, NULL, &mesh, NULL, &error));
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
  return failures;
}

/* Each in a process of its own, as what fails first differs: an arena of oneTBB, a thread, an
 * array. A process that hangs ends by its alarm. */
static void test_memory(void) {
  static const int threads[] = {1, 2, 8};
  static const long first[] = {0, 3000, 24000};
  if (SANITIZED) return; /* sanitizers need their address space, and replace malloc() */
  for (int t = 0; t < 3; ++t) {
    for (int f = 0; f < 3; ++f) {
      const pid_t child = fork();
      if (child == 0) {
        failures = 0;
        alarm(100);
        _exit(run_out_of_memory(threads[t], (hexhex_engine)((t + f) % 2), first[f]));
      }
      int status = -1;
      CHECK(waitpid(child, &status, 0) == child);
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fprintf(stderr, "%d threads, from %ld KB: status %d\n", threads[t], first[f], status);
        ++failures;
      }
    }
  }
}

int main(void) {
  char folder[] = "/tmp/hexhex-c-XXXXXX";
  if (mkdtemp(folder) == NULL) return 1;
  /* First: oneTBB has no threads yet, which would not survive the fork. */
  test_memory();
  test_corner_order();
  test_verify_of_bad_meshes();
  test_everything_once(folder);
  test_errors(folder);
  test_mixed_cells(folder);
  test_context();
  test_sink(folder);
  test_features(folder);
  test_repair();
  test_improve();
  test_improve_on_surface(folder);
  test_improve_curved(folder);
  test_quantize();
  test_shape();
  test_read_part();
  test_curved(folder);
  test_numbers_that_are_none();
  test_answers();
  test_small_things();
  test_map_structure();
  test_lagrange(folder);
  test_writer_as_sink(folder);
  test_repair_of_others(folder);
  test_reentry();
  test_threads();
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  CHECK(system(command) == 0);
  if (failures > 0) fprintf(stderr, "%d failures\n", failures);
  return failures > 0;
}
