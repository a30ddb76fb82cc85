// What progress functions are told by every long function of the library.
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

namespace hexhex {
namespace {

struct NamedCall {
  std::string name;
  std::function<void(Context&)> run;
};

class Calls {
 public:
  Calls() {
    SampleOptions options;
    options.charts = ChartStyle::Random;
    map_ = generateSample(SampleKind::Sphere, options).map;
    mesh_ = extract(map_, {});
    Context context;
    lagrange_ = extractLagrange(map_, 2, {}, context);
    parts_ = extractPiecewiseLinear(map_, PiecewiseLinearParts::ArcsAndPatches, {}, context);
    writeMap(map_, file("map.hexex"), context);
    writeHexMesh(mesh_, file("mesh.vtu"), context);
    writeLagrangeMesh(lagrange_, file("curved.vtu"), {}, context);
  }
  ~Calls() { std::filesystem::remove_all(folder_); }

  std::vector<NamedCall> all() {
    std::vector<NamedCall> calls = ofMaps();
    for (auto list : {ofMeshes(), ofFiles(), ofExtractors()}) {
      for (NamedCall& call : list) calls.push_back(std::move(call));
    }
    return calls;
  }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  std::vector<NamedCall> ofMaps() {
    ExtractOptions propeller;
    propeller.engine = Engine::Propeller;
    std::vector<NamedCall> calls = {
        {"check", [&](Context& c) { static_cast<void>(check(map_, {}, c)); }},
        {"findMapStructure",
         [&](Context& c) { static_cast<void>(findMapStructure(map_, 0.01, c)); }},
        {"extract", [&](Context& c) { static_cast<void>(extract(map_, {}, c)); }},
        {"extract by propellers",
         [=, this](Context& c) { static_cast<void>(extract(map_, propeller, c)); }},
        {"extractTo",
         [&](Context& c) {
           Context own;
           SummarySink sink(own);
           extractTo(sink, map_, {}, c);
         }},
        {"extractPartial", [&](Context& c) { static_cast<void>(extractPartial(map_, {}, c)); }},
        {"extractLagrange",
         [&](Context& c) { static_cast<void>(extractLagrange(map_, 2, {}, c)); }},
        {"extractPiecewiseLinear",
         [&](Context& c) {
           static_cast<void>(
               extractPiecewiseLinear(map_, PiecewiseLinearParts::ArcsAndPatches, {}, c));
         }},
        {"verify", [&](Context& c) { static_cast<void>(verify(map_, mesh_, {}, c)); }},
        {"VerifySink", [&](Context& c) { static_cast<void>(VerifySink(map_, {}, c)); }}};
    if (canRepair()) {
      calls.push_back({"repair", [&](Context& c) {
                         const TetMap bent = generateSample(SampleKind::Sphere, flipped()).map;
                         static_cast<void>(repair(bent, {}, c));
                       }});
    }
    if (canQuantize()) {
      QuantizeOptions options;
      options.cells = 500;
      calls.push_back(
          {"quantize", [=, this](Context& c) { static_cast<void>(quantize(map_, options, c)); }});
      calls.push_back(
          {"examineSeamless", [&](Context& c) { static_cast<void>(examineSeamless(map_, c)); }});
    }
    return calls;
  }

  static SampleOptions flipped() {
    SampleOptions options;
    options.defects = 2;
    return options;
  }

  std::vector<NamedCall> ofMeshes() {
    return {
        {"scaledJacobians", [&](Context& c) { static_cast<void>(scaledJacobians(mesh_, c)); }},
        {"certify", [&](Context& c) { static_cast<void>(certify(mesh_, c)); }},
        {"certify, curved", [&](Context& c) { static_cast<void>(certify(lagrange_, c)); }},
        {"boundaryPatches", [&](Context& c) { static_cast<void>(boundaryPatches(mesh_, 40, c)); }},
        {"namedPatches", [&](Context& c) { static_cast<void>(namedPatches(mesh_, 40, c)); }},
        {"findBaseComplex", [&](Context& c) { static_cast<void>(findBaseComplex(mesh_, c)); }},
        {"findStructure", [&](Context& c) { static_cast<void>(findStructure(mesh_, c)); }}};
  }

  std::vector<NamedCall> ofFiles() {
    return {
        {"readMap", [&](Context& c) { static_cast<void>(readMap(file("map.hexex"), c)); }},
        {"readHexMesh", [&](Context& c) { static_cast<void>(readHexMesh(file("mesh.vtu"), c)); }},
        {"readMapOrHexMesh",
         [&](Context& c) { static_cast<void>(readMapOrHexMesh(file("mesh.vtu"), {}, c)); }},
        {"summarizeFile",
         [&](Context& c) { static_cast<void>(summarizeFile(file("mesh.vtu"), c)); }},
        {"readMapPair",
         [&](Context& c) {
           static_cast<void>(readMapPair(file("map.hexex"), file("map.hexex"), c));
         }},
        {"readLagrangeMesh",
         [&](Context& c) { static_cast<void>(readLagrangeMesh(file("curved.vtu"), c)); }},
        {"writeMap", [&](Context& c) { writeMap(map_, file("map.vtu"), c); }},
        {"writeHexMesh", [&](Context& c) { writeHexMesh(mesh_, file("mesh.msh"), c); }},
        {"writeLagrangeMesh",
         [&](Context& c) { writeLagrangeMesh(lagrange_, file("curved.msh"), {}, c); }},
        {"writeArcs", [&](Context& c) { writeArcs(parts_, file("arcs.vtu"), c); }},
        {"writePatches", [&](Context& c) { writePatches(parts_, file("patches.vtu"), c); }}};
  }

  std::vector<NamedCall> ofExtractors() {
    return {{"Extractor", [&](Context& c) { Extractor(map_, {}, c); }},
            {"Extractor::extract",
             [&](Context& c) { static_cast<void>(Extractor(map_).extract({}, c)); }},
            {"Extractor::extractLagrange",
             [&](Context& c) { static_cast<void>(Extractor(map_).extractLagrange(2, {}, c)); }},
            {"Extractor::extractPiecewiseLinear", [&](Context& c) {
               static_cast<void>(
                   Extractor(map_).extractPiecewiseLinear(PiecewiseLinearParts::Arcs, {}, c));
             }}};
  }

  std::filesystem::path folder_ = ::testing::TempDir() + "hexhex_progress";
  bool made_ = std::filesystem::create_directories(folder_);
  TetMap map_;
  HexMesh mesh_;
  LagrangeMesh lagrange_;
  PiecewiseLinearMesh parts_;
};

TEST(Progress, OfEveryFunctionGoesFromZeroToOne) {
  Calls calls;
  for (const NamedCall& call : calls.all()) {
    SCOPED_TRACE(call.name);
    std::vector<double> shares;
    // Twice with one context: each call is a whole of its own.
    Context context(2, [&](std::string_view, double share) { shares.push_back(share); });
    for (int time = 0; time < 2; ++time) {
      shares.clear();
      call.run(context);
      ASSERT_GT(shares.size(), 1U);
      EXPECT_EQ(shares.front(), 0);
      EXPECT_EQ(shares.back(), 1);
      EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    }
  }
}

TEST(Progress, OfSeveralCallsIsOne) {
  const TetMap map = generateSample(SampleKind::Sphere).map;
  const std::array<WorkStep, 3> names = {{{"extract", 1}, {"verify", 2}, {"certify", 1}}};
  std::vector<double> shares;
  std::vector<double> ends;
  Context context(2, [&](std::string_view, double share) { shares.push_back(share); });
  WorkSteps steps(context, "all", names);
  const HexMesh mesh = extract(map, {}, context);
  ends.push_back(shares.back());
  static_cast<void>(verify(map, mesh, {}, context));
  ends.push_back(shares.back());
  static_cast<void>(certify(mesh, context));
  steps.finish();
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.front(), 0);
  EXPECT_LE(ends[0], 0.25);
  EXPECT_LE(ends[1], 0.75);
  EXPECT_GT(ends[1], 0.25);
  EXPECT_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace hexhex
