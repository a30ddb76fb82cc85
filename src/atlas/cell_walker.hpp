// From the centre of a cell straight to all its corners at once, tet by tet, in floating point with
// proven bounds and exact signs where these do not suffice.
//
// The corners go in groups: those that are in the same tet have arrived, those outside of just one
// of its faces leave through that face, as the way from the centre starts inside; only for corners
// outside of several faces it has to be found out which of them comes first. Ways through edges and
// vertices of the tet mesh, where that has no answer, are left to CellTracer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <atlas/charts.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A set of corners of a cell, in VTK order: bit i for corner i.
using CellCornerSet = unsigned;

/// Walks to the corners of cells whose centres are in the same tet. One per thread.
class CellWalker {
 public:
  CellWalker(const PreparedMap& map, const Charts& charts) noexcept : map_(map), charts_(charts) {}

  /// A tet on the way.
  struct Stop {
    Index tet;
    bool inSight;      ///< in the first tet's chart of the atlas, with no cut on the way
    Transition toTet;  ///< from the first tet's own chart
  };

  /// Chooses the tet whose cells come next.
  void enter(Index tet);

  /// Walks from the centre of the cell whose smallest corner is z, in the chart of the tet, which
  /// contains that centre. Calls visit(Stop, CellCornerSet) with the corners that are in the
  /// (closed) tet of the stop.
  /// @return the corners that it cannot tell
  template <class Visit>
  [[nodiscard]] CellCornerSet run(const GridPoint& z, const Visit& visit) {
    constexpr CellCornerSet kAll = 0xff;
    CellCornerSet missed = 0;
    front_.assign(1, {0, kAll});
    while (!front_.empty()) {
      const Group group = front_.back();
      front_.pop_back();
      const Sides sides = look(nodes_[group.node], z, group.corners);
      const CellCornerSet arrived = group.corners & ~sides.anyFace();
      if (arrived != 0) visit(std::as_const(nodes_[group.node].stop), arrived);
      if (arrived != group.corners) missed |= leave(group, sides);
    }
    return missed;
  }

 private:
  using Vector = std::array<double, 3>;
  static constexpr std::uint32_t kUnknown = ~std::uint32_t{0};

  /// A tet as seen from the first one: coordinates in that one's chart, in grid units, relative to
  /// `origin_`.
  struct Node {
    Stop stop;
    Transition fromTet;                 ///< inverse of stop.toTet
    int entered;                        ///< face through which the walk came, or -1
    std::array<std::uint32_t, 4> next;  ///< node behind each face
    std::array<Vector, 4> corners;
    std::array<Vector, 4> normals;  ///< of the faces, inward
    double error;                   ///< of plane values, per unit of distance from `origin_`
    double reach;                   ///< largest coordinate of a corner
  };

  /// How the corners of a cell lie to the faces of a node.
  struct Sides {
    std::array<CellCornerSet, 4> outside{};
    std::array<double, 4> center{};  ///< the planes' values
    double error = 0;
    [[nodiscard]] CellCornerSet anyFace() const noexcept {
      return outside[0] | outside[1] | outside[2] | outside[3];
    }
  };

  /// Corners on their way into a tet.
  struct Group {
    std::uint32_t node;
    CellCornerSet corners;
  };

  [[nodiscard]] Sides look(const Node& node, const GridPoint& z, CellCornerSet corners) const;
  [[nodiscard]] CellCornerSet signsOfUnsure(const Node& node, int face, const GridPoint& z,
                                            CellCornerSet unsure) const;
  [[nodiscard]] CellCornerSet leave(const Group& group, const Sides& sides);
  [[nodiscard]] static int firstExit(const Node& node, const Sides& sides, std::size_t corner);
  [[nodiscard]] std::uint32_t behind(std::uint32_t node, int face);
  [[nodiscard]] Vector relative(const Node& node, int corner) const noexcept;
  static void measure(Node& node) noexcept;

  const PreparedMap& map_;
  const Charts& charts_;
  GridPoint origin_{};       ///< near the first tet
  std::vector<Node> nodes_;  ///< a tree from the first tet on
  std::vector<Group> front_;
};

}  // namespace hexhex
