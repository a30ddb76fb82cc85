// Tet meshes with a label per boundary triangle: the direction that it is to face in a polycube.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/quantize.hpp>

#include <igm/input.hpp>
#include <lattice/direction.hpp>

namespace hexhex::quantization {

/// All tets have positive volume.
struct LabelledMesh {
  igm::OrientedMap input;           ///< without parameters
  adjacency::TetTopology topology;  ///< with stars
  std::vector<std::int8_t> flags;   ///< labels per half-face; -1 inside

  [[nodiscard]] const Vec3& point(Index tet, int corner) const {
    return input.view.points[topology.tets[tet][static_cast<std::size_t>(corner)]];
  }
  [[nodiscard]] bool isLabelled(adjacency::HalfFace h) const { return flags[h] >= 0; }
  /// @param h  must be labelled
  [[nodiscard]] lattice::Direction label(adjacency::HalfFace h) const {
    return static_cast<lattice::Direction>(flags[h]);
  }
  /// The place of a half-face in the caller's numbering of corners.
  [[nodiscard]] Place placeOf(adjacency::HalfFace h) const {
    return {PlaceKind::Face, adjacency::tetOf(h),
            static_cast<std::uint64_t>(input.callersCorner(adjacency::localOf(h)))};
  }
};

/// Reads a mesh without labels.
/// @throws Error for broken meshes, and FlippedTet for tets without positive volume
[[nodiscard]] LabelledMesh readUnlabelled(const TetMesh& tets, Stage& stage);

/// @throws Error as mapFromFlags() does for defects of a single tet or triangle
[[nodiscard]] LabelledMesh readLabels(const TetMesh& tets, std::span<const FaceFlags> flags,
                                      Stage& stage);

/// @throws Error InvalidArgument at a half-face
[[noreturn]] void refuseFlag(const LabelledMesh& mesh, adjacency::HalfFace h,
                             const std::string& sentence);

}  // namespace hexhex::quantization
