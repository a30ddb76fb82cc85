// Motions between charts of a seamless map, per half-face.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <lattice/grid_motion.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::quantization {

/// Stores distinct motions once: nearly all are the identity, and those across a piece of the cut
/// are equal.
class FaceMotions {
 public:
  explicit FaceMotions(std::size_t halfFaces = 0) : places_(halfFaces, 0) {}

  [[nodiscard]] const lattice::LatticeMotion& operator[](adjacency::HalfFace h) const noexcept {
    return distinct_[places_[h]];
  }
  void set(adjacency::HalfFace h, const lattice::LatticeMotion& motion) {
    const auto [found, isNew] = placeOf_.try_emplace({motion.rotation.index(), motion.translation},
                                                     static_cast<Index>(distinct_.size()));
    if (isNew) distinct_.push_back(motion);
    places_[h] = found->second;
  }
  /// Releases spare capacity.
  void shrink() { places_.shrink_to_fit(); }
  void appendCopyOf(adjacency::HalfFace h) { places_.push_back(Index{places_[h]}); }

 private:
  std::vector<Index> places_;  ///< index in `distinct_`, per half-face
  std::vector<lattice::LatticeMotion> distinct_ = {{}};
  std::map<std::pair<int, lattice::LatticePoint>, Index> placeOf_ = {{{0, {}}, 0}};
};

}  // namespace hexhex::quantization
