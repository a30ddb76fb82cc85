// The binary half of ovm_output.hpp's writers.
#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/ovm/ovm_output.hpp>
#include <io/ovm/ovmb_chunks.hpp>

namespace hexhex {
namespace {

// What is written between two looks at the caller's wish to cancel: some milliseconds' work.
constexpr std::size_t kSlice = std::size_t{1} << 18;

constexpr std::size_t kVerticesHeaderBytes = 16;
constexpr std::size_t kTopologyHeaderBytes = 24;
constexpr std::size_t kPropertyHeaderBytes = 16;

/// How many bytes OpenVolumeMesh takes for handles of so many things.
std::size_t handleBytes(std::size_t count) {
  if (count <= std::numeric_limits<std::uint8_t>::max()) return 1;
  return count <= std::numeric_limits<std::uint16_t>::max() ? 2 : 4;
}

class OvmbWriter {
 public:
  OvmbWriter(const OvmOutput& mesh, OutputFile& output, Stage& stage)
      : mesh_(mesh),
        topology_(mesh.topology),
        output_(output),
        progress_(stage, mesh.points.size() + 2 * topology_.edges.size() +
                             topology_.faces.handles.size() + topology_.cells.handles.size()) {}

  void write();

 private:
  template <class T>
  void put(T value) {
    const auto bytes = littleBytes(value);
    output_.writeBytes(bytes.data(), bytes.size());
  }
  void putText(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    output_.write(text);
  }
  void putZeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) output_.write('\0');
  }
  /// Numbers one after the other, as Stored.
  template <class Stored, class T>
  void putArray(std::span<const T> values);
  void putHandles(std::span<const Index> handles, std::size_t bytesEach);

  void beginChunk(std::string_view type, std::uint64_t payload);
  void endChunk(std::uint64_t payload) { putZeros(paddingOf(payload)); }
  static std::uint8_t paddingOf(std::uint64_t payload) {
    return static_cast<std::uint8_t>((8 - payload % 8) % 8);
  }
  void putSpan(std::size_t count);

  void writeHeader();
  void writeDirectory(const std::vector<OvmPropertyValues>& properties);
  void writeVertices();
  void writeTopology(std::uint8_t entity, std::size_t count, std::size_t valence,
                     std::span<const Index> handles, std::size_t referenced);
  void writeProperty(const OvmPropertyValues& property, std::uint32_t number);

  const OvmOutput& mesh_;
  const OvmTopology& topology_;
  OutputFile& output_;
  LoopProgress progress_;
};

template <class Stored, class T>
void OvmbWriter::putArray(std::span<const T> values) {
  constexpr bool kAsInMemory =
      std::is_same_v<Stored, T> && std::endian::native == std::endian::little;
  for (std::size_t begin = 0; begin < values.size(); begin += kSlice) {
    const std::span<const T> slice = values.subspan(begin, std::min(kSlice, values.size() - begin));
    if constexpr (kAsInMemory) {
      output_.writeBytes(slice.data(), slice.size_bytes());
    } else {
      for (const T value : slice) put(static_cast<Stored>(value));
    }
    progress_.advance(0);
  }
}

void OvmbWriter::putHandles(std::span<const Index> handles, std::size_t bytesEach) {
  if (bytesEach == 1) putArray<std::uint8_t>(handles);
  if (bytesEach == 2) putArray<std::uint16_t>(handles);
  if (bytesEach == 4) putArray<std::uint32_t>(handles);
  progress_.advance(handles.size());
}

void OvmbWriter::beginChunk(std::string_view type, std::uint64_t payload) {
  constexpr std::uint8_t kMandatory = 1;
  output_.write(type);
  put(std::uint8_t{0});  // version
  put(paddingOf(payload));
  put(std::uint8_t{0});  // compression
  put(kMandatory);
  put(payload + paddingOf(payload));
}

void OvmbWriter::putSpan(std::size_t count) {
  put(std::uint64_t{0});
  put(static_cast<std::uint32_t>(count));
}

void OvmbWriter::writeHeader() {
  output_.write(kOvmbMagic);
  put(std::uint8_t{1});  // version of the file
  put(std::uint8_t{1});  // version of the header
  put(std::uint8_t{3});  // dimension
  const bool tets = topology_.faces.length == 3 && topology_.cells.size() > 0;
  const bool hexes = topology_.faces.length == 4 && topology_.cells.size() > 0;
  put(static_cast<std::uint8_t>(tets ? 1 : (hexes ? 2 : 0)));
  put(std::uint32_t{0});
  for (const std::size_t count : {mesh_.points.size(), topology_.edges.size(),
                                  topology_.faces.size(), topology_.cells.size()}) {
    put(std::uint64_t{count});
  }
}

void OvmbWriter::writeDirectory(const std::vector<OvmPropertyValues>& properties) {
  if (properties.empty()) return;
  const auto defaultBytes = [](const OvmPropertyValues& property) {
    return property.points != nullptr ? sizeof(Vec3) : sizeof(std::int32_t);
  };
  const auto typeName = [](const OvmPropertyValues& property) {
    return std::string_view(property.points != nullptr ? "3d" : "i32");
  };
  constexpr std::size_t kEntryBytes = 13;  // an entity and three lengths
  std::uint64_t payload = 0;
  for (const OvmPropertyValues& property : properties) {
    payload +=
        kEntryBytes + property.name.size() + typeName(property).size() + defaultBytes(property);
  }
  beginChunk("DIRP", payload);
  for (const OvmPropertyValues& property : properties) {
    put(static_cast<std::uint8_t>(property.entity));
    putText(property.name);
    putText(typeName(property));
    put(static_cast<std::uint32_t>(defaultBytes(property)));
    putZeros(defaultBytes(property));
  }
  endChunk(payload);
}

/// The coordinates of points, one after the other.
std::span<const double> coordinatesOf(std::span<const Vec3> points) {
  return {reinterpret_cast<const double*>(points.data()), 3 * points.size()};
}

void OvmbWriter::writeVertices() {
  if (mesh_.points.empty()) return;
  constexpr std::uint32_t kFloat64 = 2;
  const std::uint64_t payload = kVerticesHeaderBytes + mesh_.points.size_bytes();
  beginChunk("VERT", payload);
  putSpan(mesh_.points.size());
  put(kFloat64);
  putArray<double>(coordinatesOf(mesh_.points));
  endChunk(payload);
  progress_.advance(mesh_.points.size());
}

void OvmbWriter::writeTopology(std::uint8_t entity, std::size_t count, std::size_t valence,
                               std::span<const Index> handles, std::size_t referenced) {
  if (count == 0) return;
  const std::size_t bytesEach = handleBytes(referenced);
  const std::uint64_t payload = kTopologyHeaderBytes + handles.size() * bytesEach;
  beginChunk("TOPO", payload);
  putSpan(count);
  put(entity);
  put(static_cast<std::uint8_t>(valence));
  put(std::uint8_t{0});  // valences do not vary
  put(static_cast<std::uint8_t>(bytesEach));
  put(std::uint64_t{0});  // OpenVolumeMesh misreads other offsets of edges
  putHandles(handles, bytesEach);
  endChunk(payload);
}

void OvmbWriter::writeProperty(const OvmPropertyValues& property, std::uint32_t number) {
  const bool points = property.points != nullptr;
  const std::size_t count = points ? property.points->size() : property.integers->size();
  const std::uint64_t payload =
      kPropertyHeaderBytes + count * (points ? sizeof(Vec3) : sizeof(std::int32_t));
  beginChunk("PROP", payload);
  putSpan(count);
  put(number);
  if (points) {
    putArray<double>(coordinatesOf(*property.points));
  } else {
    putArray<std::int32_t>(std::span<const std::int32_t>(*property.integers));
  }
  endChunk(payload);
}

void OvmbWriter::write() {
  const std::vector<OvmPropertyValues> properties = listProperties(mesh_.properties);
  writeHeader();
  writeDirectory(properties);
  writeVertices();
  const std::span<const Index> edgeEnds(reinterpret_cast<const Index*>(topology_.edges.data()),
                                        2 * topology_.edges.size());
  writeTopology(1, topology_.edges.size(), 2, edgeEnds, mesh_.points.size());
  writeTopology(2, topology_.faces.size(), topology_.faces.length, topology_.faces.handles,
                2 * topology_.edges.size());
  writeTopology(3, topology_.cells.size(), topology_.cells.length, topology_.cells.handles,
                2 * topology_.faces.size());
  for (std::uint32_t i = 0; i < properties.size(); ++i) writeProperty(properties[i], i);
  beginChunk("EOF ", 0);
  output_.commit();
}

}  // namespace

std::vector<OvmPropertyValues> listProperties(const OvmProperties& properties) {
  std::vector<OvmPropertyValues> list;
  for (std::size_t i = 0; i < kOvmIntegers.size(); ++i) {
    if (i == static_cast<std::size_t>(OvmInteger::Transition) &&
        !properties.parametrization.empty()) {
      list.push_back(
          {OvmEntity::HalfFace, kParametrizationName, &properties.parametrization, nullptr});
    }
    if (properties.integers[i].empty()) continue;
    list.push_back(
        {kOvmIntegers[i].entity, kOvmIntegers[i].name, nullptr, &properties.integers[i]});
  }
  return list;
}

void writeOvmbFile(const OvmOutput& mesh, OutputFile& output, Stage& stage) {
  OvmbWriter(mesh, output, stage).write();
}

}  // namespace hexhex
