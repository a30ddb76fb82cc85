// Walks of hex edges through the interiors of faces, step by step against exact arithmetic.
#include <cmath>

#include <gtest/gtest.h>

#include <base/stage.hpp>
#include <curved/element_numbers.hpp>
#include <curved/face_walk.hpp>
#include <curved/intersections.hpp>
#include <curved/simplex_point.hpp>
#include <igm/defects.hpp>

#include "curved/curved_maps.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

/// What occurred: tests that miss a case say nothing.
struct Counts {
  int steps = 0;    ///< points of walks
  int refused = 0;  ///< tets that are not left through the interior of a face
};

class Walker {
 public:
  Walker(const igm::PreparedMap& map, Counts& counts) : map_(map), walk_(map), counts_(counts) {}

  /// Walks from a midpoint to the boundary or to where the walk ends, at most a few tets beyond the
  /// end of the edge.
  void walk(const SimplexInTet& middle, Heading heading) {
    SimplexInTet at = middle;
    const lattice::LatticeTet ahead = see(middle);
    if (heading == Heading::Backward) at.frame = middle.frame.reversed();
    bool walks = walk_.start(at, ahead, EdgeSides(ahead), heading);
    for (int i = 0; i < 6; ++i) {
      const lattice::LatticeTet seen = see(at);
      const SimplexPoint expected = exitPoint(seen, lattice::kWholeTet, 0);
      if (!walks) {
        ++counts_.refused;
        // After the start, refusals mean that the exit is no inner point of a face.
        if (i > 0) {
          ASSERT_NE(lattice::dimension(expected.simplex()), 2);
        }
        return;
      }
      ASSERT_EQ(lattice::dimension(expected.simplex()), 2);
      ASSERT_NO_FATAL_FAILURE(compare(at, seen, expected));
      const int face = lattice::oppositeCorner(expected.simplex());
      const adjacency::HalfFace mate = map_.topology.mate[adjacency::halfFaceOf(at.tet, face)];
      ASSERT_EQ(walk_.cross(at), mate != kNone);
      if (mate == kNone) return;
      ASSERT_EQ(at.tet, adjacency::tetOf(mate));
      walks = walk_.leave(at);
    }
  }

 private:
  [[nodiscard]] lattice::LatticeTet see(const SimplexInTet& at) const {
    return at.frame.see(map_.exact.corners[at.tet], map_.exact.unit);
  }

  void compare(const SimplexInTet& at, const lattice::LatticeTet& seen,
               const SimplexPoint& expected) {
    ++counts_.steps;
    const ArcExit exit = exitThrough(map_, at.tet, walk_.face(), at.frame.edge());
    const OwnedSimplex owned = ownedBy(map_.topology, at.tet, expected.simplex());
    ASSERT_EQ(exit.generator.tet, owned.tet);
    ASSERT_EQ(exit.generator.corners, owned.corners);
    const auto shares = expected.normalized();
    const double parameter = coordinate(shares, seen, 0) / static_cast<double>(map_.exact.unit);
    ASSERT_NEAR(exit.parameter, parameter, 1e-12);
    const Tet& tet = map_.topology.tets[at.tet];
    Vec3 point{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        point[k] += shares[i] * map_.input.view.points[tet[i]][k];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(exit.point[k], point[k], 1e-12);
  }

  const igm::PreparedMap& map_;
  FaceWalk walk_;
  Counts& counts_;
};

TEST(FaceWalk, GoesWhereExactArithmeticGoes) {
  Counts counts;
  for (const SampleOptions& options : curvedOptions()) {
    const TetMap map = generateSample(SampleKind::Sphere, options).map;
    Context context(1);
    igm::DefectCollector defects;
    const igm::PreparedMap prepared = igm::prepareMap(map, 1e-3, 1, context, defects);
    defects.throwIfAny();
    Stage stage(context, "numbers");
    const ElementNumbers edges(prepared, ElementKind::Edges, stage);
    Walker walker(prepared, counts);
    for (std::size_t t = 0; t < prepared.topology.tetCount(); ++t) {
      const auto tet = static_cast<Index>(t);
      edges.forEach(tet, [&](const Element& edge) {
        if (edge.simplex != lattice::kWholeTet) return;
        const SimplexInTet middle{tet, lattice::kWholeTet, Frame::along(edge.z, edge.axis)};
        for (const Heading heading : {Heading::Forward, Heading::Backward}) {
          walker.walk(middle, heading);
        }
      });
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(counts.steps, 1000);
  EXPECT_GT(counts.refused, 0);
}

}  // namespace
}  // namespace hexhex::test
