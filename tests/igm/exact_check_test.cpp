// The check against the definition of an integer-grid map, in exact integers.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include "extract/support.hpp"
#include "igm/igm.hpp"
#include "support/damaged_maps.hpp"
#include "support/exact_findings.hpp"

namespace hexhex::test {

using namespace igm;

namespace {

constexpr double kTolerance = 1e-2;

/// The sanitized map, in doubles, which hold it exactly.
TetMap sanitized(const PreparedMap& prepared, const TetMap& given) {
  TetMap map = given;
  map.tets.assign(prepared.topology.tets.begin(), prepared.topology.tets.end());
  const auto unit = static_cast<double>(prepared.exact.unit);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        map.parameters[t][c][k] = static_cast<double>(prepared.exact.corners[t][c][k]) / unit;
      }
    }
  }
  return map;
}

/// How far sanitization moved a corner, where charts may have moved by integers.
double displacement(const TetMap& before, const TetMap& after) {
  double largest = 0;
  for (std::size_t t = 0; t < before.tets.size(); ++t) {
    const Vec3& first = before.parameters[t][0];
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double chart = std::round(first[k] - after.parameters[t][0][k]);
        const double moved = before.parameters[t][c][k] - chart - after.parameters[t][c][k];
        largest = std::max(largest, std::abs(moved));
      }
    }
  }
  return largest;
}

/// Whatever passes the check is within the tolerance of a map that fulfils all conditions exactly.
void expectExactlyValid(const TetMap& map) {
  Context context;
  DefectCollector defects;
  const PreparedMap prepared = prepareMap(map, kTolerance, 1, context, defects);
  ASSERT_TRUE(defects.empty());
  const TetMap exact = sanitized(prepared, map);
  const ExactFindings found = exactFindings(exact, 0);
  EXPECT_EQ(found.worst(), 0);
  EXPECT_EQ(found.flipped, 0U);
  EXPECT_EQ(found.oddAngles, 0U);
  if (prepared.input.mirrored || prepared.input.cornersReversed) return;
  EXPECT_NEAR(displacement(map, exact), prepared.exact.maxDisplacement, 1e-12);
  EXPECT_LE(prepared.exact.maxDisplacement, kTolerance);
}

/// Verdicts agree where the definition leaves no choice: within half the tolerance of all
/// conditions, and without tets that are thinner than it, a map is valid; twice the tolerance off
/// one of them, it is not.
/// @return whether the definition leaves a choice
bool expectTheSameVerdict(const TetMap& map, const CheckReport& report) {
  const ExactFindings found = exactFindings(map, kTolerance);
  const bool mustPass = found.worst() <= kTolerance / 2 && found.flipped == 0 && found.thin == 0;
  const bool mustFail = found.worst() > 2 * kTolerance || found.flipped > found.thin;
  if (mustPass) {
    EXPECT_TRUE(report.valid()) << name(report.defects[0].code);
  }
  if (mustFail) {
    EXPECT_FALSE(report.valid()) << found.transition << ' ' << found.boundary << ' '
                                 << found.singularity << ' ' << found.flipped;
  }
  return !mustPass && !mustFail;
}

TEST(ExactCheck, AgreesWithTheDefinitionOnDamagedMaps) {
  int valid = 0;
  int undecided = 0;
  const int count = cases(300);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    MapDamage damage(static_cast<std::uint64_t>(i));
    TetMap map = damage.sample();
    if (damage.below(8) != 0) damage.apply(map);
    const CheckReport report = check(map);
    undecided += expectTheSameVerdict(map, report) ? 1 : 0;
    if (!report.valid()) continue;
    ++valid;
    expectExactlyValid(map);
    verifiedExtraction(map);
  }
  if (count < 100) return;
  EXPECT_GT(valid, count / 10);
  EXPECT_LT(valid, count / 2);
  EXPECT_LT(undecided, count / 5);
  RecordProperty("undecided", undecided);
}

}  // namespace

}  // namespace hexhex::test
