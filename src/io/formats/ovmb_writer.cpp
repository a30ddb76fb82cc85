// Writes `.ovmb` files (see ovm_mesh.hpp).
#include <algorithm>
#include <bit>
#include <initializer_list>
#include <limits>
#include <type_traits>

#include <io/core/line_writer.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

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
