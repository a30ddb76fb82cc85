// Marks the half diagonals that cut faces may meet (docs/developer/atlas.md).
#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <vector>

#include <atlas/cut_marks.hpp>
#include <base/workspaces.hpp>
#include <lattice/triangle_cells.hpp>
#include <sweep/tet_lines.hpp>

namespace hexhex::atlas {

namespace {

using Triangle = std::array<lattice::LatticePoint, 3>;

Triangle triangleOf(const igm::ExactMap& map, adjacency::HalfFace halfFace) {
  const lattice::LatticeTet& corners = map.corners[adjacency::tetOf(halfFace)];
  const std::array<int, 3>& face = lattice::kFaceCorners[halfFace % 4];
  return {corners[static_cast<std::size_t>(face[0])], corners[static_cast<std::size_t>(face[1])],
          corners[static_cast<std::size_t>(face[2])]};
}

/// Gauge::cell(), prepared for many cells: it differs from the gauge by a constant.
SweepFrame cellFrame(const lattice::Gauge& gauge) noexcept {
  return {{gauge.rotation, gauge.cell(lattice::GridPoint{})}, {0, 1, 2}};
}

/// A half-face at which a chart ends, and where cells are to be marked, in its tet's chart.
struct CutFace {
  adjacency::HalfFace halfFace;
  std::span<const lattice::GridBox> boxes;  ///< none: everywhere
};

/// The cut faces of a region. For a face between two of its tets, one half-face is enough, as their
/// boxes agree.
std::vector<CutFace> findCuts(const igm::PreparedMap& map, const Charts& charts,
                              const GridRegion& region, Stage& stage) {
  return collectFromBlocks<CutFace>(
      stage, region.tets.size(), sweep::kSweepBlock,
      [&](std::size_t begin, std::size_t end, std::vector<CutFace>& cuts) {
        for (std::size_t i = begin; i < end; ++i) {
          for (int face = 0; face < 4; ++face) {
            if ((region.faces[i] >> face & 1) == 0) continue;
            const adjacency::HalfFace here = adjacency::halfFaceOf(region.tets[i], face);
            const adjacency::HalfFace mate = map.topology.mate[here];
            if (mate == kNone || charts.isGlued(map.topology, map.exact.transitions, here))
              continue;
            if (mate > here && charts.chart[adjacency::tetOf(mate)] != Charts::kNoChart) continue;
            cuts.push_back({here, region.boxesOf(i)});
          }
        }
      });
}

/// One half-face of each inner face that is cut.
/// @param identitiesGlue  as in markCutCells()
std::vector<CutFace> findCuts(const igm::PreparedMap& map, const Charts& charts,
                              bool identitiesGlue, Stage& stage) {
  constexpr std::size_t kGrain = 4096;
  const auto isCut = [&](adjacency::HalfFace halfFace) {
    return !charts.isGlued(map.topology, map.exact.transitions, halfFace);
  };
  if (identitiesGlue) {
    // After the identity, the two half-faces of each face with another transition are adjacent.
    const Array<adjacency::HalfFace>& halfFaces = map.exact.transitions.halfFaces;
    return collectFromBlocks<CutFace>(
        stage, halfFaces.size() / 2, kGrain,
        [&](std::size_t begin, std::size_t end, std::vector<CutFace>& cuts) {
          for (std::size_t i = begin; i < end; ++i) {
            if (isCut(halfFaces[2 * i + 1])) cuts.push_back({halfFaces[2 * i + 1], {}});
          }
        });
  }
  const Array<adjacency::HalfFace>& mate = map.topology.mate;
  return collectFromBlocks<CutFace>(
      stage, mate.size(), kGrain,
      [&](std::size_t begin, std::size_t end, std::vector<CutFace>& cuts) {
        for (std::size_t h = begin; h < end; ++h) {
          if (mate[h] < h && isCut(mate[h])) cuts.push_back({mate[h], {}});
        }
      });
}

}  // namespace

CutTransitionId CutTransitions::across(const igm::PreparedMap& map, const Charts& charts,
                                       adjacency::HalfFace halfFace) {
  const Index here = adjacency::tetOf(halfFace);
  const Index there = adjacency::tetOf(map.topology.mate[halfFace]);
  const Index from = charts.chart[here];
  const Index to = charts.chart[there];
  if (from == Charts::kNoChart || to == Charts::kNoChart) return kAnyCuts;
  const lattice::Gauge forth =
      charts.gauge(there) * map.exact.transitions.across(halfFace) * charts.gauge(here).inverse();
  const auto id = static_cast<CutTransitionId>(all_.size());
  const auto [known, isNew] = ids_.try_emplace(keyOf(from, to, forth), id);
  if (!isNew) return known->second;
  if (all_.size() + 2 > kAnyCuts) return known->second = kAnyCuts;
  const lattice::Gauge back = forth.inverse();
  const auto [inverse, isOther] = ids_.try_emplace(keyOf(to, from, back), id + 1);
  all_.push_back({from, to, forth, inverse->second});
  if (isOther) all_.push_back({to, from, back, id});
  assert(all_[id].inverse == id || all_[all_[id].inverse].inverse == id);
  return id;
}

std::size_t CutTransitions::Hash::operator()(const Key& key) const noexcept {
  std::uint64_t hash = 0;
  for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9e3779b97f4a7c15U;
  return static_cast<std::size_t>(hash >> 32);
}

CutTransitions::Key CutTransitions::keyOf(Index from, Index to,
                                          const lattice::Gauge& map) noexcept {
  return {from,
          to,
          static_cast<std::uint32_t>(map.rotation.index()),
          map.translation[0],
          map.translation[1],
          map.translation[2]};
}

// Not in an unnamed namespace: closures in explicitly instantiated templates have linkage, and so
// must the types that they capture.
namespace detail {

/// A cut cell without a brick.
struct LoneCut {
  BrickKey key;
  std::size_t place;
  lattice::CellCornerSet corners;
  CutTransitionId transition;
};

/// Marks the half diagonals that a cut face may meet, in the charts on both its sides: those on one
/// side are the images of those on the other.
template <class Id>
class CutMarker {
 public:
  CutMarker(const igm::PreparedMap& map, const Charts& charts, const CutTransitions& transitions,
            BrickGrid<Id>& grid)
      : map_(map), charts_(charts), transitions_(transitions), grid_(grid), cache_(grid) {}

  /// @param lone  receives cut cells without a brick
  void mark(const CutFace& cut, CutTransitionId transition, std::vector<LoneCut>& lone) {
    const adjacency::HalfFace halfFace = cut.halfFace;
    const Triangle triangle = triangleOf(map_.exact, halfFace);
    // Computed when first needed, as most small triangles meet no half diagonal.
    std::optional<BothSides> sides;
    lattice::TriangleCells(triangle, map_.exact.unit)
        .run([&](const lattice::GridPoint& z, lattice::CellCornerSet corners) {
          if (!sides) sides.emplace(sidesOf(halfFace, transition));
          for (const Side& side : *sides) {
            add(
                {side.chart, side.frame(z[0], z[1], z[2])}, lattice::turned(side.rotation, corners),
                side.transition, [&] { return isWanted(cut.boxes, z); }, lone);
          }
        });
  }

 private:
  /// A cut face in the chart of one of its sides.
  struct Side {
    Index chart;
    lattice::Rotation rotation;
    SweepFrame frame;            ///< of cells
    CutTransitionId transition;  ///< to the other side
  };
  using BothSides = std::array<Side, 2>;

  [[nodiscard]] static bool isWanted(std::span<const lattice::GridBox> boxes,
                                     const lattice::GridPoint& z) {
    return boxes.empty() ||
           std::any_of(boxes.begin(), boxes.end(),
                       [&](const lattice::GridBox& box) { return holdsCell(box, z); });
  }

  [[nodiscard]] BothSides sidesOf(adjacency::HalfFace halfFace, CutTransitionId transition) const {
    const Index here = adjacency::tetOf(halfFace);
    const Index there = adjacency::tetOf(map_.topology.mate[halfFace]);
    const lattice::Gauge& gaugeHere = charts_.gauge(here);
    const lattice::Gauge gaugeThere =
        charts_.gauge(there) * map_.exact.transitions.across(halfFace);
    const CutTransitionId back =
        transition == kAnyCuts ? kAnyCuts : transitions_[transition].inverse;
    return {Side{charts_.chart[here], gaugeHere.rotation, cellFrame(gaugeHere), transition},
            Side{charts_.chart[there], gaugeThere.rotation, cellFrame(gaugeThere), back}};
  }

  struct Place {
    Index chart;
    lattice::ChartPoint point;
  };
  /// @param isWanted  whether the cell gets a brick if it has none
  template <class IsWanted>
  void add(const Place& place, lattice::CellCornerSet corners, CutTransitionId transition,
           const IsWanted& isWanted, std::vector<LoneCut>& lone) {
    const auto& [chart, c] = place;
    if (chart == Charts::kNoChart) return;
    Brick<Id>* const brick = cache_.find(chart, c);
    if (brick != nullptr) {
      CutCells& cuts = grid_.cutsOf(*brick);
      cuts.add(placeInBrick(c), corners, transition);
    } else if (isWanted()) {
      lone.push_back({brickKey(chart, c), placeInBrick(c), corners, transition});
    }
  }

  const igm::PreparedMap& map_;
  const Charts& charts_;
  const CutTransitions& transitions_;
  BrickGrid<Id>& grid_;
  BrickCache<Id> cache_;
};

}  // namespace detail

namespace {

template <class Id>
Cuts markCells(const igm::PreparedMap& map, const Charts& charts, const std::vector<CutFace>& faces,
               BrickGrid<Id>& grid, Stage& stage) {
  Cuts cuts;
  cuts.faces = faces.size();
  std::vector<CutTransitionId> transitions;
  transitions.reserve(faces.size());
  for (const CutFace& face : faces) {
    transitions.push_back(cuts.transitions.across(map, charts, face.halfFace));
  }
  constexpr std::size_t kFaces = 32;  // one may meet thousands of cells
  using detail::CutMarker;
  using detail::LoneCut;
  std::vector<std::vector<LoneCut>> lone(blockCount(faces.size(), kFaces));
  parallelBlocksWith(
      stage, faces.size(), kFaces,
      [&] { return CutMarker<Id>(map, charts, cuts.transitions, grid); },
      [&](std::size_t begin, std::size_t end, std::size_t block, CutMarker<Id>& marker) {
        for (std::size_t i = begin; i < end; ++i) {
          marker.mark(faces[i], transitions[i], lone[block]);
        }
      });
  for (const LoneCut& cell : joined<LoneCut>(lone)) {
    grid.cutsOf(grid.add(cell.key)).add(cell.place, cell.corners, cell.transition);
  }
  return cuts;
}

}  // namespace

template <class Id>
Cuts markCutCells(const igm::PreparedMap& map, const Charts& charts, bool identitiesGlue,
                  BrickGrid<Id>& grid, Stage& stage) {
  return markCells(map, charts, findCuts(map, charts, identitiesGlue, stage), grid, stage);
}

template <class Id>
Cuts markCutCells(const igm::PreparedMap& map, const Charts& charts, const GridRegion& region,
                  BrickGrid<Id>& grid, Stage& stage) {
  return markCells(map, charts, findCuts(map, charts, region, stage), grid, stage);
}

template Cuts markCutCells(const igm::PreparedMap&, const Charts&, bool, BrickGrid<std::uint32_t>&,
                           Stage&);
template Cuts markCutCells(const igm::PreparedMap&, const Charts&, bool, BrickGrid<std::uint64_t>&,
                           Stage&);

template Cuts markCutCells(const igm::PreparedMap&, const Charts&, const GridRegion&,
                           BrickGrid<std::uint32_t>&, Stage&);
template Cuts markCutCells(const igm::PreparedMap&, const Charts&, const GridRegion&,
                           BrickGrid<std::uint64_t>&, Stage&);

}  // namespace hexhex::atlas
