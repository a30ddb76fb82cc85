// Tets with corners ordered so that volumes are positive.
#pragma once

#include <cstddef>
#include <vector>

#include <shape/surface.hpp>
#include <tetmap/cut.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

class PositiveTets {
 public:
  explicit PositiveTets(const TetMesh& given);

  [[nodiscard]] const TetMesh& mesh() const { return mesh_; }
  void turn(const Rotation& rotation) {
    for (Vec3& point : mesh_.points) point = turned(rotation, point);
  }
  /// Splits edges at their midpoints, the longest first. Tags are carried along.
  void split(std::vector<tetmap::EdgeInTet> edges, Stage& stage);
  /// Translates a place in these tets, unless they were split, to the given ones.
  [[nodiscard]] Place givenPlace(const Place& place) const {
    if (place.kind != PlaceKind::Face || !isSwapped_[place.index] || place.second < 2) return place;
    return {place.kind, place.index, 5 - place.second};
  }

 private:
  TetMesh mesh_;
  std::vector<bool> isSwapped_;
};

/// The boundary of a manifold of tets.
/// @throws Error FlippedTet for flat tets, Orientation for folded ones; those of broken meshes
[[nodiscard]] Surface readSurface(const PositiveTets& tets, Context& context);

}  // namespace hexhex::shape
