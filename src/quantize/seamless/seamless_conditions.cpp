#include <algorithm>
#include <iterator>
#include <utility>

#include <quantize/seamless/seamless_conditions.hpp>
#include <tetmap/freedom.hpp>

#include <base/disjoint_sets.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::quantization {

namespace {

/// Applies a rotation to a vector of forms.
std::array<IntegerForm, 3> rotated(lattice::Rotation rotation,
                                   const std::array<IntegerForm, 3>& forms) {
  std::array<IntegerForm, 3> image;
  for (int from = 0; from < 3; ++from) {
    const lattice::Direction to = rotation(lattice::direction(from, 1));
    image[static_cast<std::size_t>(lattice::axisOf(to))].add(forms[static_cast<std::size_t>(from)],
                                                             lattice::signOf(to));
  }
  return image;
}

using SharedEquations = tetmap::PointEquations<IntegerForm>;

/// Requires two paths to a sector to give the same parameter there.
void addDifference(const VertexConditions::Sector& reached, const VertexConditions::Sector& known,
                   SharedEquations& equations) {
  for (std::size_t k = 0; k < 3; ++k) {
    IntegerForm rest = reached.translation[k];
    rest.add(known.translation[k], -1);
    equations.addAgreement(reached.rotation, known.rotation, k, std::move(rest));
  }
}

/// Adds the planes of a sector.
void addPlanes(const VertexConditions::Sector& sector, const SharedUnknowns& unknowns,
               SharedEquations& equations) {
  for (int from = 0; from < 3; ++from) {
    const auto axis =
        static_cast<std::size_t>(lattice::axisOf(sector.rotation(lattice::direction(from, 1))));
    const Index plane = unknowns.plane(sector.sector, axis);
    if (plane == kNone) continue;
    IntegerForm rest = sector.translation[axis];
    rest.add({plane, 1}, -1);
    equations.addPlane(sector.rotation, axis, std::move(rest));
  }
}

/// A transition from one sector at a vertex to another, across the cut.
struct SectorTransition {
  Index from;
  Index to;
  adjacency::HalfFace halfFace;
};

std::vector<SectorTransition> transitionsAt(Index vertex, const adjacency::TetTopology& topology,
                                            const CutGraph& graph) {
  std::vector<SectorTransition> transitions;
  for (const adjacency::CornerIndex corner : topology.star(vertex)) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(corner / 4, face);
      if (face == adjacency::localOf(corner) || !graph.isCut[h]) continue;
      const Index there = adjacency::tetOf(topology.mate[h]);
      const adjacency::CornerIndex mate =
          4 * there + static_cast<Index>(topology.localCorner(there, vertex));
      transitions.push_back({graph.sectors[corner], graph.sectors[mate], h});
    }
  }
  return transitions;
}

}  // namespace

SharedUnknowns::SharedUnknowns(const adjacency::TetTopology& topology,
                               const adjacency::EdgeFans& edges, const CutGraph& graph,
                               const Alignment& alignment)
    : topology_(topology), graph_(graph) {
  numberCutPieces(edges);
  numberPlanes(alignment);
}

void SharedUnknowns::numberCutPieces(const adjacency::EdgeFans& edges) {
  // If an edge has exactly two triangles of the cut, translations across them are equal unless the
  // edge is singular.
  DisjointSets sets(topology_.mate.size());
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    std::vector<std::pair<adjacency::HalfFace, lattice::CornerMask>> cuts;
    for (const adjacency::EdgeCorner& at : edges(edge)) {
      forEachFaceAt(at, [&](adjacency::HalfFace h) {
        if (graph_.isCut[h]) cuts.emplace_back(h, at.mask());
      });
    }
    if (cuts.size() != 4 || edges.isBoundary(edge)) continue;
    for (const auto& [h, ends] : cuts) {
      const adjacency::HalfFace next = nextCutAround(topology_, graph_, ends, h);
      if (graph_.rotations[h] == graph_.rotations[next]) sets.unite(h, next);
    }
  }
  pieces_.assign(topology_.mate.size(), kNone);
  first_.assign(topology_.mate.size(), kNone);
  for (adjacency::HalfFace h = 0; h < topology_.mate.size(); ++h) {
    if (!graph_.isCut[h]) continue;
    pieces_[h] = sets.find(h);
    const adjacency::HalfFace otherSide = sets.find(topology_.mate[h]);
    if (pieces_[h] != h || otherSide < h) continue;
    first_[h] = static_cast<Index>(size_);
    size_ += 3;
  }
  // If a piece is one-sided, its translation equals that of its inverse.
  for (adjacency::HalfFace h = 0; h < topology_.mate.size(); ++h) {
    if (first_[h] == kNone || sets.find(topology_.mate[h]) != h) continue;
    std::array<IntegerForm, 3> own;
    for (std::size_t k = 0; k < 3; ++k) own[k] = translation(h, k);
    const auto back = rotated(graph_.rotations[h].inverse(), own);
    for (std::size_t k = 0; k < 3; ++k) {
      equations_.push_back(own[k]);
      equations_.back().add(back[k], 1);
    }
  }
}

void SharedUnknowns::numberPlanes(const Alignment& alignment) {
  DisjointSets sets(3 * graph_.sectorCount);
  std::vector<bool> isPlane(3 * graph_.sectorCount);
  const auto join = [&](adjacency::CornerIndex a, adjacency::CornerIndex b, Index axis) {
    const Index first = 3 * graph_.sectors[a] + axis;
    const Index second = 3 * graph_.sectors[b] + axis;
    isPlane[first] = isPlane[second] = true;
    sets.unite(first, second);
  };
  for (adjacency::HalfFace h = 0; h < topology_.mate.size(); ++h) {
    if (alignment.axes[h] == kFree) continue;
    const auto corner = [&](std::size_t k) {
      return adjacency::halfFaceOf(adjacency::tetOf(h), lattice::kFaceCorners[h % 4][k]);
    };
    join(corner(0), corner(1), alignment.axes[h]);
    join(corner(0), corner(2), alignment.axes[h]);
  }
  for (const auto& [at, along] : alignment.edges) {
    for (Index axis = 0; axis < 3; ++axis) {
      if (axis == along) continue;
      join(adjacency::halfFaceOf(at.tet, at.corner0), adjacency::halfFaceOf(at.tet, at.corner1),
           axis);
    }
  }
  planes_.assign(isPlane.size(), kNone);
  for (Index i = 0; i < planes_.size(); ++i) {
    if (!isPlane[i]) continue;
    const Index first = sets.find(i);
    planes_[i] = first == i ? static_cast<Index>(size_++) : planes_[first];
  }
}

IntegerForm SharedUnknowns::translation(adjacency::HalfFace halfFace, std::size_t axis) const {
  const adjacency::HalfFace piece = pieces_[halfFace];
  if (first_[piece] != kNone) return {first_[piece] + static_cast<Index>(axis), 1};
  // The unknown is that of the other side: u' = R u + t, so u = R^-1 u' - R^-1 t.
  const adjacency::HalfFace other = pieces_[topology_.mate[halfFace]];
  std::array<IntegerForm, 3> there;
  for (Index k = 0; k < 3; ++k) there[k] = {first_[other] + k, -1};
  return rotated(graph_.rotations[halfFace], there)[axis];
}

std::vector<adjacency::HalfFace> SharedUnknowns::cutPieces() const {
  std::vector<adjacency::HalfFace> pieces;
  for (adjacency::HalfFace h = 0; h < first_.size(); ++h) {
    if (first_[h] == kNone) continue;
    pieces.push_back(h);
    pieces.push_back(topology_.mate[h]);
  }
  return pieces;
}

std::vector<double> SharedUnknowns::measured() const {
  std::vector<double> sums(size_);
  std::vector<double> counts(size_);
  const auto add = [&](std::size_t unknown, double value) {
    sums[unknown] += value;
    counts[unknown] += 1;
  };
  for (adjacency::HalfFace h = 0; h < topology_.mate.size(); ++h) {
    if (!graph_.isCut[h] || first_[pieces_[h]] == kNone) continue;
    const igm::SharedTriangle triangle(topology_, graph_.parameters, h);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 here = graph_.rotations[h](triangle.here[k]);
      for (std::size_t i = 0; i < 3; ++i) {
        add(first_[pieces_[h]] + i, triangle.there[k][i] - here[i]);
      }
    }
  }
  for (adjacency::CornerIndex corner = 0; corner < graph_.sectors.size(); ++corner) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index unknown = plane(graph_.sectors[corner], i);
      if (unknown != kNone) add(unknown, graph_.parameters[corner / 4][corner % 4][i]);
    }
  }
  for (std::size_t i = 0; i < size_; ++i) sums[i] /= counts[i];
  return sums;
}

VertexConditions conditionsOf(Index vertex, const adjacency::TetTopology& topology,
                              const CutGraph& graph, const SharedUnknowns& unknowns,
                              std::vector<IntegerForm>& equations) {
  VertexConditions conditions;
  SharedEquations ofPoint;
  // Reaches all sectors from the first one, across the cut; every further path to a known sector
  // gives a condition.
  const std::vector<SectorTransition> transitions = transitionsAt(vertex, topology, graph);
  conditions.sectors.push_back({graph.sectors[topology.star(vertex)[0]], {}, {}});
  const auto find = [&](Index sector) {
    return std::find_if(conditions.sectors.begin(), conditions.sectors.end(),
                        [sector](const auto& known) { return known.sector == sector; });
  };
  for (std::size_t next = 0; next < conditions.sectors.size(); ++next) {
    for (const SectorTransition& transition : transitions) {
      if (transition.from != conditions.sectors[next].sector) continue;
      const VertexConditions::Sector& from = conditions.sectors[next];
      const lattice::Rotation turn = graph.rotations[transition.halfFace];
      VertexConditions::Sector reached{transition.to, turn * from.rotation,
                                       rotated(turn, from.translation)};
      for (std::size_t k = 0; k < 3; ++k) {
        reached.translation[k].add(unknowns.translation(transition.halfFace, k), 1);
      }
      const auto known = find(transition.to);
      if (known == conditions.sectors.end()) {
        conditions.sectors.push_back(std::move(reached));
        continue;
      }
      addDifference(reached, *known, ofPoint);
    }
  }
  for (const VertexConditions::Sector& sector : conditions.sectors) {
    addPlanes(sector, unknowns, ofPoint);
  }
  SharedEquations::Solution solution = std::move(ofPoint).solve();
  for (std::size_t k = 0; k < 3; ++k) {
    auto& [coefficients, rest] = solution.coordinates[k];
    conditions.fixed[k] = {coefficients[k], std::move(rest)};
  }
  std::move(solution.left.begin(), solution.left.end(), std::back_inserter(equations));
  return conditions;
}

}  // namespace hexhex::quantization
