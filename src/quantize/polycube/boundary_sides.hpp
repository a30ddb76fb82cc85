// Half-edges of the boundary of a tet mesh.
#pragma once

#include <cstddef>
#include <vector>

#include <adjacency/tet_topology.hpp>

namespace hexhex::quantization {

/// 3 * triangle + local index, 0 to 2.
using BoundarySide = std::size_t;

/// The sides of boundary triangles, counterclockwise as seen from outside.
class BoundarySides {
 public:
  explicit BoundarySides(const adjacency::TetTopology& topology);

  [[nodiscard]] std::size_t size() const noexcept { return twins_.size(); }
  [[nodiscard]] adjacency::HalfFace face(BoundarySide side) const noexcept {
    return faces_[side / 3];
  }
  [[nodiscard]] Index head(BoundarySide side) const noexcept { return corner(side, 0); }
  [[nodiscard]] Index tail(BoundarySide side) const noexcept { return corner(side, 1); }
  /// The next side of the same triangle, which starts at the head.
  [[nodiscard]] static BoundarySide next(BoundarySide side) noexcept {
    return side / 3 * 3 + (side + 2) % 3;
  }
  /// The same edge as a side of the adjacent triangle, from head to tail.
  [[nodiscard]] BoundarySide twin(BoundarySide side) const noexcept { return twins_[side]; }

 private:
  [[nodiscard]] Index corner(BoundarySide side, std::size_t ahead) const noexcept;

  const adjacency::TetTopology& topology_;
  std::vector<adjacency::HalfFace> faces_;  ///< ascending
  std::vector<BoundarySide> twins_;
};

}  // namespace hexhex::quantization
