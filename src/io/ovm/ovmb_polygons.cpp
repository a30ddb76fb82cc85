#include <bit>
#include <type_traits>

#include <io/core/bytes.hpp>
#include <io/ovm/ovmb_chunks.hpp>
#include <io/ovm/ovmb_polygons.hpp>

namespace hexhex {

namespace {

class PolygonWriter {
 public:
  PolygonWriter(const OvmbPolygons& content, OutputFile& output, Stage& stage)
      : content_(content), output_(output), progress_(stage, 4) {}

  void write() {
    writeHeader();
    writeDirectory();
    writeVertices();
    progress_.advance(1);
    writeEdges();
    progress_.advance(1);
    writeFaces();
    progress_.advance(1);
    for (std::uint32_t i = 0; i < content_.properties.size(); ++i) writeProperty(i);
    beginChunk("EOF ", 0);
    progress_.advance(1);
    output_.commit();
  }

 private:
  template <class T>
  void put(T value) {
    const auto bytes = littleBytes(value);
    output_.writeBytes(bytes.data(), bytes.size());
  }
  template <class T>
  void putAll(const std::vector<T>& values) {
    if constexpr (std::endian::native == std::endian::little) {
      output_.writeBytes(values.data(), values.size() * sizeof(T));
    } else if constexpr (std::is_arithmetic_v<T>) {
      for (const T value : values) put(value);
    } else {
      for (const T& value : values) {
        for (const auto number : value) put(number);
      }
    }
  }
  void putText(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    output_.write(text);
  }
  void putZeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) output_.write('\0');
  }
  static std::uint8_t paddingOf(std::uint64_t payload) {
    return static_cast<std::uint8_t>((8 - payload % 8) % 8);
  }
  void beginChunk(std::string_view type, std::uint64_t payload) {
    output_.write(type);
    for (const std::uint8_t byte : {std::uint8_t{0}, paddingOf(payload), std::uint8_t{0},
                                    std::uint8_t{1}}) {  // version, padding, compression, flags
      put(byte);
    }
    put(payload + paddingOf(payload));
  }
  void putSpan(std::size_t count) {
    put(std::uint64_t{0});
    put(static_cast<std::uint32_t>(count));
  }

  void writeHeader() {
    output_.write(kOvmbMagic);
    constexpr std::array<std::uint8_t, 4> kKind = {1, 1, 3, 0};  // versions, dimension, polyhedral
    for (const std::uint8_t byte : kKind) put(byte);
    put(std::uint32_t{0});
    for (const std::size_t count : {content_.points.size(), content_.edges.size(),
                                    content_.valences.size(), std::size_t{0}}) {
      put(std::uint64_t{count});
    }
  }

  static std::string_view typeOf(const OvmbProperty& property) {
    return property.isPair() ? "2d" : "i32";
  }

  void writeDirectory() {
    constexpr std::size_t kEntryBytes = 13;  // an entity and three lengths
    std::uint64_t payload = 0;
    for (const OvmbProperty& property : content_.properties) {
      payload +=
          kEntryBytes + property.name.size() + typeOf(property).size() + property.bytesEach();
    }
    beginChunk("DIRP", payload);
    for (const OvmbProperty& property : content_.properties) {
      put(property.entity);
      putText(property.name);
      putText(typeOf(property));
      put(static_cast<std::uint32_t>(property.bytesEach()));
      putZeros(property.bytesEach());
    }
    putZeros(paddingOf(payload));
  }

  void writeVertices() {
    constexpr std::uint32_t kFloat64 = 2;
    const std::uint64_t payload = 16 + content_.points.size() * sizeof(Vec3);
    beginChunk("VERT", payload);
    putSpan(content_.points.size());
    put(kFloat64);
    putAll(content_.points);
    putZeros(paddingOf(payload));
  }

  void beginTopology(std::uint64_t payload, std::uint8_t entity, std::size_t count,
                     std::uint8_t valence, std::uint8_t valenceBytes) {
    beginChunk("TOPO", payload);
    putSpan(count);
    put(entity);
    put(valence);
    put(valenceBytes);
    put(std::uint8_t{4});  // bytes of a handle
    put(std::uint64_t{0});
  }

  void writeEdges() {
    const std::uint64_t payload = 24 + content_.edges.size() * 2 * sizeof(Index);
    beginTopology(payload, 1, content_.edges.size(), 2, 0);
    putAll(content_.edges);
    putZeros(paddingOf(payload));
  }

  void writeFaces() {
    if (content_.valences.empty()) return;
    const std::uint64_t payload =
        24 + content_.valences.size() + content_.halfEdges.size() * sizeof(Index);
    beginTopology(payload, 2, content_.valences.size(), 0, 1);
    putAll(content_.valences);
    putAll(content_.halfEdges);
    putZeros(paddingOf(payload));
  }

  void writeProperty(std::uint32_t number) {
    const OvmbProperty& property = content_.properties[number];
    const std::uint64_t payload = 16 + property.count() * property.bytesEach();
    beginChunk("PROP", payload);
    putSpan(property.count());
    put(number);
    if (property.isPair()) {
      putAll(property.pairs);
    } else {
      putAll(property.integers);
    }
    putZeros(paddingOf(payload));
  }

  const OvmbPolygons& content_;
  OutputFile& output_;
  LoopProgress progress_;
};

}  // namespace

void writeOvmbPolygons(const OvmbPolygons& mesh, OutputFile& output, Stage& stage) {
  PolygonWriter(mesh, output, stage).write();
}

}  // namespace hexhex
