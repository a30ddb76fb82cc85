/* From a map to a verified mesh, in C.
 *
 *     pipeline [MAP [MESH]]
 */
#include <hexhex.h>
#include <stdio.h>

static int fail(const hexhex_error* error) {
  fprintf(stderr, "%s [%s]\n", error->message, hexhex_status_name(error->status));
  return 1;
}

static int on_progress(void* user, const char* stage, double share) {
  (void)user;
  if (share == 0) fprintf(stderr, "%s ...\n", stage);
  return 0; /* go on */
}

int main(int argc, char** argv) {
  hexhex_error error;
  hexhex_map* map = NULL;
  hexhex_status status = argc > 1 ? hexhex_map_read(argv[1], NULL, NULL, &map, &error)
                                  : hexhex_map_generate("sphere", NULL, &map, &error);
  if (status != HEXHEX_OK) return fail(&error);

  hexhex_context_options options = HEXHEX_CONTEXT_OPTIONS_INIT;
  options.progress = on_progress;
  hexhex_context* context = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_verify_report* report = NULL;
  int good = 0;
  hexhex_extract_options extract = HEXHEX_EXTRACT_OPTIONS_INIT;
  extract.scale = 2;
  if (hexhex_context_create(&options, &context, &error) != HEXHEX_OK ||
      hexhex_extract(map, &extract, context, &mesh, NULL, &error) != HEXHEX_OK ||
      hexhex_verify(map, mesh, extract.tolerance, 2, context, &report, &error) != HEXHEX_OK ||
      hexhex_mesh_write(mesh, argc > 2 ? argv[2] : "mesh.vtu", NULL, context, &error) !=
          HEXHEX_OK) {
    fail(&error);
  } else {
    hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
    hexhex_mesh_get_arrays(mesh, &arrays, NULL);
    good = hexhex_verify_passed(report);
    printf("%zu hexahedra, %zu vertices, %s\n", arrays.cell_count, arrays.point_count,
           good ? "verified" : "WRONG");
  }
  hexhex_verify_report_destroy(report);
  hexhex_mesh_destroy(mesh);
  hexhex_context_destroy(context);
  hexhex_map_destroy(map);
  return good ? 0 : 1;
}
