// The reading half of meshb.hpp.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>
#include <io/core/number_source.hpp>
#include <io/core/references.hpp>
#include <io/medit/meshb.hpp>

namespace hexhex {
namespace {

constexpr std::uint32_t kSwappedOne = std::uint32_t{1} << 24U;

/// Reads one file, section by section.
template <std::size_t corners>
class MeshbReader {
 public:
  /// @param file  the bytes of the file, or the open file, a regular one
  template <class File>
  MeshbReader(const File& file, const std::string& fileName, Stage& stage)
      : bytes_(file), fileName_(fileName), source_(bytes_, 0, fileName, stage) {}

  CellMesh<corners> read();

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  void readHead();
  /// @return whether another section follows
  bool readSection();
  void readDimension();
  void readVertices();
  void readCells();
  template <class Feature>
  void readFeatures(std::vector<Feature>& features, std::string_view what);
  [[nodiscard]] Array<std::int32_t> readReferences(std::size_t begin, RecordShape shape,
                                                   std::size_t count);
  template <class Vertices>
  [[nodiscard]] bool takeVertices(const char*& place, Vertices& vertices) const;
  [[nodiscard]] std::int64_t referenceAt(const char* place) const {
    return wide() != 0 ? loadLittle<std::int64_t>(place) : loadLittle<std::int32_t>(place);
  }
  [[nodiscard]] bool takeReference(const char* place, std::int32_t& reference) const;
  [[nodiscard]] std::uint64_t readVertex(BinarySource& record) const;
  void failIfRepeated(bool present, std::string_view keyword) const;
  void requireDimension() const;

  [[nodiscard]] std::uint64_t readPosition();
  [[nodiscard]] std::uint64_t readCount(RecordShape shape, std::string_view what);
  /// Integers of elements: 64 bits from version 4 on.
  [[nodiscard]] std::size_t wide() const { return version_ >= 4 ? 1 : 0; }

  ByteFile bytes_;
  const std::string& fileName_;
  BinarySource source_;
  std::int64_t version_ = 0;
  bool hasDimension_ = false;
  bool hasVertices_ = false;
  bool hasCells_ = false;
  CellMesh<corners> mesh_;
};

template <std::size_t corners>
CellMesh<corners> MeshbReader<corners>::read() {
  readHead();
  while (readSection()) {
  }
  if (hasCells_) return std::move(mesh_);
  throw Error(ErrorCode::FileUnsupported, fileName_ + ": the file holds no " +
                                              std::string(kKind.plural) + ": it has no section " +
                                              std::string(kKind.meditKeyword) + ".");
}

template <std::size_t corners>
void MeshbReader<corners>::readHead() {
  const std::int64_t one = source_.integer("the mark of the byte order");
  if (one == kSwappedOne) {
    source_.fail(ErrorCode::FileUnsupported,
                 "the bytes of numbers come in the order of another kind of computers; convert the "
                 "file to .mesh.");
  }
  if (one != 1) {
    source_.fail(ErrorCode::FileSyntax,
                 "a .meshb file begins with the number 1, found " + std::to_string(one) + ".");
  }
  version_ = source_.integer("the version of the format");
  if (version_ >= 1 && version_ <= 4) return;
  source_.fail(ErrorCode::FileUnsupported,
               "version " + std::to_string(version_) + " of the format is not known, only 1 to 4.");
}

template <std::size_t corners>
std::uint64_t MeshbReader<corners>::readPosition() {
  const char* const what = "the position of the next section";
  return version_ >= 3 ? source_.size(what) : static_cast<std::uint64_t>(source_.integer(what));
}

template <std::size_t corners>
bool MeshbReader<corners>::readSection() {
  const std::size_t begin = source_.position();
  const std::int64_t code = source_.integer("the keyword of a section");
  const auto keyword = static_cast<MeshbKeyword>(code);
  if (keyword == MeshbKeyword::End) return false;
  const std::uint64_t next = readPosition();
  // 0 is how some programs mark the last section. Only forwards, so that reading ends.
  if (next != 0 && (next <= begin || next > bytes_.size())) {
    source_.fail(ErrorCode::FileSyntax,
                 "the section that begins at byte " + std::to_string(begin) +
                     " says that the next one begins at byte " + std::to_string(next) + " of " +
                     std::to_string(bytes_.size()) +
                     ": either the number is wrong or the file is incomplete.");
  }
  if (keyword == MeshbKeyword::Dimension) readDimension();
  if (keyword == MeshbKeyword::Vertices) readVertices();
  if (code == kKind.meshbKeyword) readCells();
  // What stands before the vertices cannot be checked, and no known program writes it there.
  if (corners == 8 && hasVertices_) {
    if (keyword == MeshbKeyword::Edges) {
      readFeatures(mesh_.features.edges, "edges");
      keepTagged(mesh_.features.edges);
    }
    if (keyword == MeshbKeyword::Quadrilaterals) {
      readFeatures(mesh_.features.quads, "quadrilaterals");
      keepGroups(mesh_.features.quads);
    }
  }
  if (next != 0) source_.moveTo(static_cast<std::size_t>(next));
  return next != 0;
}

template <std::size_t corners>
void MeshbReader<corners>::readDimension() {
  hasDimension_ = true;
  const std::int64_t dimension = source_.integer("the dimension");
  if (dimension == 3) return;
  source_.fail(ErrorCode::FileUnsupported,
               "the dimension must be 3, found " + std::to_string(dimension) + ".");
}

template <std::size_t corners>
void MeshbReader<corners>::requireDimension() const {
  if (hasDimension_) return;
  source_.fail(ErrorCode::FileSyntax,
               "the section Dimension has to stand before the other sections.");
}

template <std::size_t corners>
void MeshbReader<corners>::failIfRepeated(bool present, std::string_view keyword) const {
  if (!present) return;
  source_.fail(ErrorCode::FileSyntax,
               "the section " + std::string(keyword) + " occurs a second time.");
}

template <std::size_t corners>
std::uint64_t MeshbReader<corners>::readCount(RecordShape shape, std::string_view what) {
  const std::string name = "the number of " + std::string(what);
  const std::uint64_t count = wide() != 0
                                  ? source_.size(name.c_str())
                                  : static_cast<std::uint32_t>(source_.integer(name.c_str()));
  requireRoom(source_, count, shape, what);
  if (count > kNone) {
    source_.fail(ErrorCode::TooLarge, "announces " + std::to_string(count) + " " +
                                          std::string(what) + "; at most " + std::to_string(kNone) +
                                          " are supported.");
  }
  return count;
}

template <std::size_t corners>
void MeshbReader<corners>::readVertices() {
  failIfRepeated(hasVertices_, "Vertices");
  requireDimension();
  hasVertices_ = true;
  const bool floats = version_ == 1;
  const RecordShape shape{
      .sizes = wide(), .integers = 1 - wide() + (floats ? 3U : 0U), .reals = floats ? 0U : 3U};
  const std::uint64_t count = readCount(shape, "vertices");
  mesh_.points.resize(count);
  const std::size_t begin = source_.position();
  const auto read = [&](BinarySource& record, std::size_t i) {
    for (double& coordinate : mesh_.points[i]) {
      coordinate = floats ? record.shortReal("a coordinate of a vertex")
                          : record.real("a coordinate of a vertex");
    }
  };
  SeenReferences seen;
  if (floats) {
    source_.records(count, shape, read);
    seen.add(2);  // not looked at
  } else {
    const auto quick = [&](const char* place, std::size_t i) {
      seen.add(referenceAt(place + sizeof(Vec3)));
      return loadPoint(place, mesh_.points[i]);
    };
    source_.records(count, shape, quick, read);
  }
  if (corners != 8 || !seen.saySomething()) return;
  mesh_.features.vertices = taggedVertices(readReferences(begin, shape, count));
}

template <std::size_t corners>
void MeshbReader<corners>::readCells() {
  failIfRepeated(hasCells_, kKind.meditKeyword);
  if (!hasVertices_) {
    source_.fail(ErrorCode::FileUnsupported,
                 "the section " + std::string(kKind.meditKeyword) +
                     " stands before the section Vertices; exchange them.");
  }
  hasCells_ = true;
  const RecordShape shape{.sizes = (corners + 1) * wide(),
                          .integers = (corners + 1) * (1 - wide())};
  const std::uint64_t count = readCount(shape, kKind.plural);
  mesh_.cells.resize(count);
  const std::size_t begin = source_.position();
  SeenReferences seen;
  const auto quick = [&](const char* place, std::size_t i) {
    const bool good = takeVertices(place, mesh_.cells[i]);
    seen.add(referenceAt(place));
    return good;
  };
  source_.records(count, shape, quick, [&](BinarySource& record, std::size_t i) {
    for (Index& corner : mesh_.cells[i]) {
      const std::uint64_t vertex = readVertex(record);
      if (vertex < 1 || vertex > mesh_.points.size()) {
        record.fail(ErrorCode::IndexOutOfRange,
                    std::string(kKind.singular) + " " + std::to_string(i + 1) + " names vertex " +
                        std::to_string(vertex) + ", but the " +
                        std::to_string(mesh_.points.size()) + " vertices are numbered from 1.",
                    Place{kKind.place, i});
      }
      corner = static_cast<Index>(vertex - 1);
    }
  });
  if (corners != 8 || !seen.saySomething()) return;
  mesh_.regions = readReferences(begin, shape, count);
  keepRegions(mesh_.regions);
}

/// Tagged elements, with their references as tags.
template <std::size_t corners>
template <class Feature>
void MeshbReader<corners>::readFeatures(std::vector<Feature>& features, std::string_view what) {
  constexpr std::size_t kNumbers = decltype(Feature::vertices){}.size() + 1;
  const RecordShape shape{.sizes = kNumbers * wide(), .integers = kNumbers * (1 - wide())};
  const std::uint64_t count = readCount(shape, what);
  features.assign(count, {});
  const auto quick = [&](const char* place, std::size_t i) {
    return takeVertices(place, features[i].vertices) && takeReference(place, features[i].tag);
  };
  source_.records(count, shape, quick, [&](BinarySource& record, std::size_t i) {
    record.fail(ErrorCode::IndexOutOfRange,
                "number " + std::to_string(i + 1) + " of the " + std::string(what) +
                    " names a vertex that does not exist, or a reference that does not fit into 32 "
                    "bits; the " +
                    std::to_string(mesh_.points.size()) + " vertices are numbered from 1.");
  });
}

/// The references at the ends of records.
template <std::size_t corners>
Array<std::int32_t> MeshbReader<corners>::readReferences(std::size_t begin, RecordShape shape,
                                                         std::size_t count) {
  const std::size_t end = source_.position();
  const std::size_t offset = shape.bytes() - (wide() != 0 ? 8 : 4);
  Array<std::int32_t> references(count);
  source_.moveTo(begin);
  const auto quick = [&](const char* place, std::size_t i) {
    return takeReference(place + offset, references[i]);
  };
  source_.records(count, shape, quick, [](BinarySource& record, std::size_t i) {
    record.fail(ErrorCode::FileUnsupported, "the reference of number " + std::to_string(i + 1) +
                                                " of this section does not fit into 32 bits.");
  });
  source_.moveTo(end);
  return references;
}

/// The vertices of an element, which are numbered from 1; false if one does not exist.
template <std::size_t corners>
template <class Vertices>
bool MeshbReader<corners>::takeVertices(const char*& place, Vertices& vertices) const {
  std::uint64_t largest = 0;
  for (Index& corner : vertices) {
    // 0, which is too small, becomes a large number.
    const std::uint64_t vertex =
        (wide() != 0 ? loadLittle<std::uint64_t>(place) : loadLittle<std::uint32_t>(place)) - 1;
    place += wide() != 0 ? 8 : 4;
    corner = static_cast<Index>(vertex);
    largest = std::max(largest, vertex);
  }
  return largest < mesh_.points.size();
}

/// A reference; false if it does not fit into 32 bits.
template <std::size_t corners>
bool MeshbReader<corners>::takeReference(const char* place, std::int32_t& reference) const {
  const std::int64_t number = referenceAt(place);
  reference = static_cast<std::int32_t>(number);
  return std::in_range<std::int32_t>(number);
}

template <std::size_t corners>
std::uint64_t MeshbReader<corners>::readVertex(BinarySource& record) const {
  const char* const what = "a vertex of a cell";
  return wide() != 0 ? record.size(what) : static_cast<std::uint32_t>(record.integer(what));
}

}  // namespace

HexMesh parseMeshb(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<MeshbReader<8>>(text, fileName, "read mesh", context));
}

HexMesh readMeshb(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readDirectly<MeshbReader<8>>(file, "read mesh", context));
}

TetCells parseMeshbTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<MeshbReader<4>>(text, fileName, "read tets", context);
}

TetCells readMeshbTets(const std::filesystem::path& file, Context& context) {
  return readDirectly<MeshbReader<4>>(file, "read tets", context);
}

}  // namespace hexhex
