// One VTKHDF file with all parts: their arrays stand one behind the other, and for each part there
// is how long they are.
//
// One process adds part by part to datasets that grow. Where each process of a team has one, all
// lengths are known before anything is written: the first process has HDF5 lay out the file, with
// room for all, and then each writes its own bytes to where they belong, as parallel HDF5 does for
// such datasets. So it takes neither HDF5's library for MPI nor MPI.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/team.hpp>

#include <base/stage.hpp>
#include <io/core/hdf_file.hpp>
#include <io/parts/parts.hpp>
#include <io/parts/piece_data.hpp>
#include <io/parts/shared_file.hpp>
#include <io/vtk/vtkhdf_kind.hpp>

namespace hexhex::io {
namespace {

/// What a part adds to a dataset of the file.
struct Column {
  std::string name;  ///< of the dataset, below VTKHDF
  const VtkArray* array;
};

/// Adds the arrays that VTKHDF has beside those of the pieces of `.pvtu`.
void addLayout(VtkDataSet& data, const MeshPart& part) {
  const auto addCount = [&data](const char* name, std::uint64_t count) {
    data.addOwn(VtkSection::Cells, name, std::vector{static_cast<std::int64_t>(count)});
  };
  const Array<Hex>& cells = part.mesh.cells;
  constexpr std::size_t kCorners = std::tuple_size_v<Hex>;
  addCount("NumberOfPoints", data.points);
  addCount("NumberOfCells", data.cells);
  addCount("NumberOfConnectivityIds", kCorners * data.cells);
  data.addComputed<std::int64_t>(VtkSection::Cells, "Offsets", cells.size() + 1,
                                 [](std::size_t i) { return kCorners * i; });
  // Of 64 bits, whatever the number of points.
  data.addComputed<std::int64_t>(
      VtkSection::Cells, "Connectivity", kCorners * cells.size(),
      [&cells](std::size_t i) { return cells[i / kCorners][i % kCorners]; });
}

/// @param data  with those of addLayout()
std::vector<Column> columnsOf(const VtkDataSet& data) {
  std::vector<Column> columns;
  for (const VtkArray& array : data.arrays()) {
    const std::string name(array.name);
    if (array.section == VtkSection::PointData) columns.push_back({"PointData/" + name, &array});
    if (array.section == VtkSection::CellData) columns.push_back({"CellData/" + name, &array});
    if (array.section == VtkSection::Points) columns.push_back({"Points", &array});
    if (array.section != VtkSection::Cells || name == "connectivity" || name == "offsets") continue;
    columns.push_back({name == "types" ? "Types" : name, &array});
  }
  return columns;
}

/// Begins the file. @return  what holds all of it
HdfObject addGrid(const HdfFile& file) {
  HdfObject grid = file.group(file.root(), "VTKHDF");
  writeVtkHdfKind(file, grid.id());
  for (const char* name : {"PointData", "CellData", "FieldData"}) {
    static_cast<void>(file.group(grid.id(), name));
  }
  return grid;
}

/// A dataset that grows.
struct GrowingSet {
  HdfObject set;
  hsize_t rows = 0;

  void add(const HdfFile& file, const VtkArray& array) {
    const hid_t type = vtkHdfTypeOf(array.type);
    array.write([&](const void* bytes, std::size_t size) {
      const std::size_t row = array.components * HDF5(H5Tget_size)(type);
      file.append(set, type, array.components, rows, bytes, size / row);
    });
  }
};

/// Tags of edges or quads, which belong to no part: rows of global vertices and the tag, as of the
/// mesh in one piece.
template <std::size_t n>
class TagRows {
 public:
  template <class Feature>
  void add(const MeshPart& part, const std::vector<Feature>& features) {
    for (const Feature& feature : features) {
      std::array<std::int64_t, n>& row = rows_.emplace_back();
      std::transform(feature.vertices.begin(), feature.vertices.end(), row.begin(),
                     [&](Index v) { return static_cast<std::int64_t>(part.globalPoints[v]); });
      row.back() = feature.tag;
    }
  }
  /// Leaves those of all processes in the first one, and none in others.
  void gather(ProcessTeam& team) {
    const std::vector<std::array<std::int64_t, n>> own = std::move(rows_);
    rows_.clear();
    const auto* const mine = reinterpret_cast<const std::uint64_t*>(own.data());
    team.showAll(std::span(mine, n * own.size()),
                 [&](std::uint32_t /*rank*/, std::span<const std::uint64_t> theirs) {
                   if (team.rank() != 0) return;
                   for (; !theirs.empty(); theirs = theirs.subspan(n)) {
                     std::copy_n(theirs.begin(), n, rows_.emplace_back().begin());
                   }
                 });
  }
  void write(const HdfFile& file, hid_t grid, std::string_view name) {
    if (rows_.empty()) return;
    std::sort(rows_.begin(), rows_.end());
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
    const hid_t type = HDF5(H5T_NATIVE_INT64_g);
    const HdfObject set =
        file.dataset(grid, "FieldData/" + std::string(name), type, file.space({rows_.size(), n}));
    set.require(
        HDF5(H5Dwrite)(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows_.front().data()));
  }

 private:
  std::vector<std::array<std::int64_t, n>> rows_;
};

class VtkHdfSink final : public PartSink {
 public:
  VtkHdfSink(const std::filesystem::path& path, Context& context, ProcessTeam* team)
      : context_(context), team_(team), target_(path, team) {}

  void begin(const PartsInfo& info) override {
    info_ = info;
    if (team_ != nullptr) return;
    file_.emplace(target_.output(), HdfFile::Order::OfNames);
    grid_.emplace(addGrid(*file_));
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    VtkPiece piece;
    VtkDataSet data = partDataSet(part, info_, piece);
    addLayout(data, part);
    edges_.add(part, part.mesh.features.edges);
    quads_.add(part, part.mesh.features.quads);
    if (team_ != nullptr) return writeTogether(columnsOf(data));
    for (const Column& column : columnsOf(data)) {
      auto place = sets_.find(column.name);
      if (place == sets_.end()) {
        const VtkArray& array = *column.array;
        HdfObject set =
            file_->growing(grid_->id(), column.name, vtkHdfTypeOf(array.type), array.components);
        place = sets_.emplace(column.name, GrowingSet{std::move(set)}).first;
      }
      place->second.add(*file_, *column.array);
    }
  }

  void end() override {
    Stage stage(context_, "write mesh");
    if (file_) {
      writeTags(*file_, grid_->id());
      sets_.clear();
      grid_->close();
      file_->close();
      grid_.reset();
      file_.reset();  // others may write now
    }
    target_.commit();
  }

 private:
  void writeTags(const HdfFile& file, hid_t grid) {
    edges_.write(file, grid, kVtkEdgeTags);
    quads_.write(file, grid, kVtkQuadTags);
  }

  void writeTogether(const std::vector<Column>& columns) {
    std::vector<std::uint64_t> rows(columns.size());
    std::transform(columns.begin(), columns.end(), rows.begin(),
                   [](const Column& column) { return column.array->rows; });
    const GatheredNumbers ofAll = team_->gather(rows);
    std::vector<std::uint64_t> before(columns.size(), 0);
    std::vector<std::uint64_t> total(columns.size(), 0);
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      if (r == team_->rank()) before = total;
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += ofAll.of(r)[i];
    }
    edges_.gather(*team_);
    quads_.gather(*team_);
    std::vector<std::uint64_t> places(columns.size());
    if (team_->rank() == 0) places = layOut(columns, total);
    team_->share(std::as_writable_bytes(std::span(places)));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (rows[i] == 0) continue;
      const VtkArray& array = *columns[i].array;
      FilePart output(target_.output(), places[i] + before[i] * (array.bytes / array.rows));
      array.write([&](const void* bytes, std::size_t size) { output.writeBytes(bytes, size); });
      output.flush();
    }
  }

  /// @param rows  of each dataset
  /// @return where each begins in the file
  std::vector<std::uint64_t> layOut(const std::vector<Column>& columns,
                                    const std::vector<std::uint64_t>& rows) {
    HdfFile file(target_.output(), HdfFile::Order::OfNames);
    HdfObject grid = addGrid(file);
    std::vector<std::uint64_t> places;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const VtkArray& array = *columns[i].array;
      places.push_back(file.reserve(grid.id(), columns[i].name, vtkHdfTypeOf(array.type), rows[i],
                                    array.components));
    }
    writeTags(file, grid.id());
    grid.close();
    file.close();
    return places;
  }

  Context& context_;
  ProcessTeam* team_;
  SharedFile target_;
  PartsInfo info_;
  TagRows<3> edges_;
  TagRows<5> quads_;
  // In one process alone.
  std::optional<HdfFile> file_;
  std::optional<HdfObject> grid_;
  std::map<std::string, GrowingSet> sets_;
};

}  // namespace

std::unique_ptr<PartSink> openVtkHdfPartSink(const std::filesystem::path& file,
                                             const WriteOptions& /*options*/, Context& context,
                                             ProcessTeam* team) {
  return std::make_unique<VtkHdfSink>(file, context, team);
}

}  // namespace hexhex::io
