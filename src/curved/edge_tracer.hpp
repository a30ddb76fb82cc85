// A hex edge, traced from its midpoint both ways by exact arithmetic.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include <curved/arc_pieces.hpp>
#include <curved/arc_tracer.hpp>

namespace hexhex {

/// One per thread.
class EdgeTracer {
 public:
  /// @param pieces  receives points and segments
  EdgeTracer(const PreparedMap& map, const LatticeNumbers& vertices, ArcPieces& pieces)
      : map_(map), vertices_(vertices), pieces_(pieces), tracer_(map, vertices) {}

  /// Traces an edge, wherever its midpoint is.
  /// @param middle  the simplex that holds the midpoint, with the edge's frame
  /// @return the vertices at both ends
  [[nodiscard]] std::array<Index, 2> trace(const SimplexInTet& middle);

  /// Adds what there is from the beginning to the segment at the midpoint.
  /// @param follow  the way back, of a visitor
  /// @return the vertex at the beginning
  template <class Follow>
  [[nodiscard]] Index traceBack(const Follow& follow) {
    const std::size_t firstPoint = pieces_.points();
    const std::size_t firstSegment = pieces_.segments();
    const ArcEnd first = follow([&](const SimplexInTet& carrier, const ArcExit& exit) {
      addSegment(carrier);
      pieces_.addPoint(exit, 1 - exit.parameter);
    });
    addSegment(first.carrier);
    pieces_.reverseFrom(firstPoint, firstSegment);
    return first.vertex;
  }
  /// Adds what there is behind the segment at the midpoint.
  /// @return the vertex at the end
  template <class Follow>
  [[nodiscard]] Index traceAhead(const Follow& follow) {
    bool atMiddle = true;
    const ArcEnd last = follow([&](const SimplexInTet& carrier, const ArcExit& exit) {
      if (!atMiddle) addSegment(carrier);
      atMiddle = false;
      pieces_.addPoint(exit, exit.parameter);
    });
    if (!atMiddle) addSegment(last.carrier);
    return last.vertex;
  }

  [[nodiscard]] ArcTracer& tracer() noexcept { return tracer_; }
  [[nodiscard]] const ArcTracer& tracer() const noexcept { return tracer_; }

  /// Exact parameters are in (0, 1) and ascend; rounding may not change that.
  /// @param before  the parameter before, or kLeastParameter
  [[nodiscard]] static double smooth(double parameter, double before) noexcept {
    constexpr double kBelowOne = 1 - 0x1p-53;
    return std::clamp(parameter, before, kBelowOne);
  }
  static constexpr double kLeastParameter = std::numeric_limits<double>::min();
  /// The same for all points of an arc.
  static void smoothParameters(ArcPieces& pieces, std::size_t firstPoint) {
    double before = kLeastParameter;
    pieces.changeParameters(
        firstPoint, [&](double& parameter) { parameter = before = smooth(parameter, before); });
  }

 private:
  using Found = LatticeNumbers::Found;

  [[nodiscard]] std::array<Index, 2> traceBothWays(const SimplexInTet& middle, const Found& from,
                                                   const Found& to);
  [[nodiscard]] std::array<Index, 2> traceFromBoundary(const SimplexInTet& middle,
                                                       const Found& from);
  void addSegment(const SimplexInTet& carrier) {
    pieces_.addSegment(ownedBy(map_.topology, carrier.tet, carrier.simplex));
  }

  const PreparedMap& map_;
  const LatticeNumbers& vertices_;
  ArcPieces& pieces_;
  ArcTracer tracer_;
};

}  // namespace hexhex
