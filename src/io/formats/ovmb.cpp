// Reads and writes `.ovmb` files (see ovm_mesh.hpp): a header followed by chunks with vertices,
// edges, faces, cells and properties.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/bytes.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

struct OvmbChunk {
  std::string_view type;     ///< four characters
  std::string_view payload;  ///< without padding
};

/// A file split into chunks; refers to its bytes.
struct OvmbFrame {
  std::string_view bytes;
  const std::string& fileName;
  std::array<std::uint64_t, 4> counts{};  ///< of vertices, edges, faces, cells, as announced
  std::vector<OvmbChunk> chunks;          ///< in order, without unknown and end chunks

  [[nodiscard]] ByteCursor cursor(std::string_view part) const { return {part, bytes, fileName}; }
};

/// The range of elements at the head of VERT, TOPO and PROP chunks.
struct OvmbSpan {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};
OvmbSpan readOvmbSpan(ByteCursor& cursor) {
  OvmbSpan span;
  span.first = cursor.read<std::uint64_t>("a span of elements");
  span.count = cursor.read<std::uint32_t>("a span of elements");
  return span;
}

/// Decodes points stored as three floats or doubles each.
/// @return the first point that is not finite, or their number
template <class Stored>
std::size_t decodeOvmbPoints(const char* data, std::span<Vec3> points, Stage& stage) {
  return firstFault(
      stage, points.size(),
      [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
          points[i][k] = double{loadLittle<Stored>(data + (3 * i + k) * sizeof(Stored))};
        }
        return isFinite(points[i]);
      },
      std::size_t{1} << 14);
}

// Elements.

// Codes of elements in file headers and TOPO chunks.
constexpr std::size_t kEdges = 1;
constexpr std::size_t kFaces = 2;
constexpr std::size_t kCells = 3;

/// The singular with its article: "an edge".
std::string anyOf(std::size_t entity) {
  return concat((entity == kEdges ? "an " : "a "), kOvmElements[entity].one);
}

/// Calls f with an unsigned integer of the width stored in the file.
template <class F>
void withWidth(std::uint8_t bytes, const F& f) {
  if (bytes == 1) f(std::uint8_t{});
  if (bytes == 2) f(std::uint16_t{});
  if (bytes == 4) f(std::uint32_t{});
}

/// Appends the elements of successive chunks to a mesh.
class ElementReader {
 public:
  ElementReader(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage)
      : frame_(frame), mesh_(mesh), stage_(stage) {}

  void readVertices(std::string_view payload) {
    ByteCursor cursor = frame_.cursor(payload);
    const OvmbSpan span = readNextSpan(cursor, 0);
    const std::size_t position = cursor.position();
    const auto encoding = cursor.read<std::uint32_t>("the header of a VERT chunk");
    if (encoding == 1) {
      decodePoints<float>(cursor, span);
    } else if (encoding == 2) {
      decodePoints<double>(cursor, span);
    } else {
      cursor.failAt(position, ErrorCode::FileSyntax,
                    "the encoding of the vertices must be 1 (float32) or 2 (float64), followed by "
                    "three zero bytes.");
    }
    if (cursor.remaining() > 0) {
      cursor.fail(ErrorCode::FileSyntax, "the VERT chunk is longer than its vertices.");
    }
  }

  void readTopology(std::string_view payload) {
    ByteCursor cursor = frame_.cursor(payload);
    ByteCursor span = cursor;
    static_cast<void>(readOvmbSpan(cursor));
    const std::size_t position = cursor.position();
    const std::size_t entity = cursor.read<std::uint8_t>("the header of a TOPO chunk");
    if (entity < kEdges || entity > kCells) {
      cursor.failAt(position, ErrorCode::FileSyntax,
                    "a TOPO chunk must be about edges (1), faces (2) or cells (3), found ", entity,
                    ".");
    }
    const auto count = static_cast<std::size_t>(readNextSpan(span, entity).count);
    readEncoding(cursor);
    if (count == 0) cursor.failAt(position, ErrorCode::FileSyntax, "a TOPO chunk is empty.");
    const std::span<Index> handles =
        entity == kEdges ? readEdges(cursor, count) : readLists(cursor, count, entity);
    withWidth(encoding_.handleBytes, [&]<class Stored>(Stored /*width*/) {
      decodeHandles<Stored>(cursor, handles, entity);
    });
    if (handles.data() == mixed_.data()) appendMixed(count, entity);
  }

  void requireAll() const {
    for (std::size_t entity = 0; entity < 4; ++entity) {
      if (done_[entity] == frame_.counts[entity]) continue;
      throw Error(
          ErrorCode::FileSyntax,
          concat(frame_.fileName, ": the file header announces ", frame_.counts[entity], " ",
                 kOvmElements[entity].many, ", but the file holds ", done_[entity], "."));
    }
  }

 private:
  /// Reads a span; those of one kind of element must be contiguous.
  OvmbSpan readNextSpan(ByteCursor& cursor, std::size_t entity) {
    const std::size_t position = cursor.position();
    const OvmbSpan span = readOvmbSpan(cursor);
    const std::string many = kOvmElements[entity].many;
    if (span.first != done_[entity]) {
      cursor.failAt(position, ErrorCode::FileSyntax, "expected ", many, " from number ",
                    done_[entity], " on, found number ", span.first, ".");
    }
    if (span.count > frame_.counts[entity] - span.first) {
      cursor.failAt(position, ErrorCode::FileSyntax, "there are more ", many, " than the ",
                    frame_.counts[entity], " that the file header announces.");
    }
    done_[entity] += span.count;
    return span;
  }

  template <class Stored>
  void decodePoints(ByteCursor& cursor, const OvmbSpan& span) {
    const std::size_t begin = cursor.position();
    const char* const data = cursor.take(span.count * 3 * sizeof(Stored), "a VERT chunk").data();
    mesh_.points.resize(static_cast<std::size_t>(span.first + span.count));
    const std::size_t fault =
        decodeOvmbPoints<Stored>(data, std::span(mesh_.points).subspan(span.first), stage_);
    if (fault == span.count) return;
    const std::uint64_t vertex = span.first + fault;
    cursor.failAt(begin + 3 * fault * sizeof(Stored), ErrorCode::NotFinite,
                  Place{PlaceKind::Vertex, vertex}, "a coordinate of vertex ", vertex,
                  " is not finite.");
  }

  void readEncoding(ByteCursor& cursor) {
    constexpr std::string_view kWhat = "the header of a TOPO chunk";
    encoding_.valence = cursor.read<std::uint8_t>(kWhat);
    const std::size_t position = cursor.position();
    encoding_.valenceBytes = cursor.read<std::uint8_t>(kWhat);
    encoding_.handleBytes = cursor.read<std::uint8_t>(kWhat);
    encoding_.handleOffset = cursor.read<std::uint64_t>(kWhat);
    const auto isWidth = [](std::uint8_t bytes) { return bytes == 1 || bytes == 2 || bytes == 4; };
    const bool goodValences =
        encoding_.valence > 0 ? encoding_.valenceBytes == 0 : isWidth(encoding_.valenceBytes);
    if (goodValences && isWidth(encoding_.handleBytes)) return;
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "the encoding of valences must be 1, 2 or 4 if they vary, else 0, and that of "
                  "handles 1, 2 or 4.");
  }

  /// @return memory for the handles that make up the rest of the chunk; also for the next functions
  std::span<Index> readEdges(const ByteCursor& cursor, std::size_t count) {
    if (encoding_.valence != 2) {
      cursor.fail(ErrorCode::FileSyntax, "edges must have the valence 2, found ", encoding_.valence,
                  ".");
    }
    if (cursor.remaining() != 2 * count * encoding_.handleBytes) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its edges.");
    }
    Array<std::array<Index, 2>>& edges = mesh_.topology.edges;
    edges.resize(edges.size() + count);
    // Arrays of pairs are contiguous numbers.
    return {reinterpret_cast<Index*>(edges.data() + edges.size() - count), 2 * count};
  }

  std::span<Index> readLists(ByteCursor& cursor, std::size_t count, std::size_t entity) {
    const std::string many = kOvmElements[entity].many;
    if (count * std::max(encoding_.valence, encoding_.valenceBytes) > cursor.remaining()) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk is too short for its ", count, " ", many,
                  ".");
    }
    if (encoding_.valence > 0 && encoding_.valence < kOvmElements[entity].leastValence) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has ", many, " of valence ",
                  encoding_.valence, ".");
    }
    std::uint64_t handles = std::uint64_t{count} * encoding_.valence;
    if (encoding_.valence == 0) {
      valences_.resize(count);
      withWidth(encoding_.valenceBytes,
                [&]<class Stored>(Stored /*width*/) { decodeValences<Stored>(cursor, entity); });
      handles = std::accumulate(valences_.begin(), valences_.end(), handles);
    }
    // The first comparison keeps the product from overflowing.
    if (handles > cursor.remaining() || cursor.remaining() != handles * encoding_.handleBytes) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its ", many, ".");
    }
    OvmLists& lists = listsOf(entity);
    Array<Index>& target = encoding_.valence == lists.length ? lists.handles : mixed_;
    if (&target == &mixed_) mixed_.clear();
    target.resize(target.size() + static_cast<std::size_t>(handles));
    return std::span(target).last(static_cast<std::size_t>(handles));
  }

  [[nodiscard]] OvmLists& listsOf(std::size_t entity) const {
    return entity == kFaces ? mesh_.topology.faces : mesh_.topology.cells;
  }

  /// Appends lists whose lengths may differ from that wanted.
  void appendMixed(std::size_t count, std::size_t entity) {
    OvmLists& lists = listsOf(entity);
    const std::size_t before = lists.size();
    const auto lengthOf = [&](std::size_t i) {
      return encoding_.valence > 0 ? encoding_.valence : valences_[i];
    };
    lists.handles.resize((before + count) * lists.length, kNone);
    const Index* from = mixed_.data();
    for (std::size_t i = 0; i < count; from += lengthOf(i++)) {
      if (lengthOf(i) == lists.length) {
        std::copy_n(from, lists.length, lists.handles.data() + (before + i) * lists.length);
      } else {
        mesh_.noteOther(lists, before + i, lengthOf(i));
      }
    }
  }

  template <class Stored>
  void decodeValences(ByteCursor& cursor, std::size_t entity) {
    const std::uint32_t least = kOvmElements[entity].leastValence;
    const std::size_t begin = cursor.position();
    const char* const data = cursor.take(valences_.size() * sizeof(Stored), "the valences").data();
    const std::size_t fault = firstFault(stage_, valences_.size(), [&](std::size_t i) {
      valences_[i] = loadLittle<Stored>(data + i * sizeof(Stored));
      return valences_[i] >= least;
    });
    if (fault == valences_.size()) return;
    cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::FileSyntax, anyOf(entity),
                  " has the valence ", valences_[fault], "; at least ", least, " is needed.");
  }

  template <class Stored>
  void decodeHandles(ByteCursor& cursor, std::span<Index> handles, std::size_t entity) {
    const std::uint64_t limit = (entity == kEdges ? 1U : 2U) * frame_.counts[entity - 1];
    const std::uint64_t offset = encoding_.handleOffset;
    const std::uint64_t room = limit - std::min(limit, offset);
    const std::size_t begin = cursor.position();
    const char* const data = cursor.take(handles.size() * sizeof(Stored), "the handles").data();
    const auto storedAt = [data](std::size_t i) {
      return loadLittle<Stored>(data + i * sizeof(Stored));
    };
    std::atomic<bool> good{true};
    parallelBlocks(stage_, handles.size(), kGrain,
                   [&, decoded = handles.data(), added = static_cast<Index>(offset)](
                       std::size_t first, std::size_t end, std::size_t /*block*/) {
                     // Compare only the largest handle, so that the loop is vectorized; otherwise
                     // reading a hex mesh takes 20 % longer.
                     Stored largest = 0;
                     for (std::size_t i = first; i < end; ++i) {
                       const Stored stored = storedAt(i);
                       decoded[i] = stored + added;
                       largest = std::max(largest, stored);
                     }
                     if (largest >= room) good.store(false, std::memory_order_relaxed);
                   });
    if (good) return;
    const std::size_t fault =
        firstFault(stage_, handles.size(), [&](std::size_t i) { return storedAt(i) < room; });
    const std::uint64_t stored = storedAt(fault);
    cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::IndexOutOfRange, anyOf(entity),
                  " names ", kOvmElements[entity].parts, " ", stored, " + ", offset,
                  ", but there are ", limit, ", numbered from 0.");
  }

  static constexpr std::size_t kGrain = 16384;

  const OvmbFrame& frame_;
  OvmMesh& mesh_;
  Stage& stage_;
  std::array<std::uint64_t, 4> done_{};
  // The second half of the current chunk's header.
  struct {
    std::uint8_t valence = 0;       ///< 0: varies
    std::uint8_t valenceBytes = 0;  ///< if it varies
    std::uint8_t handleBytes = 0;
    std::uint64_t handleOffset = 0;
  } encoding_;
  Array<std::uint32_t> valences_;  ///< if they vary
  Array<Index> mixed_;             ///< handles of lists that may have other lengths than wanted
};

/// Decodes all VERT and TOPO chunks, with any encoding of numbers, handles and valences, and any
/// number of spans. Handles are checked to be in range; the topology is not checked otherwise.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite
void readOvmbElements(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage) {
  ElementReader reader(frame, mesh, stage);
  for (const OvmbChunk& chunk : frame.chunks) {
    if (chunk.type == "VERT") reader.readVertices(chunk.payload);
    if (chunk.type == "TOPO") reader.readTopology(chunk.payload);
  }
  reader.requireAll();
  mesh.topology.vertexCount = mesh.points.size();
}

// Chunks and properties.

constexpr std::uint8_t kMandatory = 1;

/// The header of a chunk.
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
  // The version of the file is not checked: chunks have their own versions.
  static_cast<void>(readByte("the version of the file"));
  const unsigned version = readByte("the version of the header");
  require(version == 1, ErrorCode::FileUnsupported,
          concat("the header has version ", version, "; only version 1 is supported."));
  const unsigned dimension = readByte("the dimension");
  require(dimension == 3, ErrorCode::FileUnsupported,
          concat("the dimension must be 3, found ", dimension, "."));
  // Only a hint: valences determine the kind of cells.
  const unsigned kind = readByte("the kind of the mesh");
  require(kind <= 2, ErrorCode::FileSyntax,
          concat("the kind of the mesh must be 0, 1 or 2, found ", kind, "."));
  const std::size_t reserved = cursor.position();
  if (cursor.read<std::uint32_t>("the reserved part") != 0) {
    cursor.failAt(reserved, ErrorCode::FileSyntax, "the reserved part of the header is not zero.");
  }
  for (std::uint64_t& count : frame.counts) {
    const std::size_t position = cursor.position();
    count = cursor.read<std::uint64_t>("the header");
    if (count > kMaxOvmEntities) {
      cursor.failAt(position, ErrorCode::TooLarge, "the header announces ", count,
                    " elements of a kind; at most ", kMaxOvmEntities, " are supported.");
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
    cursor.failAt(header.position, ErrorCode::FileSyntax, "the chunk ", quoted(header.type),
                  " has an impossible header.");
  }
  return header;
}

std::string_view takePayload(const ChunkHeader& header, ByteCursor& cursor) {
  const std::string_view body = cursor.take(header.length, "the chunk " + quoted(header.type));
  const std::string_view payload = body.substr(0, body.size() - header.padding);
  const std::string_view padding = body.substr(payload.size());
  if (std::any_of(padding.begin(), padding.end(), [](char byte) { return byte != 0; })) {
    cursor.failAt(cursor.position() - header.padding, ErrorCode::FileSyntax,
                  "the padding at the end of the chunk ", quoted(header.type), " is not zero.");
  }
  return payload;
}

/// Whether this library supports a chunk; throws if it does not but the chunk is mandatory.
bool isKnown(const ChunkHeader& header, const ByteCursor& cursor) {
  constexpr std::array<std::string_view, 5> kTypes = {"VERT", "TOPO", "DIRP", "PROP", "EOF "};
  const bool known = std::find(kTypes.begin(), kTypes.end(), header.type) != kTypes.end() &&
                     header.version == 0 && header.compression == 0;
  if (known || (header.flags & kMandatory) == 0) return known;
  cursor.failAt(header.position, ErrorCode::FileUnsupported, "the chunk ", quoted(header.type),
                " (version ", header.version, ", compression ", header.compression,
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
    cursor.fail(ErrorCode::FileSyntax, "there are ", cursor.remaining(),
                " bytes after the end chunk.");
  }
  return frame;
}

constexpr std::string_view kBits = "b";

/// Calls f with a number of the named integer type.
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

/// An entry of the property directory.
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
    cursor.failAt(position, ErrorCode::FileSyntax, "a property belongs to an entity of kind ",
                  entity, "; only 0 to 6 exist.");
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

/// What is being decoded, for messages.
struct Subject {
  const char* name;
  const char* verb;
};
constexpr Subject kDefault = {"the default value", "has"};
constexpr Subject kValues = {"the values", "have"};

/// Returns the bytes after the cursor, which must be this many.
const char* takeAll(std::uint64_t bytes, const Entry& entry, const Subject& subject,
                    ByteCursor& cursor) {
  if (cursor.remaining() != bytes) {
    cursor.fail(ErrorCode::FileSyntax, subject.name, (" of the property " + quoted(entry.name)),
                " ", subject.verb, " ", cursor.remaining(), " bytes instead of ", bytes, ".");
  }
  return cursor.take(bytes, subject.name).data();
}

/// Decodes the supported properties, found by entity, name and type; the map may use doubles or
/// floats, integers of any width, or bits. Others are skipped once their position in the file is
/// checked. Elements outside all spans get the default value.
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
      cursor.failAt(position, ErrorCode::FileSyntax, "a PROP chunk is about property ", number,
                    ", but only ", entries_.size(), " are listed before it.");
    }
    const Entry& entry = entries_[number];
    const std::size_t count = mesh_.topology.count(entry.entity);
    if (span.first > count || span.count > count - span.first) {
      cursor.fail(ErrorCode::FileSyntax, "values of the property ", quoted(entry.name),
                  " lie outside of its ", count, " elements.");
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
      // Half-faces without a cell may have any values, even NaN.
      decodeOvmbPoints<Stored>(data, values, stage_);
    });
  }

  void decode(const Entry& entry, std::span<std::int32_t> values, const Subject& subject,
              ByteCursor& cursor) {
    const std::size_t begin = cursor.position();
    if (entry.type == kBits) {  // eight elements per byte, lowest bit first
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
      cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::FileUnsupported, "the property ",
                    quoted(entry.name), " has the value ", valueAt(fault),
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

OvmMesh parseOvmb(std::string_view bytes, const std::string& fileName, const CellKind& kind,
                  Stage& stage) {
  const OvmbFrame frame = splitOvmb(bytes, fileName);
  OvmMesh mesh(kind);
  readOvmbElements(frame, mesh, stage);
  PropertyReader reader(frame, mesh, stage);
  for (const OvmbChunk& chunk : frame.chunks) {
    if (chunk.type == "DIRP") reader.readDirectory(chunk.payload);
    if (chunk.type == "PROP") reader.readProperty(chunk.payload);
  }
  return mesh;
}

namespace {

// Writing.

// Elements written between checks for cancellation: a few milliseconds of work.
constexpr std::size_t kSlice = std::size_t{1} << 18;

/// The type of values in the property directory.
struct ElementType {
  std::string_view name;
  std::size_t bytes;
};
ElementType typeOf(const OvmProperty& property) {
  constexpr std::array<ElementType, 3> kTypes = {
      {{"i32", sizeof(std::int32_t)}, {"3d", sizeof(Vec3)}, {"2d", 2 * sizeof(double)}}};
  return kTypes[property.values.index()];
}

/// Views arrays of numbers as one range.
template <class Number, std::size_t n>
std::span<const Number> flat(std::span<const std::array<Number, n>> arrays) {
  return {reinterpret_cast<const Number*>(arrays.data()), n * arrays.size()};
}
std::span<const std::int32_t> flat(std::span<const std::int32_t> numbers) { return numbers; }

class OvmbWriter {
 public:
  OvmbWriter(const OvmOutput& mesh, OutputFile& output, Stage& stage)
      : mesh_(mesh),
        topology_(mesh.topology),
        output_(output),
        progress_(stage, mesh.points.size() + 2 * topology_.edges.size() +
                             topology_.faces.handles.size() + topology_.cells.handles.size()) {}

  void write() {
    writeHeader();
    writeDirectory();
    writeVertices();
    const std::span<const std::array<Index, 2>> edges(topology_.edges);
    writeTopology(OvmEntity::Edge, 2, {}, flat(edges), OvmEntity::Vertex);
    const OvmLists& faces = topology_.faces;
    const OvmLists& cells = topology_.cells;
    writeTopology(OvmEntity::Face, faces.length, faces.offsets, faces.handles, OvmEntity::HalfEdge);
    writeTopology(OvmEntity::Cell, cells.length, cells.offsets, cells.handles, OvmEntity::HalfFace);
    for (std::uint32_t i = 0; i < mesh_.properties.size(); ++i) writeProperty(i);
    writeChunk("EOF ", 0, [] {});
  }

 private:
  template <class T>
  void put(T value) {
    writeBytesOf(output_, value);
  }
  void putBytes(std::initializer_list<std::uint64_t> bytes) {
    for (const std::size_t byte : bytes) put(static_cast<std::uint8_t>(byte));
  }
  void putZeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) putBytes({0});
  }
  void putText(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    output_.write(text);
  }
  void putSpan(std::size_t count) {
    put(std::uint64_t{0});
    put(static_cast<std::uint32_t>(count));
  }

  /// Writes numbers converted to Stored.
  template <class Stored, class T>
  void putArray(std::span<const T> values) {
    constexpr bool kAsInMemory =
        std::is_same_v<Stored, T> && std::endian::native == std::endian::little;
    for (std::size_t begin = 0; begin < values.size(); begin += kSlice) {
      const std::span<const T> slice =
          values.subspan(begin, std::min(kSlice, values.size() - begin));
      if constexpr (kAsInMemory) {
        output_.writeBytes(slice.data(), slice.size_bytes());
      } else {
        for (const T value : slice) put(static_cast<Stored>(value));
      }
      progress_.advance(0);
    }
  }

  /// @param payload  the number of bytes that body() writes
  template <class Body>
  void writeChunk(std::string_view type, std::uint64_t payload, const Body& body) {
    const std::uint64_t padding = (8 - payload % 8) % 8;
    output_.write(type);
    putBytes({0, padding, 0, 1});  // version, padding, compression, mandatory
    put(payload + padding);
    body();
    putZeros(padding);
  }

  void writeHeader() {
    output_.write(kOvmbMagic);
    const std::size_t valence = topology_.cells.size() > 0 ? topology_.faces.length : 0;
    const bool tets = valence == 3;
    const bool hexes = valence == 4;
    putBytes({1, 1, 3, tets ? 1U : (hexes ? 2U : 0U)});  // versions of file and header, dimension
    put(std::uint32_t{0});
    for (const std::size_t count : {mesh_.points.size(), topology_.edges.size(),
                                    topology_.faces.size(), topology_.cells.size()}) {
      put(std::uint64_t{count});
    }
  }
  void writeDirectory() {
    if (mesh_.properties.empty()) return;
    constexpr std::size_t kEntryBytes = 13;  // an entity and three lengths
    std::uint64_t payload = 0;
    for (const OvmProperty& property : mesh_.properties) {
      const ElementType type = typeOf(property);
      payload += kEntryBytes + property.name.size() + type.name.size() + type.bytes;
    }
    writeChunk("DIRP", payload, [this] {
      for (const OvmProperty& property : mesh_.properties) {
        const ElementType type = typeOf(property);
        put(static_cast<std::uint8_t>(property.entity));
        putText(property.name);
        putText(type.name);
        put(static_cast<std::uint32_t>(type.bytes));
        putZeros(type.bytes);  // the default value
      }
    });
  }
  void writeVertices() {
    if (mesh_.points.empty()) return;
    constexpr std::size_t kHeaderBytes = 16;
    constexpr std::uint32_t kFloat64 = 2;
    writeChunk("VERT", kHeaderBytes + mesh_.points.size_bytes(), [this] {
      putSpan(mesh_.points.size());
      put(kFloat64);
      putArray<double>(flat(mesh_.points));
    });
    progress_.advance(mesh_.points.size());
  }

  /// @param offsets     of lists with different valences, which are at most 255; otherwise empty
  /// @param referenced  the kind of elements that handles refer to
  void writeTopology(OvmEntity entity, std::size_t valence, std::span<const std::uint64_t> offsets,
                     std::span<const Index> handles, OvmEntity referenced) {
    constexpr std::size_t kHeaderBytes = 24;
    const std::size_t count = topology_.count(entity);
    if (count == 0) return;
    // Like OpenVolumeMesh, choose the width by the number of elements, not by the largest handle.
    const std::size_t limit = topology_.count(referenced);
    const bool wide = mesh_.hasWideHandles || limit > std::numeric_limits<std::uint16_t>::max();
    const bool narrow = !wide && limit <= std::numeric_limits<std::uint8_t>::max();
    const std::size_t bytesEach = wide ? 4 : (narrow ? 1 : 2);
    const std::size_t varying = offsets.empty() ? 0 : count;
    writeChunk("TOPO", kHeaderBytes + varying + handles.size() * bytesEach, [&] {
      putSpan(count);
      const std::size_t bytesOfValence = varying > 0 ? 1 : 0;
      putBytes({static_cast<std::uint64_t>(entity), valence, bytesOfValence, bytesEach});
      put(std::uint64_t{0});  // OpenVolumeMesh misreads other offsets of edges
      for (std::size_t i = 0; i < varying; ++i) putBytes({offsets[i + 1] - offsets[i]});
      if (bytesEach == 1) putArray<std::uint8_t>(handles);
      if (bytesEach == 2) putArray<std::uint16_t>(handles);
      if (bytesEach == 4) putArray<std::uint32_t>(handles);
    });
    progress_.advance(handles.size());
  }
  void writeProperty(std::uint32_t number) {
    constexpr std::size_t kHeaderBytes = 16;
    std::visit(
        [&](const auto& values) {
          const auto numbers = flat(std::span(values));
          writeChunk("PROP", kHeaderBytes + numbers.size_bytes(), [&] {
            putSpan(values.size());
            put(number);
            putArray<typename decltype(numbers)::value_type>(numbers);
          });
        },
        mesh_.properties[number].values);
  }

  const OvmOutput& mesh_;
  const OvmTopology& topology_;
  OutputFile& output_;
  LoopProgress progress_;
};

}  // namespace

void writeOvmb(const OvmOutput& mesh, OutputFile& output, Stage& stage) {
  OvmbWriter(mesh, output, stage).write();
}

}  // namespace hexhex::io
