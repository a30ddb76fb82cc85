// The tets around a vertex, found by walking from face to face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <adjacency/key_table.hpp>
#include <adjacency/tet_topology.hpp>

#include <base/prefetch.hpp>
#include <lattice/rotation.hpp>

namespace hexhex {

/// The three faces at a corner of a tet, and the three corners other than this one.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// By corner and by the local number of a face at it: where the face stands in kOthers.
inline constexpr std::array<std::array<std::uint8_t, 4>, 4> kPlaceOfFace = {
    {{0, 0, 1, 2}, {0, 0, 1, 2}, {0, 1, 0, 2}, {0, 1, 2, 0}}};

/// The star of one vertex after the other, without any list of stars. Keeps its memory.
class VertexStar {
 public:
  struct Member {
    CornerIndex corner;  ///< at the vertex
    /// Which member is behind the face opposite corner kOthers[corner % 4][k]; kNone at the
    /// boundary.
    std::array<Index, 3> neighbour;
    /// From the chart of the first member into this one's, along the walk; if it looked at charts.
    Rotation rotation;
    std::uint8_t entry;  ///< through which of its three faces it was found; not of the first one

    [[nodiscard]] Index tet() const noexcept { return corner / 4; }
    [[nodiscard]] HalfFace halfFace(std::size_t k) const noexcept {
      return 4 * tet() + kOthers[corner % 4][k];
    }
  };

  /// Walks breadth first from the smallest tet at the vertex. Only what is connected through faces
  /// is found: everything, in a manifold.
  /// @param vertex  not isolated
  void collect(const TetTopology& topology, Index vertex) {
    static_cast<void>(walk(topology, vertex,
                           [](HalfFace /*halfFace*/, const Member& /*here*/, Member& /*spare*/,
                              const Member& /*behind*/) {}));
  }

  /// The same, and calls visit(half-face, member, spare, member behind) for the faces of each
  /// member, in order, but for the one through which it was found; at the boundary, a member is
  /// behind itself. What is spare becomes the member behind if that is new. Nothing is foretold
  /// that is as good as random: whether a member is new, or a face is on the boundary.
  /// @returns `visit`, which is taken by value so that what it counts stays in registers
  template <class Visit>
  [[nodiscard]] Visit walk(const TetTopology& topology, Index vertex, Visit visit) {
    const Tet* const tets = topology.tets.data();
    const HalfFace* const mates = topology.mate.data();
    const auto cornerAt = [tets, vertex](Index tet) {
      return 4 * tet + localCorner(tets[tet], vertex);
    };
    numbers_.clear();
    Member* members = members_.data();
    const Index first = topology.vertexTet[vertex];
    members[0].corner = cornerAt(first);
    members[0].rotation = Rotation();
    Index count = 1 + numbers_.insert(first);
    const auto pass = [&](Index head, CornerIndex here, std::size_t k) {
      const HalfFace halfFace = 4 * (here / 4) + kOthers[here % 4][k];
      const HalfFace mate = mates[halfFace];
      const bool boundary = mate == kNone;
      const Index behind = boundary ? here / 4 : tetOf(mate);
      prefetch(&mates[4 * behind]);
      const Index neighbour = numbers_.insert(behind);
      Member& spare = members[count];
      spare.corner = cornerAt(behind);
      spare.entry = kPlaceOfFace[spare.corner % 4][mate % 4];
      spare.neighbour[spare.entry] = head;
      members[head].neighbour[k] = boundary ? kNone : neighbour;
      visit(halfFace, members[head], spare, members[neighbour]);
      count += neighbour == count ? 1 : 0;
    };
    for (std::size_t k = 0; k < 3; ++k) pass(0, members[0].corner, k);
    Index room = 0;
    for (Index head = 1; head < count; ++head) {
      // Up to two more, and one that is written in vain.
      if (room < count + 3) {
        makeRoom(count + 3);
        room = static_cast<Index>(members_.size());
        members = members_.data();
      }
      const CornerIndex here = members[head].corner;
      const std::size_t entry = members[head].entry;
      pass(head, here, entry == 0 ? 1 : 0);
      pass(head, here, entry == 2 ? 1 : 2);
    }
    count_ = count;
    return visit;
  }

  /// In the order of the walk: each but the first is behind the first face, in the order of members
  /// and their faces, that leads to a member not named before.
  [[nodiscard]] std::span<const Member> members() const noexcept {
    return {members_.data(), count_};
  }

 private:
  void makeRoom(std::size_t count) {
    while (members_.size() < count) members_.resize(2 * members_.size());
  }

  KeyTable<> numbers_;  ///< of tets
  std::size_t count_ = 0;
  Array<Member> members_ = Array<Member>(64);
};

/// Stars that are kept: those of the special vertices among consecutive vertices.
struct StarBlock {
  std::vector<Index> vertices;
  /// Per vertex: the planes of its boundary faces in the chart of its first member, bit k across
  /// axis k.
  std::vector<std::uint32_t> planes;
  std::vector<std::size_t> ends;  ///< per vertex: where its members end
  Array<VertexStar::Member> members;

  /// Of boundary vertices with flat stars, only what is in the way of rounding each corner on its
  /// own: the boundary plane's axis in its chart, as a bit.
  struct PlaneCorner {
    CornerIndex corner;
    std::uint32_t plane;
  };
  std::vector<PlaneCorner> planeCorners;

  std::size_t cornersSeen = 0;  ///< in all stars, kept or flat

  /// Makes room for as many vertices.
  void reserve(std::size_t count) {
    vertices.reserve(count);
    planes.reserve(count);
    ends.reserve(count);
  }
  void add(Index vertex, std::span<const VertexStar::Member> star, unsigned planesOfStar) {
    vertices.push_back(vertex);
    planes.push_back(planesOfStar);
    members.insert(members.end(), star.begin(), star.end());
    ends.push_back(members.size());
  }
  [[nodiscard]] std::span<const VertexStar::Member> star(std::size_t i) const noexcept {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return std::span(members).subspan(begin, ends[i] - begin);
  }
};

}  // namespace hexhex
