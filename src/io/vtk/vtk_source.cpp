#include <algorithm>
#include <array>
#include <type_traits>

#include <io/core/bytes.hpp>
#include <io/vtk/vtk_source.hpp>

namespace hexhex::io {
namespace {

/// The number at a place of any alignment. Only numbers of 4 and 8 bytes come with the largest byte
/// first.
template <class T, bool bigEndian>
T loadNumber(const char* place) {
  if constexpr (bigEndian && sizeof(T) >= sizeof(std::uint32_t)) {
    return loadBig<T>(place);
  } else {
    T number;
    std::memcpy(&number, place, sizeof(T));
    return number;
  }
}

/// Numbers one after the other, as they are stored, into an array of T.
template <class T>
void convert(const VtkColumn& column, const char* from, std::size_t count, T* to) {
  const auto convertFrom = [&](auto zero) {
    const auto all = [&](auto bigEndian) {
      using Stored = decltype(zero);
      for (std::size_t i = 0; i < count; ++i) {
        // NOLINTNEXTLINE(bugprone-signed-char-misuse): numbers of 8 bits keep their sign, too.
        to[i] = static_cast<T>(loadNumber<Stored, bigEndian>(from + i * sizeof(Stored)));
      }
    };
    if (column.bigEndian) return all(std::true_type{});
    all(std::false_type{});
  };
  std::visit(convertFrom, column.scalar);
}

/// Whether numbers in memory have the bytes of the stored ones, so that they are read to their
/// place. With another copy, reading a map from a `.vtu` file takes a quarter longer.
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

void VtkSource::see(std::string_view name, bool ofCells, std::size_t components) {
  constexpr std::size_t kMostSeen = 20;  // that a sentence can name
  if (seen.size() == kMostSeen) {
    ++unnamed;
    return;
  }
  seen.push_back('"' + std::string(name) + (ofCells ? "\" (cells, " : "\" (points, ") +
                 std::to_string(components) + (components == 1 ? " component)" : " components)"));
}

VtkColumn textColumn(VtkNumbers numbers, std::size_t count) {
  VtkColumn column;
  column.scalar = numbers == VtkNumbers::Reals ? VtkScalar(double{}) : VtkScalar(std::int64_t{});
  column.count = count;
  column.decoded.resize(memorySize(std::uint64_t{count} * sizeof(double)));
  return column;
}

void readVtkNumber(TextScanner& scanner, VtkNumbers numbers, VtkColumn& column, std::size_t i,
                   const NumberName& name) {
  const auto set = [place = column.decoded.data() + i * sizeof(double)](auto number) {
    std::memcpy(place, &number, sizeof(number));
  };
  if (numbers == VtkNumbers::Reals) return set(scanner.number(name));
  set(scanner.integer(name));
}

}  // namespace hexhex::io
