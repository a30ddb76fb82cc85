// Vertices, edges, faces and cells of an `.ovmb` file (see ovmb_reader.hpp).
#include <algorithm>
#include <atomic>
#include <functional>
#include <numeric>

#include <base/parallel.hpp>
#include <io/ovm/ovmb_reader.hpp>

namespace hexhex::io {
namespace {

// Numbers of the four kinds of elements, in file headers and TOPO chunks.
constexpr std::size_t kEdges = 1;
constexpr std::size_t kFaces = 2;
constexpr std::size_t kCells = 3;

/// "an edge"
std::string anyOf(std::size_t entity) {
  return (entity == kEdges ? "an " : "a ") + std::string(kOvmElements[entity].one);
}

/// Calls f with a number of the width that a file has.
template <class F>
void withWidth(std::uint8_t bytes, const F& f) {
  if (bytes == 1) f(std::uint8_t{});
  if (bytes == 2) f(std::uint16_t{});
  if (bytes == 4) f(std::uint32_t{});
}

/// Adds the elements of one chunk after the other to a mesh.
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
                    "a TOPO chunk must be about edges (1), faces (2) or cells (3), found " +
                        std::to_string(entity) + ".");
    }
    const auto count = static_cast<std::size_t>(readNextSpan(span, entity).count);
    readEncoding(cursor);
    if (count == 0) cursor.failAt(position, ErrorCode::FileSyntax, "a TOPO chunk is empty.");
    const std::span<Index> handles =
        entity == kEdges ? readEdges(cursor, count) : readLists(cursor, count, entity);
    withWidth(encoding_.handleBytes, [&]<class Stored>(Stored /*width*/) {
      decodeHandles<Stored>(cursor, handles, entity);
    });
  }

  void requireAll() const {
    for (std::size_t entity = 0; entity < 4; ++entity) {
      if (done_[entity] == frame_.counts[entity]) continue;
      throw Error(ErrorCode::FileSyntax, frame_.fileName + ": the file header announces " +
                                             std::to_string(frame_.counts[entity]) + " " +
                                             kOvmElements[entity].many + ", but the file holds " +
                                             std::to_string(done_[entity]) + ".");
    }
  }

 private:
  /// Spans of one kind of element follow each other without gaps.
  OvmbSpan readNextSpan(ByteCursor& cursor, std::size_t entity) {
    const std::size_t position = cursor.position();
    const OvmbSpan span = readOvmbSpan(cursor);
    const std::string many = kOvmElements[entity].many;
    if (span.first != done_[entity]) {
      cursor.failAt(position, ErrorCode::FileSyntax,
                    "expected " + many + " from number " + std::to_string(done_[entity]) +
                        " on, found number " + std::to_string(span.first) + ".");
    }
    if (span.count > frame_.counts[entity] - span.first) {
      cursor.failAt(position, ErrorCode::FileSyntax,
                    "there are more " + many + " than the " +
                        std::to_string(frame_.counts[entity]) + " that the file header announces.");
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
                  "a coordinate of vertex " + std::to_string(vertex) + " is not finite.",
                  Place{PlaceKind::Vertex, vertex});
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

  /// @return room for the handles, of which the rest of the chunk has as many, as below
  std::span<Index> readEdges(const ByteCursor& cursor, std::size_t count) {
    if (encoding_.valence != 2) {
      cursor.fail(ErrorCode::FileSyntax, "edges must have the valence 2, found " +
                                             std::to_string(encoding_.valence) + ".");
    }
    if (cursor.remaining() != 2 * count * encoding_.handleBytes) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its edges.");
    }
    Array<std::array<Index, 2>>& edges = mesh_.topology.edges;
    edges.resize(edges.size() + count);
    // Pairs of numbers are numbers one after the other.
    return {reinterpret_cast<Index*>(edges.data() + edges.size() - count), 2 * count};
  }

  std::span<Index> readLists(ByteCursor& cursor, std::size_t count, std::size_t entity) {
    const std::string many = kOvmElements[entity].many;
    if (count * std::max(encoding_.valence, encoding_.valenceBytes) > cursor.remaining()) {
      cursor.fail(ErrorCode::FileSyntax,
                  "a TOPO chunk is too short for its " + std::to_string(count) + " " + many + ".");
    }
    if (encoding_.valence > 0 && encoding_.valence < kOvmElements[entity].leastValence) {
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has " + many + " of valence " +
                                             std::to_string(encoding_.valence) + ".");
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
      cursor.fail(ErrorCode::FileSyntax, "a TOPO chunk has the wrong size for its " + many + ".");
    }
    return appendLists(entity == kFaces ? mesh_.topology.faces : mesh_.topology.cells, count,
                       static_cast<std::size_t>(handles));
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
    cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::FileSyntax,
                  anyOf(entity) + " has the valence " + std::to_string(valences_[fault]) +
                      "; at least " + std::to_string(least) + " is needed.");
  }

  /// Appends lists with so many handles in total, and returns the room for them.
  std::span<Index> appendLists(OvmLists& lists, std::size_t count, std::size_t handles) const {
    const bool uniform =
        encoding_.valence > 0 || std::adjacent_find(valences_.begin(), valences_.end(),
                                                    std::not_equal_to<>()) == valences_.end();
    const std::size_t length = uniform ? handles / count : 0;
    const std::size_t before = lists.size();
    if (before == 0) lists.length = length;
    if (length == 0 || lists.length != length) {  // from now on, lists have lengths of their own
      if (lists.offsets.empty()) {
        for (std::size_t i = 0; i <= before; ++i) lists.offsets.push_back(i * lists.length);
        lists.length = 0;
      }
      for (std::size_t i = 0; i < count; ++i) {
        lists.offsets.push_back(lists.offsets.back() + (uniform ? length : valences_[i]));
      }
    }
    lists.handles.resize(lists.handles.size() + handles);
    return std::span(lists.handles).last(handles);
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
                     // Only the largest is compared, so that compilers decode several at once:
                     // else, reading a hex mesh takes a fifth longer.
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
    cursor.failAt(begin + fault * sizeof(Stored), ErrorCode::IndexOutOfRange,
                  anyOf(entity) + " names " + kOvmElements[entity].parts + " " +
                      std::to_string(stored) + " + " + std::to_string(offset) + ", but there are " +
                      std::to_string(limit) + ", numbered from 0.");
  }

  static constexpr std::size_t kGrain = 16384;

  const OvmbFrame& frame_;
  OvmMesh& mesh_;
  Stage& stage_;
  std::array<std::uint64_t, 4> done_{};
  // Of the chunk that is being read, the second half of its header:
  struct {
    std::uint8_t valence = 0;       ///< 0: varies
    std::uint8_t valenceBytes = 0;  ///< if it varies
    std::uint8_t handleBytes = 0;
    std::uint64_t handleOffset = 0;
  } encoding_;
  Array<std::uint32_t> valences_;  ///< if they vary
};

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
    if (chunk.type == "VERT") reader.readVertices(chunk.payload);
    if (chunk.type == "TOPO") reader.readTopology(chunk.payload);
  }
  reader.requireAll();
  mesh.topology.vertexCount = mesh.points.size();
}

}  // namespace hexhex::io
