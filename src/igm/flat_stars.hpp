// Stars that are as good as plain ones, but for charts that differ.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <igm/local_parameters.hpp>
#include <igm/plain_vertices.hpp>
#include <igm/vertex_star.hpp>

namespace hexhex {

/// Whether a coordinate is halfway between two integers. The plane across its axis to snap to then
/// depends on the chart.
[[nodiscard]] inline bool isBetweenPlanes(double x) noexcept {
  return std::abs(x - std::nearbyint(x)) == 0.5;
}

/// Tells flat stars from others. A star is flat if its tets, brought into one chart by exact
/// transitions, are those of a plain vertex (plain_vertices.hpp): the transitions carry the
/// parameters of common corners over without rounding, all ways through the star lead to the same
/// chart, and the boundary is in one axis-parallel plane through the vertex. All that is said of
/// plain vertices then holds. Brought into that chart is only the direction to be covered once: by
/// rotations, which is exact. Rounding to the lattice commutes with exact transitions, hence
/// corners may be rounded each in its own chart.
class FlatStarTest {
 public:
  FlatStarTest(const TetTopology& topology, const LocalParameters& parameters,
               const PlainVertices& plain)
      : topology_(topology), parameters_(parameters), plain_(plain) {}

  /// Collects the star of a vertex, and tells whether it is flat. A star where rounding could
  /// matter is not called flat.
  /// @param vertex  not isolated
  [[nodiscard]] bool run(Index vertex, VertexStar& star);

  /// The planes of the boundary faces in the chart of the star's first member: bit k across axis k.
  [[nodiscard]] unsigned planes() const noexcept { return planes_; }

  // After a star was found flat:

  /// Whether the vertex is on the boundary.
  [[nodiscard]] bool onBoundary() const noexcept { return planes_ != 0; }
  /// The axis across which the boundary plane is in the chart of a member.
  [[nodiscard]] std::size_t axis(const VertexStar::Member& member) const noexcept;

 private:
  class Unfolding;

  /// The direction to be covered, or its mirror image, in the chart of a member.
  struct Ray {
    Index member;
    Index mirror;  ///< the axis, or kNotMirrored
  };

  [[nodiscard]] bool isBetweenPlanes(CornerIndex corner) const;
  [[nodiscard]] bool coversDirectionOnce(std::span<const VertexStar::Member> star);
  [[nodiscard]] std::size_t listRays(std::span<const VertexStar::Member> star);
  [[nodiscard]] std::span<const Ray> keepOpenRays(std::span<const VertexStar::Member> star);
  [[nodiscard]] std::size_t countCones(std::span<const VertexStar::Member> star, const Ray& first,
                                       const Ray& second, bool areTwo) const;

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  const PlainVertices& plain_;
  std::vector<Ray> rays_;
  std::size_t rayCount_ = 0;
  unsigned planes_ = 0;  ///< bit k: across axis k of the first one's chart
};

}  // namespace hexhex
