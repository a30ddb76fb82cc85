// The tets around a vertex, found by walking from face to face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <map/key_table.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

/// The star of one vertex after the other, without any list of stars. Keeps its memory.
class VertexStar {
 public:
  struct Member {
    CornerIndex corner;  ///< at the vertex
    /// Per face: which member is behind it; kNone at the boundary and at the face opposite.
    std::array<Index, 4> neighbour;
  };

  /// Walks breadth first from the smallest tet at the vertex. Only what is connected through faces
  /// is found: everything, in a manifold.
  /// @param vertex  not isolated
  void collect(const TetTopology& topology, Index vertex) {
    tets_.clear();
    members_.clear();
    add(topology, topology.vertexTet[vertex], vertex);
    for (std::size_t head = 0; head < members_.size(); ++head) {
      const CornerIndex corner = members_[head].corner;
      for (int face = 0; face < 4; ++face) {
        if (members_[head].neighbour[static_cast<std::size_t>(face)] != kUnknown) continue;
        const HalfFace mate = topology.mate[halfFaceOf(corner / 4, face)];
        Index neighbour = kNone;
        if (mate != kNone) {
          neighbour = add(topology, tetOf(mate), vertex);
          members_[neighbour].neighbour[mate % 4] = static_cast<Index>(head);
        }
        members_[head].neighbour[static_cast<std::size_t>(face)] = neighbour;
      }
    }
  }

  /// In the order of the walk. Each but the first is behind the first face, in the order of
  /// members and their faces, that leads to a member not named before.
  [[nodiscard]] std::span<const Member> members() const noexcept { return members_; }

  /// The member that is this tet, which must be in the star.
  [[nodiscard]] Index memberOf(Index tet) const noexcept { return tets_[tet]; }

 private:
  static constexpr Index kUnknown = kNone - 1;

  Index add(const TetTopology& topology, Index tet, Index vertex) {
    const Index member = tets_.insert(tet);
    if (member == members_.size()) {
      const int local = topology.localCorner(tet, vertex);
      Member& added = members_.emplace_back(Member{4 * tet + static_cast<CornerIndex>(local),
                                                   {kUnknown, kUnknown, kUnknown, kUnknown}});
      added.neighbour[static_cast<std::size_t>(local)] = kNone;
    }
    return member;
  }

  KeyTable tets_;
  std::vector<Member> members_;
};

}  // namespace hexhex
