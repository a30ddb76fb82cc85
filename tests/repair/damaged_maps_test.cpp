// What holds of every map, whatever is wrong with it.
#include "support/damaged_maps.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "repair/moved_vertices.hpp"
#include "repair/same_connectivity.hpp"

namespace hexhex::test {

namespace {

/// What random damage has led to.
struct Outcomes {
  int valid = 0;
  int repaired = 0;
  int refused = 0;
};

/// Errors that say what is wrong with a map; all others would be about something else.
bool isAboutTheMap(ErrorCode code) {
  return (code >= ErrorCode::NonManifoldFace && code <= ErrorCode::HalfIntegerFixedPoint) ||
         code == ErrorCode::AmbiguousMesh;
}

/// Extraction names one of the defects that the check has found.
void expectTheSameRefusal(const TetMap& map, const CheckReport& report) {
  try {
    static_cast<void>(extract(map));
    ADD_FAILURE() << "extracted, though " << name(report.defects[0].code);
  } catch (const Error& error) {
    EXPECT_TRUE(isAboutTheMap(error.code())) << error.what();
    EXPECT_TRUE(std::any_of(report.defects.begin(), report.defects.end(),
                            [&](const Defect& defect) { return defect.code == error.code(); }))
        << error.what();
  }
}

/// Repaired maps pass what valid ones do; where a map cannot be repaired, it says so.
/// @param sound  what the map was, if its charts still fit: then its repair has the same mesh
void expectValidIfRepaired(const TetMap& map, const TetMap* sound, Outcomes& outcomes) {
  TetMap repaired;
  try {
    repaired = repair(map);
  } catch (const Error& error) {
    EXPECT_TRUE(isAboutTheMap(error.code())) << error.what();
    ++outcomes.refused;
    return;
  }
  ++outcomes.repaired;
  EXPECT_TRUE(check(repaired).valid());
  const HexMesh mesh = verifiedExtraction(repaired);
  if (sound != nullptr) {
    EXPECT_TRUE(sameConnectivity(mesh, extract(*sound)));
  }
}

/// What check, extract, verify and repair say of one map must not contradict each other.
void expectOneVerdict(const TetMap& map, const TetMap* sound, Outcomes& outcomes) {
  const CheckReport report = check(map);
  if (report.valid()) {
    ++outcomes.valid;
    verifiedExtraction(map);
    if (canRepair()) {
      EXPECT_EQ(repair(map).parameters, map.parameters);
    }
    return;
  }
  expectTheSameRefusal(map, report);
  if (canRepair()) expectValidIfRepaired(map, sound, outcomes);
}

TEST(DamagedMaps, GetTheSameVerdictFromAllCommands) {
  Outcomes outcomes;
  const int count = cases(300);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    MapDamage damage(1'000'000 + static_cast<std::uint64_t>(i));
    TetMap map = damage.sample();
    damage.apply(map);
    expectOneVerdict(map, nullptr, outcomes);
  }
  RecordProperty("valid", outcomes.valid);
  RecordProperty("repaired", outcomes.repaired);
  EXPECT_LT(outcomes.valid, count);
}

TEST(DamagedMaps, WithMovedVerticesGetTheSameVerdictFromAllCommands) {
  Outcomes outcomes;
  const int count = cases(300);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    MapDamage damage(2'000'000 + static_cast<std::uint64_t>(i));
    const TetMap sound = damage.sample();
    TetMap map = sound;
    VertexMover mover(sound);
    for (int moves = 1 + damage.below(4); moves > 0; --moves) {
      const auto vertex = static_cast<Index>(damage.below(mover.vertexCount()));
      const double far = std::ldexp(1.0, damage.below(4) - 2);
      Vec3 by{};
      for (double& x : by) x = damage.below(2) * far * (damage.share() - 0.5);
      mover.move(map, vertex, by);
    }
    expectOneVerdict(map, &sound, outcomes);
  }
  RecordProperty("valid", outcomes.valid);
  RecordProperty("repaired", outcomes.repaired);
  RecordProperty("refused", outcomes.refused);
  if (count < 100 || !canRepair()) return;
  EXPECT_GT(outcomes.valid, count / 20);
  EXPECT_GT(outcomes.repaired, count / 20);
  EXPECT_GT(outcomes.refused, count / 20);
}

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
