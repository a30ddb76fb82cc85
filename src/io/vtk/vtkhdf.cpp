#include <algorithm>
#include <array>
#include <cstdint>
#include <hdf5.h>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/quality.hpp>

#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtkhdf.hpp>
#include <io/vtk/vtu_content.hpp>

namespace hexhex {
namespace {

/// All numbers of an array of tuples, one after the other; null if there are none.
template <class Tuple>
const typename Tuple::value_type* numbersOf(const Array<Tuple>& tuples) {
  return tuples.empty() ? nullptr : tuples.front().data();
}

/// Keeps HDF5 from printing its errors, in its scope.
class QuietHdf {
 public:
  QuietHdf() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietHdf(const QuietHdf&) = delete;
  QuietHdf& operator=(const QuietHdf&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// An open object of HDF5.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(const LibraryFile& file, hid_t id, Close function)
      : file_(file), id_(id), close_(function) {
    if (id_ < 0) refuse();
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] hid_t id() const noexcept { return id_; }
  /// Closes it now, since closing may fail, too.
  void close() {
    const hid_t id = id_;
    id_ = -1;
    require(close_(id));
  }
  void require(herr_t status) const {
    if (status < 0) refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    file_.fail("HDF5 could not write it; perhaps the disk is full");
  }

  const LibraryFile& file_;
  hid_t id_;
  Close close_;
};

template <class T>
hid_t typeOf();
template <>
hid_t typeOf<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t typeOf<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t typeOf<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t typeOf<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
hid_t typeOf<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

/// Writes one file.
class VtkHdfWriter {
 public:
  VtkHdfWriter(const LibraryFile& file, const HexMesh& mesh, Stage& stage)
      : file_(file),
        mesh_(mesh),
        root_(file, H5Fcreate(file.name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              H5Fclose),
        grid_(file, createGroup(root_.id(), "VTKHDF"), H5Gclose),
        progress_(stage, mesh.points.size() + mesh.cells.size()) {}

  void write(std::span<const double> quality) {
    writeKind();
    const auto points = static_cast<std::int64_t>(mesh_.points.size());
    const auto cells = static_cast<std::int64_t>(mesh_.cells.size());
    count("NumberOfPoints", points);
    count("NumberOfCells", cells);
    count("NumberOfConnectivityIds", 8 * cells);
    rows<double>(grid_, "Points", numbersOf(mesh_.points), mesh_.points.size(), 3);
    progress_.advance(mesh_.points.size());
    writeCells();
    writePointData();
    writeCellData(quality);
    writeFieldData();
    grid_.close();
    root_.close();
  }

 private:
  static hid_t createGroup(hid_t parent, const char* name) {
    return H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  }

  /// The attributes by which VTK knows the format.
  void writeKind() {
    constexpr std::array<std::int64_t, 2> kVersion = {1, 0};
    const hsize_t two = 2;
    const Handle pair(file_, H5Screate_simple(1, &two, nullptr), H5Sclose);
    const Handle version(
        file_,
        H5Acreate2(grid_.id(), "Version", H5T_STD_I64LE, pair.id(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    version.require(H5Awrite(version.id(), H5T_NATIVE_INT64, kVersion.data()));
    const std::string kind = "UnstructuredGrid";
    const Handle type(file_, H5Tcopy(H5T_C_S1), H5Tclose);
    type.require(H5Tset_size(type.id(), kind.size()));
    type.require(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
    type.require(H5Tset_cset(type.id(), H5T_CSET_ASCII));
    const Handle one(file_, H5Screate(H5S_SCALAR), H5Sclose);
    const Handle name(file_,
                      H5Acreate2(grid_.id(), "Type", type.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
    name.require(H5Awrite(name.id(), type.id(), kind.data()));
  }

  void count(const char* name, std::int64_t number) { rows(grid_, name, &number, 1, 1); }

  /// Writes a dataset of n rows.
  /// @param file  the number type in the file; that in memory if not given
  template <class T>
  void rows(const Handle& group, const char* name, const T* values, std::size_t n,
            std::size_t columns, hid_t file = typeOf<T>()) {
    const std::array<hsize_t, 2> shape = {n, columns};
    const Handle space(file_, H5Screate_simple(columns == 1 ? 1 : 2, shape.data(), nullptr),
                       H5Sclose);
    const Handle set(
        file_,
        H5Dcreate2(group.id(), name, file, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    if (n > 0) {
      set.require(H5Dwrite(set.id(), typeOf<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
    }
  }

  void writeCells() {
    const std::size_t cells = mesh_.cells.size();
    rows<std::uint32_t>(grid_, "Connectivity", numbersOf(mesh_.cells), 8 * cells, 1, H5T_STD_I64LE);
    Array<std::int64_t> offsets(cells + 1);
    for (std::size_t i = 0; i <= cells; ++i) offsets[i] = static_cast<std::int64_t>(8 * i);
    rows(grid_, "Offsets", offsets.data(), offsets.size(), 1);
    const std::vector<std::uint8_t> types(cells, kVtkHexahedron);
    rows(grid_, "Types", types.data(), cells, 1);
    progress_.advance(cells);
  }

  void writePointData() {
    const Handle group(file_, createGroup(grid_.id(), "PointData"), H5Gclose);
    const std::size_t points = mesh_.points.size();
    if (!mesh_.generatorCorners.empty()) {
      std::vector<std::uint8_t> kinds(points);
      std::transform(mesh_.generatorCorners.begin(), mesh_.generatorCorners.end(), kinds.begin(),
                     [](CornerSet c) { return static_cast<std::uint8_t>(generatorKind(c)); });
      rows(group, "generator_kind", kinds.data(), points, 1);
      rows(group, "generator_corners", mesh_.generatorCorners.data(), points, 1);
    }
    if (!mesh_.generatorTet.empty()) {
      rows(group, "generator_tet", mesh_.generatorTet.data(), points, 1);
    }
    if (!mesh_.features.vertices.empty()) {
      rows(group, "feature_vertex", vertexTags(mesh_.features.vertices, points).data(), points, 1);
    }
  }

  void writeCellData(std::span<const double> quality) {
    const Handle group(file_, createGroup(grid_.id(), "CellData"), H5Gclose);
    rows(group, "scaled_jacobian", quality.data(), quality.size(), 1);
    if (mesh_.regions.empty()) return;
    rows(group, "region", mesh_.regions.data(), mesh_.regions.size(), 1);
  }

  void writeFieldData() {
    const Handle group(file_, createGroup(grid_.id(), "FieldData"), H5Gclose);
    if (!mesh_.features.edges.empty()) {
      rows(group, "feature_edges", rowsOf(mesh_.features.edges).data(), mesh_.features.edges.size(),
           3);
    }
    if (!mesh_.features.quads.empty()) {
      rows(group, "feature_quads", rowsOf(mesh_.features.quads).data(), mesh_.features.quads.size(),
           5);
    }
  }

  const LibraryFile& file_;
  const HexMesh& mesh_;
  Handle root_;
  Handle grid_;
  LoopProgress progress_;
};

}  // namespace

void writeVtkHdf(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context) {
  LibraryFile target(file);  // first, so that a folder that is not writable shows at once
  Array<double> computedQuality;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computedQuality = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  {
    const std::lock_guard lock(libraryLock());
    const QuietHdf quiet;
    VtkHdfWriter(target, mesh, stage).write(quality);
  }
  target.commit();
}

}  // namespace hexhex
