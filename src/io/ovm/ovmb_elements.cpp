#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <base/parallel.hpp>
#include <io/ovm/ovmb_elements.hpp>

namespace hexhex {
namespace {

/// One and many of vertices, edges, faces, cells, in the order of the file header.
struct ElementName {
  const char* one;
  const char* many;
};
constexpr std::array<ElementName, 4> kElements = {
    {{"a vertex", "vertices"}, {"an edge", "edges"}, {"a face", "faces"}, {"a cell", "cells"}}};

/// Adds the elements of one chunk after the other to a mesh.
class ElementReader {
 public:
  ElementReader(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage)
      : frame_(frame), mesh_(mesh), stage_(stage) {}

  void readVertices(std::string_view payload);
  void readTopology(std::string_view payload);
  void requireAll() const;

 private:
  OvmbSpan readNextSpan(ByteCursor& cursor, std::size_t entity);
  template <class Stored>
  void decodePoints(ByteCursor& cursor, const OvmbSpan& span);
  void readEdges(ByteCursor& cursor, std::uint64_t count);
  void readLists(ByteCursor& cursor, std::uint64_t count, std::size_t entity);
  template <class Stored>
  [[nodiscard]] bool decodeAll(const char* data, std::span<Index> handles, Index offset,
                               std::uint64_t room);
  template <class Stored>
  void decodeHandles(ByteCursor& cursor, std::span<Index> handles, std::size_t entity);
  void readHandles(ByteCursor& cursor, std::span<Index> handles, std::size_t entity);

  /// The second half of the header of a TOPO chunk.
  struct Encoding {
    std::uint8_t valence = 0;       ///< 0: varies
    std::uint8_t valenceBytes = 0;  ///< if it varies
    std::uint8_t handleBytes = 0;
    std::uint64_t handleOffset = 0;
  };
  static Encoding readEncoding(ByteCursor& cursor, std::uint8_t valence);
  template <class Stored>
  void decodeValences(ByteCursor& cursor, std::size_t entity);
  void requireValences(ByteCursor& cursor, std::uint64_t count, std::size_t entity) const;
  void readValences(ByteCursor& cursor, std::uint64_t count, std::size_t entity);

  const OvmbFrame& frame_;
  OvmMesh& mesh_;
  Stage& stage_;
  std::array<std::uint64_t, 4> done_{};
  Encoding encoding_;
  Array<std::uint32_t> valences_;  ///< of the chunk that is being read
};

/// Spans of one kind of element follow each other without gaps.
OvmbSpan ElementReader::readNextSpan(ByteCursor& cursor, std::size_t entity) {
  const std::size_t position = cursor.position();
  const OvmbSpan span = readOvmbSpan(cursor);
  if (span.first != done_[entity]) {
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "expected " + std::string(kElements[entity].many) + " from number " +
                      std::to_string(done_[entity]) + " on, found number " +
                      std::to_string(span.first) + ".");
  }
  if (span.count > frame_.counts[entity] - span.first) {
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "there are more " + std::string(kElements[entity].many) + " than the " +
                      std::to_string(frame_.counts[entity]) + " that the file header announces.");
  }
  done_[entity] += span.count;
  return span;
}

template <class Stored>
void ElementReader::decodePoints(ByteCursor& cursor, const OvmbSpan& span) {
  const std::size_t begin = cursor.position();
  const char* const data = cursor.take(span.count * 3 * sizeof(Stored), "a VERT chunk").data();
  mesh_.points.resize(static_cast<std::size_t>(span.first + span.count));
  Vec3* const points = mesh_.points.data() + span.first;
  const std::size_t fault =
      firstFault(stage_, static_cast<std::size_t>(span.count), [&](std::size_t i) {
        bool finite = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const double value{loadLittle<Stored>(data + (3 * i + k) * sizeof(Stored))};
          points[i][k] = value;
          finite = finite && std::isfinite(value);
        }
        return finite;
      });
  if (fault == span.count) return;
  const std::uint64_t vertex = span.first + fault;
  cursor.failAt(begin + 3 * fault * sizeof(Stored), ErrorCode::NotFinite,
                "a coordinate of vertex " + std::to_string(vertex) + " is not finite.",
                Place{PlaceKind::Vertex, vertex});
}

void ElementReader::readVertices(std::string_view payload) {
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

ElementReader::Encoding ElementReader::readEncoding(ByteCursor& cursor, std::uint8_t valence) {
  const std::size_t position = cursor.position();
  Encoding encoding;
  encoding.valence = valence;
  encoding.valenceBytes = cursor.read<std::uint8_t>("the header of a TOPO chunk");
  encoding.handleBytes = cursor.read<std::uint8_t>("the header of a TOPO chunk");
  encoding.handleOffset = cursor.read<std::uint64_t>("the header of a TOPO chunk");
  const auto isWidth = [](std::uint8_t bytes) { return bytes == 1 || bytes == 2 || bytes == 4; };
  const bool goodValences =
      valence > 0 ? encoding.valenceBytes == 0 : isWidth(encoding.valenceBytes);
  if (!goodValences || !isWidth(encoding.handleBytes)) {
    cursor.failAt(position, ErrorCode::FileSyntax,
                  "the encoding of valences must be 1, 2 or 4 if they vary, else 0, and that of "
                  "handles 1, 2 or 4.");
  }
  return encoding;
}

void ElementReader::readTopology(std::string_view payload) {
  ByteCursor cursor = frame_.cursor(payload);
  ByteCursor ahead = cursor;
  static_cast<void>(readOvmbSpan(ahead));
  const std::size_t position = ahead.position();
  const std::size_t entity = ahead.read<std::uint8_t>("the header of a TOPO chunk");
  if (entity < 1 || entity > 3) {
    ahead.failAt(position, ErrorCode::FileSyntax,
                 "a TOPO chunk must be about edges (1), faces (2) or cells (3), found " +
                     std::to_string(entity) + ".");
  }
  const OvmbSpan span = readNextSpan(cursor, entity);
  static_cast<void>(cursor.read<std::uint8_t>("the header of a TOPO chunk"));
  const auto valence = cursor.read<std::uint8_t>("the header of a TOPO chunk");
  encoding_ = readEncoding(cursor, valence);
  if (span.count == 0) cursor.failAt(position, ErrorCode::FileSyntax, "a TOPO chunk is empty.");
  if (entity == 1) {
    readEdges(cursor, span.count);
  } else {
    readLists(cursor, span.count, entity);
  }
  if (cursor.remaining() > 0) {
    cursor.fail(ErrorCode::FileSyntax,
                "the TOPO chunk is longer than its " + std::string(kElements[entity].many) + ".");
  }
}

void ElementReader::readEdges(ByteCursor& cursor, std::uint64_t count) {
  if (encoding_.valence != 2) {
    cursor.fail(ErrorCode::FileSyntax,
                "edges must have the valence 2, found " + std::to_string(encoding_.valence) + ".");
  }
  if (cursor.remaining() != 2 * count * encoding_.handleBytes) {
    cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its edges.");
  }
  Array<std::array<Index, 2>>& edges = mesh_.topology.edges;
  const std::size_t before = edges.size();
  edges.resize(before + static_cast<std::size_t>(count));
  // Pairs of numbers are numbers one after the other.
  auto* const first = reinterpret_cast<Index*>(edges.data() + before);
  readHandles(cursor, {first, static_cast<std::size_t>(2 * count)}, 1);
}

/// Fewer half-edges or half-faces enclose nothing.
std::uint32_t leastValence(std::size_t entity) { return entity == 2 ? 3 : 4; }

template <class Stored>
void ElementReader::decodeValences(ByteCursor& cursor, std::size_t entity) {
  const std::uint32_t least = leastValence(entity);
  const std::size_t begin = cursor.position();
  const char* const data = cursor.take(valences_.size() * sizeof(Stored), "the valences").data();
  const std::size_t fault = firstFault(stage_, valences_.size(), [&](std::size_t i) {
    valences_[i] = loadLittle<Stored>(data + i * sizeof(Stored));
    return valences_[i] >= least;
  });
  if (fault == valences_.size()) return;
  cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::FileSyntax,
                std::string(kElements[entity].one) + " has the valence " +
                    std::to_string(valences_[fault]) + "; at least " + std::to_string(least) +
                    " is needed.");
}

/// Throws unless a chunk can have so many elements of its valence.
void ElementReader::requireValences(ByteCursor& cursor, std::uint64_t count,
                                    std::size_t entity) const {
  if (count * std::max(encoding_.valence, encoding_.valenceBytes) > cursor.remaining()) {
    cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk is too short for its " +
                                           std::to_string(count) + " " + kElements[entity].many +
                                           ".");
  }
  if (encoding_.valence > 0 && encoding_.valence < leastValence(entity)) {
    cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has " + std::string(kElements[entity].many) +
                                           " of valence " + std::to_string(encoding_.valence) +
                                           ".");
  }
}

/// Reads or repeats the valences of a chunk.
void ElementReader::readValences(ByteCursor& cursor, std::uint64_t count, std::size_t entity) {
  if (encoding_.valence > 0) {
    return valences_.assign(static_cast<std::size_t>(count), encoding_.valence);
  }
  valences_.resize(static_cast<std::size_t>(count));
  if (encoding_.valenceBytes == 1) decodeValences<std::uint8_t>(cursor, entity);
  if (encoding_.valenceBytes == 2) decodeValences<std::uint16_t>(cursor, entity);
  if (encoding_.valenceBytes == 4) decodeValences<std::uint32_t>(cursor, entity);
}

/// Appends room for so many lists of this length, and returns it; nothing if the lists before are
/// of other lengths.
std::span<Index> appendEqualLists(OvmLists& lists, std::size_t count, std::uint32_t length) {
  if (lists.size() == 0) lists.length = length;
  if (lists.length != length) return {};
  const std::size_t handlesBefore = lists.handles.size();
  lists.handles.resize(handlesBefore + count * length);
  return std::span(lists.handles).subspan(handlesBefore);
}

/// Appends room for lists of these lengths, and returns it.
std::span<Index> appendLists(OvmLists& lists, const Array<std::uint32_t>& lengths) {
  const bool uniform = std::all_of(lengths.begin(), lengths.end(),
                                   [&](std::uint32_t length) { return length == lengths[0]; });
  if (uniform) {
    const std::span<Index> room = appendEqualLists(lists, lengths.size(), lengths[0]);
    if (!room.empty()) return room;
  }
  const std::size_t before = lists.size();
  const std::size_t handlesBefore = lists.handles.size();
  if (lists.offsets.empty()) {
    for (std::size_t i = 0; i <= before; ++i) lists.offsets.push_back(i * lists.length);
    lists.length = 0;
  }
  for (const std::uint32_t length : lengths) {
    lists.offsets.push_back(lists.offsets.back() + length);
  }
  lists.handles.resize(static_cast<std::size_t>(lists.offsets.back()));
  return std::span(lists.handles).subspan(handlesBefore);
}

void ElementReader::readLists(ByteCursor& cursor, std::uint64_t count, std::size_t entity) {
  requireValences(cursor, count, entity);
  OvmLists& lists = entity == 2 ? mesh_.topology.faces : mesh_.topology.cells;
  if (encoding_.valence > 0 &&
      cursor.remaining() == count * encoding_.valence * encoding_.handleBytes) {
    const std::span<Index> room =
        appendEqualLists(lists, static_cast<std::size_t>(count), encoding_.valence);
    if (!room.empty()) return readHandles(cursor, room, entity);
  }
  readValences(cursor, count, entity);
  std::uint64_t handles = 0;
  for (const std::uint32_t valence : valences_) handles += valence;
  // The first comparison keeps the product from overflowing.
  if (handles > cursor.remaining() || cursor.remaining() != handles * encoding_.handleBytes) {
    cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its " +
                                           std::string(kElements[entity].many) + ".");
  }
  readHandles(cursor, appendLists(lists, valences_), entity);
}

void ElementReader::readHandles(ByteCursor& cursor, std::span<Index> handles, std::size_t entity) {
  if (encoding_.handleBytes == 1) decodeHandles<std::uint8_t>(cursor, handles, entity);
  if (encoding_.handleBytes == 2) decodeHandles<std::uint16_t>(cursor, handles, entity);
  if (encoding_.handleBytes == 4) decodeHandles<std::uint32_t>(cursor, handles, entity);
}

/// Without a look at single ones, so that processors decode several at once.
/// @return whether all stored numbers are below `room`
template <class Stored>
bool ElementReader::decodeAll(const char* data, std::span<Index> handles, Index offset,
                              std::uint64_t room) {
  constexpr std::uint64_t kMost = std::numeric_limits<Stored>::max();
  if (room == 0 && !handles.empty()) return false;
  const auto largest = static_cast<Stored>(std::min(room - 1, kMost));
  std::atomic<bool> good{true};
  constexpr std::size_t kGrain = 16384;
  parallelBlocks(stage_, handles.size(), kGrain,
                 [&](std::size_t first, std::size_t end, std::size_t /*block*/) {
                   Index* const decoded = handles.data();
                   const Index added = offset;
                   const Stored most = largest;
                   Index tooLarge = 0;
                   for (std::size_t i = first; i < end; ++i) {
                     const auto stored = loadLittle<Stored>(data + i * sizeof(Stored));
                     decoded[i] = stored + added;
                     tooLarge |= stored > most ? 1U : 0U;
                   }
                   if (tooLarge != 0) good.store(false, std::memory_order_relaxed);
                 });
  return good;
}

template <class Stored>
void ElementReader::decodeHandles(ByteCursor& cursor, std::span<Index> handles,
                                  std::size_t entity) {
  constexpr std::array<const char*, 4> kNamed = {"", "vertex", "half-edge", "half-face"};
  const std::uint64_t limit = (entity == 1 ? 1U : 2U) * frame_.counts[entity - 1];
  const std::uint64_t offset = encoding_.handleOffset;
  const std::uint64_t room = limit - std::min(limit, offset);
  const std::size_t begin = cursor.position();
  const char* const data = cursor.take(handles.size() * sizeof(Stored), "the handles").data();
  if (decodeAll<Stored>(data, handles, static_cast<Index>(offset), room)) return;
  const std::size_t fault = firstFault(stage_, handles.size(), [&](std::size_t i) {
    return loadLittle<Stored>(data + i * sizeof(Stored)) < room;
  });
  const std::uint64_t stored{loadLittle<Stored>(data + fault * sizeof(Stored))};
  cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::IndexOutOfRange,
                std::string(kElements[entity].one) + " names " + kNamed[entity] + " " +
                    std::to_string(stored) + " + " + std::to_string(offset) + ", but there are " +
                    std::to_string(limit) + ", numbered from 0.");
}

void ElementReader::requireAll() const {
  for (std::size_t entity = 0; entity < 4; ++entity) {
    if (done_[entity] == frame_.counts[entity]) continue;
    throw Error(ErrorCode::FileSyntax, frame_.fileName + ": the file header announces " +
                                           std::to_string(frame_.counts[entity]) + " " +
                                           kElements[entity].many + ", but the file holds " +
                                           std::to_string(done_[entity]) + ".");
  }
}

}  // namespace

OvmbSpan readOvmbSpan(ByteCursor& cursor) {
  OvmbSpan span;
  span.first = cursor.read<std::uint64_t>("a span of elements");
  span.count = cursor.read<std::uint32_t>("a span of elements");
  return span;
}

void readOvmbElements(const OvmbFrame& frame, OvmMesh& mesh, Stage& stage) {
  ElementReader reader(frame, mesh, stage);
  for (const OvmbChunk& chunk : frame.chunks) {
    if (chunk.type == OvmbChunkType::Vertices) reader.readVertices(chunk.payload);
    if (chunk.type == OvmbChunkType::Topology) reader.readTopology(chunk.payload);
  }
  reader.requireAll();
  mesh.topology.vertexCount = mesh.points.size();
}

}  // namespace hexhex
