// Which of two meshes is kept, and which errors end both ways: with ways that are made up here.
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <pipeline/best_way.hpp>

#include "support/error_of.hpp"

namespace hexhex::test {
namespace {

using pipeline::bestOfBothWays;
using pipeline::isOfTheWay;
using pipeline::Refusal;

struct Figures {
  double minimum = 0.5;
  double distance = 0;
  double curvesFollowed = 1;
  std::uint64_t notPositive = 0;
};

MeshedPart partOf(ShapeMethod method, const Figures& figures) {
  MeshedPart part;
  part.shape.method = method;
  Certificate& after = part.improvement.after;
  after.refuted = figures.notPositive;
  after.quality.minimum = figures.minimum;
  part.improvement.distanceAfter.fromMesh = figures.distance;
  part.improvement.curvesFollowed = figures.curvesFollowed;
  return part;
}

/// Both orders of running give the same mesh, with the same words.
MeshedPart bestOf(const Figures& polycube, const Figures& frames) {
  const pipeline::Way way = [&](ShapeMethod method, Context& /*context*/) {
    return partOf(method, method == ShapeMethod::Frames ? frames : polycube);
  };
  Context one(1);
  Context two(2);
  MeshedPart part = bestOfBothWays(way, true, one);
  const MeshedPart same = bestOfBothWays(way, true, two);
  EXPECT_EQ(part.shape.method, same.shape.method);
  EXPECT_EQ(part.whyThisWay, same.whyThisWay);
  return part;
}

ShapeMethod keptOf(const Figures& polycube, const Figures& frames) {
  return bestOf(polycube, frames).shape.method;
}

TEST(BestWay, IsJudgedByCertificateMinimumDistanceAndCurves) {
  EXPECT_EQ(keptOf({.minimum = 0.1}, {.minimum = 0.2}), ShapeMethod::Frames);
  EXPECT_EQ(keptOf({.minimum = 0.2}, {.minimum = 0.1}), ShapeMethod::Polycube);
  EXPECT_EQ(keptOf({.minimum = 0.2}, {.minimum = 0.4, .notPositive = 1}), ShapeMethod::Polycube);
  EXPECT_EQ(keptOf({.minimum = 0.2, .notPositive = 1}, {.minimum = 0.1}), ShapeMethod::Frames);
  EXPECT_EQ(keptOf({.distance = 8e-3}, {.distance = 2e-3}), ShapeMethod::Frames);
  EXPECT_EQ(keptOf({.curvesFollowed = 0.5}, {.curvesFollowed = 0.9}), ShapeMethod::Frames);
  // Above 0.3, a minimum needs no better.
  EXPECT_EQ(keptOf({.minimum = 0.35, .distance = 2e-3}, {.minimum = 0.9, .distance = 3e-3}),
            ShapeMethod::Polycube);
}

TEST(BestWay, NeedsNoOtherThanAPolycubeThatIsGood) {
  for (const int threads : {1, 2}) {
    Context context(threads);
    const MeshedPart part = bestOfBothWays(
        [&](ShapeMethod method, Context& own) {
          while (method == ShapeMethod::Frames) own.throwIfCancelled();  // for ever
          return partOf(method, {});
        },
        true, context);
    EXPECT_EQ(part.shape.method, ShapeMethod::Polycube);
    ASSERT_EQ(part.ways.size(), 2U);
    EXPECT_TRUE(part.ways[0].hasMesh);
    EXPECT_FALSE(part.ways[1].hasMesh);
    EXPECT_EQ(part.ways[1].refusal, "");
    EXPECT_NE(part.whyThisWay.find("no other way was needed"), std::string::npos);
  }
}

/// What each code means for the other way: before there is a map, and once there is one.
TEST(BestWay, KnowsWhichErrorsBelongToOneWay) {
  const std::map<ErrorCode, std::pair<bool, bool>> expected = {
      {ErrorCode::InvalidArgument, {false, false}},
      {ErrorCode::FileNotFound, {false, false}},
      {ErrorCode::FileSyntax, {false, false}},
      {ErrorCode::FileUnsupported, {false, false}},
      {ErrorCode::FileWrite, {false, false}},
      {ErrorCode::EmptyMesh, {false, true}},
      {ErrorCode::IndexOutOfRange, {false, false}},
      {ErrorCode::RepeatedVertex, {false, false}},
      {ErrorCode::NotFinite, {false, false}},
      {ErrorCode::NonManifoldFace, {false, true}},
      {ErrorCode::NonManifoldEdge, {false, true}},
      {ErrorCode::NonManifoldVertex, {false, true}},
      {ErrorCode::Orientation, {false, true}},
      {ErrorCode::TransitionResidual, {false, true}},
      {ErrorCode::BoundaryOffLattice, {false, true}},
      {ErrorCode::SingularityOffLattice, {false, true}},
      {ErrorCode::FlippedTet, {false, true}},
      {ErrorCode::HalfIntegerFixedPoint, {false, true}},
      {ErrorCode::TooLarge, {false, true}},
      {ErrorCode::Cancelled, {false, false}},
      {ErrorCode::OutOfMemory, {false, false}},
      {ErrorCode::VerificationFailed, {false, false}},
      {ErrorCode::Internal, {false, false}},
      {ErrorCode::AmbiguousMesh, {false, true}},
      {ErrorCode::NotMeshable, {true, true}}};
  EXPECT_EQ(expected.size(), static_cast<std::size_t>(ErrorCode::NotMeshable) + 1);
  for (const auto& [code, ofTheWay] : expected) {
    EXPECT_EQ(isOfTheWay(code, false), ofTheWay.first) << name(code);
    EXPECT_EQ(isOfTheWay(code, true), ofTheWay.second) << name(code);
  }
}

TEST(BestWay, IsTheOtherOneWhereOneRefuses) {
  for (const ShapeMethod refusing : {ShapeMethod::Frames, ShapeMethod::Polycube}) {
    Context context;
    const MeshedPart part = bestOfBothWays(
        [&](ShapeMethod method, Context& /*own*/) {
          if (method == refusing) {
            throw Refusal({ErrorCode::HalfIntegerFixedPoint, "They leave no position."});
          }
          return partOf(method, {.minimum = 0.01});
        },
        true, context);
    EXPECT_NE(part.shape.method, refusing);
    EXPECT_EQ(part.whyThisWay, "the only way with a mesh");
    const WayReport& other = part.ways[refusing == ShapeMethod::Polycube ? 0 : 1];
    EXPECT_EQ(other.refusal, "They leave no position.");
  }
}

/// Maps without a mesh are followed by others; the first of their reasons counts.
TEST(BestWay, TriesOtherMapsWhereOneHasNoMesh) {
  const auto mapWithMesh = [](std::uint64_t firstWithMesh, std::uint64_t mostMaps, bool hasMap) {
    return pipeline::firstMesh(
               [&](std::uint64_t map) -> MeshedPart {
                 if (map < firstWithMesh) {
                   throw Refusal(
                       {ErrorCode::FlippedTet, "There is no mesh of map " + std::to_string(map)},
                       hasMap);
                 }
                 MeshedPart part;
                 part.shape.labelMoves = map;
                 return part;
               },
               mostMaps)
        .shape.labelMoves;
  };
  EXPECT_EQ(mapWithMesh(0, 3, true), 0U);
  EXPECT_EQ(mapWithMesh(2, 3, true), 2U);
  const auto reasonOf = [&](std::uint64_t mostMaps, bool hasMap) {
    return std::string(
        errorOf([&] { static_cast<void>(mapWithMesh(mostMaps, mostMaps, hasMap)); }).what());
  };
  EXPECT_EQ(reasonOf(3, true), "There is no mesh of map 0");
  EXPECT_EQ(reasonOf(1, true), "There is no mesh of map 0");
  // Without a map, nothing is known about others.
  EXPECT_THROW(static_cast<void>(mapWithMesh(1, 3, false)), Refusal);
}

/// @param ofFrames  the code of their refusal
Error refusalOfBoth(ErrorCode ofFrames) {
  Context context;
  return errorOf([&] {
    static_cast<void>(bestOfBothWays(
        [&](ShapeMethod method, Context& /*own*/) -> MeshedPart {
          if (method == ShapeMethod::Frames) {
            throw Refusal({ofFrames, "A curve ends.", {PlaceKind::Vertex, 3}});
          }
          throw Refusal({ErrorCode::FlippedTet, "A corner is bad.", {PlaceKind::Tet, 7}});
        },
        true, context));
  });
}

TEST(BestWay, SaysBothReasonsIfThereIsNone) {
  const Error error = refusalOfBoth(ErrorCode::NotMeshable);
  EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
  EXPECT_NE(std::string(error.what()).find("A curve ends."), std::string::npos);
  EXPECT_NE(std::string(error.what()).find("A corner is bad."), std::string::npos);
  // Places of other codes are in maps, not in the part.
  EXPECT_EQ(toString(error.place()), "vertex 3");
  EXPECT_EQ(refusalOfBoth(ErrorCode::TransitionResidual).place().kind, PlaceKind::None);
}

TEST(BestWay, EndsWithWhatIsNoRefusal) {
  for (const ErrorCode code :
       {ErrorCode::OutOfMemory, ErrorCode::VerificationFailed, ErrorCode::FlippedTet}) {
    for (const int threads : {1, 2}) {
      Context context(threads);
      EXPECT_EQ(codeOf([&] {
                  static_cast<void>(bestOfBothWays(
                      [&](ShapeMethod method, Context& /*own*/) {
                        if (method == ShapeMethod::Frames) {
                          throw Error(code, "This is not about one way.");
                        }
                        return partOf(method, {.minimum = 0.01});
                      },
                      true, context));
                }),
                code);
    }
  }
}

TEST(BestWay, EndsWhenTheCallerAsks) {
  for (const int threads : {1, 2}) {
    Context* caller = nullptr;
    Context context(threads,
                    [&](std::string_view /*stage*/, double /*share*/) { caller->cancel(); });
    caller = &context;
    EXPECT_EQ(codeOf([&] {
                static_cast<void>(bestOfBothWays(
                    [](ShapeMethod /*method*/, Context& own) -> MeshedPart {
                      while (true) {
                        own.report("waiting", 0.5);
                        own.throwIfCancelled();
                      }
                    },
                    true, context));
              }),
              ErrorCode::Cancelled);
  }
}

}  // namespace
}  // namespace hexhex::test
