#include <array>
#include <cstdint>
#include <hdf5.h>
#include <string>
#include <string_view>

#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_data_set.hpp>
#include <io/vtk/vtkhdf_kind.hpp>

namespace hexhex::io {
namespace {

/// Writes one file.
class VtkHdfWriter {
 public:
  VtkHdfWriter(const OutputFile& file, const VtkDataSet& data, Stage& stage)
      : data_(data),
        file_(file, HdfFile::Order::OfNames),
        grid_(file_.group(file_.root(), "VTKHDF")),
        progress_(stage, data.points + data.cells) {}

  void write() {
    writeVtkHdfKind(file_, grid_.id());
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
    file_.close();
  }

 private:
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
  void writeRows(const HdfObject& group, const char* name, const VtkArray& array) {
    const hid_t memory = vtkHdfTypeOf(array.type);
    const hid_t stored = array.section == VtkSection::Cells && memory == HDF5(H5T_NATIVE_INT32_g)
                             ? HDF5(H5T_STD_I64LE_g)  // whatever the number of points
                             : memory;
    const auto spaceOf = [&](hsize_t rows) {
      return array.components == 1 ? file_.space({rows}) : file_.space({rows, array.components});
    };
    const HdfObject space = spaceOf(array.rows);
    const HdfObject set = file_.dataset(group.id(), name, stored, space);
    std::array<hsize_t, 2> begin = {0, 0};
    array.write([&](const void* bytes, std::size_t size) {
      if (size == 0) return;
      const std::array<hsize_t, 2> count = {size / (array.components * HDF5(H5Tget_size)(memory)),
                                            array.components};
      const HdfObject part = spaceOf(count[0]);
      space.require(HDF5(H5Sselect_hyperslab)(space.id(), H5S_SELECT_SET, begin.data(), nullptr,
                                              count.data(), nullptr));
      set.require(HDF5(H5Dwrite)(set.id(), memory, part.id(), space.id(), H5P_DEFAULT, bytes));
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
    const HdfObject group = file_.group(grid_.id(), name);
    for (const VtkArray& array : data_.arrays()) {
      if (array.section == section) writeRows(group, std::string(array.name).c_str(), array);
    }
  }

  const VtkDataSet& data_;
  HdfFile file_;
  HdfObject grid_;
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
  VtkHdfWriter(target, data, stage).write();
  target.commit();
}

}  // namespace hexhex::io
