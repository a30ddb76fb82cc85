// Which numbers of a mesh go into which table.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <hexhex/error.hpp>

#include <view/mesh_tables.hpp>

namespace hexhex {
namespace {

/// 20 bits: in a mesh of a hundred cells along a side, a ten-thousandth of a cell.
constexpr double kPositionSteps = (1U << 20U) - 1U;

PackedTable packPoints(const HexMesh& mesh, const SurfaceNodes& nodes,
                       const Quantization& quantization, Stage& stage) {
  const std::size_t vertices = mesh.points.size();
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3& point = v < vertices ? mesh.points[v] : nodes.points[v - vertices];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double offset = point[axis] - quantization.lower[axis];
        *to++ = static_cast<std::uint32_t>(std::lround(offset / quantization.step));
      }
    }
  };
  return packTable("points", vertices + nodes.points.size(), 3, fill, stage);
}

PackedTable packNodes(const HexMesh& mesh, const SurfaceNodes& nodes, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    const std::size_t first = begin * nodes.perCell;
    std::copy_n(nodes.numbers.data() + first, (end - begin) * nodes.perCell, to);
  };
  return packTable("nodes", mesh.cells.size(), nodes.perCell, fill, stage);
}

PackedTable packRegions(const HexMesh& mesh, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t c = begin; c < end; ++c) *to++ = static_cast<std::uint32_t>(mesh.regions[c]);
  };
  return packTable("regions", mesh.regions.size(), 1, fill, stage);
}

PackedTable packCells(const HexMesh& mesh, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t c = begin; c < end; ++c) to = std::ranges::copy(mesh.cells[c], to).out;
  };
  return packTable("cells", mesh.cells.size(), 8, fill, stage);
}

PackedTable packQuality(std::span<const double> scaledJacobians, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t c = begin; c < end; ++c) {
      const double share = (std::clamp(scaledJacobians[c], -1.0, 1.0) + 1) / 2;
      *to++ = static_cast<std::uint32_t>(std::lround(share * kQualitySteps));
    }
  };
  return packTable("quality", scaledJacobians.size(), 1, fill, stage);
}

PackedTable packGenerators(const HexMesh& mesh, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t v = begin; v < end; ++v) {
      *to++ = static_cast<std::uint32_t>(generatorKind(mesh.generatorCorners[v]));
    }
  };
  return packTable("generator_kinds", mesh.generatorCorners.size(), 1, fill, stage);
}

PackedTable packSingularEdges(std::span<const SingularHexEdge> edges, Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (const SingularHexEdge& edge : edges.subspan(begin, end - begin)) {
      *to++ = edge.vertex0;
      *to++ = edge.vertex1;
      *to++ = 2 * edge.valence + (edge.boundary ? 1U : 0U);
    }
  };
  return packTable("singular_edges", edges.size(), 3, fill, stage);
}

/// Tagged edges or quads: their vertices and the tag.
template <class Feature>
PackedTable packFeatures(std::string_view name, const std::vector<Feature>& features,
                         Stage& stage) {
  const auto fill = [&](std::size_t begin, std::size_t end, std::uint32_t* to) {
    for (std::size_t i = begin; i < end; ++i) {
      to = std::ranges::copy(features[i].vertices, to).out;
      *to++ = static_cast<std::uint32_t>(features[i].tag);
    }
  };
  return packTable(name, features.size(), Feature{}.vertices.size() + 1, fill, stage);
}

}  // namespace

Quantization quantizationOf(const HexMesh& mesh, const SurfaceNodes& nodes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Quantization result{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, 1};
  const auto enclose = [&result](const Array<Vec3>& points, const char* what) {
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
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, result.upper[axis] - result.lower[axis]);
  }
  // The page computes in the same numbers.
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
                                  std::span<const double> scaledJacobians,
                                  std::span<const SingularHexEdge> singularEdges, Stage& stage,
                                  const SurfaceNodes& nodes) {
  std::vector<PackedTable> tables;
  tables.push_back(packPoints(mesh, nodes, quantization, stage));
  tables.push_back(packCells(mesh, stage));
  tables.push_back(packQuality(scaledJacobians, stage));
  if (nodes.perCell > 0) tables.push_back(packNodes(mesh, nodes, stage));
  if (!mesh.generatorCorners.empty()) tables.push_back(packGenerators(mesh, stage));
  if (!mesh.regions.empty()) tables.push_back(packRegions(mesh, stage));
  if (!singularEdges.empty()) tables.push_back(packSingularEdges(singularEdges, stage));
  const HexFeatures& features = mesh.features;
  if (!features.edges.empty()) {
    tables.push_back(packFeatures("feature_edges", features.edges, stage));
  }
  if (!features.quads.empty()) {
    tables.push_back(packFeatures("feature_quads", features.quads, stage));
  }
  return tables;
}

}  // namespace hexhex
