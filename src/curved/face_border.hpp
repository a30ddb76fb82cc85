// The border of a hex face: its vertices, and its arcs with their points.
#pragma once

#include <array>
#include <cstdint>

#include <curved/patches.hpp>
#include <curved/simplex_star.hpp>
#include <curved/square_slice.hpp>

namespace hexhex::curved {

/// A corner of a polygon: its number and its (u, v).
struct PatchPoint {
  Index number;
  std::array<double, 2> parameter;
};

/// The border of one face after another. One per thread. Sides of the square are numbered as in
/// slices.
class FaceBorder {
 public:
  explicit FaceBorder(const PatchInput& input)
      : input_(input),
        topology_(input.map.topology),
        exact_(input.map.exact),
        star_(input.map.topology, input.map.exact),
        vertexCount_(input.vertices.count()) {}

  /// Starts another face.
  void begin() noexcept {
    found_ = 0;
    reversed_ = 0;
  }
  /// Whether a tet may contain all vertices of the face.
  [[nodiscard]] static bool mayContainAll(const SeenTet& seen, std::int64_t unit) noexcept;
  /// If all four vertices are in one closed tet, sets them and the arcs between them.
  /// @return the smallest simplex of the tet that contains them, or kNoSimplex
  [[nodiscard]] lattice::CornerMask setInsideOneTet(Index tet, const Frame& frame);

  /// Looks for midpoints of sides along a slice and sets the arcs of those it finds.
  /// @param carrier  the sliced simplex, with the face's frame
  void findArcs(const SimplexInTet& carrier, const SeenTet& seen, const Slice& slice);
  /// Call when all slices have been visited.
  /// @param tet  for error messages
  void finish(Index tet);

  [[nodiscard]] const Quad& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const std::array<Index, 4>& arcs() const noexcept { return arcs_; }
  [[nodiscard]] std::uint8_t reversed() const noexcept { return reversed_; }

  [[nodiscard]] PatchPoint vertex(std::size_t corner) const noexcept {
    constexpr std::array<std::array<double, 2>, 4> kPlaces = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    return {vertices_[corner], kPlaces[corner]};
  }
  /// What is known about one end of a slice's side on the border.
  struct SideEnd {
    bool isKnown;
    bool isSquareCorner;
  };
  /// Finds the unknown arc points at the ends of a slice's side. The side runs inside the carrier,
  /// so the two points are consecutive on the arc.
  /// @param side  of the square
  /// @return false if the arc passes several times, so that the points are ambiguous
  [[nodiscard]] bool findEnds(const SimplexInTet& carrier, std::size_t side, const SideEnd& first,
                              const SideEnd& second, PatchPoint& firstPoint,
                              PatchPoint& secondPoint) const noexcept;
  /// The arc point at a corner of a slice.
  [[nodiscard]] PatchPoint pointAt(Index tet, const SeenTet& seen, const SliceCorner& corner) const;

 private:
  [[nodiscard]] bool isReversed(std::size_t side) const noexcept {
    return ((reversed_ >> side) & 1U) != 0;
  }
  /// The part of an arc inside a carrier, given as the number of the point at its end among those
  /// of all arcs; kNoPart if there are several.
  [[nodiscard]] std::uint64_t partIn(const SimplexInTet& carrier, std::size_t side) const noexcept;
  [[nodiscard]] PatchPoint arcPoint(std::size_t side, std::uint64_t point) const noexcept;
  [[nodiscard]] lattice::CornerMask simplexOfMidpoint(const lattice::LatticeTet& corners,
                                                      std::size_t side) const;
  void setArc(std::size_t side, const SimplexInTet& midpoint);

  static constexpr std::uint64_t kNoPart = ~std::uint64_t{0};

  const PatchInput& input_;
  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  SimplexStar star_;
  std::uint64_t vertexCount_;
  std::array<std::size_t, 4> lineHints_{};  ///< per side: where its arc was found last time

  // The current face:
  Quad vertices_{};
  std::array<Index, 4> arcs_{};
  std::uint8_t reversed_ = 0;  ///< bit per side
  unsigned found_ = 0;         ///< bit per side
};

/// @throws Error Internal, always
[[noreturn]] void failToCut(Index tet, const char* what);

}  // namespace hexhex::curved
