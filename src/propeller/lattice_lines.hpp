// The grid points of every closed tet, by line, with the hex vertex at each: the vertex at a grid
// point of a tet is found in constant time and without hashing, because the points of a tet come in
// planes of lines of consecutive points.
#pragma once

#include <cstdint>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <lattice/rasterize.hpp>

namespace hexhex {

struct LatticeLines {
  struct Sweep {
    std::int32_t firstPlane;  ///< coordinate along the first sweep axis
    SweepAxes axes;
  };
  struct Plane {
    std::int32_t firstLine;  ///< coordinate along the second sweep axis
    Index lineBegin;         ///< its lines; they end where those of the next plane begin
  };
  struct Line {
    std::int32_t firstPoint;  ///< coordinate along the third sweep axis
    Index pointBegin;         ///< its points; they end where those of the next line begin
    CornerMask left;          ///< simplex of the first point,
    CornerMask inner;         ///< of those between,
    CornerMask right;         ///< of the last
  };

  Array<Sweep> sweeps;      ///< per tet
  Array<Index> planeBegin;  ///< per tet (+1)
  Array<Plane> planes;      ///< (+1)
  Array<Line> lines;        ///< (+1)
  Array<Index> vertices;    ///< per point: the hex vertex

  [[nodiscard]] bool empty(Index tet) const noexcept {
    return planeBegin[tet] == planeBegin[tet + 1];
  }

  /// The first point of a tet in `vertices`; also of the tet behind the last.
  [[nodiscard]] Index pointBegin(std::size_t tet) const noexcept {
    return lines[planes[planeBegin[tet]].lineBegin].pointBegin;
  }

  /// Where the grid point is in these arrays.
  struct Place {
    Index line = kNone;  ///< kNone if the closed tet does not contain the point
    Index point = kNone;
  };
  [[nodiscard]] Place locate(Index tet, const GridPoint& z) const noexcept {
    const Index begin = planeBegin[tet];
    const Index count = planeBegin[tet + 1] - begin;
    if (count == 0) return {};
    const Sweep& sweep = sweeps[tet];
    const std::array<std::uint8_t, 3>& axes = sweep.axes();
    const auto plane = static_cast<std::uint32_t>(z[axes[0]] - sweep.firstPlane);
    if (plane >= count) return {};
    const Plane& p = planes[begin + plane];
    const auto line = static_cast<std::uint32_t>(z[axes[1]] - p.firstLine);
    if (line >= planes[begin + plane + 1].lineBegin - p.lineBegin) return {};
    const Line& l = lines[p.lineBegin + line];
    const auto point = static_cast<std::uint32_t>(z[axes[2]] - l.firstPoint);
    if (point >= lines[p.lineBegin + line + 1].pointBegin - l.pointBegin) return {};
    return {p.lineBegin + line, l.pointBegin + point};
  }
  /// The simplex that holds the point at a place.
  [[nodiscard]] CornerMask simplexAt(const Place& place) const noexcept {
    const Line& line = lines[place.line];
    if (place.point == line.pointBegin) return line.left;
    return place.point + 1 == lines[place.line + 1].pointBegin ? line.right : line.inner;
  }

  /// The hex vertex at a grid point in the chart of a tet, or kNone if the closed tet does not
  /// contain it.
  [[nodiscard]] Index find(Index tet, const GridPoint& z) const noexcept {
    const Place place = locate(tet, z);
    return place.line == kNone ? kNone : vertices[place.point];
  }

  /// Calls visit(z, simplex, index in `vertices`) for every grid point of a closed tet, in the
  /// order of its sweep.
  template <class Visit>
  void forEachPoint(Index tet, const Visit& visit) const {
    const std::array<std::uint8_t, 3>& axes = sweeps[tet].axes();
    GridPoint z{};
    z[axes[0]] = sweeps[tet].firstPlane;
    for (Index p = planeBegin[tet]; p < planeBegin[tet + 1]; ++p, ++z[axes[0]]) {
      z[axes[1]] = planes[p].firstLine;
      for (Index l = planes[p].lineBegin; l < planes[p + 1].lineBegin; ++l, ++z[axes[1]]) {
        const Line& line = lines[l];
        const Index end = lines[l + 1].pointBegin;
        z[axes[2]] = line.firstPoint;
        for (Index i = line.pointBegin; i < end; ++i, ++z[axes[2]]) {
          visit(std::as_const(z),
                i == line.pointBegin ? line.left : (i + 1 == end ? line.right : line.inner), i);
        }
      }
    }
  }
};

}  // namespace hexhex
