#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <shape/frames_tets.hpp>
#include <tetmap/tetmap.hpp>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;

/// Calls visit(edge, half-face) for the three edges of each boundary triangle.
template <class Visit>
void forEachBoundaryEdge(const adjacency::TetTopology& topology, const Visit& visit) {
  for (HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (!topology.isBoundary(h)) continue;
    tetmap::forEachEdgeOf(topology.tets[adjacency::tetOf(h)],
                          [&](const VertexPair& edge, lattice::CornerMask corners) {
                            if (!lattice::contains(corners, adjacency::localOf(h))) visit(edge, h);
                          });
  }
}

/// The corner c opposite the face through which a walk around edge ab leaves the tet,
/// counterclockwise as seen from b: a, b, c and the fourth corner are an even permutation.
int leftCorner(int a, int b) {
  std::array<int, 4> order = {a, b, 0, 0};
  int n = 2;
  for (int corner = 0; corner < 4; ++corner) {
    if (corner != a && corner != b) order[static_cast<std::size_t>(n++)] = corner;
  }
  int inversions = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) inversions += order[i] > order[j] ? 1 : 0;
  }
  return inversions % 2 == 0 ? order[2] : order[3];
}

}  // namespace

FrameTets::FrameTets(TetMesh mesh, double featureAngleInDegrees, Stage& stage)
    : mesh_(std::move(mesh)), added_(mesh_.points.size()) {
  for (Index t = 0; t < mesh_.tets.size(); ++t) parents_.push_back(t);
  buildTopology(stage);
  findFeatures(featureAngleInDegrees * std::numbers::pi / 180, stage);
}

bool FrameTets::isFeature(const VertexPair& edge) const {
  return std::binary_search(features_.begin(), features_.end(), edge);
}

Eigen::Vector3d FrameTets::normal(HalfFace h) const {
  const Tet& tet = mesh_.tets[adjacency::tetOf(h)];
  // Corners of a face are counterclockwise as seen from inside.
  const auto corner = [&](std::size_t k) {
    return point(tet[static_cast<std::size_t>(lattice::kFaceCorners[h % 4][k])]);
  };
  const Eigen::Vector3d first = corner(0);
  return (corner(2) - first).cross(corner(1) - first);
}

double FrameTets::volume(Index tet) const {
  const Tet& v = mesh_.tets[tet];
  const Eigen::Vector3d first = point(v[0]);
  return (point(v[1]) - first).cross(point(v[2]) - first).dot(point(v[3]) - first) / 6;
}

std::vector<bool> FrameTets::boundaryVertices() const {
  std::vector<bool> isOuter(mesh_.points.size());
  forEachBoundaryEdge(topology_, [&](const VertexPair& edge, HalfFace /*h*/) {
    isOuter[edge[0]] = isOuter[edge[1]] = true;
  });
  return isOuter;
}

void FrameTets::buildTopology(Stage& stage) {
  auto topology = adjacency::manifoldTopology(mesh_.tets, mesh_.points.size(), stage);
  if (!topology) {
    throw Error(ErrorCode::Internal,
                "Splitting has made tets that are no manifold. This is a bug.");
  }
  topology_ = std::move(*topology);
  adjacency::addStars(topology_, stage);
  double sum = 0;
  for (Index t = 0; t < size(); ++t) sum += volume(t);
  // About six tets fill a cube.
  edgeLength_ = std::cbrt(6 * sum / static_cast<double>(size()));
}

void FrameTets::findFeatures(double angle, Stage& stage) {
  stage.context().throwIfCancelled();
  const double limit = leastCosine(angle);
  std::vector<std::pair<VertexPair, HalfFace>> sides;
  forEachBoundaryEdge(topology_,
                      [&](const VertexPair& edge, HalfFace h) { sides.emplace_back(edge, h); });
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    const Eigen::Vector3d here = normal(sides[i].second).normalized();
    const Eigen::Vector3d there = normal(sides[i + 1].second).normalized();
    if (here.dot(there) < limit) features_.push_back(sides[i].first);
  }
}

tetmap::BoundaryCurves FrameTets::boundaryCurves() const {
  std::vector<VertexPair> edges;
  forEachBoundaryEdge(topology_,
                      [&](const VertexPair& edge, HalfFace /*h*/) { edges.push_back(edge); });
  sortUnique(edges);
  return {mesh_.points.size(), std::move(edges), features_};
}

std::vector<tetmap::EdgeInTet> FrameTets::edgesBetweenFeatures() const {
  std::vector<tetmap::EdgeInTet> edges;
  for (HalfFace h = 0; h < topology_.mate.size(); ++h) {
    if (!topology_.isBoundary(h)) continue;
    int count = 0;
    VertexPair last{};
    tetmap::forEachEdgeOf(
        mesh_.tets[adjacency::tetOf(h)], [&](const VertexPair& edge, lattice::CornerMask corners) {
          if (lattice::contains(corners, adjacency::localOf(h)) || !isFeature(edge)) return;
          ++count;
          last = edge;
        });
    if (count == 3) edges.push_back({last, adjacency::tetOf(h)});
  }
  return edges;
}

void FrameTets::refine(Stage& stage) {
  std::vector<tetmap::EdgeInTet> edges;
  for (Index t = 0; t < size(); ++t) {
    tetmap::forEachEdgeOf(mesh_.tets[t],
                          [&](const VertexPair& edge, lattice::CornerMask /*corners*/) {
                            if ((point(edge[1]) - point(edge[0])).norm() > edgeLength_)
                              edges.push_back({edge, t});
                          });
  }
  split(std::move(edges), stage);
}

void FrameTets::makeRoom(Stage& stage) {
  // Midpoints are inside, or on the boundary off features, or, for triangles with three feature
  // edges, on one of these, so the loop ends.
  while (true) {
    std::vector<tetmap::EdgeInTet> edges = boundaryCurves().tightEdges(mesh_.tets);
    const std::vector<tetmap::EdgeInTet> more = edgesBetweenFeatures();
    edges.insert(edges.end(), more.begin(), more.end());
    if (edges.empty()) break;
    split(std::move(edges), stage);
  }
  const tetmap::BoundaryCurves boundary = boundaryCurves();
  std::vector<Index> outer;
  for (Index t = 0; t < size(); ++t) {
    if (boundary.hasAllOf(mesh_.tets[t])) outer.push_back(t);
  }
  splitTets(outer, stage);
}

void FrameTets::split(std::vector<tetmap::EdgeInTet> edges, Stage& stage) {
  static_cast<void>(tetmap::splitLongestFirst(
      mesh_, topology_.mate, std::move(edges),
      [&](const VertexPair& edge, Index middle, const std::vector<tetmap::Cut>& cuts) {
        stage.context().throwIfCancelled();
        added_.add(edge);
        for (const tetmap::Cut& cut : cuts) {
          tetmap::carryTet(cut, parents_);
          if (frames.empty()) continue;
          tetmap::carryTet(cut, frames);
          // Charts of both parts agree.
          tetmap::carryFaces(cut, lattice::Rotation(), rotations);
        }
        splitFeature(edge, middle);
      }));
  buildTopology(stage);
}

void FrameTets::splitFeature(const VertexPair& edge, Index middle) {
  const auto at = std::lower_bound(features_.begin(), features_.end(), edge);
  if (at == features_.end() || *at != edge) return;
  features_.erase(at);
  for (const Index end : edge) {  // the new vertex has the largest number
    const VertexPair part = {end, middle};
    features_.insert(std::lower_bound(features_.begin(), features_.end(), part), part);
  }
}

void FrameTets::splitTets(const std::vector<Index>& tets, Stage& stage) {
  tetmap::MutableTets mutableTets(std::move(mesh_.tets), topology_.mate, mesh_.points.size());
  for (const Index t : tets) {
    const Tet whole = mutableTets.tets[t];
    Vec3 centre{};
    for (const Index v : whole) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += 0.25 * mesh_.points[v][k];
    }
    mesh_.points.push_back(centre);
    added_.add(whole);
    static_cast<void>(mutableTets.splitTet(t));
    parents_.resize(mutableTets.tetCount(), Index{parents_[t]});
  }
  mesh_.tets = std::move(mutableTets.tets);
  buildTopology(stage);
}

EdgeWalks::EdgeWalks(const FrameTets& tets) : fans_(tets.topology()) {
  const adjacency::TetTopology& topology = tets.topology();
  edges_.reserve(fans_.size());
  for (std::size_t edge = 0; edge < fans_.size(); ++edge) {
    const auto fan = fans_(edge);
    adjacency::EdgeCorner first = fan.front();
    HalfFace start = kNone;
    for (const adjacency::EdgeCorner& at : fan) {
      // The walk enters a tet through the face opposite its other corner.
      const int behind = 6 - at.corner0 - at.corner1 - leftCorner(at.corner0, at.corner1);
      const HalfFace h = adjacency::halfFaceOf(at.tet, behind);
      if (!topology.isBoundary(h)) continue;
      first = at;
      start = h;
    }
    const Tet& tet = topology.tets[first.tet];
    edges_.push_back({tet[first.corner0], tet[first.corner1]});
    starts_.push_back(start);
    const auto ends = static_cast<lattice::CornerMask>(lattice::cornerBit(first.corner0) |
                                                       lattice::cornerBit(first.corner1));
    adjacency::EdgeTurn turn(topology, first.tet, ends, leftCorner(first.corner0, first.corner1));
    for (std::size_t i = 0; i < fan.size(); ++i) {
      outs_.push_back(turn.out());
      if (turn.next() == kNone) break;
      turn.step();
    }
    begins_.push_back(outs_.size());
  }
}

std::array<Index, 3> EdgeWalks::edgesOf(HalfFace h) const {
  std::array<Index, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto ends = static_cast<lattice::CornerMask>(
        lattice::kWholeTet ^ lattice::cornerBit(adjacency::localOf(h)) ^
        lattice::cornerBit(lattice::kFaceCorners[h % 4][k]));
    edges[k] = fans_.edgeOf(adjacency::tetOf(h), ends);
  }
  return edges;
}

}  // namespace hexhex::shape
