// Writes VTKHDF files (see formats.hpp) of whole meshes and of parts; and reads them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <hdf5.h>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>

#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_data_set.hpp>
#include <io/formats/vtk_source.hpp>

namespace hexhex::io {

namespace {

/// HDF5's native type for a number type of VTK's XML.
[[nodiscard]] inline hid_t vtkHdfTypeOf(std::string_view name) {
  if (name == "Float64") return HDF5(H5T_NATIVE_DOUBLE_g);
  if (name == "Int64") return HDF5(H5T_NATIVE_INT64_g);
  if (name == "Int32") return HDF5(H5T_NATIVE_INT32_g);
  if (name == "UInt32") return HDF5(H5T_NATIVE_UINT32_g);
  return HDF5(H5T_NATIVE_UINT8_g);
}

/// Writes the attributes by which VTK recognizes the format.
void writeVtkHdfKind(const HdfFile& file, hid_t grid) {
  constexpr std::array<std::int64_t, 2> kVersion = {1, 0};
  file.writeAttribute(grid, "Version", HDF5(H5T_NATIVE_INT64_g), file.space({2}), kVersion.data());
  const std::string kind = "UnstructuredGrid";
  const HdfObject text = file.text(kind.size(), H5T_STR_NULLPAD);
  file.writeAttribute(grid, "Type", text.id(), file.space({}), kind.data());
}

// One VTKHDF file with all parts: their arrays are concatenated, and the lengths are stored for
// each part.
//
// A whole mesh is one part. For it, and in a team with a part per process, all lengths are known
// before anything is written: HDF5 lays out the file with space for everything, then each process
// writes its bytes to their position, as parallel HDF5 does for contiguous datasets. This requires
// neither parallel HDF5 nor MPI. A single process appends several parts to extensible datasets.

/// The contribution of a part to a dataset of the file.
struct Column {
  std::string name;  ///< of the dataset, below VTKHDF
  const VtkArray* array;
};

/// Adds the arrays that VTKHDF has in addition to those of `.vtu`.
void addLayout(VtkDataSet& data, const Array<Hex>& cells, const OtherCells& others = noOthers()) {
  const auto addCount = [&data](const char* name, std::uint64_t count) {
    data.addOwn(VtkSection::Cells, name, std::vector{static_cast<std::int64_t>(count)});
  };
  constexpr std::size_t kCorners = std::tuple_size_v<Hex>;
  addCount("NumberOfPoints", data.points);
  addCount("NumberOfCells", data.cells);
  const std::size_t ofHexes = kCorners * cells.size();
  const std::size_t all = ofHexes + endOf(others, data.cells);
  addCount("NumberOfConnectivityIds", all);
  data.addComputed<std::int64_t>(
      VtkSection::Cells, "Offsets", data.cells + 1, [&, ofHexes](std::size_t i) {
        return i <= cells.size() ? kCorners * i : ofHexes + endOf(others, i - cells.size());
      });
  // In 64 bits, whatever the number of points.
  data.addComputed<std::int64_t>(
      VtkSection::Cells, "Connectivity", all, [&, ofHexes](std::size_t i) {
        return i < ofHexes ? cells[i / kCorners][i % kCorners] : cornerOf(others, i - ofHexes);
      });
}

/// @param data  including the arrays of addLayout()
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

/// Begins the file. @return  the root group of the grid
HdfObject addGrid(const HdfFile& file) {
  HdfObject grid = file.group(file.root(), "VTKHDF");
  writeVtkHdfKind(file, grid.id());
  for (const char* name : {"PointData", "CellData", "FieldData"}) {
    static_cast<void>(file.group(grid.id(), name));
  }
  return grid;
}

/// Lays out a file with datasets of these numbers of rows.
/// @param more  adds what else the grid has
/// @return the position of each dataset in the file
template <class More>
std::vector<std::uint64_t> layOut(const OutputFile& output, const std::vector<Column>& columns,
                                  const std::vector<std::uint64_t>& rows, const More& more) {
  HdfFile file(output, HdfFile::Order::OfNames);
  HdfObject grid = addGrid(file);
  std::vector<std::uint64_t> places;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const VtkArray& array = *columns[i].array;
    places.push_back(file.reserve(grid.id(), columns[i].name, vtkHdfTypeOf(array.type), rows[i],
                                  array.components));
  }
  more(file, grid.id());
  grid.close();
  file.close();
  return places;
}

std::vector<std::uint64_t> rowsOf(const std::vector<Column>& columns) {
  std::vector<std::uint64_t> rows(columns.size());
  std::transform(columns.begin(), columns.end(), rows.begin(),
                 [](const Column& column) { return column.array->rows; });
  return rows;
}

/// Writes the rows of an array to their position in a file.
void writeAt(OutputFile& output, std::uint64_t position, const VtkArray& array) {
  if (array.rows == 0) return;
  FilePart part(output, position);
  array.write([&](const void* bytes, std::size_t size) { part.writeBytes(bytes, size); });
  part.flush();
}

}  // namespace

void writeVtkHdf(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                 Stage& stage) {
  VtkPiece piece;
  VtkDataSet data = hexDataSet(mesh, options, piece);
  addLayout(data, mesh.cells, othersOf(options));
  std::vector<Column> columns = columnsOf(data);
  for (const VtkArray& array : data.arrays()) {
    // names are not written: docs/user/formats.md
    if (array.name == kVtkTagNames || array.name == kVtkNamedTags) continue;
    if (array.section != VtkSection::FieldData) continue;
    columns.push_back({concat("FieldData/", array.name), &array});
  }
  LoopProgress progress(stage, columns.size());
  const std::vector<std::uint64_t> places =
      layOut(output, columns, rowsOf(columns), [](const HdfFile&, hid_t) {});
  for (std::size_t i = 0; i < columns.size(); ++i) {
    writeAt(output, places[i], *columns[i].array);
    progress.advance(1);
  }
}

namespace {

/// An extensible dataset.
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

/// Tags of edges or quads, which belong to no part: rows of global vertices and the tag, as for a
/// whole mesh.
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
  /// Collects the rows of all processes in the first one; clears the others.
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
    sortUnique(rows_);
    const hid_t type = HDF5(H5T_NATIVE_INT64_g);
    const HdfObject set =
        file.dataset(grid, concat("FieldData/", name), type, file.space({rows_.size(), n}));
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
    Stage stage(context_, Stage::kInner);
    VtkPiece piece;
    VtkDataSet data = partDataSet(part, info_, piece);
    addLayout(data, part.mesh.cells);
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
    const std::vector<std::uint64_t> rows = rowsOf(columns);
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
    if (team_->rank() == 0) {
      places = layOut(target_.output(), columns, total,
                      [this](const HdfFile& file, hid_t grid) { writeTags(file, grid); });
    }
    team_->share(std::as_writable_bytes(std::span(places)));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (rows[i] == 0) continue;
      const VtkArray& array = *columns[i].array;
      writeAt(target_.output(), places[i] + before[i] * (array.bytes / array.rows), array);
    }
  }

  Context& context_;
  ProcessTeam* team_;
  SharedFile target_;
  PartsInfo info_;
  TagRows<3> edges_;
  TagRows<5> quads_;
  // Only in a single process.
  std::optional<HdfFile> file_;
  std::optional<HdfObject> grid_;
  std::map<std::string, GrowingSet> sets_;
};

}  // namespace

std::unique_ptr<PartSink> openVtkHdfPartSink(const std::filesystem::path& file, Context& context,
                                             ProcessTeam* team) {
  return std::make_unique<VtkHdfSink>(file, context, team);
}

namespace {

// Reading, versions 1 and 2. A partition is a range of each dataset.

/// The path of a dataset or group of the grid.
std::string pathOf(const std::string& name) { return "VTKHDF/" + name; }

/// A column of these numbers.
template <class T>
VtkColumn columnOf(std::span<const T> numbers) {
  VtkColumn column;
  column.scalar = T{};
  column.count = numbers.size();
  column.decoded.resize(numbers.size_bytes() + 1);  // if empty, data are in the file
  if (!numbers.empty()) std::memcpy(column.decoded.data(), numbers.data(), numbers.size_bytes());
  return column;
}

/// One partition, or the field arrays of all.
class VtkHdfSource final : public VtkSource {
 public:
  explicit VtkHdfSource(const Input& input) : VtkSource({}, input.name()) {
    counts = input.counts();
    others = input.others();
  }
  void requireIndexable() const override {
    for (const std::uint64_t count : {points, cells}) {
      if (count > kNone) fail(ErrorCode::TooLarge, exceedsLimit(count, "points or cells", kNone));
    }
  }
};

class VtkHdfReader {
 public:
  VtkHdfReader(const Input& input, Stage& stage)
      : input_(input), file_(HdfReader::openAny(input, stage)) {
    const std::vector<std::string> top = file_->members("/");
    if (std::find(top.begin(), top.end(), "VTKHDF") == top.end()) {
      input_.fail(ErrorCode::FileSyntax, "the file has no group VTKHDF.");
    }
    if (const std::string type = file_->attribute("VTKHDF", "Type"); type != "UnstructuredGrid") {
      input_.fail(ErrorCode::FileUnsupported, "the file's type is ", quoted(std::string_view(type)),
                  ", only UnstructuredGrid is supported.");
    }
    const std::string steps = pathOf("Steps/Values");
    if (file_->has(steps) && rowsOf(steps) > 1) {
      input_.fail(ErrorCode::FileUnsupported,
                  "the file holds several steps of time. Save the mesh of one step.");
    }
    points_ = begins("NumberOfPoints", 0, "Points");
    cells_ = begins("NumberOfCells", 0, "Types");
    offsets_ = begins("NumberOfCells", 1, "Offsets");
    corners_ = begins("NumberOfConnectivityIds", 0, "Connectivity");
    if (cells_.size() != points_.size() || corners_.size() != points_.size()) {
      input_.fail(ErrorCode::FileSyntax, "the numbers of partitions differ.");
    }
  }

  [[nodiscard]] std::size_t partitions() const noexcept { return points_.size() - 1; }

  /// @param withFields  whether to add field arrays, which refer to points of a single partition
  [[nodiscard]] std::unique_ptr<VtkSource> open(std::size_t part, bool withFields) const {
    auto source = std::make_unique<VtkHdfSource>(input_);
    source->points = points_[part + 1] - points_[part];
    source->cells = cells_[part + 1] - cells_[part];
    source->coordinates = reals("Points", 3, points_, part);
    source->types = integers("Types", 1, cells_, part);
    source->offsets = integers("Offsets", 1, offsets_, part);
    source->connectivity = integers("Connectivity", 1, corners_, part);
    addArrays(*source, VtkSection::PointData, "PointData", points_, part);
    addArrays(*source, VtkSection::CellData, "CellData", cells_, part);
    if (withFields) addFields(*source);
    return source;
  }
  /// The only partition of a file, with all arrays.
  [[nodiscard]] std::unique_ptr<VtkSource> openOnly() const {
    if (partitions() == 1) return open(0, true);
    input_.fail(ErrorCode::FileUnsupported, "the file has ", partitions(),
                " partitions, of which straight hexahedra are read only. Save it as one.");
  }

  [[nodiscard]] HexMesh readHexes(Stage& stage) const {
    if (partitions() == 1) return readVtkHexMesh(*open(0, true), stage);
    const auto openPart = [this](std::size_t part) { return open(part, false); };
    GluedMesh glued = readVtkPieces(input_.name(), partitions(), openPart, stage);
    if (!glued.numbered) return std::move(glued.mesh);
    // Field arrays refer to points by global number.
    VtkHdfSource fields(input_);
    fields.points = glued.mesh.points.size();
    addFields(fields);
    HexFeatures features = readVtkHexFeatures(fields);
    glued.mesh.features.edges = std::move(features.edges);
    glued.mesh.features.quads = std::move(features.quads);
    return std::move(glued.mesh);
  }

 private:
  using Begins = std::vector<std::uint64_t>;  ///< first row per partition, and the last end

  [[nodiscard]] std::uint64_t rowsOf(const std::string& path) const {
    const std::vector<std::uint64_t> shape = file_->shape(path);
    return shape.empty() ? 1 : shape[0];
  }

  /// @param more  rows per partition beyond those in the dataset of counts
  /// @param set  whose total number of rows must match
  [[nodiscard]] Begins begins(const std::string& counts, std::uint64_t more,
                              const std::string& set) const {
    Begins begins = {0};
    const std::string path = pathOf(set);
    const std::uint64_t rows = rowsOf(path);
    for (const std::int64_t count : file_->integers(pathOf(counts))) {
      const std::uint64_t each = static_cast<std::uint64_t>(count) + more;
      if (count < 0 || each > rows - begins.back()) break;
      begins.push_back(begins.back() + each);
    }
    const bool all = begins.size() == rowsOf(pathOf(counts)) + 1;
    if (all && begins.size() > 1 && begins.back() == rows) return begins;
    input_.fail(ErrorCode::FileSyntax, "the dataset \"", path,
                "\" does not have as many rows as \"", pathOf(counts), "\" says.");
  }

  /// The rows of a partition. A dataset is read only once.
  template <class T>
  [[nodiscard]] VtkColumn rows(std::map<std::string, std::vector<T>>& known,
                               std::vector<T> (HdfReader::*read)(const std::string&) const,
                               const std::string& set, std::size_t components, const Begins& begins,
                               std::size_t part) const {
    const std::string path = pathOf(set);
    auto place = known.find(path);
    if (place == known.end()) place = known.emplace(path, ((*file_).*read)(path)).first;
    const std::vector<T>& all = place->second;
    if (all.size() != components * begins.back()) {
      input_.fail(ErrorCode::FileSyntax, "the dataset \"", path, "\" has ", all.size(),
                  " numbers instead of ", components * begins.back(), ".");
    }
    const std::uint64_t count = begins[part + 1] - begins[part];
    VtkColumn column = columnOf(std::span<const T>(all).subspan(
        memorySize(components * begins[part]), memorySize(components * count)));
    if (partitions() == 1) known.erase(place);
    return column;
  }
  [[nodiscard]] VtkColumn integers(const std::string& set, std::size_t components,
                                   const Begins& begins, std::size_t part) const {
    return rows(integers_, &HdfReader::integers, set, components, begins, part);
  }
  [[nodiscard]] VtkColumn reals(const std::string& set, std::size_t components,
                                const Begins& begins, std::size_t part) const {
    return rows(reals_, &HdfReader::reals, set, components, begins, part);
  }

  /// Calls use(name, path in the grid, components) for the arrays of a group.
  template <class Use>
  void forEachArray(const std::string& group, const Use& use) const {
    const std::vector<std::string> all = file_->members("VTKHDF");
    if (std::find(all.begin(), all.end(), group) == all.end()) return;
    for (const std::string& name : file_->members(pathOf(group))) {
      std::string set = group;
      set.append(1, '/').append(name);
      if (!file_->has(pathOf(set))) continue;
      const std::vector<std::uint64_t> shape = file_->shape(pathOf(set));
      use(name, set, shape.size() > 1 ? memorySize(shape[1]) : std::size_t{1});
    }
  }

  void addArrays(VtkSource& source, VtkSection section, const std::string& group,
                 const Begins& begins, std::size_t part) const {
    forEachArray(
        group, [&](const std::string& name, const std::string& set, std::size_t components) {
          const bool isReal = file_->hasReals(pathOf(set));
          const auto load = [this, &begins, set, components, part, isReal](auto&&, auto&&) {
            return isReal ? reals(set, components, begins, part)
                          : integers(set, components, begins, part);
          };
          source.arrays.push_back({section, name, isReal ? VtkNumbers::Reals : VtkNumbers::Integers,
                                   components, true, load});
        });
  }
  void addFields(VtkSource& source) const {
    forEachArray("FieldData",
                 [&](const std::string& name, const std::string& set, std::size_t components) {
                   const std::string path = pathOf(set);
                   if (file_->hasReals(path)) return;
                   const auto load = [this, path](auto&&, auto&&) {
                     const std::vector<std::int64_t> numbers = file_->integers(path);
                     return columnOf(std::span<const std::int64_t>(numbers));
                   };
                   source.arrays.push_back(
                       {VtkSection::FieldData, name, VtkNumbers::Integers, components, true, load});
                 });
  }

  const Input& input_;
  std::unique_ptr<HdfReader> file_;
  Begins points_;
  Begins cells_;
  Begins offsets_;
  Begins corners_;
  mutable std::map<std::string, std::vector<std::int64_t>> integers_;
  mutable std::map<std::string, std::vector<double>> reals_;
};

}  // namespace

HexMesh readVtkHdf(const Input& input, Stage& stage) {
  return VtkHdfReader(input, stage).readHexes(stage);
}

TetCells readVtkHdfTets(const Input& input, Stage& stage) {
  const VtkHdfReader reader(input, stage);
  return readVtkTets(*reader.openOnly(), stage);
}

bool holdsCurvedVtkHdf(const Input& input, Stage& stage) {
  const VtkHdfReader reader(input, stage);
  return reader.partitions() == 1 && holdsVtkLagrange(*reader.openOnly());
}

LagrangeMesh readCurvedVtkHdf(const Input& input, Stage& stage) {
  const VtkHdfReader reader(input, stage);
  return readVtkLagrange(*reader.openOnly(), stage);
}

}  // namespace hexhex::io
