#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include <adjacency/hex_topology.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <curved/blending.hpp>
#include <curved/lagrange.hpp>
#include <curved/transfinite.hpp>
#include <mesh/cell_validity.hpp>

namespace hexhex::curved {

namespace {

constexpr std::size_t kBlendingGrain = 256;

/// After this many halvings a node goes all the way to the straight cell: the last sixteenth of the
/// way is not worth checking the cells around it again.
constexpr std::uint8_t kMostHalvings = 4;

/// The tagged edges (n = 2) or quads (n = 4), by their vertices.
template <std::size_t n>
class TaggedVertices {
 public:
  template <class Feature>
  explicit TaggedVertices(const std::vector<Feature>& features) {
    for (const Feature& feature : features) all_.push_back(sorted(feature.vertices));
    std::sort(all_.begin(), all_.end());
  }
  [[nodiscard]] bool contain(const std::array<Index, n>& vertices) const {
    return !all_.empty() && std::binary_search(all_.begin(), all_.end(), sorted(vertices));
  }

 private:
  std::vector<std::array<Index, n>> all_;
};

class Blender {
 public:
  Blender(LagrangeMesh& mesh, Stage& stage)
      : mesh_(mesh),
        stage_(stage),
        blended_(mesh.order),
        validity_(mesh.order),
        straightValidity_(1),
        exact_(mesh.points),
        owner_(mesh.points.size(), kNone),
        isOnSurface_(mesh.points.size(), 0),
        steps_(mesh.points.size(), 0),
        isMoving_(mesh.points.size(), 0) {}

  std::vector<Index> run() {
    findSurface();
    std::vector<Index> cells(mesh_.cellCount());
    std::iota(cells.begin(), cells.end(), Index{0});
    stage_.setTotal(4 * cells.size());
    placeNodes(cells);
    // At first, all other nodes are straight.
    std::vector<Index> changed = thoseWith(cells, isOnSurface_);
    while (!changed.empty()) {
      std::fill(isMoving_.begin(), isMoving_.end(), std::uint8_t{0});
      for (const Index cell : findFolded(changed)) takeNextStep(cell);
      changed = thoseWith(cells, isMoving_);
      for (std::size_t node = 0; node < steps_.size(); ++node) {
        if (isMoving_[node] != 0) ++steps_[node];
      }
      placeNodes(changed);
    }
    for (std::size_t node = 0; node < steps_.size(); ++node) {
      if (isOnSurface_[node] == 0) steps_[node] = 0;
    }
    return thoseWith(cells, steps_);
  }

 private:
  [[nodiscard]] Index nodeOf(Index cell, std::size_t place) const {
    return mesh_.nodes[cell * mesh_.nodesPerCell() + place];
  }

  /// Whether any non-corner node of a cell has a property: is(node, whether inside a face).
  template <class Is>
  [[nodiscard]] bool any(Index cell, const Is& is) const {
    for (const auto* const nodes : blended_.all()) {
      for (const BlendedNode& b : *nodes) {
        if (is(nodeOf(cell, b.node), nodes == &blended_.ofFaces)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] std::vector<Index> thoseWith(const std::vector<Index>& cells,
                                             const std::vector<std::uint8_t>& marks) const {
    std::vector<Index> result;
    for (const Index cell : cells) {
      if (any(cell, [&](Index node, bool /*isInFace*/) { return marks[node] != 0; })) {
        result.push_back(cell);
      }
    }
    return result;
  }

  /// Finds the nodes that stay on the image of the map. A node inside an edge or face belongs to no
  /// other edge or face, so it stands for that one. Single-threaded: finding the nodes took a
  /// hundred times as long.
  void findSurface() {
    std::vector<std::uint8_t> isInner(mesh_.points.size(), 0);
    for (Index cell = 0; cell < mesh_.cellCount(); ++cell) {
      for (std::size_t place = 0; place < mesh_.nodesPerCell(); ++place) {
        const Index node = nodeOf(cell, place);
        if (owner_[node] == kNone) {
          owner_[node] = cell;
        } else if (mesh_.regions.empty() || mesh_.regions[owner_[node]] == mesh_.regions[cell]) {
          isInner[node] = 1;
        }
      }
    }
    const TaggedVertices<2> edges(mesh_.features.edges);
    const TaggedVertices<4> quads(mesh_.features.quads);
    for (Index cell = 0; cell < mesh_.cellCount(); ++cell) markSurface(cell, isInner, edges, quads);
  }

  void markSurface(Index cell, const std::vector<std::uint8_t>& isInner,
                   const TaggedVertices<2>& edges, const TaggedVertices<4>& quads) {
    const auto p = static_cast<std::size_t>(mesh_.order);
    // The node that many steps from one corner towards two others.
    const auto at = [&](std::size_t a, std::size_t b, std::size_t s, std::size_t c, std::size_t t) {
      const auto corner = [&](std::size_t i) {
        return static_cast<std::ptrdiff_t>(nodeOfCorner(i, mesh_.order));
      };
      const std::ptrdiff_t steps = static_cast<std::ptrdiff_t>(s) * (corner(b) - corner(a)) +
                                   static_cast<std::ptrdiff_t>(t) * (corner(c) - corner(a));
      return nodeOf(cell, static_cast<std::size_t>(corner(a) + steps / mesh_.order));
    };
    for (const auto& [a, b] : adjacency::kHexEdges) {
      if (!edges.contain({at(a, b, 0, a, 0), at(a, b, p, a, 0)})) continue;
      for (std::size_t s = 1; s < p; ++s) isOnSurface_[at(a, b, s, a, 0)] = 1;
    }
    for (const auto& f : adjacency::kHexFaces) {
      const auto in = [&](std::size_t s, std::size_t t) { return at(f[0], f[1], s, f[3], t); };
      if (isInner[in(1, 1)] != 0 && !quads.contain({in(0, 0), in(p, 0), in(p, p), in(0, p)})) {
        continue;
      }
      for (std::size_t i = 0; i < (p + 1) * (p + 1); ++i) {
        isOnSurface_[in(i % (p + 1), i / (p + 1))] = 1;
      }
    }
  }

  /// Puts nodes at their current places: inside edges, then faces, then cells. Nodes shared by
  /// cells are placed by the first of these cells, since its orientation affects rounding.
  void placeNodes(const std::vector<Index>& cells) {
    for (const auto* const nodes : blended_.all()) {
      parallelFor(stage_, cells.size(), kBlendingGrain, [&](std::size_t i) {
        for (const BlendedNode& b : *nodes) {
          const Index node = nodeOf(cells[i], b.node);
          if (owner_[node] == cells[i]) mesh_.points[node] = placeOf(node, cells[i], b);
        }
      });
    }
  }

  [[nodiscard]] Vec3 placeOf(Index node, Index cell, const BlendedNode& b) const {
    const Vec3 blended = blend(mesh_.points, cell, b);
    const double share = shareOf(node);
    if (share == 0) return blended;
    const Vec3 before = blend(exact_, cell, b);
    if (share == 1 && blended == before) return exact_[node];
    return plus(blended, times(share, minus(exact_[node], before)));
  }

  /// Position of a node between its blended place (0) and the image of the map (1).
  [[nodiscard]] double shareOf(Index node) const {
    if (isOnSurface_[node] == 0) return steps_[node] == 1 ? 1 : 0;
    return steps_[node] > kMostHalvings ? 0 : 1.0 / static_cast<double>(1U << steps_[node]);
  }

  [[nodiscard]] Vec3 blend(const Array<Vec3>& points, Index cell, const BlendedNode& b) const {
    Vec3 sum{};
    for (const auto& [place, weight] : b.weights) {
      sum = plus(sum, times(weight, points[nodeOf(cell, place)]));
    }
    return sum;
  }

  /// The cells that are not positive although their straight versions are.
  [[nodiscard]] std::vector<Index> findFolded(const std::vector<Index>& cells) const {
    std::vector<std::uint8_t> isFolded(cells.size());
    parallelBlocks(
        stage_, cells.size(), kBlendingGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
          std::vector<Vec3> nodes(mesh_.nodesPerCell());
          for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < nodes.size(); ++k) {
              nodes[k] = mesh_.points[nodeOf(cells[i], k)];
            }
            isFolded[i] =
                isPositive(validity_, nodes) || !isPositive(straightValidity_, cornersOf(cells[i]))
                    ? 0
                    : 1;
          }
        });
    std::vector<Index> folded;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (isFolded[i] != 0) folded.push_back(cells[i]);
    }
    return folded;
  }

  [[nodiscard]] static bool isPositive(const mesh::CellValidity& cells,
                                       const std::vector<Vec3>& nodes) {
    return cells.examine(nodes).validity == Validity::Positive;
  }

  /// The cell's corners, as nodes of a cell of order 1.
  [[nodiscard]] std::vector<Vec3> cornersOf(Index cell) const {
    std::vector<Vec3> corners(8);
    for (std::size_t i = 0; i < 8; ++i) {
      corners[nodeOfCorner(i, 1)] = mesh_.points[nodeOf(cell, nodeOfCorner(i, mesh_.order))];
    }
    return corners;
  }

  /// Marks the nodes of a folded cell that move next. Interior nodes go to the image of the map:
  /// thin layers of cells must be curved together. If that does not help, they return for good, and
  /// surface nodes leave the surface by halves: first only those inside faces, since nodes of an
  /// edge belong to more cells.
  void takeNextStep(Index cell) {
    const auto move = [&](const auto& isNext) {
      bool isAny = false;
      static_cast<void>(any(cell, [&](Index node, bool isInFace) {
        if (!isNext(node, isInFace)) return false;
        isMoving_[node] = 1;
        isAny = true;
        return false;
      }));
      return isAny;
    };
    for (const int step : {0, 1}) {
      if (move([&](Index node, bool) { return isOnSurface_[node] == 0 && steps_[node] == step; })) {
        return;
      }
    }
    const auto isLeft = [&](Index node) {
      return isOnSurface_[node] != 0 && steps_[node] <= kMostHalvings;
    };
    if (move([&](Index node, bool isInFace) {
          return isInFace && isLeft(node) && steps_[node] == 0;
        })) {
      return;
    }
    move([&](Index node, bool) { return isLeft(node); });
  }

  LagrangeMesh& mesh_;
  Stage& stage_;
  BlendedNodes blended_;
  mesh::CellValidity validity_;
  mesh::CellValidity straightValidity_;
  Array<Vec3> exact_;                      ///< per node: on the image of the map
  std::vector<Index> owner_;               ///< per node: its first cell
  std::vector<std::uint8_t> isOnSurface_;  ///< per node: until it has to leave the surface
  std::vector<std::uint8_t> steps_;        ///< per node
  std::vector<std::uint8_t> isMoving_;     ///< per node: moves in this round
};

}  // namespace

std::vector<Index> blendNodes(LagrangeMesh& mesh, Stage& stage) {
  if (mesh.order == 1) return {};
  return Blender(mesh, stage).run();
}

}  // namespace hexhex::curved
