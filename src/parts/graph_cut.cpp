// Cuts the graph of elements with METIS (multilevel k-way partitioning, Karypis and Kumar 1998) or
// Scotch (Pellegrini and Roman 1996).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <parts/partition.hpp>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/loaded_library.hpp>

namespace hexhex::parts {

namespace {

/// The graph in the form that both libraries take.
struct Graph {
  std::vector<std::int32_t> begin;  ///< per element (+1)
  std::vector<std::int32_t> neighbours;
  std::vector<std::int32_t> edgeWeights;
  std::vector<std::int32_t> cells;  ///< per element, scaled
};

/// METIS_PartGraphKway() of METIS 5 with 32-bit integers. Scotch has a function with the same
/// signature.
using PartGraph = int (*)(std::int32_t* vertices, std::int32_t* constraints, std::int32_t* begin,
                          std::int32_t* neighbours, std::int32_t* vertexWeights,
                          std::int32_t* vertexSizes, std::int32_t* edgeWeights, std::int32_t* parts,
                          void* partWeights, void* imbalance, std::int32_t* options,
                          std::int32_t* cut, std::int32_t* partOf);

struct Library {
  const char* title;
  const char* file;
  const char* function;
  const char* package;
};

constexpr Library kMetis = {"METIS", "libmetis.so.5", "METIS_PartGraphKway", "libmetis5"};
constexpr Library kScotch = {"Scotch", "libscotchmetisv5-7.0.so", "SCOTCH_METIS_V5_PartGraphKway",
                             "libscotch-7.0"};

PartGraph load(const Library& library) {
#if defined(__unix__) || defined(__APPLE__)
  // What Scotch returns depends on which of its threads comes first, and on how many there are.
  if (&library == &kScotch) setenv("SCOTCH_PTHREAD_NUMBER", "1", /*overwrite=*/0);
#endif
  LoadedLibrary loaded({library.file});
  const auto function = loaded.find<PartGraph>(library.function);
  if (function != nullptr) {
    // Its random numbers would go on from those of earlier calls.
    if (const auto reset = loaded.find<void (*)()>("SCOTCH_randomReset")) reset();
    return function;
  }
  throw Error(ErrorCode::InvalidArgument,
              concat(library.title, " cannot be loaded (", loaded.problem(), "). Install ",
                     library.package, ", or choose the partition \"curve\"."));
}

/// Collects which elements touch, and in how large an area.
class GraphMaker {
 public:
  GraphMaker(const igm::PreparedMap& map, const Partition& partition,
             const std::vector<PartitionElement>& elements)
      : map_(map),
        partition_(partition),
        elements_(elements),
        ofTet_(map.topology.tetCount(), kNone),
        ofBlock_(partition.ofBlock.size(), kNone) {
    for (Index e = 0; e < elements.size(); ++e) {
      const PartitionElement& element = elements[e];
      if (element.blocks == kNone) {
        ofTet_[element.tet] = e;
      } else {
        ofBlock_[partition.blocks[element.blocks].first + element.block] = e;
      }
    }
  }

  [[nodiscard]] Graph make() {
    for (Index tet = 0; tet < map_.topology.tetCount(); ++tet) {
      for (int face = 0; face < 4; ++face) {
        const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, face);
        const adjacency::HalfFace mate = map_.topology.mate[halfFace];
        if (mate != kNone && mate > halfFace) addFace(halfFace, mate);
      }
    }
    for (const TetBlocks& blocks : partition_.blocks) addBlocks(blocks);
    return collect();
  }

 private:
  struct Edge {
    Index from;
    Index to;
    double weight;
  };

  void add(Index a, Index b, double weight) {
    if (a == kNone || b == kNone || a == b) return;
    edges_.push_back({a, b, weight});
    edges_.push_back({b, a, weight});
  }

  /// Corners of a half-face's triangle in grid units, then the opposite corner.
  [[nodiscard]] std::array<Vec3, 4> cornersOf(adjacency::HalfFace halfFace) const {
    const lattice::LatticeTet& tet = map_.exact.corners[adjacency::tetOf(halfFace)];
    std::array<Vec3, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = i < 3 ? static_cast<std::size_t>(lattice::kFaceCorners[halfFace % 4][i])
                                : static_cast<std::size_t>(halfFace % 4);
      for (std::size_t k = 0; k < 3; ++k) {
        corners[i][k] = static_cast<double>(tet[corner][k]) / static_cast<double>(map_.exact.unit);
      }
    }
    return corners;
  }
  static double areaOf(const std::array<Vec3, 4>& corners) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3;
      const std::size_t j = (k + 2) % 3;
      const double normal = (corners[1][i] - corners[0][i]) * (corners[2][j] - corners[0][j]) -
                            (corners[1][j] - corners[0][j]) * (corners[2][i] - corners[0][i]);
      square += normal * normal;
    }
    return std::sqrt(square) / 2;
  }

  /// The element of a tet at a place in its chart, or at the nearest of its blocks in the grid.
  [[nodiscard]] Index elementAt(Index tet, const Vec3& place) const {
    const TetBlocks* const blocks = partition_.blocksOf(tet);
    if (blocks == nullptr) return ofTet_[tet];
    lattice::GridPoint z{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double high = blocks->low[k] + static_cast<double>(blocks->size[k]) * blocks->side - 1;
      z[k] = static_cast<std::int32_t>(
          std::clamp(std::floor(place[k]), static_cast<double>(blocks->low[k]), high));
    }
    return ofBlock_[blocks->first + blocks->blockOf(z)];
  }

  /// Looks up both sides at some points of the face, about one per block along it.
  void addFace(adjacency::HalfFace here, adjacency::HalfFace there) {
    const std::array<Vec3, 4> corners = cornersOf(here);
    const double area = areaOf(corners);
    const Index tet = adjacency::tetOf(here);
    const Index other = adjacency::tetOf(there);
    const TetBlocks* const blocks = partition_.blocksOf(tet);
    const TetBlocks* const others = partition_.blocksOf(other);
    if (blocks == nullptr && others == nullptr) {
      add(ofTet_[tet], ofTet_[other], area);
      return;
    }
    constexpr double kMost = 64;
    const double side = std::min(blocks != nullptr ? blocks->side : others->side,
                                 others != nullptr ? others->side : blocks->side);
    const auto steps = static_cast<int>(std::clamp(2 * std::sqrt(2 * area) / side, 1.0, kMost));
    const lattice::Transition& across = map_.exact.transitions.across(here);
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; i + j < steps; ++j) {
        const double a = (i + 1.0 / 3) / steps;
        const double b = (j + 1.0 / 3) / steps;
        Vec3 inside{};
        Vec3 outside{};
        for (std::size_t k = 0; k < 3; ++k) {
          const double at = corners[0][k] + a * (corners[1][k] - corners[0][k]) +
                            b * (corners[2][k] - corners[0][k]);
          const double middle = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
          const double inward = (corners[3][k] - middle) * 0.01;
          inside[k] = at + inward;
          outside[k] = at - inward;
        }
        add(elementAt(tet, inside), elementAt(other, across(outside, 1.0)),
            2 * area / (static_cast<double>(steps) * (steps + 1)));
      }
    }
  }

  /// Adds the edges between blocks of one tet that are neighbours in its chart.
  void addBlocks(const TetBlocks& blocks) {
    const double area = static_cast<double>(blocks.side) * blocks.side;
    const std::array<std::size_t, 3> steps = {std::size_t{blocks.size[1]} * blocks.size[2],
                                              blocks.size[2], 1};
    for (std::size_t b = 0; b < blocks.count(); ++b) {
      if (ofBlock_[blocks.first + b] == kNone) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (b / steps[k] % blocks.size[k] + 1 == blocks.size[k]) continue;
        add(ofBlock_[blocks.first + b], ofBlock_[blocks.first + b + steps[k]], area);
      }
    }
  }

  [[nodiscard]] Graph collect() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    Graph graph;
    graph.begin.assign(elements_.size() + 1, 0);
    std::size_t kept = 0;
    for (const Edge& edge : edges_) {
      if (kept > 0 && edges_[kept - 1].from == edge.from && edges_[kept - 1].to == edge.to) {
        edges_[kept - 1].weight += edge.weight;
      } else {
        edges_[kept++] = edge;
      }
    }
    edges_.resize(kept);
    if (kept > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      throw Error(ErrorCode::TooLarge,
                  "The graph of the map's tets is too large for METIS and Scotch. Choose the "
                  "partition \"curve\".");
    }
    double largest = 1;
    for (const Edge& edge : edges_) largest = std::max(largest, edge.weight);
    constexpr double kMostWeight = 1 << 20;
    const double scale = std::min(16.0, kMostWeight / largest);
    for (const Edge& edge : edges_) {
      ++graph.begin[std::size_t{edge.from} + 1];
      graph.neighbours.push_back(static_cast<std::int32_t>(edge.to));
      graph.edgeWeights.push_back(
          std::max(1, static_cast<std::int32_t>(std::lround(edge.weight * scale))));
    }
    for (std::size_t e = 0; e < elements_.size(); ++e) graph.begin[e + 1] += graph.begin[e];
    addCells(graph);
    return graph;
  }
  /// Scales weights so that their sums fit the libraries' integers.
  void addCells(Graph& graph) const {
    double all = 1;
    for (const PartitionElement& element : elements_) all += static_cast<double>(element.cells);
    constexpr double kMostSum = 1 << 30;
    const double scale = std::min(1.0, kMostSum / all);
    for (const PartitionElement& element : elements_) {
      graph.cells.push_back(
          static_cast<std::int32_t>(std::floor(static_cast<double>(element.cells) * scale)));
    }
  }

  const igm::PreparedMap& map_;
  const Partition& partition_;
  const std::vector<PartitionElement>& elements_;
  std::vector<Index> ofTet_;    ///< per whole tet: its element
  std::vector<Index> ofBlock_;  ///< per block: its element
  std::vector<Edge> edges_;     ///< in both directions
};

}  // namespace

std::vector<std::uint32_t> cutGraph(const igm::PreparedMap& map, const Partition& partition,
                                    const std::vector<PartitionElement>& elements,
                                    PartitionMethod method) {
  const Library& library = method == PartitionMethod::Metis ? kMetis : kScotch;
  const PartGraph partGraph = load(library);
  std::vector<std::uint32_t> result(elements.size(), 0);
  if (partition.parts == 1) return result;
  Graph graph = GraphMaker(map, partition, elements).make();
  auto vertices = static_cast<std::int32_t>(elements.size());
  std::int32_t constraints = 1;
  auto parts = static_cast<std::int32_t>(partition.parts);
  // Elements are a thirty-second of a part: with these values, parts stay within 5 %.
  float forMetis = 1.02F;
  double forScotch = 0.02;  // excess over the mean
  void* const imbalance = method == PartitionMethod::Metis ? static_cast<void*>(&forMetis)
                                                           : static_cast<void*>(&forScotch);
  std::int32_t cut = 0;
  std::vector<std::int32_t> partOf(elements.size(), 0);
  constexpr int kMetisOk = 1;
  const int status = partGraph(&vertices, &constraints, graph.begin.data(), graph.neighbours.data(),
                               graph.cells.data(), nullptr, graph.edgeWeights.data(), &parts,
                               nullptr, imbalance, nullptr, &cut, partOf.data());
  const bool isRight = std::all_of(partOf.begin(), partOf.end(), [parts](std::int32_t part) {
    return part >= 0 && part < parts;
  });
  if (status != kMetisOk || !isRight) {
    throw Error(ErrorCode::InvalidArgument,
                std::string(library.title) +
                    " could not cut the mesh into so many parts. Choose the partition \"curve\".");
  }
  std::copy(partOf.begin(), partOf.end(), result.begin());
  return result;
}

}  // namespace hexhex::parts
