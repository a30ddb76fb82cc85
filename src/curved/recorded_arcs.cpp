#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

#include <curved/arc_pieces.hpp>
#include <curved/edge_tracer.hpp>
#include <curved/element_numbers.hpp>
#include <curved/face_crossing.hpp>
#include <curved/recorded_arcs.hpp>

namespace hexhex {

namespace {

/// Where an edge has its number from: the owner of its midpoint, the axis of its chart, and where
/// the edge begins there.
struct EdgeKey {
  Index tet;
  std::int32_t axis;
  GridPoint z;
};

/// Arcs of a block of records, in their order.
struct BlockArcs {
  ArcPieces pieces;
  std::vector<EdgeKey> keys;
};

class EdgeReplay {
 public:
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices, BlockArcs& arcs)
      : map_(map),
        unit_(map.exact.unit),
        perUnit_(1 / static_cast<double>(map.exact.unit)),
        arcs_(arcs),
        pieces_(arcs.pieces),
        tracer_(map, vertices, arcs.pieces),
        star_(map.topology, map.exact) {}

  void run(const EdgeRecords& records) {
    arcs_.keys.reserve(records.edges.size());
    std::size_t first = 0;
    for (const EdgeRecord& record : records.edges) {
      const auto faces = std::span(records.faces).subspan(first, record.faceEnd - first);
      first = record.faceEnd;
      if (follow(record, faces)) {
        add(record);
      } else {
        addExactly(record, faces);
      }
    }
  }

 private:
  /// A point where an edge leaves a tet, and the tet behind.
  struct Crossing {
    OwnedSimplex face;
    Vec3 point;
    EdgePlace place;
    Index next;
  };

  /// Finds all crossings and the tet with the midpoint.
  /// @return false if the edge does not pass through the interiors of faces and tets, or its
  ///         midpoint is not certain to be inside of one
  [[nodiscard]] bool follow(const EdgeRecord& record, std::span<const HalfFace> faces) {
    crossings_.clear();
    ChartEdge at{record.z, record.along};
    Index tet = record.tet;
    if (faces.empty() && !record.inside) return false;
    const auto length = static_cast<double>(unit_);
    bool isBehind = false;
    for (const HalfFace halfFace : faces) {
      const HalfFace mate = map_.topology.mate[halfFace];
      const Index next = tetOf(mate);
      const ChartEdge ahead = at.across(map_.exact.transitions, halfFace);
      const bool isOwned = tet < next;
      const Index owner = isOwned ? tet : next;
      const int face = localOf(isOwned ? halfFace : mate);
      const FaceCrossing crossing =
          crossFace(map_.exact.corners[owner], face, isOwned ? at : ahead, unit_);
      const double place = crossing.place.fromBegin();
      const bool isBetween = place > crossing.error && place < length - crossing.error;
      const double fromMiddle = place - length / 2;
      if (!crossing.inside || !isBetween || std::abs(fromMiddle) <= crossing.error) return false;
      if (!isBehind && fromMiddle > 0) {
        isBehind = true;
        middle_ = {at.z, at.along};
        owner_ = tet;
      }
      crossings_.push_back(
          {{owner, faceMask(face)},
           pointInFace(crossing.shares, map_.topology.tets[owner], face, map_.input.view.points),
           crossing.place,
           next});
      at = ahead;
      tet = next;
    }
    if (!isBehind) {
      middle_ = at;
      owner_ = tet;
    }
    return true;
  }

  /// Adds the arc, along the owner's axis.
  void add(const EdgeRecord& record) {
    const std::size_t before = pieces_.points();
    std::array<Index, 2> ends = record.ends;
    if (signOf(middle_.along) > 0) {
      pieces_.addSegment({record.tet, kWholeTet});
      for (const Crossing& crossing : crossings_) {
        addPoint(crossing, crossing.place);
        pieces_.addSegment({crossing.next, kWholeTet});
      }
    } else {
      std::swap(ends[0], ends[1]);
      for (std::size_t i = crossings_.size(); i-- > 0;) {
        pieces_.addSegment({crossings_[i].next, kWholeTet});
        addPoint(crossings_[i], crossings_[i].place.reversed(unit_));
      }
      pieces_.addSegment({record.tet, kWholeTet});
    }
    finish(before, ends, owner_, middle_.ascending());
  }
  void addPoint(const Crossing& crossing, const EdgePlace& place) {
    pieces_.addPoint({crossing.face, crossing.point, 0, 0}, place.fromBegin() * perUnit_);
  }
  /// @param edge  in the chart of the owner, along its axis
  void finish(std::size_t before, const std::array<Index, 2>& ends, Index owner,
              const ChartEdge& edge) {
    pieces_.addArc(ends, before);
    EdgeTracer::smoothParameters(pieces_.parametersFrom(before));
    arcs_.keys.push_back({owner, axisOf(edge.along), edge.z});
  }

  /// Traces the edge from its midpoint.
  void addExactly(const EdgeRecord& record, std::span<const HalfFace> faces) {
    const SimplexInTet middle = ownedMiddle(findMiddle(record, faces));
    const ChartEdge edge = ChartEdge{middle.frame.origin, middle.frame.axes[0]}.ascending();
    const std::size_t before = pieces_.points();
    const int axis = axisOf(edge.along);
    const auto ends = tracer_.trace({middle.tet, middle.simplex, Frame::along(edge.z, axis)});
    finish(before, ends, middle.tet, edge);
  }
  /// A simplex with the midpoint, in one of the tets that the edge was followed through.
  [[nodiscard]] SimplexInTet findMiddle(const EdgeRecord& record,
                                        std::span<const HalfFace> faces) const {
    ChartEdge at{record.z, record.along};
    Index tet = record.tet;
    for (std::size_t i = 0;; ++i) {
      const ChartEdge edge = at.ascending();
      const int axis = axisOf(edge.along);
      LatticePoint middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = edge.z[k] * unit_;
      middle[static_cast<std::size_t>(axis)] += unit_ / 2;
      const LatticeTet& corners = map_.exact.corners[tet];
      const CornerMask simplex =
          simplexBySides([&](std::size_t face) { return sideOfFace(corners, face, middle); });
      if (simplex != kNoSimplex) return {tet, simplex, Frame::along(edge.z, axis)};
      if (i == faces.size()) break;
      at = at.across(map_.exact.transitions, faces[i]);
      tet = tetOf(map_.topology.mate[faces[i]]);
    }
    ArcTracer::fail(record.tet, "a hex edge was not followed through its midpoint");
  }
  /// The same in the smallest tet.
  [[nodiscard]] SimplexInTet ownedMiddle(const SimplexInTet& middle) {
    SimplexInTet owned = middle;
    star_.visit(middle, [&](const SimplexInTet& here) {
      if (here.tet < owned.tet) owned = here;
      return false;
    });
    return owned;
  }

  const PreparedMap& map_;
  std::int64_t unit_;
  double perUnit_;
  BlockArcs& arcs_;
  ArcPieces& pieces_;
  EdgeTracer tracer_;
  SimplexStar star_;
  std::vector<Crossing> crossings_;
  Index owner_ = kNone;  ///< of the midpoint
  ChartEdge middle_{};   ///< the edge there
};

/// An arc among those of all blocks.
struct ArcPlace {
  Index block;
  Index number;
};

/// Brings arcs into canonical order.
class ArcOrder {
 public:
  ArcOrder(const PreparedMap& map, std::span<const BlockArcs> blocks)
      : map_(map), blocks_(blocks), begin_(map.topology.tetCount() + 1) {}

  void run(Stage& stage) {
    std::fill(begin_.begin(), begin_.end(), 0);
    forEachKey(stage, [&](const EdgeKey& key, const ArcPlace& /*place*/) {
      std::atomic_ref(begin_[key.tet]).fetch_add(1, std::memory_order_relaxed);
    });
    places_.resize(exclusiveScan(std::span(begin_)));
    // In any order, counting down from where those of the tet end.
    Array<Index> left(map_.topology.tetCount());
    for (std::size_t t = 0; t < left.size(); ++t) {
      left[t] = static_cast<Index>(begin_[t + 1] - begin_[t]);
    }
    forEachKey(stage, [&](const EdgeKey& key, const ArcPlace& place) {
      const Index last = std::atomic_ref(left[key.tet]).fetch_sub(1, std::memory_order_relaxed);
      places_[begin_[key.tet] + last - 1] = place;
    });
    constexpr std::size_t kTets = 256;
    parallelFor(stage, map_.topology.tetCount(), kTets,
                [&](std::size_t t) { sortTet(static_cast<Index>(t)); });
  }
  [[nodiscard]] std::span<const ArcPlace> places() const noexcept { return places_; }

 private:
  template <class Visit>
  void forEachKey(Stage& stage, const Visit& visit) const {
    parallelFor(stage, blocks_.size(), 1, [&](std::size_t block) {
      Index number = 0;
      for (const EdgeKey& key : blocks_[block].keys) {
        visit(key, ArcPlace{static_cast<Index>(block), number++});
      }
    });
  }

  /// By axis, then in the order in which the tet would be swept for midpoints.
  void sortTet(Index tet) {
    const auto own = std::span(places_).subspan(begin_[tet], begin_[tet + 1] - begin_[tet]);
    if (own.size() < 2) return;
    const HalfBox box(map_.exact.corners[tet], map_.exact.unit);
    std::array<SweepAxes, 3> sweeps;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const HalfGrid grid = ElementNumbers::midpointsOf(ElementKind::Edges, static_cast<int>(axis));
      if ((box.grids() & halfGridBit(grid)) != 0) sweeps[axis] = chooseSweepAxes(box.of(grid));
    }
    const auto sweptAt = [&](const ArcPlace& place) {
      const EdgeKey& key = blocks_[place.block].keys[place.number];
      const std::array<std::uint8_t, 3>& axes = sweeps[static_cast<std::size_t>(key.axis)]();
      return std::array<std::int32_t, 4>{key.axis, key.z[axes[0]], key.z[axes[1]], key.z[axes[2]]};
    };
    std::sort(own.begin(), own.end(),
              [&](const ArcPlace& a, const ArcPlace& b) { return sweptAt(a) < sweptAt(b); });
  }

  const PreparedMap& map_;
  std::span<const BlockArcs> blocks_;
  Array<std::uint64_t> begin_;  ///< per tet (+1): its first arc
  Array<ArcPlace> places_;      ///< per arc
};

/// Copies arcs from where they were made to where they belong.
Arcs collectArcs(std::span<const BlockArcs> blocks, std::span<const ArcPlace> places,
                 Stage& stage) {
  constexpr std::size_t kArcs = 1024;
  const std::size_t count = places.size();
  Arcs arcs;
  arcs.ends.resize(count);
  arcs.pointBegin.resize(count + 1);
  arcs.pointBegin[count] = 0;
  const auto piecesOf = [&](std::size_t arc) -> const ArcPieces& {
    return blocks[places[arc].block].pieces;
  };
  parallelFor(stage, count, kArcs, [&](std::size_t arc) {
    arcs.pointBegin[arc] = piecesOf(arc).pointsOf(places[arc].number);
  });
  const std::uint64_t points = exclusiveScan(std::span(arcs.pointBegin));
  arcs.points.resize(points);
  arcs.parameters.resize(points);
  arcs.generatorTet.resize(points);
  arcs.generatorCorners.resize(points);
  arcs.segmentTet.resize(points + count);
  arcs.segmentCorners.resize(points + count);
  parallelFor(stage, count, kArcs, [&](std::size_t arc) {
    piecesOf(arc).copyArc(places[arc].number, arcs, arc, arcs.pointBegin[arc]);
  });
  return arcs;
}

}  // namespace

Arcs gatherArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                std::vector<EdgeRecords> records, Stage& stage) {
  std::vector<BlockArcs> blocks(records.size());
  parallelFor(stage, records.size(), 1, [&](std::size_t block) {
    const EdgeRecords own = std::move(records[block]);  // gives its memory back early
    EdgeReplay(map, vertices, blocks[block]).run(own);
  });
  std::uint64_t count = 0;
  for (const BlockArcs& block : blocks) count += block.keys.size();
  requireNumbers(count);
  ArcOrder order(map, blocks);
  order.run(stage);
  return collectArcs(blocks, order.places(), stage);
}

}  // namespace hexhex
