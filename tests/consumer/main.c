#include <hexhex.h>
#include <stdio.h>

int main(void) {
  hexhex_error error;
  hexhex_map* map = NULL;
  hexhex_mesh* mesh = NULL;
  hexhex_mesh_arrays arrays = HEXHEX_MESH_ARRAYS_INIT;
  int good = hexhex_map_generate("sphere", NULL, &map, &error) == HEXHEX_OK &&
             hexhex_extract(map, NULL, NULL, &mesh, NULL, &error) == HEXHEX_OK &&
             hexhex_mesh_get_arrays(mesh, &arrays, &error) == HEXHEX_OK;
  if (!good) fprintf(stderr, "%s\n", error.message);
  printf("hexhex %s: %zu hexahedra\n", hexhex_version(), arrays.cell_count);
  hexhex_mesh_destroy(mesh);
  hexhex_map_destroy(map);
  return good && arrays.cell_count == 448 ? 0 : 1;
}
