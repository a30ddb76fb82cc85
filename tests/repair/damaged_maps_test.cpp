// What holds of every map, whatever is wrong with it.
#include "support/damaged_maps.hpp"

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

TEST(DamagedMaps, HavePartialMeshes) {
  for (int i = 0; i < cases(200); ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    MapDamage damage(static_cast<std::uint64_t>(i));
    TetMap map = damage.sample();
    damage.apply(map);
    Context context;
    try {
      const PartialMesh partial = extractPartial(map, {1 + damage.below(2), 1e-2}, context);
      EXPECT_EQ(partial.faceConflicts, 0U);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace

}  // namespace hexhex::test
