// What an extraction says where a repair would help, but is not wanted or not possible.
#include <string>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

namespace hexhex::test {

namespace {

TetMap damaged() {
  SampleOptions options;
  options.refine = 3;
  options.defects = 4;
  return generateSample(SampleKind::Sphere, options).map;
}

/// The error of an extraction.
Error errorOf(RepairMode mode) {
  ExtractOptions options;
  options.repair = mode;
  try {
    static_cast<void>(extract(damaged(), options));
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::Internal, "no error"};
}

TEST(RepairMode, OffLeavesFlippedTetsAnError) {
  const Error error = errorOf(RepairMode::Off);
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet) << error.what();
  EXPECT_EQ(std::string(error.what()).find("libLBFGS"), std::string::npos) << error.what();
}

/// CI builds once without the solver, for the thread sanitizer.
TEST(RepairMode, SaysWhatIsMissingInABuildWithoutSolver) {
  if (canRepair()) GTEST_SKIP() << "skipped: built with libLBFGS";
  const Error fromExtraction = errorOf(RepairMode::Auto);
  EXPECT_EQ(fromExtraction.code(), ErrorCode::FlippedTet) << fromExtraction.what();
  EXPECT_EQ(fromExtraction.place().kind, PlaceKind::Tet);
  EXPECT_NE(std::string(fromExtraction.what()).find("liblbfgs-dev"), std::string::npos)
      << fromExtraction.what();
  EXPECT_THROW(static_cast<void>(repair(damaged())), Error);
  // Neither valid maps nor partial extraction need the solver.
  const TetMap sound = generateSample(SampleKind::Sphere).map;
  EXPECT_EQ(repair(sound).parameters, sound.parameters);
  Context context(1);
  EXPECT_FALSE(extractPartial(damaged(), {}, context).mesh.cells.empty());
}

}  // namespace

}  // namespace hexhex::test
