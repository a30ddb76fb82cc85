// Reads VTK data sets, independent of the file format: numbers of columns; points and cells,
// checked, a range at a time; meshes and maps; and the arrays that writers of this library add.
#include <algorithm>
#include <array>
#include <type_traits>

#include <hexhex/stream.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/bytes.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/input_file.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_source.hpp>

namespace hexhex::io {

namespace {

/// Reads a number from an address of any alignment.
template <class T, bool bigEndian>
T loadNumber(const char* place) {
  if constexpr (bigEndian && sizeof(T) > 1) {
    return loadBig<T>(place);
  } else {
    T number;
    std::memcpy(&number, place, sizeof(T));
    return number;
  }
}

/// Converts consecutive stored numbers to an array of T.
template <class T>
void convert(const VtkColumn& column, const char* from, std::size_t count, T* to) {
  const auto convertFrom = [&](auto zero) {
    const auto all = [&](auto bigEndian) {
      using Stored = decltype(zero);
      for (std::size_t i = 0; i < count; ++i) {
        // NOLINTNEXTLINE(bugprone-signed-char-misuse): 8-bit numbers keep their sign.
        to[i] = static_cast<T>(loadNumber<Stored, bigEndian>(from + i * sizeof(Stored)));
      }
    };
    if (column.bigEndian) return all(std::true_type{});
    all(std::false_type{});
  };
  std::visit(convertFrom, column.scalar);
}

/// Whether stored numbers have the bytes of T, so that they can be read in place. Copying them
/// would make reading a map from a `.vtu` file 25 % slower.
template <class T>
bool isStoredAs(const VtkColumn& column) {
  if (column.bigEndian) return false;
  if constexpr (std::is_same_v<T, Index>) {
    return isOf<std::int32_t>(column.scalar) || isOf<std::uint32_t>(column.scalar);
  } else {
    return isOf<T>(column.scalar);
  }
}

}  // namespace

std::size_t bytesOf(const VtkScalar& scalar) {
  return std::visit([](auto zero) { return sizeof(zero); }, scalar);
}

const VtkSourceArray* VtkSource::find(VtkSection section, std::string_view name,
                                      std::size_t components, VtkNumbers numbers,
                                      std::size_t begin) const {
  const auto first = arrays.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto found = std::find_if(first, arrays.end(), [&](const VtkSourceArray& array) {
    return array.section == section && array.name == name && array.components == components &&
           array.numbers == numbers;
  });
  return found == arrays.end() ? nullptr : &*found;
}

VtkColumn VtkSource::load(const VtkSourceArray& array) const {
  std::optional<std::uint64_t> count;
  if (array.section == VtkSection::PointData) count = array.components * points;
  if (array.section == VtkSection::CellData) count = array.components * cells;
  return array.load(array.numbers, count);
}

template <class T>
void VtkSource::copy(const VtkColumn& column, std::uint64_t begin, std::size_t count, T* to) const {
  if (column.compute) {
    for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<T>(column.compute(begin + i));
    return;
  }
  const std::size_t size = count * bytesOf(column.scalar);
  const std::uint64_t position = column.position + begin * bytesOf(column.scalar);
  if (!column.decoded.empty()) return convert(column, column.decoded.data() + position, count, to);
  if (!bytes_.isInMemory() && isStoredAs<T>(column)) {
    static_cast<void>(bytes_.view(position, size, reinterpret_cast<char*>(to)));
    return;
  }
  Array<char> room(bytes_.isInMemory() ? 0 : size);
  convert(column, bytes_.view(position, size, room.data()), count, to);
}

template void VtkSource::copy(const VtkColumn&, std::uint64_t, std::size_t, double*) const;
template void VtkSource::copy(const VtkColumn&, std::uint64_t, std::size_t, std::int64_t*) const;
template void VtkSource::copy(const VtkColumn&, std::uint64_t, std::size_t, Index*) const;
template void VtkSource::copy(const VtkColumn&, std::uint64_t, std::size_t, CornerSet*) const;

namespace {

/// A column of numbers that the file implies.
VtkColumn computedColumn(std::uint64_t count, std::function<double(std::uint64_t i)> compute) {
  VtkColumn column;
  column.count = count;
  column.compute = std::move(compute);
  return column;
}

}  // namespace

void VtkSource::makeGrid(
    const GridIndex& size, std::uint64_t dataSize,
    const std::function<double(std::size_t axis, const GridIndex& point)>& place) {
  // A few lines may describe a grid of any size. Larger ones have at least a byte for each point.
  constexpr std::uint64_t kMostWithoutData = std::uint64_t{1} << 22;
  const std::uint64_t most = std::min(std::uint64_t{kNone}, kMostWithoutData + dataSize);
  points = cells = 1;
  for (const std::uint64_t n : size) {
    const std::string sizes =
        concat("a grid of ", size[0], " x ", size[1], " x ", size[2], " points");
    if (n < 2) {
      fail(ErrorCode::FileUnsupported, sizes, " has a single layer, so it has no hexahedra.");
    }
    if (n > most / points) {
      fail(ErrorCode::TooLarge, sizes, " is larger than the data of this file: at most ", most,
           " are read. If it is right, save it as an unstructured grid.");
    }
    points *= n;
    cells *= n - 1;
  }
  types = computedColumn(cells, [](std::uint64_t) { return double{kVtkHexahedron}; });
  stride = 8;
  connectivity = computedColumn(stride * cells, [size](std::uint64_t i) {
    const std::uint64_t cell = i / 8;
    const std::uint64_t corner = i % 8;
    const std::uint64_t row = cell / (size[0] - 1);
    const std::uint64_t x = cell % (size[0] - 1) + ((corner + 1) / 2 % 2);
    const std::uint64_t y = row % (size[1] - 1) + (corner / 2 % 2);
    const std::uint64_t z = row / (size[1] - 1) + corner / 4;
    return static_cast<double>(x + size[0] * (y + size[1] * z));
  });
  if (!place) return;
  coordinates = computedColumn(3 * points, [size, place](std::uint64_t i) {
    const std::uint64_t point = i / 3;
    const std::uint64_t row = point / size[0];
    return place(i % 3, {point % size[0], row % size[1], row / size[1]});
  });
}

void VtkSource::makePolygons() {
  isSurface = true;
  types = computedColumn(cells, [](std::uint64_t) { return double{kVtkPolygon}; });
}

void VtkSource::see(std::string_view name, bool ofCells, std::size_t components) {
  constexpr std::size_t kMostSeen = 20;  // listed in an error message
  if (seen.size() == kMostSeen) {
    ++unnamed;
    return;
  }
  seen.push_back(concat('"', name, (ofCells ? "\" (cells, " : "\" (points, "), components,
                        (components == 1 ? " component)" : " components)")));
}

VtkColumn textColumn(VtkNumbers numbers, std::size_t count) {
  VtkColumn column;
  column.scalar = numbers == VtkNumbers::Reals ? VtkScalar(double{}) : VtkScalar(std::int64_t{});
  column.count = count;
  column.decoded.resize(memorySize(std::uint64_t{count} * sizeof(double)));
  return column;
}

namespace {

// Points and cells, a range at a time; meshes and maps.

// Points or cells per task of a thread: a fraction of a millisecond of work.
constexpr std::size_t kVtkReaderGrain = std::size_t{1} << 13;

/// Calls f(begin, end, block) for all blocks of n elements, in parallel. Of several errors, that of
/// the first block is thrown.
void forEachBlock(Stage& stage, std::size_t n, BlockFunction f) {
  const std::size_t begin = firstUnreadable(
      stage, n, kVtkReaderGrain, [&](std::size_t first, std::size_t end, std::size_t& i) {
        f(first, end, first / kVtkReaderGrain);
        i = end;
      });
  if (begin < n)
    f(begin, std::min(begin + kVtkReaderGrain, n), begin / kVtkReaderGrain);  // throws again
}

/// Voxels are hexahedra that list the corners of both layers row by row instead of around.
constexpr std::int64_t kVtkVoxel = 11;
bool isOfKind(std::int64_t type, const CellKind& kind) {
  return type == kind.vtkType || (type == kVtkVoxel && kind.vtkType == kCellKind<8>.vtkType);
}

/// Types of consecutive cells, and the positions of their corners.
class CellTable {
 public:
  CellTable(const VtkSource& source, const CellKind& wanted, std::uint64_t first, std::size_t count)
      : source_(source),
        wanted_(wanted),
        first_(first),
        types_(count),
        places_(vtkCellPlaces(source, first, count)) {
    source.copy(source.types, first, count, types_.data());
  }

  [[nodiscard]] bool isWanted(std::size_t i) const { return isOfKind(types_[i], wanted_); }
  [[nodiscard]] bool isVoxel(std::size_t i) const { return types_[i] == kVtkVoxel; }
  [[nodiscard]] std::uint64_t begin(std::size_t i) const {
    return static_cast<std::uint64_t>(places_[i]) + source_.gap;
  }
  [[nodiscard]] std::uint64_t end(std::size_t i) const {
    return static_cast<std::uint64_t>(places_[i + 1]);
  }
  [[nodiscard]] bool isGood(std::size_t i) const {
    return isOrdered(i) && (!isWanted(i) || end(i) - begin(i) == wanted_.corners);
  }

  /// Throws an error about an invalid cell.
  [[noreturn]] void fail(std::size_t i) const {
    const std::string cell = std::to_string(first_ + i);
    const Place place{PlaceKind::Cell, first_ + i};
    if (!isOrdered(i)) {
      source_.fail(ErrorCode::FileSyntax, place, "the corners of cell ", cell, " end at ", end(i),
                   ", which is before they begin or beyond the ", source_.connectivity.count,
                   " corners in the file.");
    }
    source_.fail(ErrorCode::FileSyntax, place, "cell ", cell, " is a ", wanted_.singular, " with ",
                 end(i) - begin(i), " instead of ", wanted_.corners, " corners.");
  }

 private:
  [[nodiscard]] bool isOrdered(std::size_t i) const {
    return end(i) >= begin(i) && end(i) <= source_.connectivity.count;
  }

  const VtkSource& source_;
  const CellKind& wanted_;
  std::uint64_t first_;
  Array<std::int64_t> types_;
  Array<std::int64_t> places_;
};

/// Fast path for 32-bit numbers, which are copied as they are. Without it, reading a whole `.vtu`
/// file takes 40 % longer.
/// @return false if they have 64 bits, or one is out of range
bool copyVertices(const VtkSource& source, std::size_t corners, std::uint64_t begin,
                  std::span<Index> vertices) {
  const VtkScalar scalar = source.connectivity.scalar;
  const bool narrow = isOf<std::int32_t>(scalar) || isOf<std::uint32_t>(scalar);
  if (!narrow || source.points > kNone) return false;
  if (source.gap == 0) {
    source.copy(source.connectivity, begin, vertices.size(), vertices.data());
  } else {
    constexpr std::size_t kCellsAtOnce = 512;  // whose numbers stay in the cache
    const std::size_t each = corners + source.gap;
    Array<Index> numbers(each * kCellsAtOnce);
    Index* to = vertices.data();
    for (std::size_t left = vertices.size() / corners; left > 0;) {
      const std::size_t cells = std::min(kCellsAtOnce, left);
      source.copy(source.connectivity, begin, each * cells - source.gap, numbers.data());
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const Index* const from = numbers.data() + each * cell;
        for (std::size_t k = 0; k < corners; ++k) *to++ = from[k];
      }
      begin += each * cells;
      left -= cells;
    }
  }
  // Negative numbers wrap to large ones.
  const Index* const numbers = vertices.data();
  Index largest = 0;
  for (std::size_t k = 0; k < vertices.size(); ++k) largest = std::max(largest, numbers[k]);
  return largest < source.points;
}

/// Reads consecutive wanted cells.
/// @param first  the number of the first
/// @param begin  where its corners begin
template <class Vertex>
void readRun(const VtkSource& source, std::size_t corners, std::uint64_t first, std::uint64_t begin,
             std::span<Vertex> vertices) {
  if constexpr (std::is_same_v<Vertex, Index>) {
    if (copyVertices(source, corners, begin, vertices)) return;
  }
  const std::size_t cells = vertices.size() / corners;
  const std::size_t each = corners + source.gap;
  Array<std::int64_t> numbers(each * cells - source.gap);
  source.copy(source.connectivity, begin, numbers.size(), numbers.data());
  Vertex* to = vertices.data();
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::int64_t* const from = numbers.data() + each * cell;
    for (std::size_t k = 0; k < corners; ++k) {
      // Negative numbers wrap to large ones.
      if (static_cast<std::uint64_t>(from[k]) >= source.points) {
        source.fail(ErrorCode::IndexOutOfRange, Place{PlaceKind::Cell, first + cell}, "cell ",
                    first + cell, " names point ", from[k], ", but the ", source.points,
                    " points are numbered from 0.");
      }
      *to++ = static_cast<Vertex>(from[k]);
    }
  }
}

/// @param cells, points  of the mesh
template <class Points, class Cells>
void readMesh(const VtkSource& source, Points& points, Cells& cells, Array<std::size_t>* numbers,
              Stage& stage) {
  source.requireIndexable();
  points.resize(source.points);
  readVtkPoints(source, points, stage);
  constexpr std::size_t kCorners = std::tuple_size_v<typename Cells::value_type>;
  const auto makeRoom = [&cells](std::size_t count) {
    cells.resize(count);
    return count == 0 ? nullptr : cells.front().data();
  };
  readVtkCells(source, kCellKind<kCorners>, makeRoom, numbers, stage);
}

// Components of the two forms of a map.
constexpr std::size_t kCellMapComponents = 12;
constexpr std::size_t kPointMapComponents = 3;

/// Finds the map among the known arrays, or reads on for more.
const VtkSourceArray* findMap(VtkSource& source, std::string_view name) {
  std::size_t looked = 0;  // number of arrays already searched
  do {
    if (const auto* const found = source.find(VtkSection::CellData, name, kCellMapComponents,
                                              VtkNumbers::Reals, looked)) {
      return found;
    }
    if (const auto* const found = source.find(VtkSection::PointData, name, kPointMapComponents,
                                              VtkNumbers::Reals, looked)) {
      return found;
    }
    looked = source.arrays.size();
  } while (source.readOn());
  return nullptr;
}

/// Lists the arrays, for messages.
std::string arraysIn(const VtkSource& source) {
  std::string found;
  for (const std::string& array : source.seen) found += (found.empty() ? "" : ", ") + array;
  if (source.unnamed > 0) found += concat(", and ", source.unnamed, " more");
  return found.empty() ? "none" : found;
}

[[noreturn]] void failWithoutMap(const VtkSource& source, std::size_t tets, std::string_view name) {
  source.fail(
      ErrorCode::FileUnsupported, "the file holds ", tets, " tets, but no map: no cell array \"",
      name,
      "\" of 12 floating-point numbers (u v w of each corner), and no point array of "
      "this name with 3, for a map with one chart. Arrays in the file: ",
      arraysIn(source),
      ". Name the map's array (--map-array), give it as a second mesh (--tets, --polycube), "
      "or make hexahedra without a map: `hexhex mesh`.");
}

/// Reads the parameters of tets from a cell array.
/// @param numbers  of the tets among the cells of the file
void readCellParameters(const VtkSource& source, const VtkColumn& column,
                        std::span<const std::size_t> numbers,
                        std::vector<TetParameters>& parameters, Stage& stage) {
  forEachBlock(stage, source.cells, [&](std::size_t begin, std::size_t end, std::size_t) {
    auto tet = std::lower_bound(numbers.begin(), numbers.end(), begin);
    if (tet == numbers.end() || *tet >= end) return;
    Array<double> values(kCellMapComponents * (end - begin));
    source.copy(column, kCellMapComponents * begin, values.size(), values.data());
    for (; tet != numbers.end() && *tet < end; ++tet) {
      std::copy_n(values.data() + kCellMapComponents * (*tet - begin), kCellMapComponents,
                  parameters[static_cast<std::size_t>(tet - numbers.begin())][0].data());
    }
  });
}

/// Reads the parameters of tets from a point array.
void readPointParameters(const VtkSource& source, const VtkColumn& column, TetMap& map,
                         Stage& stage) {
  Array<Vec3> values(source.points);
  forEachBlock(stage, values.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    source.copy(column, kPointMapComponents * begin, kPointMapComponents * (end - begin),
                values[begin].data());
  });
  parallelFor(stage, map.tets.size(), kVtkReaderGrain, [&](std::size_t t) {
    for (std::size_t i = 0; i < map.tets[t].size(); ++i) {
      map.parameters[t][i] = values[map.tets[t][i]];
    }
  });
}

}  // namespace

void readVtkPoints(const VtkSource& source, std::uint64_t first, std::span<Vec3> points) {
  if (points.empty()) return;
  source.copy(source.coordinates, 3 * first, 3 * points.size(), points.front().data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (isFinite(points[i])) continue;
    source.fail(ErrorCode::NotFinite, Place{PlaceKind::Vertex, first + i}, "a coordinate of point ",
                first + i, " is not finite.");
  }
}

void readVtkPoints(const VtkSource& source, std::span<Vec3> points, Stage& stage) {
  forEachBlock(stage, points.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    readVtkPoints(source, begin, points.subspan(begin, end - begin));
  });
}

std::size_t countVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t first,
                          std::size_t count) {
  Array<std::int64_t> types(count);
  source.copy(source.types, first, count, types.data());
  return static_cast<std::size_t>(std::count_if(
      types.begin(), types.end(), [&cells](std::int64_t type) { return isOfKind(type, cells); }));
}

template <class Vertex>
void readVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t first,
                  std::size_t count, Vertex* vertices, std::size_t* numbers) {
  const CellTable table(source, cells, first, count);
  std::size_t good = 0;
  while (good < count && table.isGood(good)) ++good;
  // The corners of consecutive cells are contiguous and read at once.
  for (std::size_t i = 0; i < good;) {
    std::size_t end = i;
    while (end < good && table.isWanted(end)) ++end;
    const std::size_t size = cells.corners * (end - i);
    if (end > i)
      readRun(source, cells.corners, first + i, table.begin(i), std::span(vertices, size));
    for (std::size_t k = i; k < end; ++k, vertices += cells.corners) {
      if (!table.isVoxel(k)) continue;
      std::swap(vertices[2], vertices[3]);
      std::swap(vertices[6], vertices[7]);
    }
    for (std::size_t k = i; numbers != nullptr && k < end; ++k) *numbers++ = first + k;
    i = std::max(end, i + 1);
  }
  if (good < count) table.fail(good);
}

template void readVtkCells(const VtkSource&, const CellKind&, std::uint64_t, std::size_t, Index*,
                           std::size_t*);
template void readVtkCells(const VtkSource&, const CellKind&, std::uint64_t, std::size_t,
                           std::uint64_t*, std::size_t*);

void readVtkCells(const VtkSource& source, const CellKind& cells,
                  const std::function<Index*(std::size_t)>& makeRoom, Array<std::size_t>* numbers,
                  Stage& stage, bool areOthers) {
  const std::size_t all = source.cells;
  std::vector<std::size_t> begins(blockCount(all, kVtkReaderGrain) + 1, 0);
  forEachBlock(stage, all, [&](std::size_t begin, std::size_t end, std::size_t block) {
    begins[block] = countVtkCells(source, cells, begin, end - begin);
  });
  const std::size_t count = exclusiveScan(std::span(begins));
  if (!areOthers) noteVtkCells(source, cells, count);
  const bool needed = all > 0 || source.isSurface;
  if (!areOthers && needed && count == 0) failWithoutVtkCells(source, cells);
  Index* const vertices = makeRoom(count);
  if (numbers != nullptr) numbers->resize(count);
  forEachBlock(stage, all, [&](std::size_t begin, std::size_t end, std::size_t block) {
    readVtkCells(source, cells, begin, end - begin, vertices + cells.corners * begins[block],
                 numbers != nullptr ? numbers->data() + begins[block] : nullptr);
  });
}

void noteVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t count) {
  if (count == source.cells) return source.counts->addVtk(cells.vtkType, count);
  Array<std::int64_t> types;
  for (std::uint64_t first = 0; first < source.cells; first += kVtkReaderGrain) {
    types.resize(std::min<std::uint64_t>(kVtkReaderGrain, source.cells - first));
    source.copy(source.types, first, types.size(), types.data());
    // Cells of one type are mostly consecutive.
    for (std::size_t i = 0; i < types.size();) {
      std::size_t end = i + 1;
      while (end < types.size() && types[end] == types[i]) ++end;
      source.counts->addVtk(isOfKind(types[i], cells) ? cells.vtkType : types[i], end - i);
      i = end;
    }
  }
}

Array<std::int64_t> vtkCellPlaces(const VtkSource& source, std::uint64_t first, std::size_t count) {
  Array<std::int64_t> places(count + 1, 0);
  if (source.stride > 0) {
    for (std::size_t i = 0; i <= count; ++i) {
      places[i] = static_cast<std::int64_t>(source.stride * (first + i));
    }
  } else if (source.offsets.count > source.cells) {
    source.copy(source.offsets, first, count + 1, places.data());
  } else {
    // A cell begins where the previous one ends.
    const std::size_t before = first > 0 ? 1 : 0;
    source.copy(source.offsets, first - before, count + before, places.data() + 1 - before);
  }
  return places;
}

void failWithoutVtkCells(const VtkSource& source, const CellKind& cells) {
  source.fail(ErrorCode::FileUnsupported, "the file holds no ", cells.plural, ": none of its ",
              source.cells, " cells has the type ", cells.vtkType, source.counts->instead(), ".",
              (cells.corners == 8 ? source.counts->adviceOnCurved() : ""),
              (source.isSurface ? " It is a surface: `hexhex mesh` fills it with tets." : ""));
}

Array<std::size_t> firstsAtSamePosition(std::span<const double> coordinates,
                                        const std::vector<std::size_t>& firstPoints,
                                        std::size_t* ambiguous) {
  using Key = std::array<std::uint64_t, 3>;
  const auto pieceOf = [&firstPoints](std::size_t point) {
    return std::upper_bound(firstPoints.begin(), firstPoints.end(), point);
  };
  std::vector<std::pair<Key, std::size_t>> places(coordinates.size() / 3);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      places[i].first[k] = std::bit_cast<std::uint64_t>(coordinates[3 * i + k] + 0.0);  // no -0
    }
    places[i].second = i;
  }
  std::sort(places.begin(), places.end());
  Array<std::size_t> firsts(places.size());
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    while (end < places.size() && places[end].first == places[begin].first) ++end;
    std::size_t pieces = 1;
    for (std::size_t i = begin + 1; i < end; ++i) {
      if (pieceOf(places[i - 1].second) != pieceOf(places[i].second)) ++pieces;
    }
    const bool unique = pieces == end - begin;
    if (!unique && pieces > 1 && ambiguous != nullptr) *ambiguous = places[begin].second;
    for (std::size_t i = begin; i < end; ++i) {
      firsts[places[i].second] = places[unique ? begin : i].second;
    }
  }
  return firsts;
}

TetCells readVtkTets(VtkSource& source, Stage& stage) {
  TetCells mesh;
  Array<std::size_t> numbers;
  readMesh(source, mesh.points, mesh.cells, &numbers, stage);
  while (source.readOn()) {
  }
  mesh.regions = readVtkRegions(source, numbers);
  mesh.features = readVtkTetFeatures(source);
  return mesh;
}

TetMap readVtkMap(VtkSource& source, std::string_view mapArray, Stage& stage) {
  TetMap map;
  Array<std::size_t> numbers;
  readMesh(source, map.points, map.tets, &numbers, stage);
  const Array<std::int32_t> regions = readVtkRegions(source, numbers);
  map.regions.assign(regions.begin(), regions.end());
  const VtkSourceArray* const array = findMap(source, mapArray);
  if (array == nullptr) failWithoutMap(source, map.tets.size(), mapArray);
  const VtkColumn column = source.load(*array);
  map.parameters.resize(map.tets.size());
  if (array->section == VtkSection::CellData) {
    readCellParameters(source, column, numbers, map.parameters, stage);
  } else {
    readPointParameters(source, column, map, stage);
  }
  const std::size_t fault = firstFault(stage, map.tets.size(),
                                       [&](std::size_t t) { return isFinite(map.parameters[t]); });
  if (fault < map.tets.size()) {
    source.fail(ErrorCode::NotFinite, Place{PlaceKind::Tet, fault}, "a parameter of tet ", fault,
                " is not finite.");
  }
  map.features = readVtkTetFeatures(source);
  return map;
}

TriangleMesh readVtkSurface(const VtkSource& source, Stage& stage) {
  if (!source.isSurface) {
    source.fail(ErrorCode::FileUnsupported, "the data set is no surface, which is POLYDATA.");
  }
  source.requireIndexable();
  TriangleMesh mesh;
  mesh.points.resize(source.points);
  readVtkPoints(source, mesh.points, stage);
  constexpr CellKind kPolygonKind = {.singular = "polygon", .plural = "polygons"};
  const CellTable table(source, kPolygonKind, 0, source.cells);
  std::vector<Index> corners;
  for (std::size_t i = 0; i < source.cells; ++i) {
    if (!table.isGood(i)) table.fail(i);
    corners.resize(table.end(i) - table.begin(i));
    if (corners.empty()) continue;
    readRun(source, corners.size(), i, table.begin(i), std::span(corners));
    addPolygon(mesh, corners);
  }
  return mesh;
}

TriangleLabels readVtkLabels(VtkSource& source, std::string_view name, Stage& stage) {
  source.requireIndexable();
  TriangleLabels labels;
  Array<std::size_t> numbers;
  const auto makeRoom = [&labels](std::size_t count) {
    labels.triangles.resize(count);
    return count == 0 ? nullptr : labels.triangles.front().data();
  };
  readVtkCells(source, kTriangleKind, makeRoom, &numbers, stage);
  const VtkSourceArray* array = nullptr;
  do {
    array = source.find(VtkSection::CellData, name, 1, VtkNumbers::Integers);
  } while (array == nullptr && source.readOn());
  if (array == nullptr) {
    source.fail(ErrorCode::FileUnsupported, "no cell array \"", name,
                "\" of whole numbers, which are to be the labels of ", numbers.size(),
                " triangles. Arrays in the file: ", arraysIn(source), ".");
  }
  const VtkColumn column = source.load(*array);
  for (const std::size_t number : numbers) {
    source.copy(column, number, 1, &labels.labels.emplace_back());
  }
  return labels;
}

namespace {

// Arrays that writers of this library add to a mesh: generators, tags and regions.

/// The array of this name, if it has the form in which this library writes it.
std::optional<VtkColumn> findGenerators(const VtkSource& source, std::string_view name,
                                        VtkScalar scalar) {
  const VtkSourceArray* const array =
      source.find(VtkSection::PointData, name, 1, VtkNumbers::Integers);
  if (array == nullptr || !array->appended || source.points == 0) return std::nullopt;
  VtkColumn column = array->load(VtkNumbers::Integers, std::nullopt);
  // HDF5 returns all integers with 64 bits.
  const bool fits = column.scalar == scalar || isOf<std::int64_t>(column.scalar);
  if (!fits || column.count != source.points) return std::nullopt;
  return column;
}

/// Calls f(i, number) for all numbers of an array; throws unless they fit in 32 bits.
template <class F>
void forEachNumber(const VtkSource& source, const VtkSourceArray& array, const F& f) {
  constexpr std::size_t kNumbersAtOnce = std::size_t{1} << 16;  // half a megabyte at a time
  const VtkColumn column = source.load(array);
  Array<std::int64_t> numbers;
  for (std::uint64_t begin = 0; begin < column.count; begin += kNumbersAtOnce) {
    numbers.resize(std::min<std::uint64_t>(kNumbersAtOnce, column.count - begin));
    source.copy(column, begin, numbers.size(), numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!std::in_range<std::int32_t>(numbers[i])) {
        source.fail(
            ErrorCode::FileUnsupported,
            Place{array.section == VtkSection::CellData ? PlaceKind::Cell : PlaceKind::Vertex,
                  begin + i},
            "the array \"", array.name, "\" has the value ", numbers[i],
            ", which does not fit into 32 bits.");
      }
      f(static_cast<std::size_t>(begin) + i, static_cast<std::int32_t>(numbers[i]));
    }
  }
}

std::vector<FeatureVertex> readVertexTags(const VtkSource& source) {
  std::vector<FeatureVertex> features;
  const VtkSourceArray* const array =
      source.find(VtkSection::PointData, kVtkVertexTags, 1, VtkNumbers::Integers);
  if (array == nullptr) return features;
  forEachNumber(source, *array, [&](std::size_t vertex, std::int32_t tag) {
    if (tag != 0) features.push_back({static_cast<Index>(vertex), tag});
  });
  return features;
}

/// Reads rows of vertices and a tag.
/// @tparam Feature  FeatureEdge, FeatureFace or FeatureQuad
template <class Feature>
std::vector<Feature> readRows(const VtkSource& source, std::string_view name) {
  constexpr std::size_t kVertices = decltype(Feature::vertices){}.size();
  std::vector<Feature> features;
  const VtkSourceArray* const array =
      source.find(VtkSection::FieldData, name, kVertices + 1, VtkNumbers::Integers);
  if (array == nullptr) return features;
  const VtkColumn column = source.load(*array);
  if (column.count % array->components != 0) {
    source.fail(ErrorCode::FileSyntax, "the array \"", array->name, "\" has ", column.count,
                " numbers, which are no rows of ", array->components, ".");
  }
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(column.count));
  source.copy(column, 0, numbers.size(), numbers.data());
  features.resize(numbers.size() / array->components);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::int64_t* const row = numbers.data() + array->components * i;
    bool good = std::in_range<std::int32_t>(row[kVertices]);
    for (std::size_t k = 0; k < kVertices; ++k) {
      good = good && row[k] >= 0 && static_cast<std::uint64_t>(row[k]) < source.points;
      features[i].vertices[k] = static_cast<Index>(row[k]);
    }
    features[i].tag = static_cast<std::int32_t>(row[kVertices]);
    if (good) continue;
    source.fail(ErrorCode::IndexOutOfRange, "row ", i, " of the array \"", array->name,
                "\" (counted from 0) names a point that does not exist, or a tag that does "
                "not fit into 32 bits. If a program has changed the points since, remove the "
                "array.");
  }
  return features;
}

/// Reads the names of tags.
std::vector<TagName> readNames(const VtkSource& source) {
  const VtkSourceArray* texts =
      source.find(VtkSection::FieldData, kVtkTagNames, 1, VtkNumbers::Integers);
  if (texts == nullptr) {  // VTK's strings
    texts = source.find(VtkSection::FieldData, kVtkTagNames, 1, VtkNumbers::Others);
  }
  const VtkSourceArray* const tags =
      source.find(VtkSection::FieldData, kVtkNamedTags, 2, VtkNumbers::Integers);
  std::vector<TagName> names;
  if (texts == nullptr || tags == nullptr) return names;
  const auto numbersOf = [&source](const VtkSourceArray& array) {
    const VtkColumn column = source.load(array);
    std::vector<std::int64_t> numbers(static_cast<std::size_t>(column.count));
    source.copy(column, 0, numbers.size(), numbers.data());
    return numbers;
  };
  const std::vector<std::int64_t> numbers = numbersOf(*tags);
  std::string name;
  for (const std::int64_t character : numbersOf(*texts)) {
    if (2 * names.size() > numbers.size()) break;  // more names than tags
    if (character != 0) {
      name += static_cast<char>(character);
    } else {
      names.push_back({0, 0, std::exchange(name, {})});
    }
  }
  bool isGood = name.empty() && numbers.size() == 2 * names.size();
  for (std::size_t i = 0; isGood && i < names.size(); ++i) {
    isGood = numbers[2 * i] >= 0 && numbers[2 * i] <= 3 &&
             std::in_range<std::int32_t>(numbers[2 * i + 1]);
    names[i].dimension = static_cast<int>(numbers[2 * i]);
    names[i].tag = static_cast<std::int32_t>(numbers[2 * i + 1]);
  }
  if (isGood) return names;
  source.fail(ErrorCode::FileSyntax, "the arrays \"", texts->name, "\" and \"", tags->name,
              "\" do not fit each other: for each name, which ends with a zero, a dimension "
              "from 0 to 3 and a tag. Write the file anew, or remove both.");
}

/// The array of regions: of this library, of meshio (for files converted from other formats), of
/// Gmsh, or of MFEM.
const VtkSourceArray* findRegions(const VtkSource& source) {
  for (const std::string_view name :
       {kVtkRegions, std::string_view("gmsh:physical"), std::string_view("medit:ref"),
        std::string_view("CellEntityIds"), std::string_view("material")}) {
    const VtkSourceArray* const array =
        source.find(VtkSection::CellData, name, 1, VtkNumbers::Integers);
    if (array != nullptr) return array;
  }
  return nullptr;
}

/// Adds cells of a kind, tagged by the array of regions.
/// @tparam Feature  FeatureEdge or FeatureFace
template <class Feature>
void addTaggedCells(const VtkSource& source, const CellKind& kind, std::vector<Feature>& features) {
  const VtkSourceArray* const array = findRegions(source);
  if (array == nullptr) return;
  constexpr std::size_t kVertices = decltype(Feature::vertices){}.size();
  for (std::uint64_t first = 0; first < source.cells; first += kVtkReaderGrain) {
    const std::size_t count = std::min<std::uint64_t>(kVtkReaderGrain, source.cells - first);
    const std::size_t wanted = countVtkCells(source, kind, first, count);
    if (wanted == 0) continue;
    std::vector<Index> vertices(kVertices * wanted);
    std::vector<std::size_t> numbers(wanted);
    readVtkCells(source, kind, first, count, vertices.data(), numbers.data());
    const VtkColumn column = source.load(*array);
    for (std::size_t i = 0; i < wanted; ++i) {
      std::int64_t tag = 0;
      source.copy(column, numbers[i], 1, &tag);
      if (tag == 0 || !std::in_range<std::int32_t>(tag)) continue;
      Feature& feature = features.emplace_back();
      std::copy_n(vertices.data() + kVertices * i, kVertices, feature.vertices.begin());
      feature.tag = static_cast<std::int32_t>(tag);
    }
  }
}

constexpr CellKind kLineKind = {
    .corners = 2, .singular = "line", .plural = "lines", .vtkType = kVtkLine};
constexpr CellKind kQuadKind = {.corners = 4, .singular = "quad", .plural = "quads", .vtkType = 9};

/// Turns prisms round if most of their volume is negative: VTK's documentation was once taken to
/// say so, as by meshio and MFEM, though VTK itself wants them positive.
void turnPrisms(std::span<const Vec3> points, Array<Index>& vertices) {
  double volume = 0;
  for (std::size_t i = 0; i < vertices.size(); i += 6) {
    const Vec3& origin = points[vertices[i]];
    const auto to = [&](std::size_t k) { return minus(points[vertices[i + k]], origin); };
    volume += dot(cross(to(1), to(2)), plus(to(3), plus(to(4), to(5))));
  }
  for (std::size_t i = 0; volume < 0 && i < vertices.size(); i += 3) {
    std::swap(vertices[i + 1], vertices[i + 2]);
  }
}

/// Reads straight cells that are no hexahedra, and tagged triangles.
void readOthers(const VtkSource& source, std::span<const Vec3> points, OtherCells& others,
                Stage& stage) {
  for (OtherCellList& kind : others.kinds) {
    const VolumeCells& type = typeWith(kind.corners);
    const std::string one = singular(type.plural);
    const CellKind wanted = {kind.corners, one, type.plural, type.vtkType};
    Array<std::size_t> numbers;
    const auto makeRoom = [&kind](std::size_t count) {
      kind.vertices.resize(kind.corners * count);
      return kind.vertices.data();
    };
    readVtkCells(source, wanted, makeRoom, &numbers, stage, true);
    if (hasVtkRegions(source)) kind.regions = readVtkRegions(source, numbers);
  }
  turnPrisms(points, others.kinds[2].vertices);
  others.triangles = readRows<FeatureFace>(source, kVtkTriangleTags);
  addTaggedCells(source, kTriangleKind, others.triangles);
}

}  // namespace

VtkGenerators findVtkGenerators(const VtkSource& source) {
  return {findGenerators(source, kVtkGeneratorTets, std::uint32_t{}),
          findGenerators(source, kVtkGeneratorCorners, std::uint8_t{})};
}

void readVtkGenerators(const VtkSource& source, Array<Index>& tets, Array<CornerSet>& corners) {
  const VtkGenerators generators = findVtkGenerators(source);
  if (!generators.tets || !generators.corners) return;
  corners.resize(source.points);
  source.copy(*generators.corners, 0, corners.size(), corners.data());
  const auto isSimplex = [](CornerSet set) { return set >= 1 && set <= 15; };
  if (!std::all_of(corners.begin(), corners.end(), isSimplex)) {
    corners.clear();  // arrays of the same names with other content
    return;
  }
  tets.resize(source.points);
  source.copy(*generators.tets, 0, tets.size(), tets.data());
}

HexFeatures readVtkHexFeatures(const VtkSource& source) {
  return {readVertexTags(source), readRows<FeatureEdge>(source, kVtkEdgeTags),
          readRows<FeatureQuad>(source, kVtkQuadTags), readNames(source)};
}

Features readVtkTetFeatures(const VtkSource& source) {
  Features features = {readVertexTags(source), readRows<FeatureEdge>(source, kVtkEdgeTags),
                       readRows<FeatureFace>(source, kVtkTriangleTags), readNames(source)};
  addTaggedCells(source, kLineKind, features.edges);
  addTaggedCells(source, kTriangleKind, features.faces);
  return features;
}

bool hasVtkRegions(const VtkSource& source) { return findRegions(source) != nullptr; }

Array<std::int32_t> readVtkRegions(const VtkSource& source, std::span<const std::size_t> cells) {
  Array<std::int32_t> regions;
  const VtkSourceArray* const array = findRegions(source);
  if (array == nullptr) return regions;
  regions.resize(cells.size());
  std::size_t next = 0;
  forEachNumber(source, *array, [&](std::size_t cell, std::int32_t region) {
    if (next < cells.size() && cells[next] == cell) regions[next++] = region;
  });
  return regions;
}

HexMesh readVtkHexMesh(const VtkSource& source, Stage& stage) {
  HexMesh mesh;
  Array<std::size_t> numbers;
  const bool regions = hasVtkRegions(source);
  readMesh(source, mesh.points, mesh.cells, regions ? &numbers : nullptr, stage);
  if (regions) mesh.regions = readVtkRegions(source, numbers);
  if (source.others != nullptr) readOthers(source, mesh.points, *source.others, stage);
  mesh.features = readVtkHexFeatures(source);
  addTaggedCells(source, kLineKind, mesh.features.edges);
  addTaggedCells(source, kQuadKind, mesh.features.quads);
  readVtkGenerators(source, mesh.generatorTet, mesh.generatorCorners);
  return mesh;
}

namespace {

// Whole files, and streaming.

// Points or cells per piece: a few megabytes.
constexpr std::size_t kVtkPiece = std::size_t{1} << 16;

/// Calls f(first, count) for consecutive ranges of n elements, and reports progress.
template <class F>
void forEachPiece(Stage& stage, std::uint64_t n, const F& f) {
  LoopProgress progress(stage, n);
  for (std::uint64_t first = 0; first < n; first += kVtkPiece) {
    const std::size_t count = std::min<std::uint64_t>(kVtkPiece, n - first);
    f(first, count);
    progress.advance(count);
  }
}

void sendPoints(const VtkSource& source, MeshSink& sink, Stage& stage) {
  Array<Vec3> points;
  Array<Index> tets;
  Array<CornerSet> corners;
  const VtkGenerators generators = findVtkGenerators(source);
  forEachPiece(stage, source.points, [&](std::uint64_t first, std::size_t count) {
    points.resize(count);
    readVtkPoints(source, first, points);
    const auto copy = [&](const auto& column, auto& values) {
      if (!column) return;
      values.resize(count);
      source.copy(*column, first, count, values.data());
    };
    copy(generators.tets, tets);
    copy(generators.corners, corners);
    sink.points({first, points, tets, corners});
  });
}

template <class Cell>
void sendCells(const VtkSource& source, MeshSink& sink, Stage& stage) {
  Array<Cell> cells;
  std::uint64_t sent = 0;
  forEachPiece(stage, source.cells, [&](std::uint64_t first, std::size_t count) {
    cells.resize(countVtkCells(source, kCellKind<8>, first, count));
    readVtkCells(source, kCellKind<8>, first, count, cells.empty() ? nullptr : cells[0].data());
    if (!cells.empty()) sink.cells(sent, std::span<const Cell>(cells));
    sent += cells.size();
  });
}

void sendPieces(const VtkSource& source, MeshSink& sink, Stage& stage) {
  std::uint64_t hexahedra = 0;
  forEachPiece(stage, source.cells, [&](std::uint64_t first, std::size_t count) {
    hexahedra += countVtkCells(source, kCellKind<8>, first, count);
  });
  noteVtkCells(source, kCellKind<8>, hexahedra);
  if (source.cells > 0 && hexahedra == 0) failWithoutVtkCells(source, kCellKind<8>);
  sink.begin(source.points, hexahedra);
  sendPoints(source, sink, stage);
  if (source.points < kNone) {
    sendCells<Hex>(source, sink, stage);
  } else {
    sendCells<Hex64>(source, sink, stage);
  }
  sink.end();
}

}  // namespace

HexMesh readVtu(const Input& input, Stage& stage) {
  return readVtkHexMesh(*openVtuFile(input, stage), stage);
}

TetCells readVtuTets(const Input& input, Stage& stage) {
  return readVtkTets(*openVtuFile(input, stage), stage);
}

TetMap readVtuMap(const Input& input, const ReadOptions& options, Stage& stage) {
  return readVtkMap(*openVtuFile(input, stage), options.mapArray, stage);
}

TriangleLabels readVtuLabels(const Input& input, std::string_view array, Stage& stage) {
  return readVtkLabels(*openVtuFile(input, stage), array, stage);
}

TriangleLabels readVtkLegacyLabels(const Input& input, std::string_view array, Stage& stage) {
  return readVtkLabels(*openVtkLegacyFile(input, false, stage), array, stage);
}

HexMesh readVtkLegacy(const Input& input, Stage& stage) {
  return readVtkHexMesh(*openVtkLegacyFile(input, true, stage), stage);
}

TetCells readVtkLegacyTets(const Input& input, Stage& stage) {
  return readVtkTets(*openVtkLegacyFile(input, false, stage), stage);
}

TetMap readVtkLegacyMap(const Input& input, const ReadOptions& options, Stage& stage) {
  return readVtkMap(*openVtkLegacyFile(input, false, stage), options.mapArray, stage);
}

TriangleMesh readVtp(const Input& input, Stage& stage) {
  return readVtkSurface(*openVtuFile(input, stage), stage);
}

TriangleMesh readVtkLegacySurface(const Input& input, Stage& stage) {
  return readVtkSurface(*openVtkLegacyFile(input, false, stage), stage);
}

void readVtuTo(MeshSink& sink, const Input& input, Context& context) {
  Stage stage(context, "read mesh");
  sendPieces(*openVtuFile(input, stage), sink, stage);
}

}  // namespace hexhex::io
