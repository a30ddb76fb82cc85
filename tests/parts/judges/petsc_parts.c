// Loads the parts of a mesh as a DMPlex on as many ranks, by global vertex numbers, and prints how
// many cells and vertices the mesh has, and how many faces of ranks belong to one of their cells.
//
//     mpirun -n R petsc_parts FOLDER GLOBAL-VERTICES
//
// FOLDER has rank0.bin and so on, as read_with_others.py writes them.
#include <petscdmplex.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static void require(int condition, const char *what) {
  if (condition) return;
  fprintf(stderr, "petsc_parts: %s\n", what);
  MPI_Abort(MPI_COMM_WORLD, 1);
}

int main(int argc, char **argv) {
  require(argc == 3, "needs FOLDER GLOBAL-VERTICES");
  const int64_t global = atoll(argv[2]);
  int one = 1;
  char **no_arguments = argv;
  PetscCall(PetscInitialize(&one, &no_arguments, NULL, NULL));
  int rank, ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  char name[4096];
  snprintf(name, sizeof name, "%s/rank%d.bin", argv[1], rank);
  FILE *file = fopen(name, "rb");
  require(file != NULL, "cannot open its file");
  int64_t counts[3];  // vertices, own cells, cells
  require(fread(counts, sizeof counts, 1, file) == 1, "a short file");

  // PETSc wants the positions of a consecutive range of vertices on each rank: all positions are
  // added up here, as the meshes of this test are small.
  double *positions = calloc((size_t)(3 * global), sizeof(double));
  for (int64_t i = 0; i < counts[0]; ++i) {
    int64_t number;
    double position[3];
    require(fread(&number, sizeof number, 1, file) == 1 && fread(position, sizeof position, 1, file) == 1,
            "a short file");
    for (int k = 0; k < 3; ++k) positions[3 * number + k] = position[k];
  }
  double *all = calloc((size_t)(3 * global), sizeof(double));
  // Ranks that have a vertex have the same position: where some have none, it is 0.
  double *least = calloc((size_t)(3 * global), sizeof(double));
  MPI_Allreduce(positions, all, (int)(3 * global), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(positions, least, (int)(3 * global), MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
  for (int64_t i = 0; i < 3 * global; ++i) all[i] += least[i];
  PetscInt *cells = malloc((size_t)(8 * counts[1] + 1) * sizeof(PetscInt));
  for (int64_t c = 0; c < counts[1]; ++c) {
    int64_t cell[10];  // its number, its owner, its vertices
    require(fread(cell, sizeof cell, 1, file) == 1, "a short file");
    // PETSc's hexahedra run around the bottom the other way.
    const int order[8] = {0, 3, 2, 1, 4, 5, 6, 7};
    for (int k = 0; k < 8; ++k) cells[8 * c + k] = (PetscInt)cell[2 + order[k]];
  }
  fclose(file);
  const int64_t begin = global * rank / ranks;
  const int64_t end = global * (rank + 1) / ranks;
  DM mesh;
  PetscCall(DMPlexCreateFromCellListParallelPetsc(
      MPI_COMM_WORLD, 3, (PetscInt)counts[1], (PetscInt)(end - begin), (PetscInt)global, 8,
      PETSC_TRUE, cells, 3, (PetscReal *)(all + 3 * begin), NULL, NULL, &mesh));

  // Cells, owned vertices, and faces with one cell of the rank.
  PetscSF shared;
  PetscCall(DMGetPointSF(mesh, &shared));
  PetscInt leaves, first, last, depth_begin, depth_end;
  const PetscInt *leaf;
  PetscCall(PetscSFGetGraph(shared, NULL, &leaves, &leaf, NULL));
  PetscCall(DMPlexGetHeightStratum(mesh, 0, &first, &last));
  PetscCall(DMPlexGetDepthStratum(mesh, 0, &depth_begin, &depth_end));
  int64_t sums[3] = {last - first, depth_end - depth_begin, 0};
  for (PetscInt i = 0; i < leaves; ++i) {
    const PetscInt point = leaf != NULL ? leaf[i] : i;
    if (point >= depth_begin && point < depth_end) --sums[1];
  }
  DMLabel boundary;
  PetscCall(DMCreateLabel(mesh, "boundary"));
  PetscCall(DMGetLabel(mesh, "boundary", &boundary));
  PetscCall(DMPlexMarkBoundaryFaces(mesh, 1, boundary));
  PetscInt size;
  PetscCall(DMLabelGetStratumSize(boundary, 1, &size));
  sums[2] = size;
  int64_t totals[3];
  MPI_Reduce(sums, totals, 3, MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
  if (rank == 0) {
    printf("%lld %lld %lld\n", (long long)totals[0], (long long)totals[1], (long long)totals[2]);
  }
  PetscCall(DMDestroy(&mesh));
  free(cells);
  free(positions);
  free(all);
  free(least);
  PetscCall(PetscFinalize());
  return 0;
}
