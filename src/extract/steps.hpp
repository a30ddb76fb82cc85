// The steps of an extraction, as the public functions combine them.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string_view>

#include <hexhex/extract.hpp>
#include <hexhex/stream.hpp>

#include <base/parallel.hpp>
#include <base/switches.hpp>
#include <igm/measures.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::extraction {

/// The most cells that 32-bit indices can number, and the most that pieces can.
inline constexpr double kMaxCells = kNone;
inline constexpr double kMaxStreamedCells = igm::kMaxCountedCells;

/// The caller's options, and what tests and ablations vary.
struct EngineOptions : ExtractOptions {
  // NOLINTNEXTLINE(google-explicit-constructor): options without switches mean the defaults.
  EngineOptions(const ExtractOptions& options, const EngineSwitches& switches_ = {})
      : ExtractOptions(options), switches(switches_) {}
  EngineSwitches switches;
  /// Margin by which the propeller engine enlarges tets when it enumerates candidates for lattice
  /// points, in parameter units; at least 0. Affects only the time, never the result: exact
  /// predicates decide. (Section 5.2.3)
  double epsilon = 1e-6;
};

/// A map that has passed all checks.
struct ValidMap {
  igm::PreparedMap prepared;
  TetMapView source;  ///< what it was prepared from: the caller's map or a repaired one
  std::shared_ptr<const TetMap> owner;  ///< of the source, unless it is the caller's alone
};

/// Checks tags, prepares the map or its repair, and throws the first defect, if any.
/// @param maxScale  the map is going to be scaled by at most this
/// @param statistics  receives what is known about the map
[[nodiscard]] ValidMap prepareValid(const TetMapView& map, int maxScale,
                                    const EngineOptions& options, Context& context,
                                    ExtractStatistics& statistics);

/// All stages after scaling. Adds to the map's topology what the engine needs.
/// @param map       scaled
/// @param observer  of the atlas engine; nullptr with the other engine
[[nodiscard]] HexMesh runEngine(igm::PreparedMap& map, std::uint64_t expectedCells,
                                const EngineOptions& options, Context& context,
                                ExtractStatistics& statistics,
                                sweep::SweepObserver* observer = nullptr);

/// A map that is ready for either engine.
struct ScaledMap {
  igm::PreparedMap map;
  TetMapView source;                    ///< as in ValidMap, with its tags
  std::shared_ptr<const TetMap> owner;  ///< as in ValidMap
  std::uint64_t expectedCells = 0;
};

struct ScaleLimits {
  int furtherScale = 1;      ///< the map is going to be scaled by this again
  double cells = kMaxCells;  ///< the mesh has fewer cells
};

/// Prepares a map and scales it.
/// @throws Error  for every violated condition; TooLarge
[[nodiscard]] ScaledMap prepareScaled(const TetMapView& map, const EngineOptions& options,
                                      const ScaleLimits& limits, Context& context,
                                      ExtractStatistics& statistics);

/// All further stages, tags included.
/// @param observer  as for runEngine()
[[nodiscard]] HexMesh extractScaled(ScaledMap& scaled, const EngineOptions& options,
                                    Context& context, ExtractStatistics& statistics,
                                    sweep::SweepObserver* observer = nullptr);

/// extract() for tests and ablations.
[[nodiscard]] HexMesh extractWith(const TetMapView& map, const EngineOptions& options,
                                  Context& context, ExtractStatistics* statistics = nullptr);

[[noreturn]] void throwOutOfMemory();

/// From a map to its mesh; weights as in inSteps().
inline constexpr std::array<WorkStep, 6> kExtractSteps = {{{"prepare", 0.1},
                                                           {"repair", 0.3},
                                                           {"prepare", 0.1},
                                                           {"scaling", 0.1},
                                                           {"engine", 4},
                                                           {"features", 0.5}}};
/// ... and what an observer of it computes afterwards.
inline constexpr std::array<WorkStep, 8> kPiecewiseSteps = {{{"prepare", 0.1},
                                                             {"repair", 0.3},
                                                             {"prepare", 0.1},
                                                             {"scaling", 0.1},
                                                             {"engine", 4},
                                                             {"features", 0.5},
                                                             {"arcs", 6},
                                                             {"patches", 12}}};
/// ... and the nodes of order 2.
inline constexpr std::array<WorkStep, 9> kLagrangeSteps = {{{"prepare", 0.1},
                                                            {"repair", 0.3},
                                                            {"prepare", 0.1},
                                                            {"scaling", 0.1},
                                                            {"engine", 4},
                                                            {"features", 0.5},
                                                            {"cell centres", 1},
                                                            {"nodes", 10},
                                                            {"blending", 4}}};

/// What a public function reports.
struct ReportedCall {
  std::string_view name;
  std::span<const WorkStep> steps = kExtractSteps;
};

/// Runs work(statistics) with the context's threads; translates exceptions that escape from it, and
/// records the time.
/// @param known  what the statistics begin with
template <class Work>
void runExtraction(const ReportedCall& call, const ExtractStatistics& known, Context& context,
                   ExtractStatistics* statistics, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  ExtractStatistics local;
  ExtractStatistics& filled = statistics != nullptr ? *statistics : local;
  filled = known;
  try {
    inSteps(context, call.name, call.steps,
            [&] { withThreads(context.threads(), [&] { work(filled); }); });
  } catch (const std::bad_alloc&) {
    throwOutOfMemory();
  }
  filled.threads = effectiveThreads(context.threads());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  filled.seconds = seconds.count();
}

}  // namespace hexhex::extraction
