// One cell of a partial extraction: the pieces of tets in its unit cube, and their volumes in
// floating point.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <lattice/wide_int.hpp>

namespace hexhex::repairs {

/// A chart-independent name of a hex vertex: the simplex of the tet mesh that holds it, by its
/// vertices in ascending order (padded with kNone), and its squared distances from up to three of
/// them, which locate it in an edge or triangle. In a tet: the coordinates in the tet's chart.
struct VertexName {
  std::array<Index, 4> simplex = {kNone, kNone, kNone, kNone};
  std::array<lattice::Int128, 3> place{};
  [[nodiscard]] bool operator==(const VertexName&) const = default;
  [[nodiscard]] bool operator<(const VertexName& other) const {
    return simplex != other.simplex ? simplex < other.simplex : place < other.place;
  }
};

class CellFlood {
 public:
  /// A tet that meets the cube, in the chart of the first one.
  struct Piece {
    Index tet;
    lattice::Transition fromFirst;
    lattice::LatticeTet corners;
    double volume;  ///< of its part inside the cube
  };

  /// @param valid  per tet
  /// @param scaled  whether the map's lattice is already scaled
  CellFlood(const igm::PreparedMap& map, std::span<const std::uint8_t> valid)
      : map_(map), valid_(valid) {}

  /// Spreads from a valid tet over all tets that meet the open unit cube above a grid point of its
  /// chart. False if something is in the way: the cell is incomplete.
  bool run(Index tet, const lattice::GridPoint& low);

  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }

  struct Corner {
    VertexName name;
    Vec3 position{};
  };
  /// Corner i of the cell in VTK's order; nothing if the pieces miss it by less than volumes
  /// reveal: the cell is incomplete then, too.
  [[nodiscard]] std::optional<Corner> corner(std::size_t i) const;

  /// Whether a face of the cell, in the order of kHexFaces, is on the boundary of the tets.
  [[nodiscard]] bool isOnBoundary(std::size_t wall) const { return wallArea_[wall] > 1 - kSlack; }

  /// Far above rounding of areas and volumes near 1.
  static constexpr double kSlack = 1e-6;

 private:
  bool visit(Index tet, const lattice::Transition& fromFirst);
  bool spread(std::size_t index);
  [[nodiscard]] std::array<Vec3, 4> relative(const lattice::LatticeTet& corners) const;
  [[nodiscard]] VertexName nameOf(const Piece& piece, lattice::CornerMask simplex,
                                  const lattice::LatticePoint& at) const;

  const igm::PreparedMap& map_;
  std::span<const std::uint8_t> valid_;
  lattice::GridPoint low_{};
  std::vector<Piece> pieces_;
  std::array<double, 6> wallArea_{};  ///< the tets' boundary area in each wall: axis 0 low, high,
                                      ///< ...
};

/// Volume of the part of a positive tet inside [0, 1]^3.
[[nodiscard]] double volumeInCube(const std::array<Vec3, 4>& tet);

/// The part of a triangle inside [0, 1]^3.
struct ClippedTriangle {
  double area = 0;
  Vec3 centre{};  ///< if the area is nonzero
};
[[nodiscard]] ClippedTriangle clipToCube(const std::array<Vec3, 3>& triangle);

}  // namespace hexhex::repairs
