// Reads a .vtkhdf file with parallel HDF5, each rank its own piece, and writes the same pieces into
// another file, by collective hyperslabs. Prints how many seconds writing takes.
//
//     mpirun -n R parallel_hdf5 FILE COPY
#include <hdf5.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int rank, ranks;

static void require(int condition, const char *what) {
  if (condition) return;
  fprintf(stderr, "parallel_hdf5, rank %d: %s\n", rank, what);
  MPI_Abort(MPI_COMM_WORLD, 1);
}

// Rows of each kind: those of ranks before this one, and its own.
enum Kind { POINTS, CELLS, CORNERS, KINDS };
static const char *const counts[KINDS] = {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"};
static hsize_t before[KINDS], mine[KINDS];

struct Files {
  hid_t from, to, collectively;
  double seconds;
};

static void count_rows(hid_t file) {
  for (int kind = 0; kind < KINDS; ++kind) {
    char name[64];
    snprintf(name, sizeof name, "VTKHDF/%s", counts[kind]);
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    hid_t space = H5Dget_space(set);
    require(H5Sget_simple_extent_npoints(space) == ranks, "there are not as many pieces as ranks");
    int64_t *rows = malloc((size_t)ranks * sizeof(int64_t));
    require(H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows) >= 0, name);
    for (int r = 0; r < rank; ++r) before[kind] += (hsize_t)rows[r];
    mine[kind] = (hsize_t)rows[rank];
    free(rows);
    H5Sclose(space);
    H5Dclose(set);
  }
}

// The rows of this rank in a dataset.
static void range_of(const char *name, hsize_t rows, hsize_t *begin, hsize_t *count) {
  const char *last = strrchr(name, '/') + 1;
  int kind = -1;
  if (strcmp(last, "Points") == 0 || strstr(name, "/PointData/")) kind = POINTS;
  if (strcmp(last, "Types") == 0 || strstr(name, "/CellData/")) kind = CELLS;
  if (strcmp(last, "Connectivity") == 0) kind = CORNERS;
  *begin = kind >= 0 ? before[kind] : 0;
  *count = kind >= 0 ? mine[kind] : rank == 0 ? rows : 0;  // the first rank writes what is not of pieces
  if (strcmp(last, "Offsets") != 0) return;
  *begin = before[CELLS] + (hsize_t)rank;
  *count = mine[CELLS] + 1;
}

static herr_t copy_attribute(hid_t from, const char *name, const H5A_info_t *info, void *to) {
  char value[1024];
  require(info->data_size <= sizeof value, name);
  hid_t attribute = H5Aopen(from, name, H5P_DEFAULT);
  hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  hid_t copy = H5Acreate2(*(hid_t *)to, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  require(H5Aread(attribute, type, value) >= 0 && H5Awrite(copy, type, value) >= 0, name);
  H5Aclose(copy);
  H5Aclose(attribute);
  H5Tclose(type);
  H5Sclose(space);
  return 0;
}

static void copy_set(struct Files *files, const char *name) {
  hid_t set = H5Dopen2(files->from, name, H5P_DEFAULT);
  hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  hsize_t shape[2] = {0, 1}, begin[2] = {0, 0}, count[2];
  const int dimensions = H5Sget_simple_extent_dims(space, shape, NULL);
  require(dimensions == 1 || dimensions == 2, name);
  range_of(name, shape[0], &begin[0], &count[0]);
  count[1] = shape[1];
  require(begin[0] + count[0] <= shape[0], name);
  hid_t rows = H5Screate_simple(dimensions, count, NULL);
  if (count[0] > 0) {
    H5Sselect_hyperslab(space, H5S_SELECT_SET, begin, NULL, count, NULL);
  } else {
    H5Sselect_none(space);
    H5Sselect_none(rows);
  }
  void *values = malloc((size_t)(count[0] * count[1]) * H5Tget_size(type) + 1);
  require(H5Dread(set, type, rows, space, files->collectively, values) >= 0, name);
  if (strstr(name, "/Connectivity")) {
    for (hsize_t i = 0; i < count[0]; ++i) {
      const int64_t corner = ((const int64_t *)values)[i];
      require(corner >= 0 && (hsize_t)corner < mine[POINTS], "a corner is not of the piece");
    }
  }
  hid_t whole = H5Screate_simple(dimensions, shape, NULL);
  hid_t copy = H5Dcreate2(files->to, name, type, whole, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const double start = MPI_Wtime();
  require(H5Dwrite(copy, type, rows, space, files->collectively, values) >= 0, name);
  files->seconds += MPI_Wtime() - start;
  free(values);
  H5Dclose(copy);
  H5Dclose(set);
  H5Tclose(type);
  H5Sclose(whole);
  H5Sclose(rows);
  H5Sclose(space);
}

static herr_t copy_object(hid_t root, const char *name, const H5O_info_t *info, void *data) {
  (void)root;
  struct Files *files = data;
  if (strcmp(name, ".") == 0) return 0;
  if (info->type == H5O_TYPE_DATASET) {
    copy_set(files, name);
    return 0;
  }
  hid_t from = H5Gopen2(files->from, name, H5P_DEFAULT);
  hid_t to = H5Gcreate2(files->to, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Aiterate2(from, H5_INDEX_NAME, H5_ITER_INC, NULL, copy_attribute, &to);
  H5Gclose(to);
  H5Gclose(from);
  return 0;
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  require(argc == 3, "needs FILE COPY");
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_mpio(access, MPI_COMM_WORLD, MPI_INFO_NULL);
  struct Files files = {H5Fopen(argv[1], H5F_ACC_RDONLY, access),
                        H5Fcreate(argv[2], H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Pcreate(H5P_DATASET_XFER), 0};
  require(files.from >= 0 && files.to >= 0, "cannot open the files");
  H5Pset_dxpl_mpio(files.collectively, H5FD_MPIO_COLLECTIVE);
  count_rows(files.from);
  require(H5Ovisit(files.from, H5_INDEX_NAME, H5_ITER_INC, copy_object, &files) >= 0, "cannot visit the file");
  H5Pclose(files.collectively);
  H5Pclose(access);
  H5Fclose(files.from);
  require(H5Fclose(files.to) >= 0, "cannot close the copy");
  if (rank == 0) printf("%.3f s of writing\n", files.seconds);
  MPI_Finalize();
  return 0;
}
