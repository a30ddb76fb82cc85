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

/// Counts by several threads at once, or by one, which takes a fraction of the time.
class Counters {
 public:
  explicit Counters(std::span<Index> counts) : counts_(counts), alone_(currentThreads() == 1) {}
  /// @return the count before
  Index increase(std::size_t i) const noexcept {
    if (alone_) return counts_[i]++;
    return std::atomic_ref(counts_[i]).fetch_add(1, std::memory_order_relaxed);
  }

 private:
  std::span<Index> counts_;
  bool alone_;
};

class EdgeReplay {
 public:
  /// @param counts  by tet: receives how many arcs belong to each
  EdgeReplay(const PreparedMap& map, const LatticeNumbers& vertices, const Counters& counts,
             BlockArcs& arcs)
      : map_(map),
        counts_(counts),
        unit_(map.exact.unit),
        arcs_(arcs),
        pieces_(arcs.pieces),
        vertices_(vertices),
        tracer_(map, vertices, arcs.pieces),
        star_(map.topology, map.exact) {}

  void run(const EdgeRecords& records) {
    // Each point is in a face; degenerate edges may have fewer or more.
    const std::size_t edges = records.edges.size();
    const std::size_t faceCount = records.faces.size();
    arcs_.keys.reserve(edges);
    pieces_.reserve(edges, faceCount, faceCount + edges);
    std::size_t first = 0;
    for (const EdgeRecord& record : records.edges) {
      const auto faces = std::span(records.faces).subspan(first, record.faceEnd - first);
      first = record.faceEnd;
      const std::size_t points = pieces_.points();
      const std::size_t segments = pieces_.segments();
      if (follow(record, faces)) {
        finish(record, points, segments);
        continue;
      }
      pieces_.shorten(points, segments);
      if (!faces.empty() || !addInFace(record)) traceExactly(record, faces);
    }
  }

 private:
  /// Adds points and segments in the direction of the record, and finds the tet with the midpoint.
  /// @return false if the edge does not pass through the interiors of faces and tets, or its
  ///         midpoint is not certain to be inside of one
  [[nodiscard]] bool follow(const EdgeRecord& record, std::span<const HalfFace> faces) {
    if (faces.empty() && !record.inside) return false;
    middle_ = {record.z, record.along};
    owner_ = record.tet;
    pieces_.addSegment({record.tet, kWholeTet});
    ChartEdge at = middle_;
    Index tet = record.tet;
    for (const HalfFace halfFace : faces) {
      const HalfFace mate = map_.topology.mate[halfFace];
      const ChartEdge ahead = at.across(map_.exact.transitions, halfFace);
      const bool isOwned = tet < tetOf(mate);
      const HalfFace owned = isOwned ? halfFace : mate;
      const FaceCrossing crossing =
          crossFace(CrossedFace(map_.exact.corners[tetOf(owned)], localOf(owned)),
                    isOwned ? at : ahead, unit_);
      const double fromMiddle = crossing.parameter - 0.5;
      const double distance = std::abs(fromMiddle);
      if (!crossing.inside || distance >= 0.5 - crossing.error || distance <= crossing.error) {
        return false;
      }
      addPoint(owned, crossing);
      at = ahead;
      tet = tetOf(mate);
      pieces_.addSegment({tet, kWholeTet});
      if (fromMiddle < 0) {
        middle_ = at;
        owner_ = tet;
      }
    }
    return true;
  }
  void addPoint(HalfFace face, const FaceCrossing& crossing) {
    const Index owner = tetOf(face);
    const FacePoints corners =
        pointsOf(map_.topology.tets[owner], localOf(face), map_.input.view.points);
    pieces_.addPoint({owner, faceMask(localOf(face))}, pointInFace(crossing.shares, corners),
                     crossing.parameter);
  }

  /// Makes the arc run along the owner's axis.
  void finish(const EdgeRecord& record, std::size_t firstPoint, std::size_t firstSegment) {
    std::array<Index, 2> ends = record.ends;
    if (signOf(middle_.along) < 0) {
      std::swap(ends[0], ends[1]);
      pieces_.reverseFrom(firstPoint, firstSegment);
      pieces_.changeParameters(firstPoint, [](double& parameter) { parameter = 1 - parameter; });
    }
    finish(firstPoint, ends, owner_, middle_.ascending());
  }
  /// @param edge  in the chart of the owner, along its axis
  void finish(std::size_t before, const std::array<Index, 2>& ends, Index owner,
              const ChartEdge& edge) {
    pieces_.addArc(ends, before);
    EdgeTracer::smoothParameters(pieces_, before);
    arcs_.keys.push_back({owner, axisOf(edge.along), edge.z});
    counts_.increase(owner);
  }

  /// Adds an edge inside a tet whose ends are on its boundary, as most degenerate ones are: in a
  /// face on the boundary of the mesh, or from face to face.
  /// @return false, without having done anything, if the edge is inside an edge of the tet
  [[nodiscard]] bool addInFace(const EdgeRecord& record) {
    // By convexity, all between lies in the smallest simplex that contains both ends.
    const GridPoint end = step(record.z, record.along);
    const auto simplex = static_cast<CornerMask>(vertices_.find(record.tet, record.z).simplex |
                                                 vertices_.find(record.tet, end).simplex);
    if (dimension(simplex) < 2) return false;
    ChartEdge edge{record.z, record.along};
    OwnedSimplex carrier{record.tet, simplex};
    if (dimension(simplex) == 2) {
      const FaceOfOwner owned(map_.topology, record.tet, oppositeCorner(simplex));
      carrier = owned.simplex();
      edge = owned.carry(edge, map_.exact.transitions);
    }
    std::array<Index, 2> ends = record.ends;
    if (signOf(edge.along) < 0) std::swap(ends[0], ends[1]);
    const std::size_t before = pieces_.points();
    pieces_.addSegment(carrier);
    finish(before, ends, carrier.tet, edge.ascending());
    return true;
  }
  /// Traces the edge from its midpoint.
  void traceExactly(const EdgeRecord& record, std::span<const HalfFace> faces) {
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
  const Counters& counts_;
  std::int64_t unit_;
  BlockArcs& arcs_;
  ArcPieces& pieces_;
  const LatticeNumbers& vertices_;
  EdgeTracer tracer_;
  SimplexStar star_;
  Index owner_ = kNone;  ///< of the midpoint
  ChartEdge middle_{};   ///< the edge there
};

/// An arc among those of all blocks.
struct ArcPlace {
  Index block;
  Index number;
};

/// Sorts the arcs of a tet: by axis, then in the order in which the tet is swept for midpoints.
class Sorter {
 public:
  void enter(const LatticeTet& corners, std::int64_t unit) {
    const HalfBox box(corners, unit);
    size_ = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const HalfGrid grid = ElementNumbers::midpointsOf(ElementKind::Edges, static_cast<int>(axis));
      if ((box.grids() & halfGridBit(grid)) == 0) continue;
      const GridBox points = box.of(grid);
      Grid& g = grids_[axis];
      g.axes = chooseSweepAxes(points)();
      g.begin = size_;
      std::uint64_t size = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const GridRange& range = points.range[g.axes[k]];
        g.first[k] = range.first;
        g.size[k] = static_cast<std::uint64_t>(range.last - range.first) + 1;
        size *= std::min(g.size[k], kMost);
      }
      size_ = std::min(size_ + size, kMost);
    }
  }
  /// @param keyOf  of an arc
  template <class KeyOf>
  void sort(std::span<ArcPlace> arcs, const KeyOf& keyOf) {
    unsorted_.assign(arcs.begin(), arcs.end());
    if (size_ >= kMost) {
      std::sort(arcs.begin(), arcs.end(), [&](const ArcPlace& a, const ArcPlace& b) {
        return longPlace(keyOf(a)) < longPlace(keyOf(b));
      });
      return;
    }
    order_.clear();
    for (const ArcPlace& arc : arcs) {
      order_.push_back(place(keyOf(arc)) << 32 | static_cast<std::uint64_t>(order_.size()));
    }
    if (arcs.size() >= kMany && size_ <= kRoom * arcs.size()) {
      sortByTable(arcs);
    } else {
      sortByComparison(arcs);
    }
  }

 private:
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  /// So many arcs are worth a table, if it has room for not many more: tets fill a sixth of their
  /// box, if they are not thin.
  static constexpr std::size_t kMany = 24;
  static constexpr std::uint64_t kRoom = 16;

  /// Where a point stands among those of all boxes, if these are less than kMost.
  [[nodiscard]] std::uint64_t place(const EdgeKey& key) const noexcept {
    const Grid& g = grids_[static_cast<std::size_t>(key.axis)];
    const auto at = [&](std::size_t k) {
      return static_cast<std::uint64_t>(key.z[g.axes[k]] - g.first[k]);
    };
    return g.begin + (at(0) * g.size[1] + at(1)) * g.size[2] + at(2);
  }
  /// The same in two numbers, whatever the boxes.
  [[nodiscard]] std::array<std::uint64_t, 2> longPlace(const EdgeKey& key) const noexcept {
    const Grid& g = grids_[static_cast<std::size_t>(key.axis)];
    const auto at = [&](std::size_t k) {
      return static_cast<std::uint64_t>(std::int64_t{key.z[g.axes[k]]} - g.first[k]);
    };
    return {static_cast<std::uint64_t>(key.axis) << 32 | at(0), at(1) << 32 | at(2)};
  }
  void sortByTable(std::span<ArcPlace> arcs) {
    table_.assign(size_, kNone);
    for (const std::uint64_t entry : order_) table_[entry >> 32] = static_cast<Index>(entry);
    std::size_t count = 0;
    for (const Index i : table_) {
      if (i != kNone) arcs[count++] = unsorted_[i];
    }
  }
  void sortByComparison(std::span<ArcPlace> arcs) {
    std::sort(order_.begin(), order_.end());
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      arcs[i] = unsorted_[static_cast<Index>(order_[i])];
    }
  }

  /// The midpoints in the box of a tet of edges along an axis.
  struct Grid {
    std::array<std::uint8_t, 3> axes{};   ///< of the sweep
    std::array<std::int32_t, 3> first{};  ///< by sweep axis
    std::array<std::uint64_t, 3> size{};
    std::uint64_t begin = 0;  ///< its points among those of all axes
  };
  std::array<Grid, 3> grids_;
  std::uint64_t size_ = 0;  ///< points of all boxes; kMost if there are more
  std::vector<ArcPlace> unsorted_;
  std::vector<std::uint64_t> order_;  ///< a place, and whose it is
  std::vector<Index> table_;
};

/// Brings arcs into canonical order.
class ArcOrder {
 public:
  /// @param counts  by tet: how many arcs belong to each
  ArcOrder(const PreparedMap& map, std::span<const BlockArcs> blocks, std::span<const Index> counts)
      : map_(map), blocks_(blocks), begin_(counts.size() + 1) {
    std::copy(counts.begin(), counts.end(), begin_.begin());
    begin_.back() = 0;
    places_.resize(exclusiveScan(std::span(begin_)));
    pointBegin_.resize(places_.size() + 1);
  }

  void run(Stage& stage) {
    collectByTet(stage);
    constexpr std::size_t kTets = 256;
    parallelBlocks(stage, map_.topology.tetCount(), kTets,
                   [&](std::size_t first, std::size_t end, std::size_t) {
                     Sorter sorter;
                     for (std::size_t t = first; t < end; ++t) {
                       sortTet(static_cast<Index>(t), sorter);
                     }
                   });
    pointBegin_.back() = 0;
    exclusiveScan(std::span(pointBegin_));
  }
  [[nodiscard]] std::span<const ArcPlace> places() const noexcept { return places_; }
  /// Per arc (+1): its first point.
  [[nodiscard]] Array<std::uint64_t>& pointBegin() noexcept { return pointBegin_; }

 private:
  /// In any order, those of each tet.
  void collectByTet(Stage& stage) {
    Array<Index> filled(map_.topology.tetCount());
    std::fill(filled.begin(), filled.end(), 0);
    const Counters counters(filled);
    parallelFor(stage, blocks_.size(), 1, [&](std::size_t block) {
      Index number = 0;
      for (const EdgeKey& key : blocks_[block].keys) {
        places_[begin_[key.tet] + counters.increase(key.tet)] = {static_cast<Index>(block),
                                                                 number++};
      }
    });
  }
  void sortTet(Index tet, Sorter& sorter) {
    const std::uint64_t first = begin_[tet];
    const auto own = std::span(places_).subspan(first, begin_[tet + 1] - first);
    if (own.size() > 1) {
      sorter.enter(map_.exact.corners[tet], map_.exact.unit);
      sorter.sort(own, [&](const ArcPlace& place) -> const EdgeKey& {
        return blocks_[place.block].keys[place.number];
      });
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      pointBegin_[first + i] = blocks_[own[i].block].pieces.pointsOf(own[i].number);
    }
  }

  const PreparedMap& map_;
  std::span<const BlockArcs> blocks_;
  Array<std::uint64_t> begin_;  ///< per tet (+1): its first arc
  Array<ArcPlace> places_;      ///< per arc
  Array<std::uint64_t> pointBegin_;
};

/// Copies arcs from where they were made to where they belong.
Arcs collectArcs(std::span<const BlockArcs> blocks, std::span<const ArcPlace> places,
                 Array<std::uint64_t> pointBegin, Stage& stage) {
  constexpr std::size_t kArcs = 1024;
  const std::size_t count = places.size();
  const std::uint64_t points = pointBegin.back();
  Arcs arcs;
  arcs.pointBegin = std::move(pointBegin);
  arcs.ends.resize(count);
  arcs.points.resize(points);
  arcs.parameters.resize(points);
  arcs.generatorTet.resize(points);
  arcs.generatorCorners.resize(points);
  arcs.segmentTet.resize(points + count);
  arcs.segmentCorners.resize(points + count);
  const auto piecesOf = [&](std::size_t arc) -> const ArcPieces& {
    return blocks[places[arc].block].pieces;
  };
  parallelFor(stage, count, kArcs, [&](std::size_t arc) {
    // Early, as arcs come from all over memory.
    constexpr std::size_t kSoon = 8;
    constexpr std::size_t kLater = 16;
    if (arc + kLater < count) piecesOf(arc + kLater).fetchArc(places[arc + kLater].number);
    if (arc + kSoon < count) piecesOf(arc + kSoon).fetchPieces(places[arc + kSoon].number);
    piecesOf(arc).copyArc(places[arc].number, arcs, arc, arcs.pointBegin[arc]);
  });
  return arcs;
}

}  // namespace

Arcs gatherArcs(const PreparedMap& map, const LatticeNumbers& vertices,
                std::vector<EdgeRecords> records, Stage& stage) {
  std::vector<BlockArcs> blocks(records.size());
  Array<Index> counts(map.topology.tetCount());
  std::fill(counts.begin(), counts.end(), 0);
  const Counters counters(counts);
  parallelFor(stage, records.size(), 1, [&](std::size_t block) {
    const EdgeRecords own = std::move(records[block]);  // gives its memory back early
    EdgeReplay(map, vertices, counters, blocks[block]).run(own);
  });
  std::uint64_t count = 0;
  for (const BlockArcs& block : blocks) count += block.keys.size();
  requireNumbers(count);
  ArcOrder order(map, blocks, counts);
  order.run(stage);
  return collectArcs(blocks, order.places(), std::move(order.pointBegin()), stage);
}

}  // namespace hexhex
