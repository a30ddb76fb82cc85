#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <quantize/complex/arcs_and_patches.hpp>
#include <quantize/complex/motorcycle_complex.hpp>
#include <quantize/complex/wall_remover.hpp>

#include <lattice/charts_along_trees.hpp>

namespace hexhex::quantization {

namespace {

/// Displacements around a ring that are smaller than others by this power of two are noise.
constexpr int kNoiseBits = 24;

/// Numbers the blocks, that is, the components between walls, and unifies their charts.
/// @return a tet in a ring, i.e. a block whose charts do not close up, or kNone
Index findBlocks(MotorcycleComplex& complex) {
  const WallMesh& mesh = complex.mesh;
  const auto forEachNeighbour = [&](Index tet, const auto& visit) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(tet, face);
      if (mesh.isWall[h]) continue;
      visit(adjacency::tetOf(mesh.mate[h]), [&](const lattice::LatticeMotion& toBlock) {
        return toBlock * mesh.change[h].inverse();
      });
    }
  };
  auto trees = lattice::chartsAlongTrees<lattice::LatticeMotion>(mesh.tetCount(), forEachNeighbour);
  complex.blockOf = std::move(trees.tree);
  complex.toBlock = std::move(trees.motions);
  complex.blockCount = trees.trees;
  for (const Index tet : trees.order) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(tet, face);
      if (!mesh.isWall[h] && !complex.across(h).isIdentity()) return adjacency::tetOf(mesh.mate[h]);
    }
  }
  return kNone;
}

/// Cuts across a ring: a block that returns to itself, and so is no box.
class RingCutter {
 public:
  /// @param inRing  a tet of the block
  RingCutter(MotorcycleComplex& complex, Index inRing)
      : complex_(complex), mesh_(complex.mesh), inRing_(inRing) {
    for (Index t = 0; t < mesh_.tetCount(); ++t) {
      if (complex.blockOf[t] == complex.blockOf[inRing]) tets_.push_back(t);
    }
  }

  void run() {
    const lattice::LatticePoint moves = findMoves();
    const std::size_t axis = axisOfMost(moves);
    if (moves[axis] == 0) {
      throw Error(ErrorCode::TransitionResidual,
                  "A part of the map returns to itself turned over; it has no motorcycle complex.",
                  {PlaceKind::Tet, mesh_.original[inRing_]});
    }
    // The chart of the ring is cut open somewhere, so the plane may lie one turn further.
    for (const std::int64_t shift : {std::int64_t{0}, moves[axis], -moves[axis]}) {
      if (startAt({axis, somePlace()[axis] + shift}, moves)) return;
    }
    throw Error(ErrorCode::Internal,
                "A ring of the motorcycle complex cannot be cut. This is a bug.",
                {PlaceKind::Tet, mesh_.original[inRing_]});
  }

 private:
  /// Maximum displacement along each axis by a closed path around the ring.
  [[nodiscard]] lattice::LatticePoint findMoves() const {
    lattice::LatticePoint most{};
    for (const Index t : tets_) {
      for (int face = 0; face < 4; ++face) {
        const adjacency::HalfFace h = adjacency::halfFaceOf(t, face);
        if (mesh_.isWall[h]) continue;
        const lattice::LatticeMotion way = complex_.across(h);
        for (std::size_t k = 0; k < 3; ++k) {
          const lattice::Direction d = lattice::direction(static_cast<int>(k), 1);
          if (way.rotation(d) == d) most[k] = std::max(most[k], std::abs(way.translation[k]));
        }
      }
    }
    return most;
  }
  static std::size_t axisOfMost(const lattice::LatticePoint& moves) {
    return static_cast<std::size_t>(std::max_element(moves.begin(), moves.end()) - moves.begin());
  }

  /// The position of a node if there is one, to avoid short arcs.
  [[nodiscard]] lattice::LatticePoint somePlace() const {
    const std::vector<bool> isNode = findNodes(complex_);
    lattice::LatticePoint place = complex_.toBlock[inRing_](mesh_.at(inRing_, 0));
    for (const Index t : tets_) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (isNode[mesh_.tets[t][i]]) place = complex_.toBlock[t](mesh_.at(t, i));
      }
    }
    return place;
  }

  /// Cuts along a plane of the block's chart. If closed paths lead along several axes, a single
  /// wall could wind forever; perpendicular walls from the same point then end at each other.
  /// @return false if no tet reaches both sides of the plane
  bool startAt(const AxisPlane& plane, const lattice::LatticePoint& moves) {
    WallTracer tracer(mesh_);
    const auto before = static_cast<Index>(mesh_.tetCount());
    for (const Index t : tets_) {
      const lattice::LatticeMotion back = complex_.toBlock[t].inverse();
      const lattice::LatticePoint point = complex_.toBlock[t](pointIn(t, plane.beyond(back)));
      if (!tracer.startIn(t, plane.beyond(back))) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (k == plane.axis || moves[k] <= moves[plane.axis] >> kNoiseBits) continue;
        for (Index part = 0; part < mesh_.tetCount(); ++part) {
          const bool isPart = part >= before && mesh_.original[part] == mesh_.original[t];
          if (part == t || isPart) tracer.startIn(part, AxisPlane{k, point[k]}.beyond(back));
        }
      }
      tracer.grow();
      return true;
    }
    return false;
  }

  /// The centroid of the intersections of a plane with the edges of a tet, in the tet's chart; the
  /// origin if there are none.
  [[nodiscard]] lattice::LatticePoint pointIn(Index t, const AxisPlane& plane) const {
    Vec3 sum{};
    double count = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const lattice::LatticePoint& from = mesh_.at(t, a);
        const lattice::LatticePoint& to = mesh_.at(t, b);
        if (plane.sideOf(from) * plane.sideOf(to) > 0 || from[plane.axis] == to[plane.axis]) {
          continue;
        }
        const double share = static_cast<double>(plane.value - from[plane.axis]) /
                             static_cast<double>(to[plane.axis] - from[plane.axis]);
        for (std::size_t k = 0; k < 3; ++k) {
          sum[k] += static_cast<double>(from[k]) + share * static_cast<double>(to[k] - from[k]);
        }
        ++count;
      }
    }
    lattice::LatticePoint point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = std::llround(sum[k] / std::max(count, 1.0));
    return point;
  }

  MotorcycleComplex& complex_;
  WallMesh& mesh_;
  Index inRing_;
  std::vector<Index> tets_;  ///< of the block
};

/// A block is a box if it has the volume of its bounding box.
void requireBoxes(const MotorcycleComplex& complex) {
  std::vector<Extent> extents(complex.blockCount);
  std::vector<lattice::Int192> sixfoldVolumes(complex.blockCount);
  std::vector<Index> someTet(complex.blockCount);
  for (Index t = 0; t < complex.mesh.tetCount(); ++t) {
    const Index block = complex.blockOf[t];
    someTet[block] = t;
    lattice::LatticeTet u = complex.mesh.corners[t];
    for (lattice::LatticePoint& corner : u) {
      corner = complex.toBlock[t](corner);
      extents[block].add(corner);
    }
    sixfoldVolumes[block] += lattice::orientationDeterminant(u[0], u[1], u[2], u[3]);
  }
  for (Index block = 0; block < complex.blockCount; ++block) {
    const lattice::LatticePoint size = extents[block].high - extents[block].low;
    lattice::Int192 difference = sixfoldVolumes[block];
    difference.addProduct(static_cast<lattice::Int128>(size[0]) * size[1], -6 * size[2]);
    if (difference.sign() != 0) {
      throw Error(ErrorCode::Internal,
                  "A block of the motorcycle complex is no box. This is a bug.",
                  {PlaceKind::Tet, complex.mesh.original[someTet[block]]});
    }
  }
}

/// A patch is a rectangle if it has the area of its bounding rectangle.
void requireRectangles(const MotorcycleComplex& complex) {
  const WallMesh& mesh = complex.mesh;
  std::vector<Extent> extents(complex.patches.size());
  std::vector<lattice::Int128> twofoldAreas(complex.patches.size());
  for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
    const Index p = complex.patchOf[h];
    if (p == kNone) continue;
    const Index tet = adjacency::tetOf(h);
    std::array<lattice::LatticePoint, 3> u;
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] = complex.toBlock[tet](
          mesh.at(tet, static_cast<std::size_t>(lattice::kFaceCorners[h % 4][k])));
      extents[p].add(u[k]);
    }
    const lattice::LatticePoint a = u[1] - u[0];
    const lattice::LatticePoint b = u[2] - u[0];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3;
      const std::size_t j = (k + 2) % 3;
      const lattice::Int128 area =
          static_cast<lattice::Int128>(a[i]) * b[j] - static_cast<lattice::Int128>(a[j]) * b[i];
      twofoldAreas[p] += area < 0 ? -area : area;
    }
  }
  for (Index p = 0; p < complex.patches.size(); ++p) {
    const lattice::LatticePoint size = extents[p].high - extents[p].low;
    lattice::Int128 area = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      area += static_cast<lattice::Int128>(size[k]) * size[(k + 1) % 3];
    }
    if (twofoldAreas[p] == 2 * area) continue;
    throw Error(ErrorCode::Internal,
                "A patch of the motorcycle complex is no rectangle. This is a bug.",
                {PlaceKind::Tet, mesh.original[adjacency::tetOf(complex.patches[p].first)]});
  }
}

}  // namespace

MotorcycleComplex traceComplex(const SeamlessMap& map, bool reduced, Context& context) {
  Stage stage(context, "motorcycle complex");
  MotorcycleComplex complex{.mesh = traceWalls(map, adjacency::EdgeFans(map.topology))};
  for (Index ring = findBlocks(complex); ring != kNone; ring = findBlocks(complex)) {
    context.throwIfCancelled();
    RingCutter(complex, ring).run();
  }
  requireBoxes(complex);
  findArcsAndPatches(complex);
  while (reduced && removeNeedlessWalls(complex)) {
    context.throwIfCancelled();
    findBlocks(complex);
    findArcsAndPatches(complex);
  }
  requireBoxes(complex);
  requireRectangles(complex);
  complex.mesh.shrink();
  return complex;
}

}  // namespace hexhex::quantization
