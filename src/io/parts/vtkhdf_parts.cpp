// One VTKHDF file with all parts: their arrays stand one behind the other, and for each part there
// is how long they are.
#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/parts/parts.hpp>
#include <io/parts/piece_data.hpp>
#include <io/vtk/vtkhdf_kind.hpp>

namespace hexhex {
namespace {

/// A dataset that grows part by part.
class Column {
 public:
  Column(const HdfFile& file, hid_t group, const std::string& name, hid_t stored, hid_t memory,
         std::size_t components)
      : file_(file),
        set_(file.growing(group, name, stored, components)),
        memory_(memory),
        components_(components) {}

  void add(const void* values, std::size_t bytes) {
    const std::size_t row = components_ * HDF5(H5Tget_size)(memory_);
    file_.append(set_, memory_, components_, rows_, values, bytes / row);
  }
  void add(std::int64_t number) { add(&number, sizeof(number)); }

 private:
  const HdfFile& file_;
  HdfObject set_;
  hid_t memory_;
  hsize_t components_;
  hsize_t rows_ = 0;
};

class VtkHdfSink final : public PartSink {
 public:
  VtkHdfSink(const std::filesystem::path& path, Context& context)
      : context_(context), target_(path, OutputFile::Target::Regular) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    file_.emplace(target_, HdfFile::Order::OfNames);
    grid_.emplace(file_->group(file_->root(), "VTKHDF"));
    writeVtkHdfKind(*file_, grid_->id());
    const hid_t type = HDF5(H5T_NATIVE_INT64_g);
    const auto open = [&](std::optional<Column>& column, const char* name) {
      column.emplace(*file_, grid_->id(), name, type, type, 1);
    };
    open(points_, "NumberOfPoints");
    open(cells_, "NumberOfCells");
    open(corners_, "NumberOfConnectivityIds");
    open(offsets_, "Offsets");
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    VtkPiece piece;
    const VtkDataSet data = partDataSet(part, info_, piece);
    if (sections_.empty()) openArrays(data);
    points_->add(static_cast<std::int64_t>(data.points));
    cells_->add(static_cast<std::int64_t>(data.cells));
    corners_->add(static_cast<std::int64_t>(8 * data.cells));
    std::vector<std::int64_t> begins(data.cells + 1);
    for (std::size_t i = 0; i < begins.size(); ++i) begins[i] = static_cast<std::int64_t>(8 * i);
    offsets_->add(begins.data(), begins.size() * sizeof(std::int64_t));
    for (const VtkArray& array : data.arrays()) {
      Column* const column = columnOf(array);
      if (column == nullptr) continue;
      array.write([column](const void* bytes, std::size_t size) { column->add(bytes, size); });
    }
    addTags(part);
  }

  void end() override {
    Stage stage(context_, "write mesh");
    writeTags();
    arrays_.clear();
    for (std::optional<Column>* const column : {&points_, &cells_, &corners_, &offsets_}) {
      column->reset();
    }
    sections_.clear();
    grid_->close();
    file_->close();
    target_.commit();
  }

 private:
  struct NamedColumn {
    std::string name;
    VtkSection section;
    Column column;
  };

  void openArrays(const VtkDataSet& data) {
    const hid_t points = sections_.emplace_back(file_->group(grid_->id(), "PointData")).id();
    const hid_t cells = sections_.emplace_back(file_->group(grid_->id(), "CellData")).id();
    const hid_t grid = grid_->id();
    for (const VtkArray& array : data.arrays()) {
      const hid_t memory = vtkHdfTypeOf(array.type);
      const auto open = [&](hid_t group, std::string name, hid_t stored) {
        arrays_.push_back({std::string(array.name), array.section,
                           Column(*file_, group, name, stored, memory, array.components)});
      };
      const std::string name(array.name);
      if (array.section == VtkSection::PointData) open(points, name, memory);
      if (array.section == VtkSection::CellData) open(cells, name, memory);
      if (array.section == VtkSection::Points) open(grid, "Points", memory);
      if (name == "types") open(grid, "Types", memory);
      // Whatever the number of points.
      if (name == "connectivity") open(grid, "Connectivity", HDF5(H5T_STD_I64LE_g));
    }
  }
  Column* columnOf(const VtkArray& array) {
    for (NamedColumn& column : arrays_) {
      if (column.section == array.section && column.name == array.name) return &column.column;
    }
    return nullptr;
  }

  /// Tags of edges and quads belong to no part: rows of global numbers, as of the mesh in one
  /// piece.
  void addTags(const MeshPart& part) {
    const auto add = [&part](const auto& features, std::vector<std::vector<std::int64_t>>& rows) {
      for (const auto& feature : features) {
        std::vector<std::int64_t>& row = rows.emplace_back();
        for (const Index v : feature.vertices) {
          row.push_back(static_cast<std::int64_t>(part.globalPoints[v]));
        }
        row.push_back(feature.tag);
      }
    };
    add(part.mesh.features.edges, edges_);
    add(part.mesh.features.quads, quads_);
  }
  void writeTags() {
    const HdfObject group = file_->group(grid_->id(), "FieldData");
    const auto write = [&](const char* name, std::vector<std::vector<std::int64_t>>& rows) {
      if (rows.empty()) return;
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      const hid_t type = HDF5(H5T_NATIVE_INT64_g);
      Column column(*file_, group.id(), name, type, type, rows.front().size());
      std::vector<std::int64_t> numbers;
      for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
      column.add(numbers.data(), numbers.size() * sizeof(std::int64_t));
    };
    write(std::string(kVtkEdgeTags).c_str(), edges_);
    write(std::string(kVtkQuadTags).c_str(), quads_);
  }

  Context& context_;
  OutputFile target_;
  PartsInfo info_;
  std::optional<HdfFile> file_;
  std::optional<HdfObject> grid_;
  std::deque<HdfObject> sections_;
  std::optional<Column> points_;
  std::optional<Column> cells_;
  std::optional<Column> corners_;
  std::optional<Column> offsets_;
  std::deque<NamedColumn> arrays_;
  std::vector<std::vector<std::int64_t>> edges_;
  std::vector<std::vector<std::int64_t>> quads_;
};

}  // namespace

std::unique_ptr<PartSink> openVtkHdfPartSink(const std::filesystem::path& file,
                                             const WriteOptions& /*options*/, Context& context,
                                             ProcessTeam* /*team*/) {
  return std::make_unique<VtkHdfSink>(file, context);
}

}  // namespace hexhex
