#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <shape/frames_matching.hpp>

#include <base/parallel.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;
using Kind = EdgeTurning::Kind;

constexpr std::size_t kMatchGrain = 1024;
/// A boundary edge is aligned with the frame axis that has the largest cosine with it, and with any
/// axis whose cosine is at least this.
constexpr double kAligned = 0.6;

/// The class of a rotation of the grid around an edge.
struct RotationKind {
  Kind kind = Kind::Regular;    ///< a quarter turn is Three
  lattice::Direction axis = 0;  ///< of a quarter turn, counterclockwise
};

RotationKind kindOf(lattice::Rotation rotation) {
  if (rotation.isIdentity()) return {};
  for (int k = 0; k < 3; ++k) {
    const lattice::Direction along = lattice::direction(k, 1);
    if (rotation(along) != along) continue;
    const lattice::Direction next = lattice::direction((k + 1) % 3, 1);
    const lattice::Direction last = lattice::direction((k + 2) % 3, 1);
    if (rotation(next) == last) return {Kind::Three, along};
    if (rotation(next) == lattice::opposite(last)) return {Kind::Three, lattice::opposite(along)};
    return {Kind::HalfTurn, along};
  }
  return {Kind::Compound, 0};
}

const RotationKind& knownKind(lattice::Rotation rotation) {
  static const std::array<RotationKind, lattice::Rotation::kCount> kKinds = [] {
    std::array<RotationKind, lattice::Rotation::kCount> kinds;
    for (int r = 0; r < lattice::Rotation::kCount; ++r) {
      kinds[static_cast<std::size_t>(r)] = kindOf(lattice::Rotation(r));
    }
    return kinds;
  }();
  return kKinds[static_cast<std::size_t>(rotation.index())];
}

Eigen::Vector3d directionOf(const FrameTets& tets, const VertexPair& edge) {
  return (tets.point(edge[1]) - tets.point(edge[0])).normalized();
}

/// Numbers of singular edges at a vertex, by kind.
struct Ends {
  int threes = 0;
  int fives = 0;
  int others = 0;
};

/// Reports triangles whose edges are all singular.
void addFlat(const FrameTets& tets, const EdgeWalks& walks, const std::vector<bool>& isSingular,
             std::vector<FieldDefect>& defects) {
  for (HalfFace h = 0; h < tets.topology().mate.size(); ++h) {
    if (!tets.topology().isBoundary(h) && tets.topology().mate[h] < h) continue;
    const std::array<Index, 3> edges = walks.edgesOf(h);
    if (std::all_of(edges.begin(), edges.end(), [&](Index edge) { return isSingular[edge]; }))
      defects.push_back({FieldDefect::Kind::Flat, walks[edges[0]]});
  }
}

void addZippers(const FrameTets& tets, const std::vector<Ends>& ends,
                std::vector<FieldDefect>& defects) {
  const std::vector<bool> isOuter = tets.boundaryVertices();
  for (Index v = 0; v < ends.size(); ++v) {
    if (isOuter[v] || ends[v].others > 0) continue;
    if (!isNode(ends[v].threes, ends[v].fives))
      defects.push_back({FieldDefect::Kind::Zipper, {v, v}});
  }
}

}  // namespace

double likeness(const Frame& here, const Frame& there, lattice::Rotation rotation) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const lattice::Direction to = rotation(lattice::direction(k, 1));
    sum += lattice::signOf(to) * there.col(lattice::axisOf(to)).dot(here.col(k));
  }
  return sum;
}

void matchFrames(FrameTets& tets, Stage& stage) {
  const adjacency::TetTopology& topology = tets.topology();
  tets.rotations.assign(topology.mate.size(), {});
  parallelFor(stage, topology.mate.size(), kMatchGrain, [&](std::size_t i) {
    const auto h = static_cast<HalfFace>(i);
    const HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) return;
    const Frame& here = tets.frames[adjacency::tetOf(h)];
    const Frame& there = tets.frames[adjacency::tetOf(mate)];
    double best = -3;
    for (int r = 0; r < lattice::Rotation::kCount; ++r) {
      const double like = likeness(here, there, lattice::Rotation(r));
      if (like <= best) continue;
      best = like;
      tets.rotations[h] = lattice::Rotation(r);
    }
    tets.rotations[mate] = tets.rotations[h].inverse();
  });
}

EdgeTurning turningAt(const FrameTets& tets, const EdgeWalks& walks, std::size_t edge) {
  const auto outs = walks.outs(edge);
  lattice::Rotation around;
  for (const HalfFace h : outs) around = tets.rotations[h] * around;
  const RotationKind& kind = knownKind(around);
  EdgeTurning turning{kind.kind, 1};
  if (kind.kind != Kind::Three) return turning;
  // Unfolded around an edge of valence 3, charts close after 3/4 of a turn, so the transition back
  // to the first one is a quarter turn.
  const Eigen::Vector3d along = directionOf(tets, walks[edge]);
  double sum = 0;
  lattice::Direction axis = kind.axis;
  for (const HalfFace h : outs) {
    sum += (tets.frames[adjacency::tetOf(h)] * vectorOf(axis)).dot(along);
    axis = tets.rotations[h](axis);
  }
  sum /= static_cast<double>(outs.size());
  return {sum > 0 ? Kind::Three : Kind::Five, std::abs(sum)};
}

lattice::Direction normalDirection(const FrameTets& tets, HalfFace h) {
  const Eigen::Vector3d local = tets.frames[adjacency::tetOf(h)].transpose() * tets.normal(h);
  Eigen::Index axis = 0;
  local.cwiseAbs().maxCoeff(&axis);
  return lattice::direction(static_cast<int>(axis), local[axis] > 0 ? 1 : -1);
}

int boundaryValence(const FrameTets& tets, const EdgeWalks& walks, std::size_t edge) {
  const auto outs = walks.outs(edge);
  const HalfFace start = walks.start(edge);
  const lattice::Direction first = normalDirection(tets, start);
  lattice::Direction last = normalDirection(tets, outs.back());
  for (std::size_t i = outs.size() - 1; i > 0; --i) {
    last = tets.rotations[outs[i - 1]].inverse()(last);
  }
  if (last == first) return 2;
  if (last == lattice::opposite(first)) return 0;
  const Frame& frame = tets.frames[adjacency::tetOf(start)];
  const Eigen::Vector3d along = directionOf(tets, walks[edge]);
  const double cosine = (frame * vectorOf(lattice::cross(first, last))).dot(along);
  double best = 0;
  for (int k = 0; k < 3; ++k) best = std::max(best, std::abs(frame.col(k).dot(along)));
  if (std::abs(cosine) < best - 1e-6 && std::abs(cosine) < kAligned) return 0;
  return cosine > 0 ? 3 : 1;
}

bool isNode(int threes, int fives) {
  // Hexahedra around a vertex cut a small sphere into triangles, and the degree of a corner there
  // is the valence of an edge. Of triangulated spheres with degrees 3 to 5, there are these (all
  // triangulations with up to ten corners were checked; there is one with twelve, and none with
  // eleven).
  using Counts = std::pair<int, int>;
  constexpr std::array<Counts, 11> kNodes = {
      {{0, 0}, {2, 0}, {4, 0}, {0, 2}, {2, 2}, {1, 3}, {0, 4}, {0, 6}, {2, 6}, {0, 8}, {0, 12}}};
  return std::find(kNodes.begin(), kNodes.end(), Counts(threes, fives)) != kNodes.end();
}

std::vector<FieldDefect> defectsOf(const FrameTets& tets, const EdgeWalks& walks) {
  std::vector<FieldDefect> defects;
  std::vector<Ends> ends(tets.mesh().points.size());
  std::vector<bool> isSingular(walks.size());
  for (std::size_t edge = 0; edge < walks.size(); ++edge) {
    if (walks.isBoundary(edge)) {
      const int valence = boundaryValence(tets, walks, edge);
      isSingular[edge] = valence != 2;
      if (valence == 0) {
        defects.push_back({FieldDefect::Kind::Boundary, walks[edge]});
      }
      continue;
    }
    const Kind kind = turningAt(tets, walks, edge).kind;
    if (kind == Kind::Regular) continue;
    isSingular[edge] = true;
    if (kind == Kind::HalfTurn) defects.push_back({FieldDefect::Kind::HalfTurn, walks[edge]});
    if (kind == Kind::Compound) defects.push_back({FieldDefect::Kind::Compound, walks[edge]});
    for (const Index v : walks[edge]) {
      if (kind == Kind::Three) {
        ++ends[v].threes;
      } else if (kind == Kind::Five) {
        ++ends[v].fives;
      } else {
        ++ends[v].others;
      }
    }
  }
  addFlat(tets, walks, isSingular, defects);
  addZippers(tets, ends, defects);
  return defects;
}

}  // namespace hexhex::shape
