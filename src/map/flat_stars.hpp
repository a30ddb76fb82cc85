// Stars that are as good as plain ones, but for charts that differ.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <map/local_parameters.hpp>
#include <map/plain_vertices.hpp>
#include <map/transitions.hpp>
#include <map/vertex_star.hpp>

namespace hexhex {

/// Tells flat stars from others. A star is flat if its tets, brought into one chart by exact
/// transitions, are those of a plain vertex (plain_vertices.hpp): the transitions carry the
/// parameters of common corners over without rounding, all ways through the star lead to the same
/// chart, and the boundary is in one axis-parallel plane through the vertex. All that is said of
/// plain vertices then holds. Brought into that chart is only the direction to be covered once: by
/// rotations, which is exact. Rounding to the lattice commutes with exact transitions, hence
/// corners may be rounded each in its own chart.
class FlatStarTest {
 public:
  FlatStarTest(const LocalParameters& parameters, const PlainVertices& plain,
               const Transitions& transitions)
      : parameters_(parameters), plain_(plain), transitions_(transitions) {}

  /// A star where rounding could matter is not called flat.
  [[nodiscard]] bool run(std::span<const VertexStar::Member> star);

  // After a star was found flat:

  /// Whether the vertex is on the boundary.
  [[nodiscard]] bool onBoundary() const noexcept { return plane_ != 0; }
  /// The axis across which the boundary plane is in the chart of a member.
  [[nodiscard]] std::size_t axis(std::size_t member) const noexcept;

 private:
  bool unfold(std::span<const VertexStar::Member> star);
  bool addBoundary(HalfFace halfFace, std::size_t i);
  [[nodiscard]] bool isBetweenPlanes(CornerIndex corner) const;
  [[nodiscard]] bool coversDirectionOnce(std::span<const VertexStar::Member> star) const;

  const LocalParameters& parameters_;
  const PlainVertices& plain_;
  const Transitions& transitions_;
  std::vector<Rotation> rotations_;  ///< per member: from the first one's chart
  unsigned plane_ = 0;               ///< bit k: across axis k of the first one's chart
};

}  // namespace hexhex
