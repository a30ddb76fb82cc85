// Reads Lagrange cells from `.vtu` files.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <io/core/input_file.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_order.hpp>
#include <io/vtk/read_vtu_with.hpp>
#include <io/vtk/vtu_elements.hpp>
#include <io/vtk/vtu_file.hpp>
#include <io/vtk/vtu_tags.hpp>

namespace hexhex {
namespace {

Array<std::int64_t> typesOf(const VtuFile& file) {
  Array<std::int64_t> types(file.cellCount());
  file.copy(file.types(), 0, types.size(), types.data());
  return types;
}

/// Says whether there are Lagrange cells.
class VtuLagrangeFinder {
 public:
  VtuLagrangeFinder(std::string_view text, const std::string& fileName, Stage& stage)
      : file_(text, fileName, stage) {}
  VtuLagrangeFinder(const InputFile& input, const std::string& fileName, Stage& /*stage*/)
      : file_(input, fileName) {}

  [[nodiscard]] bool read() const {
    const Array<std::int64_t> types = typesOf(file_);
    return std::ranges::find(types, kVtkLagrangeHexahedron) != types.end();
  }

 private:
  VtuFile file_;
};

class VtuLagrangeReader {
 public:
  VtuLagrangeReader(std::string_view text, const std::string& fileName, Stage& stage)
      : file_(text, fileName, stage) {}
  VtuLagrangeReader(const InputFile& input, const std::string& fileName, Stage& /*stage*/)
      : file_(input, fileName) {}

  LagrangeMesh read() {
    file_.requireIndexable();
    Array<std::size_t> numbers;
    const std::vector<std::uint64_t> begins = findCells(numbers);
    LagrangeMesh mesh;
    mesh.order = order_;
    mesh.points.resize(file_.pointCount());
    readVtuPoints(file_, 0, mesh.points);
    readNodes(begins, mesh);
    readGenerators(mesh);
    mesh.regions = readVtuRegions(file_, numbers);
    mesh.features = {readVtuVertexTags(file_), readVtuFeatures<FeatureEdge>(file_, kVtkEdgeTags),
                     readVtuFeatures<FeatureQuad>(file_, kVtkQuadTags)};
    putCornersFirst(mesh);
    return mesh;
  }

 private:
  /// Where the nodes of each cell begin. Finds the order on the way.
  /// @param[out] numbers  which cells of the file they are
  std::vector<std::uint64_t> findCells(Array<std::size_t>& numbers) {
    const Array<std::int64_t> types = typesOf(file_);
    Array<std::int64_t> ends(types.size());
    file_.copy(file_.ends(), 0, ends.size(), ends.data());
    std::vector<std::uint64_t> begins;
    for (std::size_t c = 0; c < types.size(); ++c) {
      if (types[c] != kVtkLagrangeHexahedron) continue;
      const std::int64_t begin = c == 0 ? 0 : ends[c - 1];
      const auto stored = static_cast<std::int64_t>(file_.connectivity().count);
      if (begin < 0 || ends[c] < begin || ends[c] > stored) {
        file_.fail(ErrorCode::FileSyntax,
                   "the nodes of cell " + std::to_string(c) + " end at " + std::to_string(ends[c]) +
                       ", which is before they begin or beyond the " + std::to_string(stored) +
                       " in the file.",
                   Place{PlaceKind::Cell, c});
      }
      requireOrder(c, static_cast<std::size_t>(ends[c] - begin), begins.empty());
      begins.push_back(static_cast<std::uint64_t>(begin));
      numbers.push_back(c);
    }
    if (begins.empty()) {
      file_.fail(ErrorCode::FileUnsupported, "the file holds no Lagrange hexahedra: none of its " +
                                                 std::to_string(file_.cellCount()) +
                                                 " cells has the type 72.");
    }
    return begins;
  }

  void requireOrder(std::size_t cell, std::size_t nodes, bool first) {
    if (!first && nodes == perCell_) return;
    for (int order = 1; first && order <= kMaxOrder; ++order) {
      const auto n = static_cast<std::size_t>(order) + 1;
      if (n * n * n != nodes) continue;
      order_ = order;
      perCell_ = nodes;
      return;
    }
    file_.fail(ErrorCode::FileUnsupported,
               "cell " + std::to_string(cell) + " has " + std::to_string(nodes) + " nodes" +
                   (first ? ", but Lagrange hexahedra of an order p from 1 to 9, the same in all "
                            "directions, have (p + 1)^3."
                          : ", but the cells before it have " + std::to_string(perCell_) +
                                ". Cells of different orders are not supported."),
               Place{PlaceKind::Cell, cell});
  }

  void readNodes(const std::vector<std::uint64_t>& begins, LagrangeMesh& mesh) const {
    const std::vector<std::uint32_t> places = vtkNodeOrder(order_);
    mesh.nodes.resize(begins.size() * perCell_);
    std::vector<std::int64_t> row(perCell_);
    for (std::size_t c = 0; c < begins.size(); ++c) {
      file_.copy(file_.connectivity(), begins[c], perCell_, row.data());
      for (std::size_t k = 0; k < perCell_; ++k) {
        if (row[k] < 0 || static_cast<std::uint64_t>(row[k]) >= mesh.points.size()) {
          file_.fail(ErrorCode::IndexOutOfRange,
                     "Lagrange hexahedron " + std::to_string(c) + " names point " +
                         std::to_string(row[k]) + ", but the " +
                         std::to_string(mesh.points.size()) + " points are numbered from 0.",
                     Place{PlaceKind::Cell, c});
        }
        mesh.nodes[c * perCell_ + places[k]] = static_cast<Index>(row[k]);
      }
    }
  }

  void readGenerators(LagrangeMesh& mesh) const {
    if (!file_.generatorTets() || !file_.generatorCorners()) return;
    Array<CornerSet> corners(mesh.points.size());
    file_.copy(*file_.generatorCorners(), 0, corners.size(), corners.data());
    const auto isSimplex = [](CornerSet set) { return set >= 1 && set <= 15; };
    if (!std::ranges::all_of(corners, isSimplex)) return;  // of the same name, but something else
    mesh.generatorCorners = std::move(corners);
    mesh.generatorTet.resize(mesh.points.size());
    file_.copy(*file_.generatorTets(), 0, mesh.points.size(), mesh.generatorTet.data());
  }

  /// Renumbers nodes so that those at corners come first, otherwise in the order of the file.
  static void putCornersFirst(LagrangeMesh& mesh) {
    std::vector<bool> isCorner(mesh.points.size(), false);
    const std::vector<std::uint32_t> places = vtkNodeOrder(mesh.order);  // corners come first
    const std::size_t perCell = mesh.nodesPerCell();
    for (std::size_t c = 0; c < mesh.cellCount(); ++c) {
      for (std::size_t k = 0; k < 8; ++k) isCorner[mesh.nodes[c * perCell + places[k]]] = true;
    }
    mesh.vertexCount =
        static_cast<std::uint64_t>(std::count(isCorner.begin(), isCorner.end(), true));
    Array<Index> newNumber(mesh.points.size());
    Index nextCorner = 0;
    auto nextOther = static_cast<Index>(mesh.vertexCount);
    for (std::size_t v = 0; v < newNumber.size(); ++v) {
      newNumber[v] = isCorner[v] ? nextCorner++ : nextOther++;
    }
    const auto moved = [&newNumber](const auto& from) {
      auto to = from;
      for (std::size_t v = 0; v < from.size(); ++v) to[newNumber[v]] = from[v];
      return to;
    };
    mesh.points = moved(mesh.points);
    mesh.generatorTet = moved(mesh.generatorTet);
    mesh.generatorCorners = moved(mesh.generatorCorners);
    for (Index& node : mesh.nodes) node = newNumber[node];
    renumberFeatures(isCorner, newNumber, mesh.features);
  }

  /// Only what has its vertices at corners is a part of the straight mesh.
  static void renumberFeatures(const std::vector<bool>& isCorner, const Array<Index>& newNumber,
                               HexFeatures& features) {
    const auto isNoCorner = [&isCorner](Index node) { return !isCorner[node]; };
    std::erase_if(features.vertices,
                  [&](const FeatureVertex& feature) { return isNoCorner(feature.vertex); });
    for (FeatureVertex& feature : features.vertices) feature.vertex = newNumber[feature.vertex];
    const auto renumber = [&](auto& elements) {
      std::erase_if(elements, [&](const auto& element) {
        return std::ranges::any_of(element.vertices, isNoCorner);
      });
      for (auto& element : elements) {
        for (Index& vertex : element.vertices) vertex = newNumber[vertex];
      }
    };
    renumber(features.edges);
    renumber(features.quads);
  }

  VtuFile file_;
  int order_ = 1;
  std::size_t perCell_ = 0;
};

}  // namespace

bool holdsLagrangeVtu(const std::filesystem::path& file, Context& context) {
  return readVtuWith<VtuLagrangeFinder>(file, "read mesh", context);
}

LagrangeMesh readLagrangeVtu(const std::filesystem::path& file, Context& context) {
  return readVtuWith<VtuLagrangeReader>(file, "read mesh", context);
}

}  // namespace hexhex
