#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <base/stage.hpp>
#include <io/output_file.hpp>
#include <io/ovmb_bytes.hpp>
#include <io/ovmb_chunks.hpp>
#include <io/piecewise_ovmb.hpp>

namespace hexhex {

namespace {

using UV = std::array<double, 2>;
using EdgeEnds = std::array<Index, 2>;

/// Values of one property.
struct Property {
  std::uint8_t entity;  ///< 0 vertex, 1 edge, 2 face
  std::string_view name;
  std::vector<std::int32_t> integers;
  std::vector<UV> pairs;  ///< if there are no integers

  [[nodiscard]] bool isPair() const { return !pairs.empty(); }
  [[nodiscard]] std::size_t count() const { return isPair() ? pairs.size() : integers.size(); }
  [[nodiscard]] std::size_t bytesEach() const {
    return isPair() ? sizeof(UV) : sizeof(std::int32_t);
  }
};

/// A mesh without cells, as it will be written.
struct Content {
  std::vector<Vec3> points;
  std::vector<EdgeEnds> edges;
  std::vector<std::uint8_t> valences;  ///< per face
  std::vector<Index> halfEdges;        ///< of all faces
  std::vector<Property> properties;
};

class Writer {
 public:
  Writer(const Content& content, OutputFile& output, Stage& stage)
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

  static std::string_view typeOf(const Property& property) {
    return property.isPair() ? "2d" : "i32";
  }

  void writeDirectory() {
    constexpr std::size_t kEntryBytes = 13;  // an entity and three lengths
    std::uint64_t payload = 0;
    for (const Property& property : content_.properties) {
      payload +=
          kEntryBytes + property.name.size() + typeOf(property).size() + property.bytesEach();
    }
    beginChunk("DIRP", payload);
    for (const Property& property : content_.properties) {
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
    const std::uint64_t payload = 24 + content_.edges.size() * sizeof(EdgeEnds);
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
    const Property& property = content_.properties[number];
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

  const Content& content_;
  OutputFile& output_;
  LoopProgress progress_;
};

void addGenerators(
    Content& content, std::uint8_t entity, std::string_view typeName,
    const std::vector<std::pair<std::span<const Index>, std::span<const CornerSet>>>& parts,
    std::size_t count) {
  Property type{entity, typeName, {}, {}};
  Property tet{entity, "hexhex::generator_tet", {}, {}};
  Property corners{entity, "hexhex::generator_corners", {}, {}};
  for (const auto& [tets, sets] : parts) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
      type.integers.push_back(static_cast<std::int32_t>(generatorKind(sets[i])));
      tet.integers.push_back(static_cast<std::int32_t>(tets[i]));
      corners.integers.push_back(sets[i]);
    }
  }
  for (Property* const property : {&type, &tet, &corners}) {
    property->integers.resize(count, -1);  // unknown
    content.properties.push_back(std::move(*property));
  }
}

/// Points, segments and what is known about them.
Content ofArcs(const PiecewiseLinearMesh& mesh, bool withPatches) {
  Content content;
  Property type{0, "v_type", {}, {}};
  Property uv{0, "v_igm_uv", {}, {}};
  const auto addPoints = [&](std::span<const Vec3> points, std::int32_t kind) {
    content.points.insert(content.points.end(), points.begin(), points.end());
    type.integers.resize(content.points.size(), kind);
  };
  addPoints(mesh.mesh.points, 0);
  uv.pairs.resize(content.points.size());
  addPoints(mesh.arcs.points, 1);
  for (const double t : mesh.arcs.parameters) uv.pairs.push_back({t, 0});
  std::vector<std::pair<std::span<const Index>, std::span<const CornerSet>>> generators = {
      {mesh.mesh.generatorTet, mesh.mesh.generatorCorners},
      {mesh.arcs.generatorTet, mesh.arcs.generatorCorners}};
  if (withPatches) {
    const std::size_t first = content.points.size();
    addPoints(mesh.patches.points, 2);
    uv.pairs.resize(content.points.size());
    for (std::size_t i = 0; i < mesh.patches.corners.size(); ++i) {
      const Index point = mesh.patches.corners[i];
      if (point >= first) uv.pairs[point] = mesh.patches.parameters[i];
    }
    generators.emplace_back(mesh.patches.generatorTet, mesh.patches.generatorCorners);
  }
  content.properties.push_back(std::move(type));
  content.properties.push_back(std::move(uv));
  addGenerators(content, 0, "v_tet_generator_type", generators, content.points.size());

  const auto vertices = static_cast<Index>(mesh.mesh.points.size());
  for (std::size_t e = 0; e < mesh.arcs.count(); ++e) {
    Index from = mesh.arcs.ends[e][0];
    for (std::uint64_t i = mesh.arcs.pointBegin[e]; i < mesh.arcs.pointBegin[e + 1]; ++i) {
      const Index to = vertices + static_cast<Index>(i);
      content.edges.push_back({from, to});
      from = to;
    }
    content.edges.push_back({from, mesh.arcs.ends[e][1]});
  }
  return content;
}

void addEdgeProperties(const PiecewiseLinearMesh& mesh, Content& content) {
  const Arcs& arcs = mesh.arcs;
  Property edge{1, "e_linear_hex_edge", {}, {}};
  for (std::size_t e = 0; e < arcs.count(); ++e) {
    edge.integers.resize(arcs.firstSegment(e + 1), static_cast<std::int32_t>(e));
  }
  edge.integers.resize(content.edges.size(), -1);
  content.properties.push_back(std::move(edge));
  addGenerators(content, 1, "e_tet_generator_type", {{arcs.segmentTet, arcs.segmentCorners}},
                content.edges.size());
}

/// An edge by its ends in ascending order, and its number.
struct KnownEdge {
  EdgeEnds ends;
  Index number;
  [[nodiscard]] bool operator<(const KnownEdge& other) const { return ends < other.ends; }
};

EdgeEnds ascending(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Adds the polygons of a face, and the sides that no arc has.
void addFace(const PiecewiseLinearMesh& mesh, std::size_t face, Content& content,
             std::vector<KnownEdge>& known) {
  const Patches& patches = mesh.patches;
  known.clear();
  for (const Index arc : patches.arcs[face]) {
    for (std::uint64_t s = mesh.arcs.firstSegment(arc);
         s < mesh.arcs.firstSegment(std::size_t{arc} + 1); ++s) {
      const EdgeEnds& ends = content.edges[s];
      known.push_back({ascending(ends[0], ends[1]), static_cast<Index>(s)});
    }
  }
  const std::uint64_t first = patches.polygonBegin[face];
  const std::uint64_t end = patches.polygonBegin[face + 1];
  const auto forEachSide = [&](const auto& visit) {
    for (std::uint64_t p = first; p < end; ++p) {
      const std::uint64_t begin = patches.cornerBegin[p];
      const std::uint64_t size = patches.cornerBegin[p + 1] - begin;
      for (std::uint64_t i = 0; i < size; ++i) {
        visit(patches.corners[begin + i], patches.corners[begin + (i + 1) % size]);
      }
    }
  };
  std::sort(known.begin(), known.end());
  const std::size_t border = known.size();
  forEachSide([&](Index a, Index b) {
    const KnownEdge side{ascending(a, b), kNone};
    // Sides inside the face come twice, once in each direction.
    const auto bordering = std::span(known).first(border);
    if (a > b || std::binary_search(bordering.begin(), bordering.end(), side)) return;
    known.push_back({side.ends, static_cast<Index>(content.edges.size())});
    content.edges.push_back(side.ends);
  });
  std::sort(known.begin(), known.end());
  forEachSide([&](Index a, Index b) {
    const auto edge =
        std::lower_bound(known.begin(), known.end(), KnownEdge{ascending(a, b), kNone});
    const bool along = content.edges[edge->number][0] == a;
    content.halfEdges.push_back(2 * edge->number + (along ? 0 : 1));
  });
  for (std::uint64_t p = first; p < end; ++p) {
    content.valences.push_back(
        static_cast<std::uint8_t>(patches.cornerBegin[p + 1] - patches.cornerBegin[p]));
  }
}

void requireSmall(std::uint64_t count) {
  if (count <= std::numeric_limits<std::int32_t>::max()) return;
  throw Error(ErrorCode::TooLarge,
              "OpenVolumeMesh files number elements with 31 bits, which do "
              "not suffice for " +
                  std::to_string(count) + ". Lower the scale, or write .vtu.");
}

}  // namespace

void writeArcsOvmb(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                   Context& context) {
  Stage stage(context, "write arcs");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  Content content = ofArcs(mesh, false);
  requireSmall(2 * std::max(content.points.size(), content.edges.size()));
  addEdgeProperties(mesh, content);
  Writer(content, output, stage).write();
}

void writePatchesOvmb(const PiecewiseLinearMesh& mesh, const std::filesystem::path& file,
                      Context& context) {
  Stage stage(context, "write patches");
  OutputFile output(file);
  requireSmall(2 * mesh.patches.corners.size());
  Content content = ofArcs(mesh, true);
  std::vector<KnownEdge> known;
  for (std::size_t f = 0; f < mesh.patches.count(); ++f) addFace(mesh, f, content, known);
  addEdgeProperties(mesh, content);
  Property face{2, "f_linear_hex_face", {}, {}};
  for (std::size_t f = 0; f < mesh.patches.count(); ++f) {
    face.integers.resize(mesh.patches.polygonBegin[f + 1], static_cast<std::int32_t>(f));
  }
  content.properties.push_back(std::move(face));
  Property tet{2, "f_intersected_tet_index", {}, {}};
  tet.integers.assign(mesh.patches.polygonTet.begin(), mesh.patches.polygonTet.end());
  content.properties.push_back(std::move(tet));
  Writer(content, output, stage).write();
}

}  // namespace hexhex
