// What an extraction says where a repair would help, but is not wanted or not possible.
#include <string>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

TetMap damaged() {
  SampleOptions options;
  options.refine = 3;
  options.defects = 4;
  return generateSample(SampleKind::Sphere, options).map;
}

Error errorOfExtraction(RepairedMap* repaired) {
  return errorOf([&] { static_cast<void>(extract(damaged(), {.repair = repaired})); });
}

TEST(RepairOption, NoneLeavesFlippedTetsAnError) {
  const Error error = errorOfExtraction(nullptr);
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet) << error.what();
  EXPECT_EQ(std::string(error.what()).find("Eigen"), std::string::npos) << error.what();
}

/// CI builds once without the solver, for the thread sanitizer.
TEST(RepairOption, SaysWhatIsMissingInABuildWithoutSolver) {
  if (canRepair()) GTEST_SKIP() << "skipped: built with Eigen";
  RepairedMap repaired;
  const Error fromExtraction = errorOfExtraction(&repaired);
  EXPECT_EQ(fromExtraction.code(), ErrorCode::FlippedTet) << fromExtraction.what();
  EXPECT_EQ(fromExtraction.place().kind, PlaceKind::Tet);
  EXPECT_NE(std::string(fromExtraction.what()).find("libeigen3-dev"), std::string::npos)
      << fromExtraction.what();
  EXPECT_EQ(codeOf([&] { static_cast<void>(repair(damaged())); }), ErrorCode::FlippedTet);
  // Neither valid maps nor partial extraction need the solver.
  const TetMap sound = generateSample(SampleKind::Sphere).map;
  EXPECT_EQ(repair(sound).parameters, sound.parameters);
  Context context(1);
  EXPECT_FALSE(extractPartial(damaged(), {}, context).mesh.cells.empty());
}

}  // namespace

}  // namespace hexhex::test
