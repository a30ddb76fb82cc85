// Writes `.pvtu` files with their pieces; and joins pieces of data sets by the global numbers of
// their vertices and cells, or by positions.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_data_set.hpp>
#include <io/formats/vtk_source.hpp>
#include <io/formats/xml_tags.hpp>

namespace hexhex::io {

namespace {

/// What stands for characters in an attribute.
constexpr std::array<std::pair<std::string_view, char>, 5> kXmlNames = {
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto name = std::find_if(kXmlNames.begin(), kXmlNames.end(),
                                   [c](const auto& each) { return each.second == c; });
    const bool isNamed = name != kXmlNames.end() && c != '\'';
    isNamed ? result.append(name->first) : result.append(1, c);
  }
  return result;
}

class PvtuSink final : public PartSink {
 public:
  PvtuSink(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : stem_(file.stem().string()),
        context_(context),
        team_(team),
        folder_(
            file.parent_path() / stem_,
            [stem = stem_](std::uint32_t part) { return concat(stem, '_', part, ".vtu"); }, team) {
    if (isFirst(team)) index_.emplace(file);
  }

  void begin(const PartsInfo& info) override { info_ = info; }

  [[nodiscard]] bool takesAnyOrder() const override { return true; }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    VtkPiece piece;
    const VtkDataSet data = partDataSet(part, info_, piece);
    if (part.part == 0) head_ = headOf(data);
    folder_.run([&] {
      OutputFile output(folder_.fileOf(part.part));
      writeVtkXml(output, data, Compression::None, stage);
      output.commit();
    });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    barrier(team_);  // wait until all pieces are written
    if (index_) nameAll(*index_);
    barrier(team_);
  }

 private:
  void nameAll(OutputFile& index) {
    index.write(head_);
    for (std::uint32_t part = 0; part < info_.parts; ++part) {
      const std::string piece = folder_.fileOf(part).filename().string();
      index.write("    <Piece Source=\"" + escaped(stem_ + '/' + piece) + "\"/>\n");
    }
    index.write("  </PUnstructuredGrid>\n</VTKFile>\n");
    index.flush();
    folder_.commit(info_.parts);
    try {
      index.commit();
    } catch (...) {
      if (!index.isNamed()) folder_.takeBack();
      throw;
    }
  }

  /// The header of the `.pvtu` file, which declares the arrays of all pieces.
  [[nodiscard]] std::string headOf(const VtkDataSet& data) const {
    const bool little = std::endian::native == std::endian::little;
    std::string head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" "
        "version=\"1.0\" byte_order=\"";
    head += little ? "LittleEndian" : "BigEndian";
    head += concat("\" header_type=\"UInt64\">\n  <PUnstructuredGrid GhostLevel=\"",
                   info_.ghostLayers, "\">\n");
    const auto addSection = [&](const std::string& name, VtkSection section) {
      head += "    <" + name + globalNumbersOf(section) + ">\n";
      for (const VtkArray& array : data.arrays()) {
        if (array.section != section) continue;
        head += concat("      <PDataArray type=\"", array.type, "\" Name=\"", array.name, "\"");
        if (array.components != 1) head += concat(" NumberOfComponents=\"", array.components, "\"");
        head += "/>\n";
      }
      head += "    </" + name + ">\n";
    };
    addSection("PPointData", VtkSection::PointData);
    addSection("PCellData", VtkSection::CellData);
    addSection("PPoints", VtkSection::Points);
    return head;
  }
  static std::string globalNumbersOf(VtkSection section) {
    if (section == VtkSection::Points) return {};
    const bool ofPoints = section == VtkSection::PointData;
    return concat(" GlobalIds=\"", ofPoints ? kVtkGlobalPoints : kVtkGlobalCells, '"');
  }

  std::string stem_;
  Context& context_;
  ProcessTeam* team_;
  std::optional<OutputFile> index_;  ///< first process only
  PartFolder folder_;
  PartsInfo info_;
  std::string head_;
};

}  // namespace

std::unique_ptr<PartSink> openPvtuSink(const std::filesystem::path& file, Context& context,
                                       ProcessTeam* team) {
  return std::make_unique<PvtuSink>(file, context, team);
}

namespace {

// Joining pieces.

std::string unescaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto name = std::find_if(kXmlNames.begin(), kXmlNames.end(),
                                   [&](const auto& each) { return text.starts_with(each.first); });
    result += name != kXmlNames.end() ? name->second : text.front();
    text.remove_prefix(name != kXmlNames.end() ? name->first.size() : 1);
  }
  return result;
}

/// Guards against paths chosen by the author of the file: refuses pipes and devices, which may
/// never end, and repeated files, so that all pieces are no larger than the files on disk.
void requireFiles(const Input& input, const std::vector<std::filesystem::path>& pieces) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& piece : pieces) {
    std::error_code missing;
    const std::filesystem::path file = std::filesystem::canonical(piece, missing);
    const std::filesystem::file_status status = std::filesystem::status(file, missing);
    // Opening it will report why it cannot be read.
    if (missing || std::filesystem::is_directory(status)) continue;
    files.push_back(file);
    if (std::filesystem::is_regular_file(status)) continue;
    input.fail(ErrorCode::FileUnsupported,
               "the piece " + piece.string() + " is a pipe or a device.");
  }
  std::sort(files.begin(), files.end());
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice == files.end()) return;
  input.fail(ErrorCode::FileSyntax, "two pieces are the same file, " + twice->string() + '.');
}

/// The files of all pieces.
std::vector<std::filesystem::path> findPieces(const Input& input, Stage& stage) {
  Array<char> room;
  XmlTags tags(input.text(room, stage, kXmlFirst), input.name());
  std::vector<std::filesystem::path> pieces;
  XmlTag tag;
  bool inGrid = false;
  while (tags.next(tag)) {
    if (tag.name == "PUnstructuredGrid") inGrid = !tag.closing;
    if (tag.name != "Piece" || tag.closing || !inGrid) continue;
    const std::string source = unescaped(tag.attribute("Source"));
    if (source.empty() || source.find('\0') != std::string::npos) {
      tags.fail(ErrorCode::FileSyntax, tag, "a piece without Source, the name of its file.");
    }
    pieces.push_back(input.path().parent_path() / source);
  }
  if (pieces.empty()) {
    input.fail(ErrorCode::FileSyntax,
               "the file names no pieces: there is no <Piece> in a "
               "<PUnstructuredGrid>.");
  }
  requireFiles(input, pieces);
  return pieces;
}

/// A piece, with the global numbers of its points and hexahedra if it has both.
struct Piece {
  HexMesh mesh;
  Array<std::int64_t> points;
  Array<std::int64_t> cells;
  Array<std::int64_t> marks;  ///< vtkGhostType of cells; empty: all 0
};

/// The numbers of an array; empty if there is no such array.
Array<std::int64_t> readNumbers(const VtkSource& source, VtkSection section,
                                std::string_view name) {
  Array<std::int64_t> numbers;
  const VtkSourceArray* const array = source.find(section, name, 1, VtkNumbers::Integers);
  if (array == nullptr) return numbers;
  const VtkColumn column = source.load(*array);
  numbers.resize(memorySize(column.count));
  source.copy(column, 0, numbers.size(), numbers.data());
  return numbers;
}

Piece readPiece(const VtkSource& source, Stage& stage) {
  source.requireIndexable();
  Piece piece;
  if (source.cells == 0) return piece;
  piece.mesh = readVtkHexMesh(source, stage);
  if (piece.mesh.cells.size() != source.cells) {
    source.fail(ErrorCode::FileUnsupported, "the piece has other cells than hexahedra.");
  }
  piece.points = readNumbers(source, VtkSection::PointData, kVtkGlobalPoints);
  piece.cells = readNumbers(source, VtkSection::CellData, kVtkGlobalCells);
  piece.marks = readNumbers(source, VtkSection::CellData, kVtkGhosts);
  return piece;
}

/// Joins pieces into one mesh. If all pieces have global numbers of points and cells, these number
/// the mesh; otherwise points at the same position are merged, and cells marked as duplicates are
/// dropped.
class Gluer {
 public:
  explicit Gluer(std::string name) : name_(std::move(name)) {}

  void add(const VtkSource& source, const Piece& piece) {
    const HexMesh& mesh = piece.mesh;
    if (mesh.cells.empty()) return;
    const bool generators = mesh.generatorTet.size() == mesh.points.size() &&
                            mesh.generatorCorners.size() == mesh.points.size();
    hasNumbers_ = hasNumbers_ && !piece.points.empty() && !piece.cells.empty();
    hasGenerators_ = hasGenerators_ && generators;
    hasRegions_ = hasRegions_ && !mesh.regions.empty();
    if (mesh.points.size() > kNone - points_.size()) {
      source.fail(ErrorCode::TooLarge,
                  "up to this piece there are more points than are supported.");
    }
    firstPoints_.push_back(points_.size());
    // Numbers are checked only once all pieces are known: none may exceed the total number of
    // points or cells.
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      points_.push_back({numberAt(source, piece.points, v, "point"), mesh.points[v],
                         generators ? mesh.generatorTet[v] : kNone,
                         generators ? mesh.generatorCorners[v] : CornerSet{0}});
    }
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      Cell cell{numberAt(source, piece.cells, c, "cell"), mesh.cells[c], 0};
      shift(cell.corners);
      if (!mesh.regions.empty()) cell.region = mesh.regions[c];
      cells_.push_back(cell);
      isGhost_.push_back(!piece.marks.empty() && (piece.marks[c] & kVtkDuplicate) != 0);
    }
    addFeatures(mesh.features);
  }

  [[nodiscard]] GluedMesh take() {
    if (!hasNumbers_) numberByPositions();
    nameAll();
    HexMesh mesh;
    keepOnce(points_, "vertex");
    keepOnce(cells_, "cell");
    for (const Point& point : points_) {
      mesh.points.push_back(point.position);
      if (!hasGenerators_) continue;
      mesh.generatorTet.push_back(point.tet);
      mesh.generatorCorners.push_back(point.corners);
    }
    for (const Cell& cell : cells_) {
      mesh.cells.push_back(cell.corners);
      if (hasRegions_) mesh.regions.push_back(cell.region);
    }
    sortOnce(features_.vertices);
    sortOnce(features_.edges);
    sortOnce(features_.quads);
    mesh.features = std::move(features_);
    return {std::move(mesh), hasNumbers_};
  }

 private:
  /// Until nameAll(), corners index the concatenated points of all pieces.
  struct Point {
    std::uint64_t number;
    Vec3 position;
    Index tet;
    CornerSet corners;
    bool operator==(const Point&) const = default;
  };
  struct Cell {
    std::uint64_t number;
    Hex corners;
    std::int32_t region;
    bool operator==(const Cell&) const = default;
  };

  static std::uint64_t numberAt(const VtkSource& source, const Array<std::int64_t>& numbers,
                                std::size_t i, const char* what) {
    if (numbers.empty()) return 0;
    if (numbers[i] >= 0 && numbers[i] < std::int64_t{kNone}) {
      return static_cast<std::uint64_t>(numbers[i]);
    }
    source.fail(ErrorCode::FileUnsupported, "a ", what, " has the global number ", numbers[i],
                "; numbers from 0 to 2^32 - 2 are read.");
  }

  /// Converts indices within the last piece to indices of concatenated points.
  template <class Vertices>
  void shift(Vertices& vertices) const {
    for (Index& v : vertices) v += static_cast<Index>(firstPoints_.back());
  }
  void addFeatures(const HexFeatures& features) {
    const auto addAll = [this](const auto& from, auto& to) {
      for (auto feature : from) {
        shift(feature.vertices);
        to.push_back(feature);
      }
    };
    for (const auto& [vertex, tag] : features.vertices) {
      features_.vertices.push_back({vertex + static_cast<Index>(firstPoints_.back()), tag});
    }
    addAll(features.edges, features_.edges);
    addAll(features.quads, features_.quads);
  }

  void numberByPositions() {
    hasGenerators_ = false;
    Array<double> coordinates;
    for (Point& point : points_) {
      coordinates.insert(coordinates.end(), point.position.begin(), point.position.end());
      point.tet = kNone;
      point.corners = 0;
    }
    std::size_t ambiguous = points_.size();
    const Array<std::size_t> firsts = firstsAtSamePosition(coordinates, firstPoints_, &ambiguous);
    if (ambiguous < points_.size()) {
      const Vec3& at = points_[ambiguous].position;
      fail(concat(
          "pieces have no global numbers of points and cells, and at the point (", at[0], ", ",
          at[1], ", ", at[2],
          ") a piece has several points, so that nobody knows which of them another piece's is. "
          "Write the pieces with GlobalPointIds and GlobalCellIds."));
    }
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i].number = firsts[i] == i ? next++ : points_[firsts[i]].number;
    }
    std::size_t kept = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (isGhost_[c]) continue;
      cells_[kept] = cells_[c];
      cells_[kept].number = kept;
      ++kept;
    }
    cells_.resize(kept);
  }

  /// Replaces corners by the numbers of their points.
  void nameAll() {
    const auto name = [this](Index& v) { v = static_cast<Index>(points_[v].number); };
    const auto nameIn = [&](auto& elements) {
      for (auto& element : elements)
        std::for_each(element.vertices.begin(), element.vertices.end(), name);
    };
    for (Cell& cell : cells_) std::for_each(cell.corners.begin(), cell.corners.end(), name);
    for (FeatureVertex& feature : features_.vertices) name(feature.vertex);
    nameIn(features_.edges);
    nameIn(features_.quads);
  }

  /// Sorts by number. Elements with equal numbers must agree, and no number may be missing.
  template <class Element>
  void keepOnce(std::vector<Element>& elements, const char* what) const {
    std::stable_sort(elements.begin(), elements.end(),
                     [](const Element& a, const Element& b) { return a.number < b.number; });
    for (std::size_t i = 1; i < elements.size(); ++i) {
      if (elements[i].number != elements[i - 1].number || elements[i] == elements[i - 1]) continue;
      fail(concat("two pieces have different ",
                  what == std::string_view("vertex") ? "vertices" : "cells",
                  " with the global number ", elements[i].number, '.'));
    }
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (elements[i].number == i) continue;
      fail(concat("the ", what, " with the global number ", i, " is in no piece."));
    }
  }
  template <class Feature>
  static void sortOnce(std::vector<Feature>& features) {
    std::stable_sort(features.begin(), features.end(), [](const Feature& a, const Feature& b) {
      return verticesOf(a) < verticesOf(b);
    });
    features.erase(std::unique(features.begin(), features.end()), features.end());
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw Error(ErrorCode::FileSyntax, name_ + ": " + sentence);
  }

  std::string name_;
  std::vector<std::size_t> firstPoints_;  ///< per piece
  std::vector<Point> points_;
  std::vector<Cell> cells_;
  std::vector<bool> isGhost_;
  HexFeatures features_;
  bool hasNumbers_ = true;
  bool hasGenerators_ = true;
  bool hasRegions_ = true;
};

}  // namespace

GluedMesh readVtkPieces(const std::string& name, std::size_t count, const OpenVtkPiece& open,
                        Stage& stage) {
  Gluer gluer(name);
  for (std::size_t i = 0; i < count; ++i) {
    const std::unique_ptr<VtkSource> source = open(i);
    gluer.add(*source, readPiece(*source, stage));
  }
  return gluer.take();
}

HexMesh readPvtu(const Input& input, Stage& stage) {
  const std::vector<std::filesystem::path> files = findPieces(input, stage);
  std::optional<Input> piece;  // must outlive its source
  const auto open = [&](std::size_t i) {
    piece.emplace(files[i]);
    return openVtuFile(*piece, stage);
  };
  return readVtkPieces(input.name(), files.size(), open, stage).mesh;
}

}  // namespace hexhex::io
