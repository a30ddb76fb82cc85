// Damage that repair is made for: vertices that are somewhere else in the map, in all charts at
// once, so that tets at them are flipped but everything still fits together.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "igm/igm.hpp"
#include "igm/vertex_star.hpp"

namespace hexhex::test {

class VertexMover {
 public:
  /// @param map  valid; must outlive this object, and may be damaged meanwhile
  explicit VertexMover(const TetMap& map) : sound_(map) {
    Context context;
    igm::DefectCollector defects;
    prepared_ = igm::prepareMap(sound_, 1e-2, 1, context, defects);
    EXPECT_TRUE(defects.empty());
  }

  [[nodiscard]] std::size_t vertexCount() const { return prepared_.topology.pointCount; }

  /// @param by  in the chart of the vertex's smallest tet
  void move(TetMap& map, Index vertex, const Vec3& by) {
    igm::VertexStar star;
    star.collect(prepared_.topology, vertex);
    std::vector<lattice::Rotation> rotations(star.members().size());
    std::size_t reached = 1;
    for (std::size_t i = 0; i < star.members().size(); ++i) {
      const igm::VertexStar::Member& member = star.members()[i];
      for (std::size_t k = 0; k < 3; ++k) {
        if (member.neighbour[k] != reached) continue;
        const lattice::Transition& across = prepared_.exact.transitions.across(member.halfFace(k));
        rotations[reached++] = across.rotation * rotations[i];
      }
      Vec3& u = map.parameters[member.tet()][member.corner % 4];
      const Vec3 turned = rotations[i](by);
      for (std::size_t k = 0; k < 3; ++k) u[k] += turned[k];
    }
  }

 private:
  TetMap sound_;
  igm::PreparedMap prepared_;
};

}  // namespace hexhex::test
