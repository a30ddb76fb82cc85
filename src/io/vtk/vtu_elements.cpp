#include <algorithm>
#include <type_traits>

#include <hexhex/stream.hpp>

#include <io/vtk/vtu_elements.hpp>

namespace hexhex {
namespace {

/// Types and ends of the corners of consecutive cells.
class CellTable {
 public:
  CellTable(const VtuFile& file, const CellKind& kind, std::size_t corners, std::uint64_t first,
            std::size_t count)
      : file_(file),
        kind_(kind),
        corners_(corners),
        first_(first),
        types_(count),
        ends_(count + 1, 0) {
    file.copy(file.types(), first, count, types_.data());
    // The end of the cell before is the beginning of the first one.
    const std::size_t before = first > 0 ? 1 : 0;
    file.copy(file.ends(), first - before, count + before, ends_.data() + 1 - before);
  }

  [[nodiscard]] std::size_t size() const { return types_.size(); }
  [[nodiscard]] bool isWanted(std::size_t i) const { return types_[i] == kind_.vtkType; }
  [[nodiscard]] std::uint64_t begin(std::size_t i) const {
    return static_cast<std::uint64_t>(ends_[i]);
  }
  [[nodiscard]] std::uint64_t end(std::size_t i) const {
    return static_cast<std::uint64_t>(ends_[i + 1]);
  }
  [[nodiscard]] bool isGood(std::size_t i) const {
    return isOrdered(i) && (!isWanted(i) || end(i) - begin(i) == corners_);
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
               "cell " + cell + " is a " + std::string(kind_.singular) + " with " +
                   std::to_string(end(i) - begin(i)) + " instead of " + std::to_string(corners_) +
                   " corners.",
               place);
  }

 private:
  [[nodiscard]] bool isOrdered(std::size_t i) const {
    return end(i) >= begin(i) && end(i) <= file_.connectivity().count;
  }

  const VtuFile& file_;
  const CellKind& kind_;
  std::size_t corners_;
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

/// The usual case, which needs no conversion: all cells are wanted, and their corners are stored as
/// they are in memory.
/// @return false if it is not, or a corner is no point
template <std::size_t corners>
bool copyCells(const VtuFile& file, const CellTable& table, std::array<Index, corners>* cells) {
  const VtuColumn& column = file.connectivity();
  const bool narrow = column.scalar == VtuScalar::Int32 || column.scalar == VtuScalar::UInt32;
  const std::size_t count = table.size();
  if (!narrow || count == 0 || file.pointCount() > kNone) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!table.isWanted(i)) return false;
  }
  file.copy(column, table.begin(0), corners * count, cells->data());
  // A negative number is a large one here.
  const Index* const vertices = cells->data();
  Index largest = 0;
  for (std::size_t k = 0; k < corners * count; ++k) largest = std::max(largest, vertices[k]);
  return largest < file.pointCount();
}

}  // namespace

std::size_t countVtuCells(const VtuFile& file, const CellKind& kind, std::uint64_t first,
                          std::size_t count) {
  Array<std::int64_t> types(count);
  file.copy(file.types(), first, count, types.data());
  return static_cast<std::size_t>(std::count(types.begin(), types.end(), kind.vtkType));
}

template <class Vertex, std::size_t corners>
void readVtuCells(const VtuFile& file, std::uint64_t first, std::size_t count,
                  std::array<Vertex, corners>* cells, std::size_t* numbers) {
  const CellTable table(file, kCellKind<corners>, corners, first, count);
  std::size_t good = 0;
  while (good < count && table.isGood(good)) ++good;

  if constexpr (std::is_same_v<Vertex, Index>) {
    if (good == count && copyCells(file, table, cells)) {
      for (std::size_t k = 0; numbers != nullptr && k < count; ++k) numbers[k] = first + k;
      return;
    }
  }
  // Cells that follow each other have their corners one after the other, and are read at once.
  Array<std::int64_t> vertices;
  for (std::size_t i = 0; i < good;) {
    std::size_t end = i;
    while (end < good && table.isWanted(end)) ++end;
    vertices.resize(corners * (end - i));
    if (end > i) file.copy(file.connectivity(), table.begin(i), vertices.size(), vertices.data());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      requireVertex(file, first + i + k / corners, vertices[k]);
      cells[k / corners][k % corners] = static_cast<Vertex>(vertices[k]);
    }
    for (std::size_t k = i; numbers != nullptr && k < end; ++k) *numbers++ = first + k;
    cells += end - i;
    i = std::max(end, i + 1);
  }
  if (good < count) table.fail(good);
}

template void readVtuCells(const VtuFile&, std::uint64_t, std::size_t, Tet*, std::size_t*);
template void readVtuCells(const VtuFile&, std::uint64_t, std::size_t, Hex*, std::size_t*);
template void readVtuCells(const VtuFile&, std::uint64_t, std::size_t, Hex64*, std::size_t*);

void failWithoutCells(const VtuFile& file, const CellKind& kind) {
  file.fail(ErrorCode::FileUnsupported, "the file holds no " + std::string(kind.plural) +
                                            ": none of its " + std::to_string(file.cellCount()) +
                                            " cells has the type " + std::to_string(kind.vtkType) +
                                            ".");
}

}  // namespace hexhex
