#include <algorithm>
#include <string>

#include <base/disjoint_sets.hpp>
#include <igm/vertex_star.hpp>
#include <repair/bad_tets.hpp>
#include <repair/whole_regions.hpp>

namespace hexhex {

namespace {

/// More bad tets than this share of all, and than this number, are no local defect.
constexpr double kMaxBadShare = 0.2;
/// Nor are more connected ones, if some of them have no good tet around.
constexpr std::size_t kMaxBadTets = 200;

std::string tetsAsText(std::size_t count) {
  return count == 1 ? "1 tet" : std::to_string(count) + " tets";
}

/// Unites tets that have a triangle in common, and for which a test holds.
template <class Test>
DisjointSets componentsOf(const TetTopology& topology, const Test& test) {
  DisjointSets sets(topology.tetCount());
  for (HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    const HalfFace mate = topology.mate[halfFace];
    if (mate == kNone || mate < halfFace) continue;
    if (test(tetOf(halfFace)) && test(tetOf(mate))) sets.unite(tetOf(halfFace), tetOf(mate));
  }
  return sets;
}

void refuseInvertedComponents(const TetTopology& topology, const LocalParameters& parameters) {
  DisjointSets sets = componentsOf(topology, [](Index) { return true; });
  std::vector<double> volume(topology.tetCount(), 0);  // by smallest tet
  std::vector<Index> count(topology.tetCount(), 0);
  for (Index t = 0; t < topology.tetCount(); ++t) {
    const Index root = sets.find(t);
    volume[root] += determinantOf(parameters(t)) / 6;
    ++count[root];
  }
  for (Index t = 0; t < topology.tetCount(); ++t) {
    if (count[t] == 0 || volume[t] > 0) continue;
    throw Error(
        ErrorCode::FlippedTet,
        "The component of the mesh with tet " + std::to_string(t) + " (" + tetsAsText(count[t]) +
            " of " + std::to_string(topology.tetCount()) +
            ") is inverted or collapsed as a whole: its volume in the map, in which flipped "
            "tets count negative, is not positive. That is no local defect and is not "
            "repaired; if it is mirrored, negate one parameter of its corners, otherwise "
            "compute the map again.",
        {PlaceKind::Tet, t});
  }
}

/// Whether all tets at the vertices of a tet are bad.
bool isSurrounded(const TetTopology& topology, Index tet, const std::vector<Index>& bad,
                  VertexStar& star) {
  const Tet& corners = topology.tets[tet];
  return std::all_of(corners.begin(), corners.end(), [&](Index v) {
    star.collect(topology, v);
    return std::all_of(star.members().begin(), star.members().end(),
                       [&](const VertexStar::Member& member) {
                         return std::binary_search(bad.begin(), bad.end(), member.tet());
                       });
  });
}

}  // namespace

void refuseInvertedParts(const TetTopology& topology, const LocalParameters& parameters,
                         const std::vector<Index>& bad) {
  if (bad.empty()) return;
  refuseInvertedComponents(topology, parameters);
  const auto tets = static_cast<double>(topology.tetCount());
  if (bad.size() > kMaxBadTets && static_cast<double>(bad.size()) > kMaxBadShare * tets) {
    throw Error(ErrorCode::FlippedTet,
                std::to_string(bad.size()) + " of " + tetsAsText(topology.tetCount()) +
                    " are flipped or flat in the map: whole regions of it are inverted or "
                    "collapsed. That is no local defect and is not repaired; compute the map "
                    "again.",
                {PlaceKind::Tet, bad.front()});
  }
}

void refuseInvertedRegions(const TetTopology& topology, const std::vector<Index>& bad) {
  if (bad.size() <= kMaxBadTets) return;
  DisjointSets sets = componentsOf(
      topology, [&](Index t) { return std::binary_search(bad.begin(), bad.end(), t); });
  std::vector<Index> roots;
  roots.reserve(bad.size());
  for (const Index t : bad) roots.push_back(sets.find(t));
  std::sort(roots.begin(), roots.end());
  VertexStar star;
  for (const Index t : bad) {
    const auto [first, last] = std::equal_range(roots.begin(), roots.end(), sets.find(t));
    const auto size = static_cast<std::size_t>(last - first);
    if (size <= kMaxBadTets || !isSurrounded(topology, t, bad, star)) continue;
    throw Error(ErrorCode::FlippedTet,
                "A whole region of the map is inverted or collapsed: " + tetsAsText(size) +
                    " around tet " + std::to_string(t) +
                    ", which has no positive tet near. That is no local defect and is not "
                    "repaired; compute the map again, there at least.",
                {PlaceKind::Tet, t});
  }
}

}  // namespace hexhex
