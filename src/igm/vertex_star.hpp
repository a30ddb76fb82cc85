// The tets around a vertex, found by walking from face to face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>

#include <base/low_level.hpp>
#include <igm/half_face_transition.hpp>
#include <lattice/grid_motion.hpp>

namespace hexhex::igm {

/// The three faces at a corner of a tet, and the three corners other than this one.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// Per corner and local number of a face at it: the face's position in kOthers.
inline constexpr std::array<std::array<std::uint8_t, 4>, 4> kPlaceOfFace = {
    {{0, 0, 1, 2}, {0, 0, 1, 2}, {0, 1, 0, 2}, {0, 1, 2, 0}}};

/// The stars of vertices, one after the other, without any list of stars. Keeps its memory.
class VertexStar {
 public:
  struct Member {
    adjacency::CornerIndex corner = 0;  ///< at the vertex
    /// The member behind the face opposite corner kOthers[corner % 4][k]; kNone at the boundary.
    std::array<Index, 3> neighbour{};
    /// From the chart of the first member into this one's, along the walk.
    lattice::Rotation rotation;
    std::uint8_t entry =
        0;  ///< through which of its three faces it was found; not of the first one

    [[nodiscard]] Index tet() const noexcept { return corner / 4; }
    [[nodiscard]] adjacency::HalfFace halfFace(std::size_t k) const noexcept {
      return 4 * tet() + kOthers[corner % 4][k];
    }
  };

  /// Walks breadth first from the smallest tet at the vertex. Finds only what is connected through
  /// faces: everything, in a manifold.
  /// @param vertex  not isolated
  /// @param faceTransitions  per half-face; without them, nothing is known of charts
  void collect(const adjacency::TetTopology& topology, Index vertex,
               std::span<const HalfFaceTransition> faceTransitions = {}) {
    numbers_.clear();
    adjacency::KeyTable::Numberer number = numbers_.numberer();
    Member* members = members_.data();
    const Index first = topology.vertexTet[vertex];
    members[0].corner = 4 * first + adjacency::localCorner(topology.tets[first], vertex);
    members[0].rotation = lattice::Rotation();
    Index count = 1 + number(first, 0);
    unsigned misfits = 0;
    lattice::AxisSet planes = 0;
    // Looks through face k of a member, without branches: neither whether the member behind is new
    // nor where the boundary is can be predicted. At the boundary, a member is its own neighbour.
    const auto cross = [&](Index head, std::size_t k) {
      const Member here = members[head];
      const adjacency::HalfFace halfFace = here.halfFace(k);
      const HalfFaceTransition across =
          faceTransitions.empty() ? HalfFaceTransition() : faceTransitions[halfFace];
      const adjacency::HalfFace mate = topology.mate[halfFace];
      const bool isBoundary = mate == kNone;
      const Index tet = adjacency::tetOf(isBoundary ? halfFace : mate);
      prefetch(&topology.mate[4 * tet]);
      const Index j = number(tet, count);
      Member& behind = members[count];  // wasted if it is not new
      const Index corner = adjacency::localCorner(topology.tets[tet], vertex);
      behind.corner = 4 * tet + corner;
      behind.entry = kPlaceOfFace[corner][mate % 4];
      behind.neighbour[behind.entry] = head;
      behind.rotation = across.rotation() * here.rotation;
      members[head].neighbour[k] = isBoundary ? kNone : j;
      misfits |= behind.rotation == members[j].rotation ? 0U : 1U;
      misfits |= across.isInexact() ? 1U : 0U;
      planes |= lattice::imageOf(across.plane(), here.rotation.inverse());
      count += j == count ? 1 : 0;
    };
    for (std::size_t k = 0; k < 3; ++k) cross(0, k);
    for (Index head = 1; head < count; ++head) {
      // Up to two more, and one wasted write.
      if (members_.size() < count + 3) {
        members_.resize(2 * members_.size());
        numbers_.makeRoom(members_.size());
        members = members_.data();
        number = numbers_.numberer();
      }
      const std::size_t entry = members[head].entry;
      cross(head, entry == 0 ? 1 : 0);
      cross(head, entry == 2 ? 1 : 2);
    }
    count_ = count;
    fits_ = misfits == 0;
    planes_ = planes;
  }

  /// In walk order.
  [[nodiscard]] std::span<const Member> members() const noexcept {
    return {members_.data(), count_};
  }
  /// The axes across boundary faces, in the chart of the first member.
  [[nodiscard]] lattice::AxisSet planes() const noexcept { return planes_; }
  /// Whether transitions are exact, and all paths through the star lead to the same charts.
  [[nodiscard]] bool chartsFit() const noexcept { return fits_; }

 private:
  adjacency::KeyTable numbers_;  ///< of tets
  Index count_ = 0;
  lattice::AxisSet planes_ = 0;
  bool fits_ = true;
  std::vector<Member> members_ = std::vector<Member>(64);
};

/// From the chart of a star's first member into those of all members, along the walk.
/// @param across  across(half-face): the transition into the neighbour's chart
template <class Across>
std::vector<lattice::Transition> unfoldStar(std::span<const VertexStar::Member> star,
                                            const Across& across) {
  std::vector<lattice::Transition> charts(star.size());
  std::size_t reached = 1;
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (star[i].neighbour[k] != reached) continue;
      charts[reached++] = across(star[i].halfFace(k)) * charts[i];
    }
  }
  return charts;
}

}  // namespace hexhex::igm
