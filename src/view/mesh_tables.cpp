// Decides which numbers of a mesh go into which table, and packs the tables.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <string>
#include <utility>
#include <vector>
#include <zlib.h>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <mesh/lagrange_check.hpp>
#include <view/mesh_tables.hpp>

namespace hexhex::view {
namespace {

// How a chunk is packed: each row is replaced by its difference from the previous row (modulo
// 2^32), signs move to the lowest bit, and bytes are sorted by significance. What remains is long
// runs of few byte values, which zlib compresses well. Either row by row or column by column,
// whichever packs the first chunk better: this makes points a sixth smaller, and cells of some
// meshes 7 %.

/// Numbers per chunk: large enough for zlib, small enough for a string in a browser and for keeping
/// all cores busy.
constexpr std::size_t kNumbersPerChunk = std::size_t{1} << 18;

/// Level 6 takes 1.7 times as long for tables that are only 2 to 4 % smaller.
constexpr int kZlibLevel = 5;

/// 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
constexpr std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1U) ^ (difference >> 31U != 0 ? ~std::uint32_t{0} : 0U);
}

/// The differences, row by row or column by column.
Array<std::uint32_t> differences(const Array<std::uint32_t>& table, std::size_t rows,
                                 std::size_t columns, bool byRows) {
  Array<std::uint32_t> codes(table.size());
  for (std::size_t column = 0; column < columns; ++column) {
    std::uint32_t previous = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::uint32_t value = table[row * columns + column];
      codes[byRows ? row * columns + column : column * rows + row] = zigzag(value - previous);
      previous = value;
    }
  }
  return codes;
}

/// The number of planes, then the planes, least significant bytes first.
std::string bytePlanes(const Array<std::uint32_t>& codes) {
  std::uint32_t used = 0;
  for (const std::uint32_t code : codes) used |= code;
  std::size_t planes = 0;
  while (planes < 4 && used >> (8 * planes) != 0) ++planes;
  std::string bytes(1 + planes * codes.size(), '\0');
  bytes[0] = static_cast<char>(planes);
  char* to = bytes.data() + 1;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    for (const std::uint32_t code : codes) *to++ = static_cast<char>(code >> (8 * plane));
  }
  return bytes;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), kZlibLevel);
  // The bound suffices for any content, so no other failure is possible.
  if (status != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  packed.shrink_to_fit();
  return packed;
}

}  // namespace

PackedTable packTable(std::string_view name, std::size_t rows, std::size_t columns,
                      const FillRows& fill, Stage& stage) {
  PackedTable packed{std::string(name), rows, columns, kNumbersPerChunk / columns, false, {}};
  packed.chunks.resize(blockCount(rows, packed.rowsPerChunk));
  const auto pack = [&](std::size_t begin, std::size_t end, bool byRows) {
    Array<std::uint32_t> table((end - begin) * columns);
    fill(begin, end, table.data());
    return deflated(bytePlanes(differences(table, end - begin, columns, byRows)));
  };
  if (rows == 0) return packed;
  const std::size_t first = std::min(rows, packed.rowsPerChunk);
  packed.chunks[0] = pack(0, first, false);
  if (columns > 1) {
    std::string byRows = pack(0, first, true);
    packed.byRows = byRows.size() < packed.chunks[0].size();
    if (packed.byRows) packed.chunks[0] = std::move(byRows);
  }
  parallelBlocks(stage, rows - first, packed.rowsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                   packed.chunks[chunk + 1] = pack(first + begin, first + end, packed.byRows);
                 });
  return packed;
}

std::string toBase64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  char* to = text.data();
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    // Digits without any bits of the input remain '='.
    for (std::size_t k = 0; k <= count; ++k) to[k] = kDigits[group >> (18 - 6 * k) & 63U];
    to += 4;
  }
  return text;
}

namespace {

/// Positions, in a cell's list, of the nodes that are on its faces but not at corners.
std::vector<std::size_t> placesOnFaces(int order) {
  std::vector<std::size_t> places;
  std::size_t place = 0;
  for (int k = 0; k <= order; ++k) {
    for (int j = 0; j <= order; ++j) {
      for (int i = 0; i <= order; ++i, ++place) {
        const auto atEnd = [order](int index) { return index == 0 || index == order ? 1 : 0; };
        const int ends = atEnd(i) + atEnd(j) + atEnd(k);
        if (ends == 1 || ends == 2) places.push_back(place);
      }
    }
  }
  return places;
}

}  // namespace

SurfaceNodes surfaceNodesOf(const LagrangeMesh& mesh) {
  mesh::requireConsistent(mesh);
  const std::vector<std::size_t> places = placesOnFaces(mesh.order);
  SurfaceNodes result;
  result.order = mesh.order;
  result.perCell = places.size();
  result.numbers.resize(mesh.cellCount() * result.perCell);
  Array<Index> numberOf(mesh.points.size());
  std::ranges::fill(numberOf, kNone);
  auto next = static_cast<Index>(mesh.vertexCount);
  auto to = result.numbers.begin();
  for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
    const Index* const nodes = mesh.nodes.data() + c * mesh.nodesPerCell();
    for (const std::size_t place : places) {
      Index& number = numberOf[nodes[place]];
      if (number == kNone) {
        number = next++;
        result.points.push_back(mesh.points[nodes[place]]);
      }
      *to++ = number;
    }
  }
  return result;
}

namespace {

/// 20 bits: a ten-thousandth of a cell in a mesh with a hundred cells along a side.
constexpr double kPositionSteps = (1U << 20U) - 1U;

/// The tables of a page; empty ones are omitted.
class TableList {
 public:
  explicit TableList(Stage& stage) : stage_(stage) {}

  /// @param putRow  of (i, place): writes row i to its place, and returns the end of the row
  template <class PutRow>
  void add(std::string_view name, std::size_t rows, std::size_t columns, const PutRow& putRow) {
    const auto fill = [&putRow](std::size_t begin, std::size_t end, std::uint32_t* to) {
      for (std::size_t i = begin; i < end; ++i) to = putRow(i, to);
    };
    if (rows > 0) tables_.push_back(packTable(name, rows, columns, fill, stage_));
  }
  /// A table of one column.
  template <class NumberOf>
  void addColumn(std::string_view name, std::size_t rows, const NumberOf& numberOf) {
    add(name, rows, 1, [&](std::size_t i, std::uint32_t* to) {
      *to++ = static_cast<std::uint32_t>(numberOf(i));
      return to;
    });
  }
  /// Tagged edges or quads: their vertices and the tag.
  template <class Feature>
  void addFeatures(std::string_view name, const std::vector<Feature>& features) {
    add(name, features.size(), Feature{}.vertices.size() + 1,
        [&](std::size_t i, std::uint32_t* to) {
          to = std::ranges::copy(features[i].vertices, to).out;
          *to++ = static_cast<std::uint32_t>(features[i].tag);
          return to;
        });
  }
  [[nodiscard]] std::vector<PackedTable> take() { return std::move(tables_); }

 private:
  Stage& stage_;
  std::vector<PackedTable> tables_;
};

}  // namespace

Quantization quantizationOf(const HexMesh& mesh, const SurfaceNodes& nodes,
                            const StateBefore& before) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Quantization result{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, 1};
  const auto enclose = [&result](std::span<const Vec3> points, const char* what) {
    for (std::size_t v = 0; v < points.size(); ++v) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double coordinate = points[v][axis];
        if (!std::isfinite(coordinate)) {
          throw Error(ErrorCode::NotFinite,
                      std::string("A coordinate of ") + what + std::to_string(v) +
                          " is no finite number. The mesh cannot be shown.",
                      {PlaceKind::Vertex, v, 0});
        }
        result.lower[axis] = std::min(result.lower[axis], coordinate);
        result.upper[axis] = std::max(result.upper[axis], coordinate);
      }
    }
  };
  enclose(mesh.points, "hex vertex ");
  enclose(nodes.points, "node ");
  enclose(before.points, "an earlier hex vertex ");
  enclose(before.nodes, "an earlier node ");
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, result.upper[axis] - result.lower[axis]);
  }
  // The page computes with the same number type.
  if (!std::isfinite(longest)) {
    throw Error(ErrorCode::TooLarge,
                "The bounding box of the mesh is larger than the largest number. The mesh cannot "
                "be shown; make it smaller.");
  }
  // A box of subnormal size has no step of its own.
  const double step = longest / kPositionSteps;
  if (step >= std::numeric_limits<double>::min()) result.step = step;
  return result;
}

std::vector<PackedTable> packMesh(const HexMesh& mesh, const Quantization& quantization,
                                  const CellQuality& quality,
                                  std::span<const SingularHexEdge> singularEdges, Stage& stage,
                                  const SurfaceNodes& nodes, const StateBefore& before,
                                  std::span<const std::uint32_t> skinPatches) {
  TableList list(stage);
  const std::size_t vertices = mesh.points.size();
  const auto stored = [&quantization](const Vec3& point, std::size_t axis) {
    const double offset = point[axis] - quantization.lower[axis];
    return static_cast<std::uint32_t>(std::lround(offset / quantization.step));
  };
  const auto addQuality = [&list](const CellQuality& of, const std::string& suffix) {
    list.addColumn("quality" + suffix, of.scaledJacobians.size(), [&](std::size_t c) {
      return std::lround((std::clamp(of.scaledJacobians[c], -1.0, 1.0) + 1) / 2 * kQualitySteps);
    });
    list.addColumn("not_positive" + suffix, of.notPositive.size(),
                   [&](std::size_t i) { return of.notPositive[i]; });
  };
  const auto pointAt = [&](std::size_t v) {
    return v < vertices ? mesh.points[v] : nodes.points[v - vertices];
  };
  list.add("points", vertices + nodes.points.size(), 3, [&](std::size_t v, std::uint32_t* to) {
    for (std::size_t axis = 0; axis < 3; ++axis) *to++ = stored(pointAt(v), axis);
    return to;
  });
  list.add("cells", mesh.cells.size(), 8, [&](std::size_t c, std::uint32_t* to) {
    return std::ranges::copy(mesh.cells[c], to).out;
  });
  addQuality(quality, "");
  const std::vector<std::uint64_t> skin = adjacency::boundaryPlaces(mesh, stage);
  list.addColumn("skin", skin.size(), [&](std::size_t i) { return skin[i] / 8 * 6 + skin[i] % 8; });
  list.addColumn("skin_patches", skinPatches.size(), [&](std::size_t i) { return skinPatches[i]; });
  list.add("nodes", nodes.perCell > 0 ? mesh.cells.size() : 0, nodes.perCell,
           [&](std::size_t c, std::uint32_t* to) {
             return std::copy_n(nodes.numbers.data() + c * nodes.perCell, nodes.perCell, to);
           });
  list.addColumn("generator_kinds", mesh.generatorCorners.size(),
                 [&](std::size_t v) { return generatorKind(mesh.generatorCorners[v]); });
  list.addColumn("regions", mesh.regions.size(), [&](std::size_t c) { return mesh.regions[c]; });
  list.add("singular_edges", singularEdges.size(), 3, [&](std::size_t i, std::uint32_t* to) {
    const SingularHexEdge& edge = singularEdges[i];
    const std::array<std::uint32_t, 3> row = {edge.vertex0, edge.vertex1,
                                              2 * edge.valence + (edge.boundary ? 1U : 0U)};
    return std::ranges::copy(row, to).out;
  });
  list.addFeatures("feature_edges", mesh.features.edges);
  list.addFeatures("feature_quads", mesh.features.quads);
  // Most vertices move by little: differences take half the bytes of positions.
  list.add("points_before", before.points.size() + before.nodes.size(), 3,
           [&](std::size_t v, std::uint32_t* to) {
             const Vec3& was = v < vertices ? before.points[v] : before.nodes[v - vertices];
             for (std::size_t axis = 0; axis < 3; ++axis) {
               *to++ = stored(was, axis) - stored(pointAt(v), axis);
             }
             return to;
           });
  addQuality(before.quality, "_before");
  return list.take();
}

}  // namespace hexhex::view
