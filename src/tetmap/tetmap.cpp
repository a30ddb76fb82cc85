// Splits edges and tets, and finds the parts of what has been split.
#include <algorithm>
#include <utility>

#include <tetmap/tetmap.hpp>

#include <hexhex/error.hpp>

namespace hexhex::tetmap {

MutableTets::MutableTets(std::vector<Tet> tets_, std::span<const adjacency::HalfFace> mate_,
                         std::size_t vertexCount)
    : tets(std::move(tets_)),
      mate(mate_.begin(), mate_.end()),
      vertexCount_(vertexCount),
      firstPart_(tets.size(), kNone) {}

void MutableTets::shrink() {
  tets.shrink_to_fit();
  mate.shrink_to_fit();
  parts_ = {};
  firstPart_ = {};
}

MutableTets::Found MutableTets::find(Index v, Index w, Index tet) const {
  // The tet itself is the first of its parts; those split off, and their parts, form a tree.
  std::vector<Index> toLookAt = {tet};
  while (!toLookAt.empty()) {
    const Index t = toLookAt.back();
    toLookAt.pop_back();
    const auto has = [&](Index vertex) {
      return std::find(tets[t].begin(), tets[t].end(), vertex) != tets[t].end();
    };
    if (has(v) && has(w)) return {edge(t, v, w), kNone};
    for (Index p = firstPart_[t]; p != kNone; p = parts_[p].next) {
      const Part& part = parts_[p];
      if ((part.kept == v && part.given == w) || (part.kept == w && part.given == v)) {
        return {std::nullopt, part.middle};
      }
      toLookAt.push_back(part.tet);
    }
  }
  throw Error(ErrorCode::Internal, "An edge of a tet mesh has vanished. This is a bug.",
              {PlaceKind::Edge, v, w});
}

std::vector<Cut> MutableTets::splitEdge(const EdgeInTet& at) {
  const auto [v, w] = at.vertices;
  const std::optional<adjacency::TetEdge> found = find(v, w, at.tet).edge;
  if (!found) {
    throw Error(ErrorCode::Internal, "An edge is to be split twice. This is a bug.",
                {PlaceKind::Edge, v, w});
  }
  std::vector<adjacency::TetEdge> around;
  for (const Index t : adjacency::tetsAround(*this, found->tet, found->mask())) {
    around.push_back(edge(t, at.vertices[0], at.vertices[1]));
  }
  return splitEdge(around);
}

std::vector<Cut> MutableTets::splitEdge(std::span<const adjacency::TetEdge> around) {
  const auto middle = static_cast<Index>(vertexCount_++);
  const auto firstNew = static_cast<Index>(tetCount());
  std::vector<Cut> cuts;
  cuts.reserve(around.size());
  for (const adjacency::TetEdge& at : around) {
    const Tet& tet = tets[at.tet];
    const Part part{static_cast<Index>(tetCount()), kNone, tet[at.corner0], tet[at.corner1],
                    middle};
    cuts.push_back(cutTet(tets, at, middle));
    addPart(at.tet, part);
    for (adjacency::HalfFace h = 4 * at.tet; h < 4 * at.tet + 4; ++h) {
      mate.push_back(adjacency::HalfFace{mate[h]});
    }
  }
  const auto secondOf = [&](Index tet) {
    std::size_t i = 0;
    while (around[i].tet != tet) ++i;
    return firstNew + static_cast<Index>(i);
  };
  for (const Cut& cut : cuts) {
    for (std::size_t face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = 4 * cut.second + static_cast<Index>(face);
      if (mate[h] == kNone || face == cut.b) continue;
      // The face beyond the new vertex belongs to the second part alone; those at the edge are
      // split.
      if (face == cut.a) {
        mate[mate[h]] = h;
      } else {
        mate[h] =
            adjacency::halfFaceOf(secondOf(adjacency::tetOf(mate[h])), adjacency::localOf(mate[h]));
      }
    }
  }
  for (const Cut& cut : cuts) {
    join(4 * cut.first + static_cast<Index>(cut.a), 4 * cut.second + static_cast<Index>(cut.b));
  }
  return cuts;
}

std::array<Index, 4> MutableTets::splitTet(Index tet) {
  const auto vertex = static_cast<Index>(vertexCount_++);
  const Tet whole = tets[tet];
  std::array<Index, 4> parts{tet};
  for (Index i = 1; i < 4; ++i) {
    parts[i] = static_cast<Index>(tetCount());
    tets.push_back(whole);
    mate.resize(mate.size() + 4, kNone);
    mate[4 * parts[i] + i] = mate[4 * tet + i];
    if (mate[4 * tet + i] != kNone) join(4 * parts[i] + i, mate[4 * tet + i]);
    addPart(tet, {parts[i], kNone, kNone, kNone, kNone});
  }
  for (Index i = 0; i < 4; ++i) {
    tets[parts[i]][i] = vertex;
    for (Index j = 0; j < i; ++j) join(4 * parts[i] + j, 4 * parts[j] + i);
  }
  return parts;
}

void MutableTets::addPart(Index tet, Part part) {
  part.next = std::exchange(firstPart_[tet], static_cast<Index>(parts_.size()));
  parts_.push_back(part);
  firstPart_.push_back(kNone);
}

}  // namespace hexhex::tetmap
