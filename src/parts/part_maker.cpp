#include <algorithm>
#include <cassert>
#include <limits>
#include <string>

#include <parts/part_borders.hpp>
#include <parts/part_cells.hpp>
#include <parts/part_maker.hpp>
#include <parts/part_region.hpp>
#include <parts/vertex_set.hpp>

#include <base/sorted.hpp>
#include <base/workspaces.hpp>
#include <extract/mesh_tags.hpp>

namespace hexhex::parts {

namespace {

/// More vertices than this require wide ids: two values are reserved.
constexpr std::uint64_t kMaxNarrowVertices = std::numeric_limits<std::uint32_t>::max() - 1;

template <class Cell>
void renumber(const Cell& from, VertexSet::Cache& vertices, Hex& to) {
  for (std::size_t k = 0; k < 8; ++k) to[k] = vertices.rank(from[k]);
}

/// Converts cells whose corners are all in the set; may work in place. Where a corner's number
/// follows that of the previous cell's corner, so does its rank.
template <class Cell>
void renumber(std::span<const Cell> from, const VertexSet& vertices, Hex* to) {
  if (from.empty()) return;
  VertexSet::Cache cache(vertices);
  Cell before = from.front();
  Hex ranks{};
  for (const Cell& cell : from) {
    const Cell here = cell;
    if (follows(here, before)) {
      for (Index& rank : ranks) ++rank;
    } else {
      for (std::size_t k = 0; k < 8; ++k) {
        ranks[k] = here[k] == before[k] + 1 ? ranks[k] + 1 : cache.rank(here[k]);
      }
    }
    before = here;
    *to++ = ranks;
  }
}

std::vector<std::int32_t> different(std::vector<std::int32_t> tags) {
  sortUnique(tags);
  return tags;
}

template <class Features>
std::vector<std::int32_t> tagsOf(const Features& features) {
  std::vector<std::int32_t> tags;
  for (const auto& feature : features) {
    if (feature.tag != 0) tags.push_back(feature.tag);
  }
  return different(std::move(tags));
}

/// Splits the cells of other parts around a part into layers: each consists of the cells in no
/// layer so far that have a vertex of the part or of the previous layers.
/// @param own  the part's vertices
template <class Id>
std::vector<std::vector<NearbyCell<Id>>> layersOf(std::vector<NearbyCell<Id>> nearby,
                                                  std::uint32_t count, const VertexSet& own,
                                                  Stage& stage) {
  std::vector<std::vector<NearbyCell<Id>>> layers(count);
  VertexSet ofLayer;
  for (std::vector<NearbyCell<Id>>& layer : layers) {
    std::vector<NearbyCell<Id>> rest;
    // Everything farther away touches the previous layer.
    VertexSet::Cache cache(&layer == &layers.front() ? own : ofLayer);
    for (const NearbyCell<Id>& cell : nearby) {
      (cache.holdsAny(cell.corners) ? layer : rest).push_back(cell);
    }
    nearby = std::move(rest);
    if (&layer == &layers.back()) break;
    std::vector<std::array<Id, 8>> corners;
    corners.reserve(layer.size());
    for (const NearbyCell<Id>& cell : layer) corners.push_back(cell.corners);
    ofLayer = VertexSet(std::span<const std::array<Id, 8>>(corners), stage);
  }
  return layers;
}

template <class Id>
class Maker final : public PartMaker {
 public:
  Maker(const PartsOfMap& map, const PartOptions& options, sweep::ElementCounts counts,
        Partition partition, atlas::Charts charts)
      : map_(map),
        options_(options),
        partition_(std::move(partition)),
        counts_(std::move(counts)),
        charts_(std::move(charts)) {}

  PartsInfo info() const override {
    const TetMapView& source = map_.source;
    PartsInfo info;
    info.parts = options_.parts;
    info.ghostLayers = options_.ghostLayers;
    info.pointCount = counts_.vertices.count();
    info.cellCount = counts_.cells.back();
    info.vertexTags = tagsOf(source.features.vertices);
    info.edgeTags = tagsOf(source.features.edges);
    info.quadTags = tagsOf(source.features.faces);
    info.regions = different({source.regions.begin(), source.regions.end()});
    return info;
  }

  const sweep::ElementCounts& counts() const noexcept override { return counts_; }

  MeshPart make(std::uint32_t number, Stage& stage) override {
    MeshPart part;
    part.part = number;
    part.parts = options_.parts;
    if (partition_.tetsOf(number).empty()) return part;
    std::vector<std::vector<NearbyCell<Id>>> layers;
    GlobalCells<Id> own;
    VertexSet vertices;
    const auto makeWorkspace = [this] {
      return Workspace{PartGrid<Id>(map_.map, counts_, partition_, charts_),
                       RegionFinder(map_.map, partition_, counts_.cells.back())};
    };
    workspaces_.with(makeWorkspace, [&](Workspace& workspace) {
      // One extra layer, which knows the owners of the vertices of the last one.
      const std::uint32_t around = options_.ghostLayers + 1;
      PartGrid<Id>& grid = workspace.grid;
      grid.enter(workspace.regions.find(number, around), stage);
      own = grid.ownCells(number, stage);
      vertices = VertexSet(std::span<const std::array<Id, 8>>(own.corners), stage);
      if (around == 1) {
        layers.push_back(grid.nearbyCells(number, &vertices, stage));
      } else {
        layers = layersOf(grid.nearbyCells(number, nullptr, stage), around, vertices, stage);
      }
      grid.clear();  // frees memory for what follows
    });
    Assembly assembly{part, layers, vertices, stage};
    takeOwn(assembly, std::move(own));
    takeGhosts(assembly);
    addTags(assembly);
    return part;
  }

 private:
  struct Workspace {
    PartGrid<Id> grid;
    RegionFinder regions;
  };
  struct Assembly {
    MeshPart& part;
    const std::vector<std::vector<NearbyCell<Id>>>& layers;
    const VertexSet& vertices;  ///< of own cells
    Stage& stage;
  };

  static void requireNarrow(std::uint64_t count, const char* what) {
    if (count < kNone) return;
    throw Error(ErrorCode::TooLarge, "A part would have " + std::to_string(count) + ' ' + what +
                                         ", more than 32-bit indices can number. Ask for more "
                                         "parts.");
  }

  /// Adds own cells, their vertices, and what these share with neighbours.
  void takeOwn(const Assembly& assembly, GlobalCells<Id> own) const {
    // No structured binding: clang 14 does not capture those in a lambda.
    auto& part = assembly.part;
    const auto& layers = assembly.layers;
    const VertexSet& vertices = assembly.vertices;
    Stage& stage = assembly.stage;
    requireNarrow(own.numbers.size(), "cells");
    requireNarrow(vertices.size(), "vertices");
    assert(std::is_sorted(own.numbers.begin(), own.numbers.end()));
    part.globalPoints = vertices.list();
    part.ownPoints = vertices.size();
    part.ownCells = own.numbers.size();
    part.globalCells = std::move(own.numbers);
    const auto renumberAll = [&](const auto& from) {
      part.mesh.cells.resize(from.size());
      constexpr std::size_t kGrain = 4096;
      parallelBlocks(stage, from.size(), kGrain,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                       renumber(std::span(from).subspan(begin, end - begin), vertices,
                                &part.mesh.cells[begin]);
                     });
    };
    if constexpr (std::is_same_v<Id, Index>) {
      part.mesh.cells = std::move(own.corners);
      renumberAll(part.mesh.cells);
    } else {
      renumberAll(own.corners);
    }
    VertexSet::Cache cache(vertices);
    std::vector<BorderCell> around;
    around.reserve(layers[0].size());
    part.pointOwners.assign(part.ownPoints, part.part);
    for (const NearbyCell<Id>& cell : layers[0]) {
      around.push_back({cell.number, cell.part, {}});
      renumber(cell.corners, cache, around.back().corners);
    }
    findNeighbours(part, around);
    for (const PartNeighbour& neighbour : part.neighbours) {
      for (const Index v : neighbour.vertices) {
        part.pointOwners[v] = std::min(part.pointOwners[v], neighbour.part);
      }
    }
    part.mesh.points.resize(part.ownPoints);
    part.mesh.generatorTet.resize(part.ownPoints);
    part.mesh.generatorCorners.resize(part.ownPoints);
    describeVertices(map_.map, counts_, part.globalPoints, 0, part.mesh, stage);
  }

  /// Appends ghosts and their vertices after own ones.
  void takeGhosts(const Assembly& assembly) const {
    auto& part = assembly.part;
    const auto& layers = assembly.layers;
    Stage& stage = assembly.stage;
    std::vector<std::array<Id, 8>> corners;
    for (std::size_t layer = 0; layer + 1 < layers.size(); ++layer) {
      for (const NearbyCell<Id>& cell : layers[layer]) {
        corners.push_back(cell.corners);
        part.globalCells.push_back(cell.number);
        part.ghostParts.push_back(cell.part);
        part.ghostLayers.push_back(static_cast<std::uint32_t>(layer + 1));
      }
    }
    if (corners.empty()) return;
    std::vector<std::uint64_t> added;
    const auto own = std::span(part.globalPoints).first(part.ownPoints);
    for (const std::array<Id, 8>& cell : corners) {
      for (const Id vertex : cell) {
        if (!std::binary_search(own.begin(), own.end(), vertex)) added.push_back(vertex);
      }
    }
    sortUnique(added);
    const std::uint64_t count = part.ownPoints + added.size();
    requireNarrow(count, "vertices");
    requireNarrow(part.globalCells.size(), "cells");
    const auto localOf = [&](std::uint64_t vertex) {
      const auto points = std::span<const std::uint64_t>(part.globalPoints).first(part.ownPoints);
      const auto here = std::lower_bound(points.begin(), points.end(), vertex);
      if (here != points.end() && *here == vertex) {
        return static_cast<Index>(here - points.begin());
      }
      const auto there = std::lower_bound(added.begin(), added.end(), vertex);
      if (there == added.end() || *there != vertex) return kNone;
      return static_cast<Index>(part.ownPoints + static_cast<std::size_t>(there - added.begin()));
    };
    part.mesh.cells.reserve(part.globalCells.size());
    for (const std::array<Id, 8>& cell : corners) {
      Hex& hex = part.mesh.cells.emplace_back();
      for (std::size_t k = 0; k < 8; ++k) hex[k] = localOf(cell[k]);
      assert(std::find(hex.begin(), hex.end(), kNone) == hex.end());
    }
    part.pointOwners.resize(count, part.parts);
    for (const auto& layer : layers) {
      for (const NearbyCell<Id>& cell : layer) {
        for (const Id vertex : cell.corners) {
          const Index v = localOf(vertex);
          if (v != kNone) part.pointOwners[v] = std::min(part.pointOwners[v], cell.part);
        }
      }
    }
    part.globalPoints.insert(part.globalPoints.end(), added.begin(), added.end());
    part.mesh.points.resize(count);
    part.mesh.generatorTet.resize(count);
    part.mesh.generatorCorners.resize(count);
    describeVertices(map_.map, counts_, added, part.ownPoints, part.mesh, stage);
  }

  void addTags(const Assembly& assembly) const {
    const auto& [part, layers, vertices, stage] = assembly;
    if (!map_.source.features.empty()) {
      extraction::carryFeatures(map_.source, map_.map, cellsOf(part), part.mesh, stage);
    }
    if (map_.source.regions.empty()) return;
    Array<std::int32_t>& regions = part.mesh.regions;
    regions.reserve(part.mesh.cells.size());
    for (std::size_t c = 0; c < part.ownCells; ++c) {
      const auto behind =
          std::upper_bound(counts_.cells.begin(), counts_.cells.end(), part.globalCells[c]);
      const auto tet = static_cast<std::size_t>(behind - counts_.cells.begin()) - 1;
      while (c < part.ownCells && part.globalCells[c] < *behind) {
        regions.push_back(map_.source.regions[tet]);
        ++c;
      }
      --c;
    }
    for (std::size_t layer = 0; layer + 1 < layers.size(); ++layer) {
      for (const NearbyCell<Id>& cell : layers[layer]) {
        regions.push_back(map_.source.regions[cell.place.tet]);
      }
    }
  }

  /// The part's own cells for carryFeatures(), grouped by tet.
  [[nodiscard]] extraction::TaggedCells cellsOf(const MeshPart& part) const {
    const std::span<const Index> tets = partition_.tetsOf(part.part);
    return {tets.size(),
            [this, &part, tets](std::size_t i, const extraction::TaggedCells::Visit& visit) {
              const Index tet = tets[i];
              const std::uint64_t first = counts_.cells[tet];
              if (first == counts_.cells[std::size_t{tet} + 1]) return;
              const auto own = std::span(part.globalCells).first(part.ownCells);
              auto cell = static_cast<std::uint64_t>(
                  std::lower_bound(own.begin(), own.end(), first) - own.begin());
              std::vector<lattice::SweptLine> lines;
              lattice::TetRasterizer(map_.map.exact.corners[tet], map_.map.exact.unit)
                  .append(lattice::kCenterGrid, lines);
              forEachRun(map_.map, partition_, part.part, tet, lines,
                         [&](const lattice::SweptLine& line, std::uint32_t begin,
                             std::uint32_t count, std::uint64_t) {
                           for (std::uint32_t k = begin; k < begin + count; ++k) {
                             visit(cell++, tet, line.point(k), line.simplex(k));
                           }
                         });
            }};
  }

  PartsOfMap map_;
  PartOptions options_;
  Partition partition_;
  sweep::ElementCounts counts_;
  atlas::Charts charts_;
  Workspaces<Workspace> workspaces_;
};

}  // namespace

std::unique_ptr<PartMaker> makePartMaker(const PartsOfMap& map, const PartOptions& options,
                                         Context& context, ExtractStatistics& statistics) {
  atlas::Charts charts;
  {
    Stage stage(context, "charts");
    charts = atlas::buildCharts(map.map, stage);
  }
  statistics.charts = charts.count;
  sweep::ElementCounts counts;
  {
    Stage stage(context, "sweep");
    counts = sweep::countElements(map.map, map.expectedCells, map.team, stage);
  }
  statistics.generators = counts.vertices.generatorCounts;
  statistics.vertices = counts.vertices.vertexCounts;
  Partition partition =
      makePartition({map.map, counts, map.team}, options.parts, options.method, context);
  const auto make = [&]<class Id>(Id /*type*/) -> std::unique_ptr<PartMaker> {
    return std::make_unique<Maker<Id>>(map, options, std::move(counts), std::move(partition),
                                       std::move(charts));
  };
  if (counts.vertices.count() > kMaxNarrowVertices) return make(std::uint64_t{});
  return make(Index{});
}

}  // namespace hexhex::parts
