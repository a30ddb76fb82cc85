// M. Snoep, B. Speckmann, K. Verbeek, "Robust construction of polycube segmentations via dual
// loops" (2025): begin with a simple polycube that has as many handles as the part, and change
// labels only such that they stay those of a polycube.
//
// Here it is a prism. Loops along all handles, and paths between them, have a neighbourhood that is
// a disk with a hole for each handle, and so is the rest of the surface: top and bottom. The rings
// between them are walls. Each is divided into columns, whose directions turn four times more to
// one side than to the other. Any such sequence is that of some polygon without crossings (J.
// Culberson, G. Rawlins, "Turtlegons: generating simple polygons from sequences of angles", 1985).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <shape/chart_moves.hpp>
#include <shape/handle_loops.hpp>
#include <shape/label_check.hpp>
#include <shape/loop_labels.hpp>
#include <shape/wall_directions.hpp>

namespace hexhex::shape {
namespace {

constexpr Index kTop = 0;  // charts; walls have others
constexpr Index kBottom = 1;
/// The cost of a corner between columns, and that of a border as long as the root of the area,
/// relative to labels at right angles to all of the surface.
constexpr double kCostOfCorner = 0.005;
constexpr double kCostOfBorder = 0.1;

/// Splits edges of the boundary.
/// @param splits  of the vertices of an edge
template <class Splits>
void splitEdges(PositiveTets& tets, Surface& surface, const Splits& splits, Stage& stage) {
  std::vector<tetmap::EdgeInTet> edges;
  for (Side side = 0; side < surface.tails.size(); ++side) {
    const tetmap::VertexPair edge = tetmap::pairOf(surface.tails[side], surface.head(side));
    if (splits(edge)) {
      edges.push_back({edge, adjacency::tetOf(surface.faces[Surface::triangleOf(side)])});
    }
  }
  if (edges.empty()) return;
  tets.split(std::move(edges), stage);
  const TetMesh& mesh = tets.mesh();
  surface =
      surfaceOf(*adjacency::manifoldTopology(mesh.tets, mesh.points.size(), stage), mesh.points);
}

/// Splits edges until the triangles at a graph are a neighbourhood of it, and those at the ring of
/// vertices around them are walls.
/// @return per vertex: whether it is on such a ring
std::vector<bool> makeRoom(PositiveTets& tets, Surface& surface, const LoopGraph& graph,
                           Stage& stage) {
  const auto isChord = [&graph](const tetmap::VertexPair& edge) {
    return graph.has[edge[0]] && graph.has[edge[1]] &&
           !std::binary_search(graph.edges.begin(), graph.edges.end(), edge);
  };
  splitEdges(tets, surface, isChord, stage);
  std::vector<bool> isInside = graph.has;
  const auto crosses = [&isInside](const tetmap::VertexPair& edge) {
    return isInside[edge[0]] != isInside[edge[1]];
  };
  isInside.resize(surface.pointCount);
  const std::size_t before = surface.pointCount;
  splitEdges(tets, surface, crosses, stage);
  std::vector<bool> isRing(before);
  isRing.resize(surface.pointCount, true);
  isInside.resize(surface.pointCount, true);
  splitEdges(tets, surface, crosses, stage);
  isRing.resize(surface.pointCount);
  return isRing;
}

class Prism {
 public:
  Prism(PositiveTets tets, Surface surface, lattice::Direction up)
      : tets_(std::move(tets)), surface_(std::move(surface)), up_(up) {
    const lattice::Direction x = lattice::direction((lattice::axisOf(up) + 1) % 3, 1);
    const lattice::Direction y = lattice::cross(up, x);
    around_ = {x, y, lattice::opposite(x), lattice::opposite(y)};
  }

  /// @return whether there is room
  bool label(const LoopGraph& graph, Stage& stage) {
    const std::vector<bool> isRing = makeRoom(tets_, surface_, graph, stage);
    if (!makeColumns(graph.has, isRing)) return false;
    // With a price on length from the start, borders stay where they are shortest.
    for (const double price : {0.0, kCostOfBorder}) widen(price, stage.context());
    nameWalls();
    for (const double price : {0.0, kCostOfBorder}) settle(price, stage.context());
    return true;
  }

  [[nodiscard]] LoopLabels take() && {
    Labels labels;
    labels.reserve(chartOf_.size());
    for (const Index chart : chartOf_) labels.push_back(labelOf_[chart]);
    return {std::move(tets_), std::move(surface_), std::move(labels)};
  }

 private:
  struct Wall {
    Index begin, end;  ///< its columns, counterclockwise as seen from below
    Index vertex;
  };

  /// Divides walls such that each column has an edge at the top and one at the bottom.
  bool makeColumns(const std::vector<bool>& isTop, const std::vector<bool>& isRing) {
    chartOf_.assign(surface_.triangleCount(), kBottom);
    for (Side side = 0; side < surface_.tails.size(); ++side) {
      const Index v = surface_.tails[side];
      Index& chart = chartOf_[Surface::triangleOf(side)];
      if (v < isTop.size() && isTop[v]) chart = kTop;
      if (isRing[v] && chart != kTop) chart = kNone;
    }
    for (Side side = 0; side < surface_.tails.size(); ++side) {
      const bool isTopOfNew =
          chartOf_[Surface::triangleOf(side)] == kTop && chartOf_[surface_.beyond(side)] == kNone;
      if (isTopOfNew && !makeWall(surface_.twins[side])) return false;
    }
    return true;
  }

  /// @param first  a side of the wall at the top
  bool makeWall(Side first) {
    std::vector<Index> triangles;
    std::vector<bool> isAtTop;
    const auto isOut = [&](Side side) { return chartOf_[surface_.beyond(side)] <= kBottom; };
    Side side = first;
    do {
      const Index t = Surface::triangleOf(side);
      Side border = 3 * t;  // of the wall; either the top is beyond or the bottom
      while (!isOut(border)) ++border;
      triangles.push_back(t);
      isAtTop.push_back(chartOf_[surface_.beyond(border)] == kTop);
      const Side next = Surface::next(border);
      side = surface_.twins[isAtTop.back() ? next : Surface::next(next)];
    } while (Surface::triangleOf(side) != Surface::triangleOf(first));
    const std::size_t count = triangles.size();
    const auto begins = [&](std::size_t i) {
      return isAtTop[i % count] && !isAtTop[(i + count - 1) % count];
    };
    std::size_t begin = 0;
    while (begin < count && !begins(begin)) ++begin;
    Wall wall = {charts_, charts_, surface_.tails[first]};
    for (std::size_t i = begin; i < begin + count; ++i) {
      if (begins(i)) ++wall.end;
      chartOf_[triangles[i % count]] = wall.end - 1;
    }
    charts_ = wall.end;
    walls_.push_back(wall);
    return wall.end - wall.begin >= Index{kLeastColumns};
  }

  [[nodiscard]] double shareOf(Index t) const { return surface_.areas[t] / surface_.area; }
  [[nodiscard]] double relativeLength(Side side) const {
    return surface_.lengths[side] / std::sqrt(surface_.area);
  }

  /// Lets walls take all that is neither above nor below.
  void widen(double price, Context& context) {
    const auto ofTriangle = [&](Index t, Index chart) {
      const double up = cosine(surface_.normals[t], up_);
      const double best = chart == kTop      ? up
                          : chart == kBottom ? -up
                                             : std::sqrt(std::max(0.0, 1 - up * up));
      return shareOf(t) * (1 - best);
    };
    const auto ofSide = [&](Side side, Index chart, Index beyond) {
      const bool isInWall = chart > kBottom && beyond > kBottom;
      return isInWall ? 0 : price * relativeLength(side);
    };
    moveBorders(surface_, chartOf_, ofTriangle, ofSide, context);
  }

  /// Gives columns their directions, and joins those that have the same.
  void nameWalls() {
    std::vector<std::array<double, 4>> costs(charts_);
    for (Index t = 0; t < chartOf_.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        costs[chartOf_[t]][i] += shareOf(t) * (1 - cosine(surface_.normals[t], around_[i]));
      }
    }
    std::vector<WallDirections> outer;
    std::vector<WallDirections> inner;
    for (const Wall& wall : walls_) {
      const std::vector<std::array<double, 4>> ofWall = {costs.begin() + wall.begin,
                                                         costs.begin() + wall.end};
      outer.push_back(cheapestDirections(ofWall, -4, kCostOfCorner));
      inner.push_back(cheapestDirections(ofWall, 4, kCostOfCorner));
    }
    // One wall of each component is outside: the one that costs least there, compared to a hole.
    const std::vector<Index> componentOf = surface_.components();
    std::vector<std::size_t> outerOf(surface_.pointCount, walls_.size());
    const auto extra = [&](std::size_t i) { return outer[i].cost - inner[i].cost; };
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      std::size_t& best = outerOf[componentOf[walls_[i].vertex]];
      if (best == walls_.size() || extra(i) < extra(best)) best = i;
    }
    labelOf_.assign(charts_, up_);
    labelOf_[kBottom] = lattice::opposite(up_);
    std::vector<Index> names = {kTop, kBottom};
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      const bool isOuter = outerOf[componentOf[walls_[i].vertex]] == i;
      nameColumns(walls_[i], (isOuter ? outer : inner)[i].ofColumns, names);
    }
    for (Index& chart : chartOf_) chart = names[chart];
  }

  /// @param[in,out] names  per chart: the one that it becomes a part of
  void nameColumns(const Wall& wall, const std::vector<int>& directions,
                   std::vector<Index>& names) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const auto column = static_cast<Index>(wall.begin + i);
      labelOf_[column] = around_[static_cast<std::size_t>(directions[i])];
      const bool continues = i > 0 && directions[i] == directions[i - 1];
      names.push_back(continues ? names.back() : column);
    }
    if (directions.back() != directions.front()) return;
    std::replace(names.begin() + wall.begin, names.end(), Index{names.back()}, wall.begin);
  }

  /// Moves borders to where labels fit.
  void settle(double price, Context& context) {
    const auto ofTriangle = [&](Index t, Index chart) {
      return shareOf(t) * (1 - cosine(surface_.normals[t], labelOf_[chart]));
    };
    const auto ofSide = [&](Side side, Index chart, Index beyond) {
      const int axis = 3 - lattice::axisOf(labelOf_[chart]) - lattice::axisOf(labelOf_[beyond]);
      const double along = std::abs(surface_.directions[side][static_cast<std::size_t>(axis)]);
      return price * relativeLength(side) * (2 - along);
    };
    moveBorders(surface_, chartOf_, ofTriangle, ofSide, context);
  }

  PositiveTets tets_;
  Surface surface_;
  lattice::Direction up_;
  std::array<lattice::Direction, 4> around_{};  ///< counterclockwise as seen from above
  std::vector<Index> chartOf_;                  ///< per triangle
  Index charts_ = kBottom + 1;
  std::vector<Wall> walls_;
  std::vector<lattice::Direction> labelOf_;  ///< per chart
};

/// @return nothing if loops or walls have no room
std::optional<LoopLabels> bestPrism(const PositiveTets& tets, const Surface& surface,
                                    Stage& stage) {
  const HandleLoops loops(tets.mesh().tets, surface, tets.mesh().points, stage);
  std::optional<LoopLabels> best;
  double least = std::numeric_limits<double>::infinity();
  for (lattice::Direction up = 0; up < lattice::kDirections; ++up) {
    const std::optional<LoopGraph> graph = loops.graph(up, stage);
    if (!graph) continue;
    Prism prism(tets, surface, up);
    if (!prism.label(*graph, stage)) continue;
    LoopLabels found = std::move(prism).take();
    const LabelCosts costs(found.surface);
    const double energy = LabelCheck(found.surface, costs)(found.labels).energy;
    if (energy < least) least = energy, best = std::move(found);
  }
  return best;
}

}  // namespace

std::optional<LoopLabels> labelsByLoops(PositiveTets tets, Surface surface, Stage& stage) {
  constexpr int kMostHalvings = 2;
  for (int halvings = 0;; ++halvings) {
    std::optional<LoopLabels> best = bestPrism(tets, surface, stage);
    if (best || halvings == kMostHalvings) return best;
    const auto all = [](const tetmap::VertexPair& /*edge*/) { return true; };
    splitEdges(tets, surface, all, stage);
  }
}

}  // namespace hexhex::shape
