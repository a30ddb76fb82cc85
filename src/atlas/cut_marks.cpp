#include <array>
#include <optional>
#include <span>
#include <vector>

#include <atlas/cut_marks.hpp>
#include <base/workspaces.hpp>
#include <lattice/triangle_cells.hpp>

namespace hexhex {

namespace {

using Triangle = std::array<LatticePoint, 3>;

Triangle triangleOf(const ExactMap& map, HalfFace halfFace) {
  const LatticeTet& corners = map.corners[tetOf(halfFace)];
  const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
  return {corners[static_cast<std::size_t>(face[0])], corners[static_cast<std::size_t>(face[1])],
          corners[static_cast<std::size_t>(face[2])]};
}

/// Gauge::cell() prepared for many cells: it differs from the gauge by a constant.
SweepFrame cellFrame(const Gauge& gauge) noexcept {
  return {{gauge.rotation, gauge.cell(GridPoint{})}, {0, 1, 2}};
}

/// One half-face of each inner face that is cut.
/// @param onlyJumps  as in markCutCells()
std::vector<HalfFace> findCuts(const PreparedMap& map, const Charts& charts, bool onlyJumps,
                               Stage& stage) {
  constexpr std::size_t kGrain = 4096;
  const Array<HalfFace>& mate = map.topology.mate;
  const Array<HalfFace>& jumps = map.exact.transitions.halfFaces;
  return collectFromBlocks<HalfFace>(
      stage, onlyJumps ? jumps.size() / 2 : mate.size(), kGrain,
      [&](std::size_t begin, std::size_t end, std::vector<HalfFace>& cuts) {
        // Listed without branches, as nobody could predict on which side of a face one is. Tets of
        // smaller half-faces have been looked at not long ago.
        std::array<HalfFace, kGrain + 1> faces;  // NOLINT: written before it is read
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
          // Both half-faces of a jump are neighbours in the table, behind the identity.
          faces[count] = onlyJumps ? jumps[2 * i + 1] : mate[i];
          count += onlyJumps || mate[i] < i ? 1 : 0;
        }
        for (const HalfFace halfFace : std::span(faces).first(count)) {
          if (charts.isGlued(map.topology, map.exact.transitions, halfFace)) continue;
          cuts.push_back(halfFace);
        }
      });
}

}  // namespace

// What templates lend to loops has a name beyond this file.
namespace detail {

/// A cut cell without a brick.
struct LoneCut {
  BrickKey key;
  std::size_t place;
  CellCornerSet corners;
  JumpId jump;
};

/// Marks what a cut may meet, in the charts on both its sides: what the triangle meets on one side
/// are the images of what it meets on the other.
template <class Id>
class CutMarker {
 public:
  CutMarker(const PreparedMap& map, const Charts& charts, const Jumps& jumps, BrickGrid<Id>& grid)
      : map_(map), charts_(charts), jumps_(jumps), grid_(grid), cache_(grid) {}

  /// @param lone  receives what there is no brick for
  void mark(HalfFace halfFace, JumpId jump, std::vector<LoneCut>& lone) {
    const Triangle triangle = triangleOf(map_.exact, halfFace);
    // Made when first needed, as most small triangles do not come before any corner.
    std::optional<BothSides> sides;
    TriangleCells(triangle, map_.exact.unit).run([&](const GridPoint& z, CellCornerSet corners) {
      if (!sides) sides.emplace(sidesOf(halfFace, jump));
      for (const Side& side : *sides) {
        add(side.chart, side.frame(z[0], z[1], z[2]), turned(side.rotation, corners), side.jump,
            lone);
      }
    });
  }

 private:
  /// What a cut is in a chart.
  struct Side {
    Index chart;
    Rotation rotation;
    SweepFrame frame;  ///< of cells
    JumpId jump;       ///< to the other side
  };
  using BothSides = std::array<Side, 2>;

  [[nodiscard]] BothSides sidesOf(HalfFace halfFace, JumpId jump) const {
    const Index here = tetOf(halfFace);
    const Index there = tetOf(map_.topology.mate[halfFace]);
    const Gauge& gaugeHere = charts_.gauge(here);
    const Gauge gaugeThere = charts_.gauge(there) * map_.exact.transitions.across(halfFace);
    const JumpId back = jump == kManyJumps ? kManyJumps : jumps_[jump].inverse;
    return {Side{charts_.chart[here], gaugeHere.rotation, cellFrame(gaugeHere), jump},
            Side{charts_.chart[there], gaugeThere.rotation, cellFrame(gaugeThere), back}};
  }

  void add(Index chart, const ChartPoint& c, CellCornerSet corners, JumpId jump,
           std::vector<LoneCut>& lone) {
    if (chart == Charts::kNoChart) return;
    Brick<Id>* const brick = cache_.find(chart, c);
    if (brick != nullptr) {
      CutCells& cuts = grid_.cutsOf(*brick);
      cuts.add(placeInBrick(c), corners, jump);
    } else {
      lone.push_back({brickKey(chart, c), placeInBrick(c), corners, jump});
    }
  }

  const PreparedMap& map_;
  const Charts& charts_;
  const Jumps& jumps_;
  BrickGrid<Id>& grid_;
  BrickCache<Id> cache_;
};

}  // namespace detail

template <class Id>
Cuts markCutCells(const PreparedMap& map, const Charts& charts, bool onlyJumps, BrickGrid<Id>& grid,
                  Stage& stage) {
  const std::vector<HalfFace> halfFaces = findCuts(map, charts, onlyJumps, stage);
  Cuts cuts;
  cuts.faces = halfFaces.size();
  std::vector<JumpId> jumps(halfFaces.size());
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    jumps[i] = cuts.jumps.across(map, charts, halfFaces[i]);
  }
  constexpr std::size_t kFaces = 32;  // one may meet thousands of cells
  using detail::CutMarker;
  using detail::LoneCut;
  Workspaces<CutMarker<Id>> markers;
  const auto lone = collectFromBlocks<LoneCut>(
      stage, halfFaces.size(), kFaces,
      [&](std::size_t begin, std::size_t end, std::vector<LoneCut>& loneHere) {
        const auto make = [&] { return CutMarker<Id>(map, charts, cuts.jumps, grid); };
        markers.with(make, [&](CutMarker<Id>& marker) {
          for (std::size_t i = begin; i < end; ++i) marker.mark(halfFaces[i], jumps[i], loneHere);
        });
      });
  for (const LoneCut& cell : lone)
    grid.cutsOf(grid.add(cell.key)).add(cell.place, cell.corners, cell.jump);
  return cuts;
}

template Cuts markCutCells(const PreparedMap&, const Charts&, bool, BrickGrid<std::uint32_t>&,
                           Stage&);
template Cuts markCutCells(const PreparedMap&, const Charts&, bool, BrickGrid<std::uint64_t>&,
                           Stage&);

}  // namespace hexhex
