// Legacy `.vtk` files up to version 4 piece by piece.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_window.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_source.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kNumbers = 1 + 8;  // of a cell: how many corners it has, and these

constexpr std::size_t kVtkLegacyStreamGrain = 4096;

/// What stands where in a file with the sections POINTS, CELLS and CELL_TYPES, in this order, and
/// nothing but hexahedra. Arrays may follow.
class VtkSections : public PlainMesh {
 public:
  VtkSections(const InputFile& file, const std::string& name, Context& context, std::size_t window)
      : text_(file, name, context, window) {}

 protected:
  /// Reads everything up to the first section.
  [[nodiscard]] bool lookAtHead(std::string_view encoding) {
    const std::string magic = text_.takeLine();
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    // From version 5 on, cells are stored in another way.
    if (!magic.starts_with(kMagic) || magic.size() == kMagic.size() || magic[kMagic.size()] < '1' ||
        magic[kMagic.size()] > '4') {
      return false;
    }
    static_cast<void>(text_.takeLine());  // a title, which may be anything
    return lowerCase(text_.token()) == encoding && lowerCase(text_.token()) == "dataset" &&
           lowerCase(text_.token()) == "unstructured_grid";
  }
  /// "POINTS n double".
  [[nodiscard]] bool lookAtPoints() {
    if (lowerCase(text_.token()) != "points" || !takeCount(points)) return false;
    const std::string type = lowerCase(text_.token());
    isFloat_ = type == "float";
    return isFloat_ || type == "double";
  }
  /// "CELLS n 9n".
  [[nodiscard]] bool lookAtCells() {
    return lowerCase(text_.token()) == "cells" && takeCount(cells) &&
           text_.count() == kNumbers * cells;
  }
  /// "CELL_TYPES n".
  [[nodiscard]] bool lookAtTypes() {
    return lowerCase(text_.token()) == "cell_types" && text_.count() == cells;
  }

  TextWindow text_;
  std::uint64_t positionOfPoints_ = 0;
  std::uint64_t positionOfCells_ = 0;
  bool isFloat_ = false;

 private:
  [[nodiscard]] bool takeCount(std::uint64_t& to) {
    const std::optional<std::uint64_t> found = text_.count();
    to = found.value_or(0);
    return found.has_value();
  }
};

std::uint64_t vertexAt(std::int64_t number, std::uint64_t points) {
  const auto vertex = static_cast<std::uint64_t>(number);
  if (vertex < points) return vertex;
  throw Error(ErrorCode::IndexOutOfRange, "A cell names point " + std::to_string(number) + " of " +
                                              std::to_string(points) + ".");
}

void requireCorners(std::int64_t number) {
  if (number == 8) return;
  throw Error(ErrorCode::FileSyntax,
              "A hexahedron has " + std::to_string(number) + " corners instead of 8.");
}

class VtkTextPieces final : public VtkSections {
 public:
  VtkTextPieces(const InputFile& file, const std::string& name, Context& context)
      : VtkSections(file, name, context, TextWindow::kText) {}

  [[nodiscard]] bool look() {
    if (!lookAtHead("ascii") || !lookAtPoints()) return false;
    positionOfPoints_ = text_.position();
    if (!text_.skip(3 * points) || !lookAtCells()) return false;
    positionOfCells_ = text_.position();
    return text_.skip(kNumbers * cells) && lookAtTypes() && areHexahedra();
  }

  void beginPoints() override { text_.moveTo(positionOfPoints_); }
  void read(std::span<Vec3> to) override {
    text_.elements(to.size(), 3, [&](TextScanner& scanner, std::size_t i) {
      for (double& x : to[i]) x = scanner.number("a coordinate of a point");
    });
  }
  void beginCells() override { text_.moveTo(positionOfCells_); }
  void read(std::span<Hex64> to) override {
    text_.elements(to.size(), kNumbers, [&](TextScanner& scanner, std::size_t i) {
      requireCorners(scanner.integer("a number of corners"));
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexAt(scanner.integer("a corner of a cell"), points);
      }
    });
  }

 private:
  [[nodiscard]] bool areHexahedra() {
    std::atomic<bool> all{true};
    for (std::uint64_t first = 0; first < cells && all; first += kPieceElements) {
      text_.elements(std::min<std::uint64_t>(kPieceElements, cells - first), 1,
                     [&](TextScanner& scanner, std::size_t) {
                       if (scanner.integer("the type of a cell") != kCellKind<8>.vtkType)
                         all = false;
                     });
    }
    return all;
  }
};

class VtkBytePieces final : public VtkSections {
 public:
  VtkBytePieces(const InputFile& file, const std::string& name, Context& context)
      : VtkSections(file, name, context, TextWindow::kWords),
        file_(file),
        quiet_(context.threads()) {}

  [[nodiscard]] bool look() {
    if (!lookAtHead("binary") || !lookAtPoints()) return false;
    return skipBytes(3 * points, isFloat_ ? 4 : 8, positionOfPoints_) && lookAtCells() &&
           skipBytes(kNumbers * cells, 4, positionOfCells_) && lookAtTypes() && areHexahedra();
  }

  void beginPoints() override { next_ = positionOfPoints_; }
  void read(std::span<Vec3> to) override {
    if (isFloat_) return readPoints<float>(to);
    readPoints<double>(to);
  }
  void beginCells() override { next_ = positionOfCells_; }
  void read(std::span<Hex64> to) override {
    const char* const bytes = take(to.size() * kNumbers * 4);
    forEach(to.size(), [&](std::size_t i) {
      const char* place = bytes + i * kNumbers * 4;
      requireCorners(loadBig<std::int32_t>(place));
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexAt(loadBig<std::int32_t>(place += 4), points);
      }
    });
  }

 private:
  /// Numbers begin on the next line.
  [[nodiscard]] bool skipBytes(std::uint64_t numbers, std::uint64_t bytesEach,
                               std::uint64_t& position) {
    if (!text_.skipLineBreak()) return false;
    position = text_.position();
    if (numbers > (file_.size() - position) / bytesEach) return false;
    text_.moveTo(position + numbers * bytesEach);
    return true;
  }

  [[nodiscard]] bool areHexahedra() {
    if (!text_.skipLineBreak() || cells > (file_.size() - text_.position()) / 4) return false;
    next_ = text_.position();
    for (std::uint64_t first = 0; first < cells; first += kPieceElements) {
      const std::size_t count = std::min<std::uint64_t>(kPieceElements, cells - first);
      const char* const bytes = take(4 * count);
      for (std::size_t i = 0; i < count; ++i) {
        if (loadBig<std::int32_t>(bytes + 4 * i) != kCellKind<8>.vtkType) return false;
      }
    }
    return true;
  }

  template <class T>
  void readPoints(std::span<Vec3> to) {
    const char* const bytes = take(to.size() * 3 * sizeof(T));
    forEach(to.size(), [&](std::size_t i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[i][axis] = loadBig<T>(bytes + (3 * i + axis) * sizeof(T));
        if (!std::isfinite(to[i][axis])) {
          throw Error(ErrorCode::NotFinite, "A coordinate is not finite.");
        }
      }
    });
  }

  /// The next bytes.
  [[nodiscard]] const char* take(std::size_t size) {
    bytes_.resize(size);
    file_.readAt(next_, bytes_.data(), size);
    next_ += size;
    return bytes_.data();
  }

  template <class F>
  void forEach(std::size_t n, const F& f) {
    Stage stage(quiet_, "read");
    parallelFor(stage, n, kVtkLegacyStreamGrain, f);
  }

  const InputFile& file_;
  Context quiet_;
  std::uint64_t next_ = 0;  ///< position in the file
  Array<char> bytes_;
};

template <class Mesh>
std::unique_ptr<PlainMesh> openVtkAs(const InputFile& file, const std::string& name,
                                     Context& context) {
  auto mesh = std::make_unique<Mesh>(file, name, context);
  return mesh->look() ? std::move(mesh) : nullptr;
}

std::unique_ptr<PlainMesh> openVtkPieces(const InputFile& file, const std::string& name,
                                         Context& context) {
  std::unique_ptr<PlainMesh> bytes = openVtkAs<VtkBytePieces>(file, name, context);
  return bytes ? std::move(bytes) : openVtkAs<VtkTextPieces>(file, name, context);
}

}  // namespace

void readVtkLegacyTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({openVtkPieces, readVtkLegacy}, sink, input, context);
}

}  // namespace hexhex::io
