#include <algorithm>

#include <hexhex/stream.hpp>

#include <io/vtu_elements.hpp>

namespace hexhex {
namespace {

constexpr std::uint64_t kCorners = 8;

/// Types and ends of the corners of consecutive cells.
class CellTable {
 public:
  CellTable(const VtuFile& file, std::uint64_t first, std::size_t count)
      : file_(file), first_(first), types_(count), ends_(count + 1, 0) {
    file.copy(file.types(), first, count, types_.data());
    // The end of the cell before is the beginning of the first one.
    const std::size_t before = first > 0 ? 1 : 0;
    file.copy(file.ends(), first - before, count + before, ends_.data() + 1 - before);
  }

  [[nodiscard]] bool isHexahedron(std::size_t i) const { return types_[i] == kVtuHexahedron; }
  [[nodiscard]] std::uint64_t begin(std::size_t i) const {
    return static_cast<std::uint64_t>(ends_[i]);
  }
  [[nodiscard]] std::uint64_t end(std::size_t i) const {
    return static_cast<std::uint64_t>(ends_[i + 1]);
  }
  [[nodiscard]] bool isGood(std::size_t i) const {
    return isOrdered(i) && (!isHexahedron(i) || end(i) - begin(i) == kCorners);
  }

  /// Throws what is wrong with a cell that is not good.
  [[noreturn]] void fail(std::size_t i) const {
    const std::string cell = std::to_string(first_ + i);
    const Place place{PlaceKind::Cell, first_ + i};
    if (!isOrdered(i)) {
      file_.fail(ErrorCode::FileSyntax,
                 "the corners of cell " + cell + " end at " + std::to_string(end(i)) +
                     ", which is before they begin or beyond the " +
                     std::to_string(file_.connectivity().count) + " corners in the file.",
                 place);
    }
    file_.fail(ErrorCode::FileSyntax,
               "cell " + cell + " is a hexahedron with " + std::to_string(end(i) - begin(i)) +
                   " instead of 8 corners.",
               place);
  }

 private:
  [[nodiscard]] bool isOrdered(std::size_t i) const {
    return end(i) >= begin(i) && end(i) <= file_.connectivity().count;
  }

  const VtuFile& file_;
  std::uint64_t first_;
  Array<std::int64_t> types_;
  Array<std::int64_t> ends_;
};

void requireVertex(const VtuFile& file, std::uint64_t cell, std::int64_t vertex) {
  if (vertex >= 0 && static_cast<std::uint64_t>(vertex) < file.pointCount()) return;
  file.fail(ErrorCode::IndexOutOfRange,
            "cell " + std::to_string(cell) + " names point " + std::to_string(vertex) +
                ", but the " + std::to_string(file.pointCount()) + " points are numbered from 0.",
            Place{PlaceKind::Cell, cell});
}

}  // namespace

std::size_t countVtuHexahedra(const VtuFile& file, std::uint64_t first, std::size_t count) {
  Array<std::int64_t> types(count);
  file.copy(file.types(), first, count, types.data());
  return static_cast<std::size_t>(std::count(types.begin(), types.end(), kVtuHexahedron));
}

template <class Vertex>
void readVtuHexahedra(const VtuFile& file, std::uint64_t first, std::size_t count,
                      std::array<Vertex, 8>* hexahedra) {
  const CellTable cells(file, first, count);
  std::size_t good = 0;
  while (good < count && cells.isGood(good)) ++good;

  // Hexahedra that follow each other have their corners one after the other, and are read at once.
  Array<std::int64_t> corners;
  for (std::size_t i = 0; i < good;) {
    std::size_t end = i;
    while (end < good && cells.isHexahedron(end)) ++end;
    corners.resize(kCorners * (end - i));
    file.copy(file.connectivity(), cells.begin(i), corners.size(), corners.data());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      requireVertex(file, first + i + k / kCorners, corners[k]);
      hexahedra[k / kCorners][k % kCorners] = static_cast<Vertex>(corners[k]);
    }
    hexahedra += end - i;
    i = std::max(end, i + 1);
  }
  if (good < count) cells.fail(good);
}

template void readVtuHexahedra(const VtuFile&, std::uint64_t, std::size_t, Hex*);
template void readVtuHexahedra(const VtuFile&, std::uint64_t, std::size_t, Hex64*);

void failWithoutHexahedra(const VtuFile& file) {
  file.fail(ErrorCode::FileUnsupported, "the file holds no hexahedra: none of its " +
                                            std::to_string(file.cellCount()) +
                                            " cells has the type 12.");
}

}  // namespace hexhex
