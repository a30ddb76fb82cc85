// The reading half of meshb.hpp.
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/input_file.hpp>
#include <io/meshb.hpp>
#include <io/number_source.hpp>

namespace hexhex {
namespace {

constexpr std::uint32_t kSwappedOne = std::uint32_t{1} << 24U;

/// Reads one file, section by section.
class MeshbReader {
 public:
  MeshbReader(std::string_view bytes, const std::string& fileName, Stage& stage)
      : bytes_(bytes), fileName_(fileName), source_(bytes, 0, fileName, stage) {}

  HexMesh read();

 private:
  void readHead();
  /// @return whether another section follows
  bool readSection();
  void readDimension();
  void readVertices();
  void readHexahedra();
  void failIfRepeated(bool present, const char* keyword) const;
  void requireDimension() const;

  [[nodiscard]] std::uint64_t readPosition();
  [[nodiscard]] std::uint64_t readCount(RecordShape shape, const char* what);
  /// Integers of elements: 64 bits from version 4 on.
  [[nodiscard]] std::size_t wide() const { return version_ >= 4 ? 1 : 0; }

  std::string_view bytes_;
  const std::string& fileName_;
  BinarySource source_;
  std::int64_t version_ = 0;
  bool hasDimension_ = false;
  bool hasVertices_ = false;
  bool hasHexahedra_ = false;
  HexMesh mesh_;
};

HexMesh MeshbReader::read() {
  readHead();
  while (readSection()) {
  }
  if (hasHexahedra_) return std::move(mesh_);
  throw Error(ErrorCode::FileUnsupported,
              fileName_ + ": the file holds no hexahedra: it has no section Hexahedra.");
}

void MeshbReader::readHead() {
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

std::uint64_t MeshbReader::readPosition() {
  const char* const what = "the position of the next section";
  return version_ >= 3 ? source_.size(what) : static_cast<std::uint64_t>(source_.integer(what));
}

bool MeshbReader::readSection() {
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
  if (keyword == MeshbKeyword::Hexahedra) readHexahedra();
  if (next != 0) source_.moveTo(static_cast<std::size_t>(next));
  return next != 0;
}

void MeshbReader::readDimension() {
  hasDimension_ = true;
  const std::int64_t dimension = source_.integer("the dimension");
  if (dimension == 3) return;
  source_.fail(ErrorCode::FileUnsupported,
               "the dimension must be 3, found " + std::to_string(dimension) + ".");
}

void MeshbReader::requireDimension() const {
  if (hasDimension_) return;
  source_.fail(ErrorCode::FileSyntax,
               "the section Dimension has to stand before the other sections.");
}

void MeshbReader::failIfRepeated(bool present, const char* keyword) const {
  if (!present) return;
  source_.fail(ErrorCode::FileSyntax,
               "the section " + std::string(keyword) + " occurs a second time.");
}

std::uint64_t MeshbReader::readCount(RecordShape shape, const char* what) {
  const std::string name = "the number of " + std::string(what);
  const std::uint64_t count = wide() != 0
                                  ? source_.size(name.c_str())
                                  : static_cast<std::uint32_t>(source_.integer(name.c_str()));
  const std::size_t room = source_.room(shape);
  if (count > room) {
    source_.fail(ErrorCode::FileSyntax,
                 "announces " + std::to_string(count) + " " + what +
                     ", but the rest of the file has room for at most " + std::to_string(room) +
                     ": either the number is wrong or the file is incomplete.");
  }
  if (count > kNone) {
    source_.fail(ErrorCode::TooLarge, "announces " + std::to_string(count) + " " + what +
                                          "; at most " + std::to_string(kNone) + " are supported.");
  }
  return count;
}

void MeshbReader::readVertices() {
  failIfRepeated(hasVertices_, "Vertices");
  requireDimension();
  hasVertices_ = true;
  const bool floats = version_ == 1;
  const RecordShape shape{
      .sizes = wide(), .integers = 1 - wide() + (floats ? 3U : 0U), .reals = floats ? 0U : 3U};
  const std::uint64_t count = readCount(shape, "vertices");
  mesh_.points.resize(count);
  source_.records(count, shape, [&](BinarySource& record, std::size_t i) {
    for (double& coordinate : mesh_.points[i]) {
      coordinate = floats ? record.shortReal("a coordinate of a vertex")
                          : record.real("a coordinate of a vertex");
    }
  });
}

void MeshbReader::readHexahedra() {
  failIfRepeated(hasHexahedra_, "Hexahedra");
  if (!hasVertices_) {
    source_.fail(ErrorCode::FileUnsupported,
                 "the section Hexahedra stands before the section Vertices; exchange them.");
  }
  hasHexahedra_ = true;
  const RecordShape shape{.sizes = 9 * wide(), .integers = 9 * (1 - wide())};
  const std::uint64_t count = readCount(shape, "hexahedra");
  mesh_.cells.resize(count);
  const std::uint64_t vertices = mesh_.points.size();
  source_.records(count, shape, [&](BinarySource& record, std::size_t i) {
    for (Index& corner : mesh_.cells[i]) {
      const char* const what = "a vertex of a hexahedron";
      const std::uint64_t vertex =
          wide() != 0 ? record.size(what) : static_cast<std::uint32_t>(record.integer(what));
      if (vertex < 1 || vertex > vertices) {
        record.fail(ErrorCode::IndexOutOfRange,
                    "hexahedron " + std::to_string(i + 1) + " names vertex " +
                        std::to_string(vertex) + ", but the " + std::to_string(vertices) +
                        " vertices are numbered from 1.",
                    Place{PlaceKind::Cell, i});
      }
      corner = static_cast<Index>(vertex - 1);
    }
  });
}

}  // namespace

HexMesh parseMeshb(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] { mesh = MeshbReader(text, fileName, stage).read(); });
  return mesh;
}

HexMesh readMeshb(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] {
    const Array<char> bytes = readWholeFile(file, stage);
    mesh = MeshbReader(asText(bytes), file.string(), stage).read();
  });
  return mesh;
}

}  // namespace hexhex
