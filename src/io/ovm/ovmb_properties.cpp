#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>
#include <io/ovm/ovmb_elements.hpp>
#include <io/ovm/ovmb_properties.hpp>

namespace hexhex {
namespace {

/// A type of elements of fixed size.
struct ElementType {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::string_view kBits = "b";
constexpr std::array<ElementType, 10> kNumbers = {{{"u8", 1},
                                                   {"u16", 2},
                                                   {"u32", 4},
                                                   {"u64", 8},
                                                   {"i8", 1},
                                                   {"i16", 2},
                                                   {"i32", 4},
                                                   {"i64", 8},
                                                   {"3d", 24},
                                                   {"3f", 12}}};

std::size_t bytesOf(std::string_view type) {
  for (const ElementType& known : kNumbers) {
    if (known.name == type) return known.bytes;
  }
  return 0;
}

/// One entry of the directory.
struct Entry {
  OvmEntity entity = OvmEntity::Vertex;
  std::string_view name;
  std::string_view type;
  std::string_view defaultValue;
};

/// Calls f(load), where load(place) reads one element of an integer type.
template <class F>
void withIntegerType(std::string_view type, const F& f) {
  const auto loader = []<class Stored>(Stored /*type*/) {
    return [](const char* place) { return loadLittle<Stored>(place); };
  };
  if (type == "u8" || type == kBits) f(loader(std::uint8_t{}));
  if (type == "u16") f(loader(std::uint16_t{}));
  if (type == "u32") f(loader(std::uint32_t{}));
  if (type == "u64") f(loader(std::uint64_t{}));
  if (type == "i8") f(loader(std::int8_t{}));
  if (type == "i16") f(loader(std::int16_t{}));
  if (type == "i32") f(loader(std::int32_t{}));
  if (type == "i64") f(loader(std::int64_t{}));
}

/// Calls f(load) for a type of points.
template <class F>
void withPointType(std::string_view type, const F& f) {
  const auto loader = []<class Stored>(Stored /*type*/) {
    return [](const char* place) {
      Vec3 point;
      for (std::size_t k = 0; k < 3; ++k) {
        point[k] = loadLittle<Stored>(place + k * sizeof(Stored));
      }
      return point;
    };
  };
  if (type == "3d") f(loader(double{}));
  if (type == "3f") f(loader(float{}));
}

bool isPointType(std::string_view type) { return type == "3d" || type == "3f"; }
bool isIntegerType(std::string_view type) {
  return type == kBits || (bytesOf(type) > 0 && !isPointType(type));
}

Entry readEntry(ByteCursor& cursor) {
  const std::size_t position = cursor.position();
  const auto entity = cursor.read<std::uint8_t>("the directory of properties");
  if (entity > static_cast<std::uint8_t>(OvmEntity::Mesh)) {
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "a property belongs to an entity of kind " + std::to_string(entity) +
                      "; only 0 to 6 exist.");
  }
  const auto text = [&cursor](std::string_view what) {
    return cursor.take(cursor.read<std::uint32_t>(what), what);
  };
  Entry entry;
  entry.entity = static_cast<OvmEntity>(entity);
  entry.name = text("the name of a property");
  entry.type = text("the type of a property");
  entry.defaultValue = text("the default value of a property");
  return entry;
}

/// All that remains of a PROP chunk, which must have this size.
std::string_view takeElements(const Entry& entry, std::uint64_t bytes, ByteCursor& cursor) {
  if (cursor.remaining() != bytes) {
    cursor.fail(ErrorCode::FileSyntax, "the values of the property " + quoted(entry.name) +
                                           " have " + std::to_string(cursor.remaining()) +
                                           " bytes instead of " + std::to_string(bytes) + ".");
  }
  return cursor.take(bytes, "the values of a property");
}

/// Eight elements per byte, from the lowest bit on.
void decodeBits(const char* data, std::span<std::int32_t> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto byte = static_cast<unsigned char>(data[i / 8]);
    values[i] = (byte >> (i % 8)) & 1;
  }
}

/// Whether an integer fits where this library keeps it; sets the place anyhow.
template <class Stored>
bool setInteger(std::int32_t& place, Stored value) {
  place = static_cast<std::int32_t>(static_cast<std::int64_t>(value));
  return std::in_range<std::int32_t>(value);
}

[[noreturn]] void failTooLarge(const ByteCursor& cursor, std::size_t position, const Entry& entry,
                               const std::string& value) {
  cursor.failAt(position, ErrorCode::FileUnsupported,
                "the property " + quoted(entry.name) + " has the value " + value +
                    ", which does not fit into 32 bits with a sign.");
}

class PropertyReader {
 public:
  PropertyReader(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage)
      : frame_(frame), mesh_(mesh), stage_(stage) {}

  void readDirectory(std::string_view payload);
  void readProperty(std::string_view payload);

 private:
  void prepare(std::size_t number);
  template <class T, class Load>
  void makeArray(std::size_t number, Array<T>& values, const Load& load);
  [[nodiscard]] bool isGivenAtOnce(std::size_t number) const;
  void decodePoints(const Entry& entry, const OvmbSpan& span, ByteCursor& cursor);
  void decodeIntegers(const Entry& entry, const OvmbSpan& span, ByteCursor& cursor,
                      Array<std::int32_t>& values);

  const OvmbFrame& frame_;
  OvmMesh& mesh_;
  Stage& stage_;
  bool hasDirectory_ = false;
  std::vector<Entry> entries_;
  // The entries that are decoded; the first of several with the same name counts.
  std::optional<std::size_t> map_;
  std::array<std::optional<std::size_t>, kOvmIntegers.size()> integers_;
};

void PropertyReader::readDirectory(std::string_view payload) {
  ByteCursor cursor = frame_.cursor(payload);
  if (hasDirectory_) cursor.fail(ErrorCode::FileSyntax, "there is a second DIRP chunk.");
  hasDirectory_ = true;
  while (cursor.remaining() > 0) {
    entries_.push_back(readEntry(cursor));
    prepare(entries_.size() - 1);
  }
}

/// If an entry is one of those that are wanted, makes its array.
void PropertyReader::prepare(std::size_t number) {
  const Entry& entry = entries_[number];
  if (entry.name == kParametrizationName) {
    if (entry.entity == OvmEntity::HalfFace && isPointType(entry.type) && !map_) {
      map_ = number;
      withPointType(entry.type, [&](const auto& load) {
        makeArray(number, mesh_.properties.parametrization, load);
      });
    } else {
      mesh_.hasForeignParametrization = true;
    }
  }
  if (!isIntegerType(entry.type)) return;
  for (std::size_t i = 0; i < kOvmIntegers.size(); ++i) {
    const bool wanted =
        entry.entity == kOvmIntegers[i].entity && entry.name == kOvmIntegers[i].name;
    if (!wanted || integers_[i]) continue;
    integers_[i] = number;
    withIntegerType(entry.type, [&](const auto& load) {
      makeArray(number, mesh_.properties.integers[i], [&](const char* place) {
        std::int32_t value = 0;
        if (!setInteger(value, load(place))) {
          const ByteCursor cursor = frame_.cursor(entry.defaultValue);
          failTooLarge(cursor, cursor.position(), entry, std::to_string(load(place)));
        }
        return value;
      });
    });
  }
}

/// Whether one of the PROP chunks has the values of all elements, as is normal.
bool PropertyReader::isGivenAtOnce(std::size_t number) const {
  constexpr std::size_t kSpanBytes = 12;
  return std::any_of(frame_.chunks.begin(), frame_.chunks.end(), [&](const OvmbChunk& chunk) {
    if (chunk.type != OvmbChunkType::Property) return false;
    if (chunk.payload.size() < kSpanBytes + sizeof(std::uint32_t)) return false;
    ByteCursor cursor = frame_.cursor(chunk.payload);
    const OvmbSpan span = readOvmbSpan(cursor);
    return cursor.read<std::uint32_t>("") == number && span.first == 0 &&
           span.count == mesh_.topology.count(entries_[number].entity);
  });
}

/// Makes an array of default values, unless they would all be overwritten.
template <class T, class Load>
void PropertyReader::makeArray(std::size_t number, Array<T>& values, const Load& load) {
  const Entry& entry = entries_[number];
  ByteCursor cursor = frame_.cursor(entry.defaultValue);
  const std::size_t bytes = entry.type == kBits ? 1 : bytesOf(entry.type);
  if (entry.defaultValue.size() != bytes) {
    cursor.fail(ErrorCode::FileSyntax, "the default value of the property " + quoted(entry.name) +
                                           " has " + std::to_string(entry.defaultValue.size()) +
                                           " bytes instead of " + std::to_string(bytes) + ".");
  }
  const T value = load(entry.defaultValue.data());
  values.resize(mesh_.topology.count(entry.entity));
  if (isGivenAtOnce(number)) return;
  constexpr std::size_t kGrain = 1 << 16;
  parallelFor(stage_, values.size(), kGrain, [&](std::size_t i) { values[i] = value; });
}

void PropertyReader::readProperty(std::string_view payload) {
  ByteCursor cursor = frame_.cursor(payload);
  const OvmbSpan span = readOvmbSpan(cursor);
  const std::size_t position = cursor.position();
  const auto number = cursor.read<std::uint32_t>("the header of a PROP chunk");
  if (number >= entries_.size()) {
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "a PROP chunk is about property " + std::to_string(number) + ", but only " +
                      std::to_string(entries_.size()) + " are listed before it.");
  }
  const Entry& entry = entries_[number];
  const std::size_t count = mesh_.topology.count(entry.entity);
  if (span.first > count || span.count > count - span.first) {
    cursor.fail(ErrorCode::FileSyntax, "values of the property " + quoted(entry.name) +
                                           " lie outside of its " + std::to_string(count) +
                                           " elements.");
  }
  if (map_ == number) decodePoints(entry, span, cursor);
  for (std::size_t i = 0; i < integers_.size(); ++i) {
    if (integers_[i] == number) {
      decodeIntegers(entry, span, cursor, mesh_.properties.integers[i]);
    }
  }
}

void PropertyReader::decodePoints(const Entry& entry, const OvmbSpan& span, ByteCursor& cursor) {
  const std::size_t bytes = bytesOf(entry.type);
  const char* const data = takeElements(entry, span.count * bytes, cursor).data();
  Vec3* const values = mesh_.properties.parametrization.data() + span.first;
  withPointType(entry.type, [&](const auto& load) {
    constexpr std::size_t kGrain = 1 << 14;
    parallelFor(stage_, static_cast<std::size_t>(span.count), kGrain,
                [&](std::size_t i) { values[i] = load(data + i * bytes); });
  });
}

void PropertyReader::decodeIntegers(const Entry& entry, const OvmbSpan& span, ByteCursor& cursor,
                                    Array<std::int32_t>& values) {
  const std::size_t begin = cursor.position();
  const std::size_t bytes = bytesOf(entry.type);
  const std::uint64_t size = entry.type == kBits ? (span.count + 7) / 8 : span.count * bytes;
  const char* const data = takeElements(entry, size, cursor).data();
  const std::span<std::int32_t> place = std::span(values).subspan(
      static_cast<std::size_t>(span.first), static_cast<std::size_t>(span.count));
  if (entry.type == kBits) return decodeBits(data, place);
  withIntegerType(entry.type, [&](const auto& load) {
    const std::size_t fault = firstFault(stage_, place.size(), [&](std::size_t i) {
      return setInteger(place[i], load(data + i * bytes));
    });
    if (fault == place.size()) return;
    const std::size_t wrong = fault * bytes;
    failTooLarge(cursor, begin + wrong, entry, std::to_string(load(data + wrong)));
  });
}

}  // namespace

void readOvmbProperties(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage) {
  PropertyReader reader(frame, mesh, stage);
  for (const OvmbChunk& chunk : frame.chunks) {
    if (chunk.type == OvmbChunkType::Directory) reader.readDirectory(chunk.payload);
    if (chunk.type == OvmbChunkType::Property) reader.readProperty(chunk.payload);
  }
}

}  // namespace hexhex
