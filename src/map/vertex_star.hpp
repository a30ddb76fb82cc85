// The tets around a vertex, found by walking from face to face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <map/key_table.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

/// The three faces at a corner of a tet, and the three corners other than this one.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// The star of one vertex after the other, without any list of stars. Keeps its memory.
class VertexStar {
 public:
  struct Member {
    CornerIndex corner;  ///< at the vertex
    /// Which member is behind the face opposite corner kOthers[corner % 4][k]; kNone at the
    /// boundary.
    std::array<Index, 3> neighbour;

    [[nodiscard]] Index tet() const noexcept { return corner / 4; }
    [[nodiscard]] HalfFace halfFace(std::size_t k) const noexcept {
      return 4 * tet() + kOthers[corner % 4][k];
    }
  };

  /// Walks breadth first from the smallest tet at the vertex. Only what is connected through faces
  /// is found: everything, in a manifold.
  /// @param vertex  not isolated
  void collect(const TetTopology& topology, Index vertex) {
    const Index first = topology.vertexTet[vertex];
    numbers_.clear();
    KeyTable::Numberer number = numbers_.numberer();
    Member* members = members_.data();
    members[0] = {cornerAt(topology, first, vertex), {kUnset, kUnset, kUnset}};
    Index count = 1 + number(first, 0);
    for (Index head = 0; head < count; ++head) {
      // Up to three more, and one that is written in vain.
      if (members_.size() < count + 4 || !numbers_.hasRoom(count + 4)) {
        members_.resize(2 * members_.size());
        numbers_.makeRoom(members_.size());
        members = members_.data();
        number = numbers_.numberer();
      }
      const CornerIndex here = members[head].corner;
      for (std::size_t k = 0; k < 3; ++k) {
        if (members[head].neighbour[k] != kUnset) continue;
        const HalfFace mate = topology.mate[4 * (here / 4) + kOthers[here % 4][k]];
        // No branch at the boundary: there, a tet stands for its neighbour.
        const bool boundary = mate == kNone;
        const Index tet = boundary ? here / 4 : tetOf(mate);
        const Index neighbour = number(tet, count);
        const CornerIndex corner = cornerAt(topology, tet, vertex);
        members[count] = {corner, {kUnset, kUnset, kUnset}};
        // The same link from the other side, if there is one.
        const HalfFace local = mate % 4;
        const std::size_t back = local - (local > corner % 4 ? 1U : 0U);
        if (!boundary) members[neighbour].neighbour[back] = head;
        members[head].neighbour[k] = boundary ? kNone : neighbour;
        count += neighbour == count ? 1 : 0;
      }
    }
    count_ = count;
  }

  /// In the order of the walk: each but the first is behind the first face, in the order of members
  /// and their faces, that leads to a member not named before.
  [[nodiscard]] std::span<const Member> members() const noexcept {
    return {members_.data(), count_};
  }

 private:
  [[nodiscard]] static CornerIndex cornerAt(const TetTopology& topology, Index tet, Index vertex) {
    return 4 * tet + static_cast<CornerIndex>(topology.localCorner(tet, vertex));
  }

  static constexpr Index kUnset = kNone - 1;  ///< neighbour not looked up yet

  KeyTable numbers_;  ///< of tets
  std::size_t count_ = 0;
  std::vector<Member> members_ = std::vector<Member>(64);
};

/// Stars that are kept: those of the special vertices among consecutive vertices.
struct StarBlock {
  std::vector<Index> vertices;
  std::vector<std::size_t> ends;  ///< per vertex: where its members end
  std::vector<VertexStar::Member> members;

  /// Of boundary vertices with flat stars, only what is in the way of rounding each corner on its
  /// own: the boundary plane's axis in its chart, as a bit.
  struct PlaneCorner {
    CornerIndex corner;
    std::uint32_t plane;
  };
  std::vector<PlaneCorner> planeCorners;

  std::size_t cornersSeen = 0;  ///< in all stars, kept or flat

  void add(Index vertex, std::span<const VertexStar::Member> star) {
    vertices.push_back(vertex);
    members.insert(members.end(), star.begin(), star.end());
    ends.push_back(members.size());
  }
  [[nodiscard]] std::span<const VertexStar::Member> star(std::size_t i) const noexcept {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return std::span(members).subspan(begin, ends[i] - begin);
  }
};

}  // namespace hexhex
