// `.pvtu` files: writes one and its pieces, and glues such pieces by the global numbers of their
// vertices and cells.
#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_data_set.hpp>
#include <io/formats/vtk_source.hpp>
#include <io/formats/xml_tags.hpp>

namespace hexhex::io {

namespace {

/// As the value of an attribute.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
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
            [stem = stem_](std::uint32_t part) {
              return stem + '_' + std::to_string(part) + ".vtu";
            },
            team) {
    if (isFirst(team)) index_.emplace(file);
  }

  void begin(const PartsInfo& info) override { info_ = info; }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    VtkPiece piece;
    const VtkDataSet data = partDataSet(part, info_, piece);
    if (head_.empty()) head_ = headOf(data);
    folder_.run([&] {
      OutputFile output(folder_.fileOf(part.part));
      writeVtkXml(output, data, false, stage);
    });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    barrier(team_);  // all pieces are written
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

  /// What is the same in all pieces.
  [[nodiscard]] std::string headOf(const VtkDataSet& data) const {
    const bool little = std::endian::native == std::endian::little;
    std::string head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" "
        "version=\"1.0\" byte_order=\"";
    head += little ? "LittleEndian" : "BigEndian";
    head += "\" header_type=\"UInt64\">\n  <PUnstructuredGrid GhostLevel=\"" +
            std::to_string(info_.ghostLayers) + "\">\n";
    const auto addSection = [&](const std::string& name, VtkSection section) {
      head += "    <" + name + globalNumbersOf(section) + ">\n";
      for (const VtkArray& array : data.arrays()) {
        if (array.section != section) continue;
        head += "      <PDataArray type=\"" + std::string(array.type) + "\" Name=\"" +
                std::string(array.name) + "\"";
        if (array.components != 1) {
          head += " NumberOfComponents=\"" + std::to_string(array.components) + "\"";
        }
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
    return " GlobalIds=\"" + std::string(ofPoints ? kVtkGlobalPoints : kVtkGlobalCells) + '"';
  }

  std::string stem_;
  Context& context_;
  ProcessTeam* team_;
  std::optional<OutputFile> index_;  ///< of the first process
  PartFolder folder_;
  PartsInfo info_;
  std::string head_;
};

}  // namespace

std::unique_ptr<PartSink> openPvtuSink(const std::filesystem::path& file,
                                       const WriteOptions& /*options*/, Context& context,
                                       ProcessTeam* team) {
  return std::make_unique<PvtuSink>(file, context, team);
}

namespace {

// Glues the pieces of a `.pvtu` file by the global numbers of their vertices and cells.

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kNames = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  while (!text.empty()) {
    const auto name = std::find_if(kNames.begin(), kNames.end(),
                                   [&](const auto& each) { return text.starts_with(each.first); });
    result += name != kNames.end() ? name->second : text.front();
    text.remove_prefix(name != kNames.end() ? name->first.size() : 1);
  }
  return result;
}

/// Whoever wrote the file chose what is opened: no pipes and devices, which may never end, and no
/// file twice, so that all pieces together are no larger than what is on the disk.
void requireFiles(const Input& input, const std::vector<std::filesystem::path>& pieces) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& piece : pieces) {
    std::error_code missing;
    const std::filesystem::path file = std::filesystem::canonical(piece, missing);
    const std::filesystem::file_status status = std::filesystem::status(file, missing);
    // Whoever opens it will tell why it cannot be read.
    if (missing || std::filesystem::is_directory(status)) continue;
    files.push_back(file);
    if (std::filesystem::is_regular_file(status)) continue;
    throw Error(ErrorCode::FileUnsupported,
                input.name() + ": the piece " + piece.string() + " is a pipe or a device.");
  }
  std::sort(files.begin(), files.end());
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice == files.end()) return;
  throw Error(ErrorCode::FileSyntax,
              input.name() + ": two pieces are the same file, " + twice->string() + '.');
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
      tags.fail(ErrorCode::FileSyntax, "a piece without Source, the name of its file.", tag);
    }
    pieces.push_back(input.path().parent_path() / source);
  }
  if (pieces.empty()) {
    throw Error(ErrorCode::FileSyntax, input.name() +
                                           ": the file names no pieces: there is no <Piece> in a "
                                           "<PUnstructuredGrid>.");
  }
  requireFiles(input, pieces);
  return pieces;
}

/// A piece with the global numbers of its points and hexahedra.
struct Piece {
  HexMesh mesh;
  Array<std::int64_t> points;
  Array<std::int64_t> cells;
};

Array<std::int64_t> readNumbers(const VtkSource& source, VtkSection section, std::string_view name,
                                std::uint64_t count) {
  const VtkSourceArray* const array = source.find(section, name, 1, VtkNumbers::Integers);
  if (array == nullptr) {
    source.fail(ErrorCode::FileUnsupported,
                "the piece has no array \"" + std::string(name) +
                    "\": without global numbers, pieces cannot be glued.");
  }
  Array<std::int64_t> numbers(count);
  source.copy(source.load(*array), 0, count, numbers.data());
  return numbers;
}

Piece readPiece(const std::filesystem::path& file, Stage& stage) {
  const Input input(file);
  const std::unique_ptr<VtkSource> source = openVtuFile(input, stage);
  source->requireIndexable();
  Piece piece;
  if (source->cells == 0) return piece;
  piece.mesh = readVtkHexMesh(*source, stage);
  if (piece.mesh.cells.size() != source->cells) {
    source->fail(ErrorCode::FileUnsupported, "the piece has other cells than hexahedra.");
  }
  piece.points =
      readNumbers(*source, VtkSection::PointData, kVtkGlobalPoints, piece.mesh.points.size());
  piece.cells =
      readNumbers(*source, VtkSection::CellData, kVtkGlobalCells, piece.mesh.cells.size());
  return piece;
}

class Gluer {
 public:
  explicit Gluer(std::string name) : name_(std::move(name)) {}

  void add(const Piece& piece, const std::filesystem::path& file) {
    const HexMesh& mesh = piece.mesh;
    const bool generators = mesh.generatorTet.size() == mesh.points.size() &&
                            mesh.generatorCorners.size() == mesh.points.size();
    hasGenerators_ = hasGenerators_ && (generators || mesh.cells.empty());
    hasRegions_ = hasRegions_ && (!mesh.regions.empty() || mesh.cells.empty());
    // Numbers are not trusted before all pieces are known: of so many points and cells, none can
    // have a larger one.
    for (std::size_t v = 0; v < piece.points.size(); ++v) {
      requireNumber(piece.points[v], file, "point");
      points_.push_back({static_cast<std::uint64_t>(piece.points[v]), mesh.points[v],
                         generators ? mesh.generatorTet[v] : kNone,
                         generators ? mesh.generatorCorners[v] : CornerSet{0}});
    }
    for (std::size_t c = 0; c < piece.cells.size(); ++c) {
      requireNumber(piece.cells[c], file, "cell");
      Cell cell{static_cast<std::uint64_t>(piece.cells[c]), {}, 0};
      for (std::size_t k = 0; k < 8; ++k) {
        cell.corners[k] = static_cast<Index>(piece.points[mesh.cells[c][k]]);
      }
      if (!mesh.regions.empty()) cell.region = mesh.regions[c];
      cells_.push_back(cell);
    }
    addFeatures(piece);
  }

  [[nodiscard]] HexMesh take() {
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
    mesh.features.vertices = std::move(features_.vertices);
    mesh.features.edges = std::move(features_.edges);
    mesh.features.quads = std::move(features_.quads);
    return mesh;
  }

 private:
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

  static void requireNumber(std::int64_t number, const std::filesystem::path& file,
                            const char* what) {
    if (number >= 0 && number < std::int64_t{kNone}) return;
    throw Error(ErrorCode::FileUnsupported, file.string() + ": a " + what +
                                                " has the global number " + std::to_string(number) +
                                                "; numbers from 0 to 2^32 - 2 are read.");
  }
  /// Sorts by number. Whoever has a number is the same everywhere, and none is missing.
  template <class Element>
  void keepOnce(std::vector<Element>& elements, const char* what) const {
    std::stable_sort(elements.begin(), elements.end(),
                     [](const Element& a, const Element& b) { return a.number < b.number; });
    for (std::size_t i = 1; i < elements.size(); ++i) {
      if (elements[i].number != elements[i - 1].number || elements[i] == elements[i - 1]) continue;
      fail("two pieces have different " +
           std::string(what == std::string_view("vertex") ? "vertices" : "cells") +
           " with the global number " + std::to_string(elements[i].number) + '.');
    }
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (elements[i].number == i) continue;
      fail("the " + std::string(what) + " with the global number " + std::to_string(i) +
           " is in no piece.");
    }
  }
  template <class Feature>
  static void sortOnce(std::vector<Feature>& features) {
    const auto key = [](const Feature& feature) {
      if constexpr (std::is_same_v<Feature, FeatureVertex>) {
        return feature.vertex;
      } else {
        return feature.vertices;
      }
    };
    std::stable_sort(features.begin(), features.end(),
                     [&](const Feature& a, const Feature& b) { return key(a) < key(b); });
    features.erase(std::unique(features.begin(), features.end()), features.end());
  }
  void addFeatures(const Piece& piece) {
    const auto global = [&piece](Index v) { return static_cast<Index>(piece.points[v]); };
    const auto addAll = [&](const auto& from, auto& to) {
      for (auto feature : from) {
        for (Index& v : feature.vertices) v = global(v);
        to.push_back(feature);
      }
    };
    for (const FeatureVertex& feature : piece.mesh.features.vertices) {
      features_.vertices.push_back({global(feature.vertex), feature.tag});
    }
    addAll(piece.mesh.features.edges, features_.edges);
    addAll(piece.mesh.features.quads, features_.quads);
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw Error(ErrorCode::FileSyntax, name_ + ": " + sentence);
  }

  std::string name_;
  std::vector<Point> points_;
  std::vector<Cell> cells_;
  HexFeatures features_;
  bool hasGenerators_ = true;
  bool hasRegions_ = true;
};

}  // namespace

HexMesh readPvtu(const Input& input, Context& context) {
  return inStage(context, "read mesh", [&](Stage& stage) {
    Gluer gluer(input.name());
    for (const std::filesystem::path& file : findPieces(input, stage)) {
      gluer.add(readPiece(file, stage), file);
    }
    return gluer.take();
  });
}

}  // namespace hexhex::io
