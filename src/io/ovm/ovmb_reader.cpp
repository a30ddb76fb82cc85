// Cuts an `.ovmb` file into its chunks, and decodes its properties (see ovmb_reader.hpp).
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>
#include <io/ovm/ovmb_reader.hpp>

namespace hexhex::io {
namespace {

constexpr std::uint8_t kMandatory = 1;

/// What stands before the body of a chunk.
struct ChunkHeader {
  std::size_t position = 0;  ///< in the file
  std::string_view type;     ///< four characters
  std::uint8_t version = 0;
  std::uint8_t padding = 0;
  std::uint8_t compression = 0;
  std::uint8_t flags = 0;
  std::uint64_t length = 0;  ///< of the body, including padding
};

void readFileHeader(OvmbFrame& frame, ByteCursor& cursor) {
  if (!isOvmb(frame.bytes)) {
    cursor.fail(ErrorCode::FileSyntax,
                "an .ovmb file begins with \"OVMB\" and the bytes 0A 0D 0A FF, which are missing "
                "here. If this is a text file of OpenVolumeMesh, give it the extension .ovm.");
  }
  static_cast<void>(cursor.take(kOvmbMagic.size(), "the signature"));
  const auto readByte = [&cursor](const char* what) {
    return unsigned{cursor.read<std::uint8_t>(what)};
  };
  const auto require = [&cursor](bool condition, ErrorCode code, const std::string& sentence) {
    if (!condition) cursor.failAt(cursor.position() - 1, code, sentence);
  };
  // The version of the file is not checked: chunks have versions of their own.
  static_cast<void>(readByte("the version of the file"));
  const unsigned version = readByte("the version of the header");
  require(version == 1, ErrorCode::FileUnsupported,
          "the header has version " + std::to_string(version) + "; only version 1 is supported.");
  const unsigned dimension = readByte("the dimension");
  require(dimension == 3, ErrorCode::FileUnsupported,
          "the dimension must be 3, found " + std::to_string(dimension) + ".");
  // Valences decide what the cells are; this is but a hint.
  const unsigned kind = readByte("the kind of the mesh");
  require(kind <= 2, ErrorCode::FileSyntax,
          "the kind of the mesh must be 0, 1 or 2, found " + std::to_string(kind) + ".");
  const std::size_t reserved = cursor.position();
  if (cursor.read<std::uint32_t>("the reserved part") != 0) {
    cursor.failAt(reserved, ErrorCode::FileSyntax, "the reserved part of the header is not zero.");
  }
  for (std::uint64_t& count : frame.counts) {
    const std::size_t position = cursor.position();
    count = cursor.read<std::uint64_t>("the header");
    if (count > kMaxOvmEntities) {
      cursor.failAt(position, ErrorCode::TooLarge,
                    "the header announces " + std::to_string(count) +
                        " elements of a kind; at most " + std::to_string(kMaxOvmEntities) +
                        " are supported.");
    }
  }
}

ChunkHeader readChunkHeader(ByteCursor& cursor) {
  constexpr std::string_view kWhat = "the header of a chunk";
  ChunkHeader header;
  header.position = cursor.position();
  header.type = cursor.take(4, kWhat);
  header.version = cursor.read<std::uint8_t>(kWhat);
  header.padding = cursor.read<std::uint8_t>(kWhat);
  header.compression = cursor.read<std::uint8_t>(kWhat);
  header.flags = cursor.read<std::uint8_t>(kWhat);
  header.length = cursor.read<std::uint64_t>(kWhat);
  if (header.padding > 7 || header.padding > header.length || header.flags > kMandatory) {
    cursor.failAt(header.position, ErrorCode::FileSyntax,
                  "the chunk " + quoted(header.type) + " has an impossible header.");
  }
  return header;
}

std::string_view takePayload(const ChunkHeader& header, ByteCursor& cursor) {
  const std::string_view body = cursor.take(header.length, "the chunk " + quoted(header.type));
  const std::string_view payload = body.substr(0, body.size() - header.padding);
  const std::string_view padding = body.substr(payload.size());
  if (std::any_of(padding.begin(), padding.end(), [](char byte) { return byte != 0; })) {
    cursor.failAt(cursor.position() - header.padding, ErrorCode::FileSyntax,
                  "the padding at the end of the chunk " + quoted(header.type) + " is not zero.");
  }
  return payload;
}

/// Whether a chunk is of a kind that this library knows; if not, it has to be optional.
bool isKnown(const ChunkHeader& header, const ByteCursor& cursor) {
  constexpr std::array<std::string_view, 5> kTypes = {"VERT", "TOPO", "DIRP", "PROP", "EOF "};
  const bool known = std::find(kTypes.begin(), kTypes.end(), header.type) != kTypes.end() &&
                     header.version == 0 && header.compression == 0;
  if (known || (header.flags & kMandatory) == 0) return known;
  cursor.failAt(header.position, ErrorCode::FileUnsupported,
                "the chunk " + quoted(header.type) + " (version " + std::to_string(header.version) +
                    ", compression " + std::to_string(header.compression) +
                    ") is not supported, and marked as mandatory. Save the file with an earlier "
                    "version of OpenVolumeMesh, uncompressed.");
}

/// @param bytes, fileName  must outlive the frame
/// @throws Error FileSyntax, also if the end chunk is missing; FileUnsupported; TooLarge
OvmbFrame splitOvmb(std::string_view bytes, const std::string& fileName) {
  OvmbFrame frame{bytes, fileName, {}, {}};
  ByteCursor cursor = frame.cursor(bytes);
  readFileHeader(frame, cursor);
  while (true) {
    if (cursor.remaining() == 0) {
      cursor.fail(ErrorCode::FileSyntax,
                  "the file ends without its end chunk: it is truncated. Copy or save it again.");
    }
    const ChunkHeader header = readChunkHeader(cursor);
    const bool known = isKnown(header, cursor);
    const std::string_view payload = takePayload(header, cursor);
    if (!known) continue;
    if (header.type == "EOF ") {
      if (!payload.empty()) {
        cursor.failAt(header.position, ErrorCode::FileSyntax, "the end chunk is not empty.");
      }
      break;
    }
    frame.chunks.push_back({header.type, payload});
  }
  if (cursor.remaining() > 0) {
    cursor.fail(ErrorCode::FileSyntax,
                "there are " + std::to_string(cursor.remaining()) + " bytes after the end chunk.");
  }
  return frame;
}

constexpr std::string_view kBits = "b";

/// Calls f with a number of an integer type.
/// @return whether there is such a type
template <class F>
bool withIntegerType(std::string_view type, const F& f) {
  const auto callIf = [&]<class Stored>(std::string_view name, Stored stored) {
    if (type != name) return false;
    f(stored);
    return true;
  };
  return callIf("u8", std::uint8_t{}) || callIf("u16", std::uint16_t{}) ||
         callIf("u32", std::uint32_t{}) || callIf("u64", std::uint64_t{}) ||
         callIf("i8", std::int8_t{}) || callIf("i16", std::int16_t{}) ||
         callIf("i32", std::int32_t{}) || callIf("i64", std::int64_t{}) ||
         callIf(kBits, std::uint8_t{});
}

/// The same for types of points, with a coordinate.
template <class F>
bool withPointType(std::string_view type, const F& f) {
  if (type == "3d") f(double{});
  if (type == "3f") f(float{});
  return type == "3d" || type == "3f";
}

/// One entry of the directory.
struct Entry {
  OvmEntity entity = OvmEntity::Vertex;
  std::string_view name;
  std::string_view type;
  std::string_view defaultValue;
  OvmMesh::Destination destination = {};
};

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

/// What is decoded, for messages.
struct Subject {
  const char* name;
  const char* verb;
};
constexpr Subject kDefault = {"the default value", "has"};
constexpr Subject kValues = {"the values", "have"};

/// All that remains behind a cursor, which must have this size.
const char* takeAll(std::uint64_t bytes, const Entry& entry, const Subject& subject,
                    ByteCursor& cursor) {
  if (cursor.remaining() != bytes) {
    cursor.fail(ErrorCode::FileSyntax, subject.name + (" of the property " + quoted(entry.name)) +
                                           " " + subject.verb + " " +
                                           std::to_string(cursor.remaining()) +
                                           " bytes instead of " + std::to_string(bytes) + ".");
  }
  return cursor.take(bytes, subject.name).data();
}

/// Decodes the properties that this library knows, by entity, name and type; the map may be of
/// doubles or floats, integers of any width, or bits. All others are skipped, after a check of
/// their place in the file. Elements outside of all spans have the default value.
class PropertyReader {
 public:
  PropertyReader(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage)
      : frame_(frame), mesh_(mesh), stage_(stage) {}

  void readDirectory(std::string_view payload) {
    ByteCursor cursor = frame_.cursor(payload);
    if (hasDirectory_) cursor.fail(ErrorCode::FileSyntax, "there is a second DIRP chunk.");
    hasDirectory_ = true;
    while (cursor.remaining() > 0) {
      Entry entry = readEntry(cursor);
      entry.destination = mesh_.destinationOf(entry.entity, entry.name, numbersOf(entry.type));
      if (entry.destination.points != nullptr) makeDefault(entry, *entry.destination.points);
      if (entry.destination.integers != nullptr) makeDefault(entry, *entry.destination.integers);
      entries_.push_back(entry);
    }
  }

  void readProperty(std::string_view payload) {
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
    const auto decodeInto = [&](auto* values) {
      if (values == nullptr) return;
      decode(entry,
             std::span(*values).subspan(static_cast<std::size_t>(span.first),
                                        static_cast<std::size_t>(span.count)),
             kValues, cursor);
    };
    decodeInto(entry.destination.points);
    decodeInto(entry.destination.integers);
  }

 private:
  static OvmNumbers numbersOf(std::string_view type) {
    const auto ignore = [](auto /*number*/) {};
    if (withPointType(type, ignore)) return OvmNumbers::Points;
    return withIntegerType(type, ignore) ? OvmNumbers::Integers : OvmNumbers::Others;
  }

  template <class T>
  void makeDefault(const Entry& entry, Array<T>& values) {
    ByteCursor cursor = frame_.cursor(entry.defaultValue);
    T value{};
    decode(entry, std::span<T>(&value, 1), kDefault, cursor);
    values.assign(mesh_.topology.count(entry.entity), value);
  }

  void decode(const Entry& entry, std::span<Vec3> values, const Subject& subject,
              ByteCursor& cursor) {
    withPointType(entry.type, [&]<class Stored>(Stored /*coordinate*/) {
      const char* const data = takeAll(values.size() * 3 * sizeof(Stored), entry, subject, cursor);
      // Half-faces without a cell may have any numbers.
      decodeOvmbPoints<Stored>(data, values, stage_);
    });
  }

  void decode(const Entry& entry, std::span<std::int32_t> values, const Subject& subject,
              ByteCursor& cursor) {
    const std::size_t begin = cursor.position();
    if (entry.type == kBits) {  // eight elements per byte, from the lowest bit on
      const char* const data = takeAll((values.size() + 7) / 8, entry, subject, cursor);
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<unsigned char>(data[i / 8]) >> (i % 8) & 1;
      }
      return;
    }
    withIntegerType(entry.type, [&]<class Stored>(Stored /*number*/) {
      const char* const data = takeAll(values.size() * sizeof(Stored), entry, subject, cursor);
      const auto valueAt = [data](std::size_t i) {
        return loadLittle<Stored>(data + i * sizeof(Stored));
      };
      const std::size_t fault = firstFault(stage_, values.size(), [&](std::size_t i) {
        values[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(valueAt(i)));
        return std::in_range<std::int32_t>(valueAt(i));
      });
      if (fault == values.size()) return;
      cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::FileUnsupported,
                    "the property " + quoted(entry.name) + " has the value " +
                        std::to_string(valueAt(fault)) +
                        ", which does not fit into 32 bits with a sign.");
    });
  }

  const OvmbFrame& frame_;
  OvmMesh& mesh_;
  Stage& stage_;
  bool hasDirectory_ = false;
  std::vector<Entry> entries_;
};

}  // namespace

OvmMesh parseOvmb(std::string_view bytes, const std::string& fileName, Stage& stage) {
  const OvmbFrame frame = splitOvmb(bytes, fileName);
  OvmMesh mesh;
  readOvmbElements(frame, mesh, stage);
  PropertyReader reader(frame, mesh, stage);
  for (const OvmbChunk& chunk : frame.chunks) {
    if (chunk.type == "DIRP") reader.readDirectory(chunk.payload);
    if (chunk.type == "PROP") reader.readProperty(chunk.payload);
  }
  return mesh;
}

}  // namespace hexhex::io
