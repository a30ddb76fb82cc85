#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <shape/frames_rematch.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;
using Kind = EdgeTurning::Kind;

/// Number of sweeps that accept some changes for the worse, fewer and fewer, and maximum number of
/// sweeps that accept none.
constexpr int kWarmSweeps = 40;
constexpr int kColdSweeps = 40;
/// Costs in mean edge lengths or, for edges, relative to the edge's length.
constexpr double kPerRadian = 0.4;  // of the rotation across a triangle
constexpr double kHalfTurn = 8;
constexpr double kCompound = 10;
constexpr double kSkew = 2;     // of a proper edge aligned with another axis than its own
constexpr double kAlong = 0.6;  // lower cosines count as skew
constexpr double kZipper = 4;
constexpr double kFlat = 2;    // a triangle with three singular edges, counted at each of them
constexpr double kNode = 0.3;  // per curve beyond the second
constexpr double kBoundaryNode = 2.5;  // per curve beyond the first
/// Costs of boundary edges without valence, and of those whose valence differs by more than
/// kNearValence from their angle in quarter turns.
constexpr double kNoValence = 10;
constexpr double kOtherValence = 3;
constexpr double kNearValence = 0.75;
constexpr double kWarmth = 0.3;
/// Edges with a higher cost per length are searched.
constexpr double kBad = 2.5;

/// Singular edges at a vertex.
struct Curves {
  int threes = 0;
  int fives = 0;
  int improper = 0;

  void count(Kind kind, int by) {
    if (kind == Kind::Three) threes += by;
    if (kind == Kind::Five) fives += by;
    if (kind == Kind::HalfTurn || kind == Kind::Compound) improper += by;
  }
};

/// The interior dihedral angle at a boundary edge.
double innerAngle(const FrameTets& tets, const EdgeWalks& walks, std::size_t edge) {
  const Eigen::Vector3d first = tets.normal(walks.start(edge)).normalized();
  const Eigen::Vector3d last = tets.normal(walks.outs(edge).back()).normalized();
  const Eigen::Vector3d along =
      (tets.point(walks[edge][1]) - tets.point(walks[edge][0])).normalized();
  return std::numbers::pi + std::atan2(first.cross(last).dot(along), first.dot(last));
}

class Rematcher {
 public:
  Rematcher(FrameTets& tets, const EdgeWalks& walks, std::uint64_t seed, Stage& stage)
      : tets_(tets),
        walks_(walks),
        stage_(stage),
        random_(seed),
        isOuter_(tets.boundaryVertices()),
        edges_(walks.size()),
        curves_(tets.mesh().points.size()) {
    double sum = 0;
    for (std::size_t edge = 0; edge < walks.size(); ++edge) {
      edges_[edge].length = (tets.point(walks[edge][0]) - tets.point(walks[edge][1])).norm();
      sum += edges_[edge].length;
      if (walks.isBoundary(edge)) {
        edges_[edge].quarters =
            std::max(1.0, innerAngle(tets, walks, edge) / (std::numbers::pi / 2));
      }
      update(edge);
    }
    unit_ = sum / static_cast<double>(walks.size());
  }

  void run() {
    for (int sweep = 0; sweep < kWarmSweeps + kColdSweeps; ++sweep) {
      stage_.context().throwIfCancelled();
      const double left = 1 - (sweep + 1.0) / kWarmSweeps;
      std::vector<HalfFace> faces = facesNearDefects();
      if (faces.empty()) return;
      for (std::size_t i = faces.size() - 1; i > 0; --i) {
        std::swap(faces[i], faces[random_() % (i + 1)]);
      }
      bool isChanged = false;
      for (const HalfFace h : faces) {
        if (improve(h, std::max(0.0, left) * kWarmth * unit_)) isChanged = true;
      }
      if (left <= 0 && !isChanged) return;
    }
  }

 private:
  struct Edge {
    double length = 0;
    double quarters = 2;  ///< of a boundary edge: its interior angle in quarter turns, at least one
    double cost = 0;
    bool isSingular = false;
    Kind kind = Kind::Regular;
  };

  /// Recomputes an edge after the rotation across one of its triangles has changed.
  void update(std::size_t edge) {
    Edge& at = edges_[edge];
    if (walks_.isBoundary(edge)) {
      const int valence = boundaryValence(tets_, walks_, edge);
      at.cost = at.length * boundaryCost(valence, at.quarters);
      at.isSingular = valence != 2;
      return;
    }
    const EdgeTurning turning = turningAt(tets_, walks_, edge);
    if (turning.kind != at.kind) {
      for (const Index v : walks_[edge]) {
        curves_[v].count(at.kind, -1);
        curves_[v].count(turning.kind, 1);
      }
    }
    at.kind = turning.kind;
    at.isSingular = at.kind != Kind::Regular;
    at.cost = at.length * costOf(turning);
  }

  /// Cost per length of a boundary edge.
  static double boundaryCost(int valence, double quarters) {
    if (valence == 0) return kNoValence;
    return std::abs(valence - quarters) < kNearValence ? 0 : kOtherValence;
  }

  static double costOf(const EdgeTurning& turning) {
    if (turning.kind == Kind::Regular) return 0;
    if (turning.kind == Kind::HalfTurn) return kHalfTurn;
    if (turning.kind == Kind::Compound) return kCompound;
    return 2 - turning.alignment + (turning.alignment < kAlong ? kSkew : 0);
  }

  [[nodiscard]] double vertexCost(Index v) const {
    const auto& [threes, fives, improper] = curves_[v];
    const int proper = threes + fives;
    if (isOuter_[v]) return kBoundaryNode * unit_ * std::max(0, proper + improper - 1);
    if (improper > 0 || proper == 0) return 0;
    return unit_ * (isNode(threes, fives) ? kNode * std::max(0, proper - 2) : kZipper);
  }

  [[nodiscard]] double faceCost(HalfFace h) const {
    const double like =
        likeness(tets_.frames[adjacency::tetOf(h)],
                 tets_.frames[adjacency::tetOf(tets_.topology().mate[h])], tets_.rotations[h]);
    return kPerRadian * unit_ * std::acos(std::clamp((like - 1) / 2, -1.0, 1.0));
  }

  /// Number of triangles at an edge whose edges are all singular.
  [[nodiscard]] int flatFacesAt(Index edge) const {
    if (!edges_[edge].isSingular) return 0;
    int count = 0;
    for (const HalfFace h : walks_.outs(edge)) count += isFlat(h) ? 1 : 0;
    return count;
  }
  [[nodiscard]] bool isFlat(HalfFace h) const {
    const std::array<Index, 3> edges = walks_.edgesOf(h);
    return std::all_of(edges.begin(), edges.end(),
                       [&](Index edge) { return edges_[edge].isSingular; });
  }

  [[nodiscard]] double costAround(HalfFace h, const std::array<Index, 3>& edges) const {
    double cost = faceCost(h);
    for (const Index edge : edges) cost += edges_[edge].cost + kFlat * unit_ * flatFacesAt(edge);
    for (const int k : lattice::kFaceCorners[h % 4]) {
      cost += vertexCost(tets_.mesh().tets[adjacency::tetOf(h)][static_cast<std::size_t>(k)]);
    }
    return cost;
  }

  void set(HalfFace h, lattice::Rotation rotation, const std::array<Index, 3>& edges) {
    tets_.rotations[h] = rotation;
    tets_.rotations[tets_.topology().mate[h]] = rotation.inverse();
    for (const Index edge : edges) update(edge);
  }

  /// Tries all rotations across a triangle.
  /// @param warmth  mean of the exponential noise subtracted from costs
  /// @return whether the rotation changes
  bool improve(HalfFace h, double warmth) {
    const std::array<Index, 3> edges = walks_.edgesOf(h);
    const lattice::Rotation old = tets_.rotations[h];
    lattice::Rotation best = old;
    double least = costAround(h, edges) - 1e-12 * unit_;
    for (int r = 0; r < lattice::Rotation::kCount; ++r) {
      if (lattice::Rotation(r) == old) continue;
      const double noise = warmth > 0 ? -warmth * std::log(1 - draw()) : 0;
      // A bound: all other costs are nonnegative.
      tets_.rotations[h] = lattice::Rotation(r);
      if (faceCost(h) - noise >= least) continue;
      set(h, lattice::Rotation(r), edges);
      const double cost = costAround(h, edges) - noise;
      if (cost >= least) continue;
      least = cost;
      best = lattice::Rotation(r);
    }
    set(h, best, edges);
    return best != old;
  }

  double draw() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  [[nodiscard]] std::vector<bool> badVertices() const {
    std::vector<bool> isBad(curves_.size());
    for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
      if (edges_[edge].cost <= kBad * edges_[edge].length) continue;
      for (const Index v : walks_[edge]) isBad[v] = true;
    }
    for (HalfFace h = 0; h < tets_.topology().mate.size(); ++h) {
      if (!isFlat(h)) continue;
      for (const Index edge : walks_.edgesOf(h)) {
        for (const Index v : walks_[edge]) isBad[v] = true;
      }
    }
    for (Index v = 0; v < isBad.size(); ++v) {
      if (vertexCost(v) >= 0.9 * std::min(kZipper, kBoundaryNode) * unit_) isBad[v] = true;
    }
    return isBad;
  }

  /// Inner triangles with at least two vertices next to a defect.
  [[nodiscard]] std::vector<HalfFace> facesNearDefects() const {
    const std::vector<bool> isBad = badVertices();
    std::vector<bool> isNear = isBad;
    for (const Tet& tet : tets_.mesh().tets) {
      if (!std::any_of(tet.begin(), tet.end(), [&](Index v) { return isBad[v]; })) continue;
      for (const Index v : tet) isNear[v] = true;
    }
    std::vector<HalfFace> faces;
    const adjacency::TetTopology& topology = tets_.topology();
    for (HalfFace h = 0; h < topology.mate.size(); ++h) {
      if (topology.isBoundary(h) || topology.mate[h] < h) continue;
      int near = 0;
      for (const int k : lattice::kFaceCorners[h % 4]) {
        near += isNear[topology.tets[adjacency::tetOf(h)][static_cast<std::size_t>(k)]] ? 1 : 0;
      }
      if (near >= 2) faces.push_back(h);
    }
    return faces;
  }

  FrameTets& tets_;
  const EdgeWalks& walks_;
  Stage& stage_;
  std::mt19937_64 random_;
  std::vector<bool> isOuter_;
  std::vector<Edge> edges_;
  std::vector<Curves> curves_;  ///< per vertex
  double unit_ = 0;             ///< mean edge length
};

/// Whether a tet's frame must meet a condition.
bool isConstrained(const FrameTets& tets, Index t) {
  bool isBound = false;
  for (int face = 0; face < 4; ++face) {
    if (tets.topology().isBoundary(adjacency::halfFaceOf(t, face))) isBound = true;
  }
  tetmap::forEachEdgeOf(tets.mesh().tets[t],
                        [&](const VertexPair& edge, lattice::CornerMask /*corners*/) {
                          if (tets.isFeature(edge)) isBound = true;
                        });
  return isBound;
}

}  // namespace

void rematchFrames(FrameTets& tets, const EdgeWalks& walks, std::uint64_t seed, Stage& stage) {
  Rematcher(tets, walks, seed, stage).run();
}

void smoothFrames(FrameTets& tets, Stage& stage) {
  constexpr int kSmoothings = 10;
  std::vector<Index> free;
  for (Index t = 0; t < tets.size(); ++t) {
    if (!isConstrained(tets, t)) free.push_back(t);
  }
  const adjacency::TetTopology& topology = tets.topology();
  for (int round = 0; round < kSmoothings; ++round) {
    stage.context().throwIfCancelled();
    for (const Index t : free) {
      Frame sum = Frame::Zero();
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        if (topology.isBoundary(h)) continue;
        const Frame& there = tets.frames[adjacency::tetOf(topology.mate[h])];
        const double area = tets.normal(h).norm();
        for (int k = 0; k < 3; ++k) {
          sum.col(k) += area * there * vectorOf(tets.rotations[h](lattice::direction(k, 1)));
        }
      }
      const Eigen::JacobiSVD<Frame> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
      const Frame nearest = svd.matrixU() * svd.matrixV().transpose();
      if (nearest.determinant() > 0) tets.frames[t] = nearest;
    }
  }
}

}  // namespace hexhex::shape
