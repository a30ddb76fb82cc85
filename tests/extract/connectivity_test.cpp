// The stages' own invariants: propellers, blades and corners form small spheres and disks;
// opposites are mutual; epsilon changes nothing.
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include <extract/steps.hpp>
#include <igm/measures.hpp>
#include <propeller/propeller.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// All stages of one map, kept.
struct Stages {
  Context context;
  igm::DefectCollector defects;
  igm::PreparedMap map;
  Array<lattice::NormalSigns> signs;
  std::optional<propeller::HexVertices> swept;
  propeller::LocalConnectivity local;
  propeller::GlobalConnectivity global;

  explicit Stages(const TetMapView& input, double epsilon = 1e-6) {
    map = igm::prepareMap(input, 1e-2, 1, context, defects);
    defects.throwIfAny();
    Stage stage(context, "test");
    adjacency::addStars(map.topology, stage);
    signs.resize(map.exact.corners.size());
    for (std::size_t t = 0; t < signs.size(); ++t)
      signs[t] = lattice::NormalSigns(map.exact.corners[t]);
    propeller::HexVertices& vertices = swept.emplace(map, epsilon, stage);
    local = propeller::extractLocalConnectivity(map, signs, vertices, stage);
    global = propeller::traceOpposites(map, signs, vertices, local, stage);
  }
  [[nodiscard]] const propeller::HexVertices& vertices() const { return *swept; }
};

Sample sampleOf(SampleKind kind) {
  SampleOptions o;
  o.cells = 4;
  o.refine = 3;
  o.charts = ChartStyle::Random;
  o.jitter = 0.5;
  o.onLattice = 0.5;
  return generateSample(kind, o);
}

class Connectivity : public ::testing::TestWithParam<SampleKind> {};

TEST_P(Connectivity, LocalStructureIsASphereOrADisk) {
  const Sample sample = sampleOf(GetParam());
  const Stages stages(sample.map);
  const propeller::LocalConnectivity& local = stages.local;
  for (std::size_t c = 0; c < local.configurations.size(); ++c) {
    const propeller::Configuration& configuration = local.configurations[c];
    std::size_t slots = 0;
    bool closed = true;
    for (std::size_t p = 0; p < configuration.propellerCount; ++p) {
      const propeller::Propeller& propeller = local.propeller(configuration, p);
      slots += propeller.slotCount;
      closed = closed && propeller.closed;
      for (std::size_t i = 0; i < propeller.slotCount; ++i) {
        const propeller::Slot& slot = local.slot(propeller, i);
        const propeller::Slot& back =
            local.slot(local.propeller(configuration, slot.blade), slot.back);
        EXPECT_EQ(back.blade, p);
        EXPECT_EQ(back.back, i);
        EXPECT_EQ(slot.corner == propeller::kNoCorner,
                  !propeller.closed && i + 1 == propeller.slotCount);
      }
    }
    // Euler characteristic of the small surface around the vertex.
    const auto euler = static_cast<int>(configuration.propellerCount) -
                       static_cast<int>(slots / 2) + static_cast<int>(configuration.cornerCount);
    EXPECT_EQ(euler, closed ? 2 : 1) << "configuration " << c;
  }
}

TEST_P(Connectivity, OppositesAreMutual) {
  const Sample sample = sampleOf(GetParam());
  const Stages stages(sample.map);
  const auto entry = [&](Index vertex, std::size_t propeller) {
    const Index g = stages.vertices().generatorOf[vertex];
    const std::size_t count = stages.local.configuration(g).propellerCount;
    return propeller::GlobalConnectivity::unpack(
        stages.global
            .opposites[stages.global.begin[g] +
                       (vertex - stages.vertices().generators[g].firstVertex) * count + propeller]);
  };
  for (Index v = 0; v < stages.vertices().tables.count(); ++v) {
    const propeller::Configuration& configuration =
        stages.local.configuration(stages.vertices().generatorOf[v]);
    for (std::uint16_t p = 0; p < configuration.propellerCount; ++p) {
      const propeller::Opposite there = entry(v, p);
      const propeller::Opposite back = entry(there.vertex, there.propeller);
      ASSERT_EQ(back.vertex, v);
      ASSERT_EQ(back.propeller, p);
      ASSERT_EQ(back.offset, there.offset);
      // Both ends see the same number of faces around the edge.
      const propeller::Configuration& other =
          stages.local.configuration(stages.vertices().generatorOf[there.vertex]);
      ASSERT_EQ(stages.local.propeller(other, there.propeller).slotCount,
                stages.local.propeller(configuration, p).slotCount);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Connectivity,
                         ::testing::Values(SampleKind::Box, SampleKind::Sphere, SampleKind::Star,
                                           SampleKind::Tetrahedron, SampleKind::Torus,
                                           SampleKind::HandleBody));

TEST(ConstantConfigurations, AreThoseOfTheRegularGrid) {
  const Sample sample = generateSample(SampleKind::Box);
  const Stages stages(sample.map);
  ASSERT_GE(stages.local.configurations.size(), propeller::kConstantConfigurations);
  EXPECT_EQ(stages.local.configurations[0].propellerCount, 6);
  EXPECT_EQ(stages.local.configurations[0].cornerCount, 8);
  for (std::size_t c = 1; c < propeller::kConstantConfigurations; ++c) {
    EXPECT_EQ(stages.local.configurations[c].propellerCount, 5);
    EXPECT_EQ(stages.local.configurations[c].cornerCount, 4);
  }
}

TEST(Epsilon, ChangesNothing) {
  const Sample sample = sampleOf(SampleKind::Sphere);
  const HexMesh right = extract(sample.map);
  for (const double epsilon : {0.0, 1e-6, 1e-3, 0.2, 0.6, 1e9, kInfinity}) {
    Context context;
    ExtractStatistics statistics;
    extraction::EngineOptions options(ExtractOptions{.engine = Engine::Propeller});
    options.epsilon = epsilon;
    const HexMesh mesh = extraction::extractWith(sample.map, options, context, &statistics);
    EXPECT_TRUE(sameBits(mesh, right)) << epsilon;
    EXPECT_EQ(statistics.vertices[0] + statistics.vertices[1] + statistics.vertices[2] +
                  statistics.vertices[3],
              mesh.points.size());
  }
}

}  // namespace
}  // namespace hexhex::test
