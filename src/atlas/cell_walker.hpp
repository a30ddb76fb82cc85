// From the centre of a cell straight to all its corners at once, tet by tet, in floating point with
// proven bounds and exact signs where these do not suffice.
//
// The corners go in groups: those that are in the same tet have arrived, those outside of just one
// of its faces leave through that face, as the way from the centre starts inside; only for corners
// outside of several faces it has to be found out which of them comes first. Ways through edges and
// vertices of the tet mesh, where that has no answer, are left to CellTracer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <atlas/charts.hpp>
#include <igm/prepare.hpp>
#include <lattice/cell_corners.hpp>

namespace hexhex {

/// Walks to the corners of cells. One per thread.
class CellWalker {
 public:
  CellWalker(const PreparedMap& map, const Charts& charts);

  /// A tet on the way.
  struct Stop {
    Index tet;
    bool inSight;      ///< in the first tet's chart of the atlas, with no cut on the way
    Transition toTet;  ///< from the first tet's own chart
  };

  /// Walks from the centre of the cell whose smallest corner is z, in the chart of a tet that
  /// contains that centre, to some of its corners. Calls visit(Stop, CellCornerSet) with those that
  /// are in the (closed) tet of the stop.
  /// @return the corners that it cannot tell
  template <class Visit>
  [[nodiscard]] CellCornerSet run(Index tet, const GridPoint& z, CellCornerSet corners,
                                  const Visit& visit) {
    CellCornerSet missed = 0;
    begin(tet, z, corners);
    while (!front_.empty()) {
      const Group group = front_.back();
      front_.pop_back();
      const Faces& faces = facesOf(group.stop.tet);
      const Sides sides = look(faces, group, z);
      const CellCornerSet arrived = group.corners & ~sides.anyFace();
      if (arrived != 0) visit(group.stop, arrived);
      if (arrived != group.corners) missed |= leave(faces, group, sides);
    }
    return missed;
  }

 private:
  using Vector = std::array<double, 3>;

  /// The faces of a tet as planes, in its own chart, in grid units: values are those of inward
  /// normals. Nothing is outside of a face on the boundary.
  struct Faces {
    std::array<std::array<double, 4>, 3> normal;  ///< by coordinate, then face
    std::array<double, 4> offset;                 ///< value at `origin`
    std::array<double, 4> extent;  ///< how far a cell's corners differ from its centre
    std::array<double, 3> origin;  ///< grid point near the tet
    double error;                  ///< of values, per unit of distance from the origin
    double reach;                  ///< largest coordinate of a corner, relative to the origin
  };

  /// Corners on their way into a tet.
  struct Group {
    Stop stop;
    unsigned entered;                    ///< face through which they come, as a bit; 0 for none
    CellCornerSet corners;               ///< in terms of the first tet's chart
    std::array<std::int64_t, 3> center;  ///< twice the cell's centre, in the tet's chart
  };

  /// How the corners of a cell lie to the faces of a tet.
  struct Sides {
    std::array<CellCornerSet, 4> outside{};
    std::array<double, 4> center;  ///< the planes' values
    double error;
    [[nodiscard]] CellCornerSet anyFace() const noexcept {
      return outside[0] | outside[1] | outside[2] | outside[3];
    }
  };

  void begin(Index tet, const GridPoint& z, CellCornerSet corners);
  [[nodiscard]] const Faces& facesOf(Index tet) noexcept;
  void measure(Index tet, Faces& faces) const noexcept;
  [[nodiscard]] Sides look(const Faces& faces, const Group& group, const GridPoint& z) const;
  [[nodiscard]] CellCornerSet signsOfUnsure(const Stop& stop, std::size_t face, const GridPoint& z,
                                            CellCornerSet unsure) const;
  [[nodiscard]] static Vector normalFor(const Faces& faces, const Group& group,
                                        std::size_t face) noexcept;
  [[nodiscard]] CellCornerSet leave(const Faces& faces, const Group& group, const Sides& sides);
  [[nodiscard]] static int firstExit(const Faces& faces, const Group& group, const Sides& sides,
                                     std::size_t corner) noexcept;
  void cross(const Group& group, std::size_t face, CellCornerSet corners);

  const PreparedMap& map_;
  const Charts& charts_;
  double scale_;  ///< grid units per lattice unit

  // Ways of neighbouring cells pass the same tets: a table of tets and their faces, by number.
  std::vector<Index> tetAt_;
  Array<Faces> faces_;

  std::vector<Group> front_;
  std::size_t stepsLeft_ = 0;
};

}  // namespace hexhex
