// Tet meshes whose boundary triangles say by labels which way they are to face in a polycube.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/quantize.hpp>

#include <igm/input.hpp>
#include <lattice/direction.hpp>

namespace hexhex::quantization {

/// A tet mesh with labels, positive in space.
struct LabelledMesh {
  igm::OrientedMap input;           ///< without parameters
  adjacency::TetTopology topology;  ///< with stars
  std::vector<std::int8_t> flags;   ///< per half-face

  [[nodiscard]] const Vec3& point(Index tet, int corner) const {
    return input.view.points[topology.tets[tet][static_cast<std::size_t>(corner)]];
  }
  [[nodiscard]] bool isLabelled(adjacency::HalfFace h) const { return flags[h] >= 0; }
  /// Of a half-face that has one.
  [[nodiscard]] lattice::Direction label(adjacency::HalfFace h) const {
    return static_cast<lattice::Direction>(flags[h]);
  }
  /// In the caller's terms.
  [[nodiscard]] Place placeOf(adjacency::HalfFace h) const {
    return {PlaceKind::Face, adjacency::tetOf(h),
            static_cast<std::uint64_t>(input.callersCorner(adjacency::localOf(h)))};
  }
};

/// Without labels.
/// @throws Error for broken meshes, and FlippedTet for tets that are not positive in space
[[nodiscard]] LabelledMesh readUnlabelled(const TetMesh& tets, Stage& stage);

/// @throws Error as mapFromFlags() does, for what can be told of one tet or triangle at a time
[[nodiscard]] LabelledMesh readLabels(const TetMesh& tets, std::span<const FaceFlags> flags,
                                      Stage& stage);

/// @throws Error InvalidArgument at a half-face
[[noreturn]] void refuseFlag(const LabelledMesh& mesh, adjacency::HalfFace h,
                             const std::string& sentence);

}  // namespace hexhex::quantization
