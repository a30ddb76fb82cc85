// `.mesh` and `.meshb` piece by piece.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <io/core/number_source.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_window.hpp>
#include <io/medit/medit.hpp>

namespace hexhex::io {
namespace {

/// Whether a section of cells that are no hexahedra is meant.
template <class Fits>
bool isOtherCells(const Fits& fits) {
  return std::any_of(kVolumeCells.begin(), kVolumeCells.end(), [&](const VolumeCells& type) {
    return type.meditVertices > 0 && type.meditKeyword != kCellKind<8>.meditKeyword && fits(type);
  });
}

/// A text with one section of vertices, and one of hexahedra behind it.
class MeditTextPieces final : public PlainMesh {
 public:
  MeditTextPieces(const InputFile& file, const std::string& name, Context& context)
      : text_(file, name, context) {}

  /// @return whether the whole file is of the form
  [[nodiscard]] bool look() {
    if (text_.token() != "MeshVersionFormatted" || !text_.count()) return false;
    std::uint64_t positionOfCells = 0;
    for (std::string word = text_.token(); !word.empty() && word != "End"; word = text_.token()) {
      if (word == "Vertices" && !lookAt(points, 4, positionOfPoints_)) return false;
      if (word == "Hexahedra" && !lookAt(cells, 9, positionOfCells)) return false;
      if (isOtherCells([&](const VolumeCells& type) { return word == type.meditKeyword; })) {
        return false;
      }
      if (word == "Dimension" && text_.count() != 3) return false;
    }
    positionOfCells_ = positionOfCells;
    return 0 < positionOfPoints_ && positionOfPoints_ < positionOfCells && !text_.sawComments();
  }

  void beginPoints() override { text_.moveTo(positionOfPoints_); }
  void read(std::span<Vec3> to) override {
    text_.elements(to.size(), 4, [&](TextScanner& scanner, std::size_t i) {
      for (double& x : to[i]) x = scanner.number("a coordinate of a vertex");
      readReference(scanner);
    });
  }

  void beginCells() override { text_.moveTo(positionOfCells_); }
  void read(std::span<Hex64> to) override {
    text_.elements(to.size(), 9, [&](TextScanner& scanner, std::size_t i) {
      for (std::uint64_t& vertex : to[i]) {
        const std::int64_t number = scanner.integer("a vertex of a hexahedron");
        vertex = vertexOfNumber(static_cast<std::uint64_t>(number), points);
      }
      readReference(scanner);
    });
  }

 private:
  static void readReference(TextScanner& scanner) {
    if (std::in_range<std::int32_t>(scanner.integer("a reference"))) return;
    scanner.failToken("a reference of 32 bits");
  }

  /// @param[out] position  of the first element; must not be set before
  [[nodiscard]] bool lookAt(std::uint64_t& count, std::uint64_t tokensEach,
                            std::uint64_t& position) {
    const std::optional<std::uint64_t> found = text_.count();
    if (!found || position != 0) return false;
    count = *found;
    position = text_.position();
    return text_.skip(tokensEach * count);
  }

  TextWindow text_;
  std::uint64_t positionOfPoints_ = 0;
  std::uint64_t positionOfCells_ = 0;
};

/// The same as bytes, of version 2 or later.
class MeditBytePieces final : public PlainMesh {
 public:
  MeditBytePieces(const InputFile& file, const std::string& name, Context& context)
      : quiet_(context.threads()),
        stage_(quiet_, "read"),
        bytes_(file, name),
        source_(bytes_, 0, stage_) {}

  [[nodiscard]] bool look() {
    if (source_.integer("the mark of the byte order") != 1) return false;
    version_ = source_.integer("the version of the format");
    if (version_ < 2 || version_ > 4) return false;
    std::uint64_t next = source_.position();
    bool hasDimension = false;
    while (next != 0 && next < bytes_.size()) {
      const std::uint64_t begin = std::exchange(next, 0);
      source_.moveTo(begin);
      const auto section = static_cast<MeditSection>(source_.integer("the keyword of a section"));
      if (section == MeditSection::End) break;
      next = version_ >= 3 ? source_.size("a position")
                           : static_cast<std::uint32_t>(source_.integer("a position"));
      if (next != 0 && (next <= begin || next > bytes_.size())) return false;
      if (section == MeditSection::Dimension) {
        hasDimension = source_.integer("the dimension") == 3;
        if (!hasDimension) return false;
      }
      if (section == MeditSection::Vertices &&
          (!hasDimension || !lookAt(points, point(), points_))) {
        return false;
      }
      if (isOtherCells([&](const VolumeCells& type) {
            return static_cast<std::uint32_t>(section) == type.meditCode;
          })) {
        return false;
      }
      if (section == MeditSection::Hexahedra && !lookAt(cells, cell(), cells_)) return false;
    }
    return 0 < points_ && points_ < cells_;
  }

  void beginPoints() override { source_.moveTo(points_); }
  void read(std::span<Vec3> to) override {
    source_.records(to.size(), point(), [&](BinaryRecord& record, std::size_t i) {
      for (double& x : to[i]) x = record.real("a coordinate of a vertex");
      static_cast<void>(integer(record));
    });
  }

  void beginCells() override { source_.moveTo(cells_); }
  void read(std::span<Hex64> to) override {
    source_.records(to.size(), cell(), [&](BinaryRecord& record, std::size_t i) {
      for (std::uint64_t& vertex : to[i]) vertex = vertexOfNumber(integer(record), points);
      static_cast<void>(integer(record));
    });
  }

 private:
  /// Integers have 64 bits from version 4 on.
  [[nodiscard]] RecordShape integers(std::size_t count, std::size_t reals) const {
    RecordShape shape{.reals = reals};
    (version_ >= 4 ? shape.sizes : shape.integers) = count;
    return shape;
  }
  [[nodiscard]] RecordShape point() const { return integers(1, 3); }
  [[nodiscard]] RecordShape cell() const { return integers(9, 0); }
  template <class Source>
  [[nodiscard]] std::uint64_t integer(Source& source) const {
    return version_ >= 4 ? source.size("an integer")
                         : static_cast<std::uint32_t>(source.integer("an integer"));
  }

  [[nodiscard]] bool lookAt(std::uint64_t& count, RecordShape shape, std::uint64_t& position) {
    count = integer(source_);
    if (position != 0 || count > source_.room(shape)) return false;
    position = source_.position();
    return true;
  }

  Context quiet_;
  Stage stage_;
  ByteFile bytes_;
  BinarySource source_;
  std::int64_t version_ = 0;
  std::uint64_t points_ = 0;  ///< position of the first one
  std::uint64_t cells_ = 0;
};

template <class Mesh>
std::unique_ptr<PlainMesh> openMedit(const InputFile& file, const std::string& name,
                                     Context& context) {
  auto mesh = std::make_unique<Mesh>(file, name, context);
  return mesh->look() ? std::move(mesh) : nullptr;
}

}  // namespace

void readMeditTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({openMedit<MeditTextPieces>, readMedit}, sink, input, context);
}

void readMeshbTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({openMedit<MeditBytePieces>, readMeshb}, sink, input, context);
}

}  // namespace hexhex::io
