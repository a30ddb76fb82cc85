#include <array>
#include <cstdint>
#include <hdf5.h>
#include <mutex>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_data_set.hpp>

namespace hexhex {
namespace {

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
  Handle(const OutputFile& file, hid_t id, Close function)
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

  const OutputFile& file_;
  hid_t id_;
  Close close_;
};

/// HDF5's type of the numbers that VTK's XML calls so, in memory.
hid_t typeOf(std::string_view name) {
  if (name == "Float64") return H5T_NATIVE_DOUBLE;
  if (name == "Int64") return H5T_NATIVE_INT64;
  if (name == "Int32") return H5T_NATIVE_INT32;
  if (name == "UInt32") return H5T_NATIVE_UINT32;
  return H5T_NATIVE_UINT8;
}

/// Writes one file.
class VtkHdfWriter {
 public:
  VtkHdfWriter(const OutputFile& file, const VtkDataSet& data, Stage& stage)
      : file_(file),
        data_(data),
        root_(file, H5Fcreate(file.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              H5Fclose),
        grid_(file, createGroup(root_.id(), "VTKHDF"), H5Gclose),
        progress_(stage, data.points + data.cells) {}

  void write() {
    writeKind();
    count("NumberOfPoints", data_.points);
    count("NumberOfCells", data_.cells);
    count("NumberOfConnectivityIds", 8 * data_.cells);
    for (const VtkArray& array : data_.arrays()) {
      if (array.section == VtkSection::Points) writeRows(grid_, "Points", array);
    }
    progress_.advance(data_.points);
    writeCells();
    progress_.advance(data_.cells);
    writeGroup("PointData", VtkSection::PointData);
    writeGroup("CellData", VtkSection::CellData);
    writeGroup("FieldData", VtkSection::FieldData);
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

  void count(const char* name, std::uint64_t number) {
    writeNumbers(name, 1, [number](std::size_t) { return number; });
  }
  /// Writes n integers of 64 bits.
  template <class F>
  void writeNumbers(const char* name, std::uint64_t n, const F& valueOf) {
    VtkArray array;
    array.type = "Int64";
    array.rows = n;
    array.write = [&](const VtkBytes& output) { writeValues<std::int64_t>(output, n, valueOf); };
    writeRows(grid_, name, array);
  }

  /// Writes a dataset, piece by piece as the array's bytes come.
  void writeRows(const Handle& group, const char* name, const VtkArray& array) {
    const hid_t memory = typeOf(array.type);
    const hid_t stored = array.section == VtkSection::Cells && memory == H5T_NATIVE_INT32
                             ? H5T_STD_I64LE  // whatever the number of points
                             : memory;
    const int rank = array.components == 1 ? 1 : 2;
    const std::array<hsize_t, 2> shape = {array.rows, array.components};
    const Handle space(file_, H5Screate_simple(rank, shape.data(), nullptr), H5Sclose);
    const Handle set(
        file_,
        H5Dcreate2(group.id(), name, stored, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    std::array<hsize_t, 2> begin = {0, 0};
    array.write([&](const void* bytes, std::size_t size) {
      if (size == 0) return;
      const std::array<hsize_t, 2> count = {size / (array.components * H5Tget_size(memory)),
                                            array.components};
      const Handle part(file_, H5Screate_simple(rank, count.data(), nullptr), H5Sclose);
      space.require(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr,
                                        count.data(), nullptr));
      set.require(H5Dwrite(set.id(), memory, part.id(), space.id(), H5P_DEFAULT, bytes));
      begin[0] += count[0];
    });
  }

  void writeCells() {
    for (const VtkArray& array : data_.arrays()) {
      if (array.section != VtkSection::Cells) continue;
      if (array.name == "connectivity") writeRows(grid_, "Connectivity", array);
      if (array.name == "types") writeRows(grid_, "Types", array);
      if (array.name != "offsets") continue;
      // Where cells begin, and the last one ends.
      writeNumbers("Offsets", data_.cells + 1, [](std::size_t i) { return 8 * i; });
    }
  }

  void writeGroup(const char* name, VtkSection section) {
    const Handle group(file_, createGroup(grid_.id(), name), H5Gclose);
    for (const VtkArray& array : data_.arrays()) {
      if (array.section == section) writeRows(group, std::string(array.name).c_str(), array);
    }
  }

  const OutputFile& file_;
  const VtkDataSet& data_;
  Handle root_;
  Handle grid_;
  LoopProgress progress_;
};

}  // namespace

void writeVtkHdf(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context) {
  // First, so that a folder that is not writable shows at once.
  OutputFile target(file, OutputFile::Target::Regular);
  VtkPiece piece;
  const VtkDataSet data = hexDataSet(mesh, options, piece, context);
  Stage stage(context, "write mesh");
  {
    const std::lock_guard lock(libraryLock());
    const QuietHdf quiet;
    VtkHdfWriter(target, data, stage).write();
  }
  target.commit();
}

}  // namespace hexhex
