// Gives the map of one process to all processes of a team.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <parts/number_hash.hpp>
#include <parts/part_maker.hpp>
#include <verify/proof.hpp>

#include <hexhex/parts.hpp>
#include <hexhex/team.hpp>

#include <base/workspaces.hpp>
#include <extract/steps.hpp>

namespace hexhex::parts {

namespace {

/// Process 0 shares copies of pieces: shared memory must be writable by all.
template <class T>
void shareArray(ProcessTeam& team, std::span<const T> mine, std::vector<T>& theirs) {
  std::uint64_t size = mine.size();
  team.share(std::as_writable_bytes(std::span(&size, 1)));
  if (team.rank() > 0) theirs.resize(size);
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<T> piece;
  for (std::size_t first = 0; first < size; first += kPiece) {
    const std::size_t count = std::min<std::size_t>(kPiece, size - first);
    if (team.rank() == 0) {
      const std::span<const T> given = mine.subspan(first, count);
      piece.assign(given.begin(), given.end());
    }
    const std::span<T> items =
        team.rank() == 0 ? std::span(piece) : std::span(theirs).subspan(first, count);
    team.share(std::as_writable_bytes(items));
  }
}

}  // namespace

}  // namespace hexhex::parts

namespace hexhex {

TetMap shareMap(ProcessTeam& team, const TetMapView& map) {
  TetMap shared;
  team.run([&] {
    parts::shareArray(team, map.points, shared.points);
    parts::shareArray(team, map.tets, shared.tets);
    parts::shareArray(team, map.parameters, shared.parameters);
    parts::shareArray(team, map.edgeValences, shared.edgeValences);
    parts::shareArray(team, map.rotations, shared.rotations);
    parts::shareArray(team, map.features.vertices, shared.features.vertices);
    parts::shareArray(team, map.features.edges, shared.features.edges);
    parts::shareArray(team, map.features.faces, shared.features.faces);
    parts::shareArray(team, map.regions, shared.regions);
  });
  return shared;
}

}  // namespace hexhex

namespace hexhex::parts {

// The public functions.

namespace {

/// Weights as in inSteps().
constexpr std::array<WorkStep, 9> kPartsSteps = {{{"prepare", 0.1},
                                                  {"repair", 0.3},
                                                  {"prepare", 0.1},
                                                  {"scaling", 0.1},
                                                  {"verification", 0.1},
                                                  {"charts", 0.1},
                                                  {"sweep", 0.5},
                                                  {"partition", 0.2},
                                                  {"parts", 5}}};

void checkOptions(const PartOptions& options) {
  if (options.parts < 1 || options.parts > kMaxParts) {
    throw Error(ErrorCode::InvalidArgument,
                "The number of parts is " + std::to_string(options.parts) +
                    ". Choose it from 1 to " + std::to_string(kMaxParts) + '.');
  }
  if (options.ghostLayers > kMaxGhostLayers) {
    throw Error(ErrorCode::InvalidArgument,
                "The number of ghost layers is " + std::to_string(options.ghostLayers) +
                    ". Choose it from 0 to " + std::to_string(kMaxGhostLayers) + '.');
  }
}

class Collector final : public PartSink {
 public:
  explicit Collector(std::vector<MeshPart>& parts) : parts_(parts) {}
  void begin(const PartsInfo& /*info*/) override {}
  void part(MeshPart&& part) override { parts_.push_back(std::move(part)); }
  void end() override {}

 private:
  std::vector<MeshPart>& parts_;
};

/// The most parts to have in memory at once: as many as threads, or twice as many if they are
/// delivered in order, since some parts take twice as long as others; but no more than fit in a
/// gigabyte, one at least. Making a part takes 145 bytes per cell (docs/results/scaling.md), and
/// tables of some 40 bytes per tet that each needs for itself.
std::uint32_t partsAtOnce(const PartsInfo& info, std::size_t tets, bool inOrder) {
  constexpr std::uint64_t kBytes = std::uint64_t{1} << 30;
  const std::uint64_t ofOne = 145 * (info.cellCount / info.parts + 1) + 40 * tets;
  const auto threads = static_cast<std::uint64_t>(currentThreads());
  const std::uint64_t most = threads > 1 && inOrder ? 2 * threads : threads;
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kBytes / ofOne, 1, most));
}

/// Makes parts, and proves them if requested.
class ProvenParts {
 public:
  ProvenParts(ProcessTeam* team, extraction::ScaledMap& scaled, const PartOptions& options,
              Context& context, ExtractStatistics& statistics)
      : map_(scaled.map), context_(context) {
    if (options.verify) {
      Stage stage(context, "verification");
      expected_ = verification::expectationOf(scaled.map, stage);
    }
    maker_ = makePartMaker({scaled.map, scaled.source, scaled.expectedCells, team}, options,
                           context, statistics);
  }

  [[nodiscard]] PartsInfo info() const { return maker_->info(); }
  /// Makes, proves and delivers all parts.
  /// @param info  of this
  void deliverTo(PartSink& sink, const PartsInfo& info) {
    Stage stage(context_, "parts");
    stage.setTotal(info.parts);
    const bool inOrder = !sink.takesAnyOrder();
    const std::uint32_t atOnce = partsAtOnce(info, map_.topology.tetCount(), inOrder);
    inOrder ? deliverInOrder(sink, info.parts, atOnce, stage)
            : deliverInAnyOrder(sink, info.parts, atOnce, stage);
  }

  /// Thread-safe.
  [[nodiscard]] MeshPart make(std::uint32_t which) {
    Stage stage(context_, Stage::kInner);
    MeshPart part = maker_->make(which, stage);
    if (expected_) {
      proofs_.with([&] { return verification::PartProof(map_, *expected_, maker_->counts()); },
                   [&](verification::PartProof& proof) { proof.compare(part, stage); });
    }
    return part;
  }

 private:
  void deliverInAnyOrder(PartSink& sink, std::uint32_t parts, std::uint32_t atOnce, Stage& stage) {
    LoopProgress progress(stage, parts);
    // So that no more parts than these are in memory, whichever thread works on which.
    std::atomic<std::uint32_t> next{0};
    parallelBlocks(nullptr, atOnce, 1, [&](std::size_t, std::size_t, std::size_t) {
      try {
        for (std::uint32_t part = next++; part < parts; part = next++) {
          sink.part(make(part));
          progress.advance(1);
        }
      } catch (...) {
        next = parts;  // the other threads need not go on
        throw;
      }
    });
  }
  void deliverInOrder(PartSink& sink, std::uint32_t parts, std::uint32_t atOnce, Stage& stage) {
    std::vector<MeshPart> made(atOnce);
    for (std::uint32_t first = 0; first < parts; first += atOnce) {
      const std::uint32_t count = std::min(atOnce, parts - first);
      parallelFor(stage, count, 1,
                  [&](std::size_t i) { made[i] = make(first + static_cast<std::uint32_t>(i)); });
      for (std::uint32_t i = 0; i < count; ++i) {
        MeshPart part = std::exchange(made[i], {});  // freed behind this, whatever the sink does
        sink.part(std::move(part));
      }
    }
  }

  const igm::PreparedMap& map_;
  Context& context_;
  std::unique_ptr<PartMaker> maker_;
  std::optional<Expectation> expected_;  ///< if parts are proven
  Workspaces<verification::PartProof> proofs_;
};

/// Prepares a map and calls make(maker), which decides which parts to make.
/// @param team  null for one process
template <class Make>
void runParts(ProcessTeam* team, std::uint32_t sinkLayers, const TetMapView& map,
              const ExtractOptions& options, const PartOptions& parts, Context& context,
              ExtractStatistics* statistics, const Make& make) {
  checkOptions(parts);
  PartOptions needed = parts;
  needed.ghostLayers = std::max(needed.ghostLayers, sinkLayers);
  extraction::runExtraction(
      {"extractParts", kPartsSteps}, {}, context, statistics, [&](ExtractStatistics& filled) {
        extraction::ScaledMap scaled = extraction::prepareScaled(
            map, options, {1, extraction::kMaxStreamedCells}, context, filled);
        ProvenParts maker(team, scaled, needed, context, filled);
        PartsInfo info = maker.info();
        info.ghostLayers = parts.ghostLayers;
        make(maker, info);
      });
}

void addBytes(NumberHash& hash, std::span<const std::byte> bytes) {
  constexpr std::size_t kWord = sizeof(std::uint64_t);
  hash.add(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); i += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(kWord, bytes.size() - i));
    hash.add(word);
  }
}

/// Covers everything that a mesh in parts depends on.
std::uint64_t hashOf(const TetMapView& map, const ExtractOptions& options,
                     const PartOptions& parts) {
  NumberHash hash;
  addBytes(hash, std::as_bytes(map.points));
  addBytes(hash, std::as_bytes(map.tets));
  addBytes(hash, std::as_bytes(map.parameters));
  addBytes(hash, std::as_bytes(map.edgeValences));
  addBytes(hash, std::as_bytes(map.rotations));
  addBytes(hash, std::as_bytes(map.features.vertices));
  addBytes(hash, std::as_bytes(map.features.edges));
  addBytes(hash, std::as_bytes(map.features.faces));
  addBytes(hash, std::as_bytes(map.regions));
  hash.add(static_cast<std::uint64_t>(options.scale));
  hash.add(std::bit_cast<std::uint64_t>(options.tolerance));
  hash.add(options.repair != nullptr ? 1 : 0);
  hash.add(options.round ? 1 : 0);
  hash.add(parts.ghostLayers);
  hash.add(static_cast<std::uint64_t>(parts.method));
  return hash.value();
}

void requireSame(ProcessTeam& team, std::uint64_t hash) {
  const GatheredNumbers all = team.gather(std::span(&hash, 1));
  for (std::uint32_t r = 1; r < team.size(); ++r) {
    if (all.numbers[r] == all.numbers[0]) continue;
    throw Error(ErrorCode::InvalidArgument,
                "Processes 0 and " + std::to_string(r) +
                    " have different maps or options. Give all of them the same.");
  }
}

}  // namespace

}  // namespace hexhex::parts

namespace hexhex {

void extractParts(PartSink& sink, const TetMapView& map, const ExtractOptions& options,
                  const PartOptions& parts, Context& context, ExtractStatistics* statistics) {
  parts::runParts(nullptr, sink.neededGhostLayers(), map, options, parts, context, statistics,
                  [&](parts::ProvenParts& maker, const PartsInfo& info) {
                    sink.begin(info);
                    maker.deliverTo(sink, info);
                    sink.end();
                  });
}

std::vector<MeshPart> extractParts(const TetMapView& map, const ExtractOptions& options,
                                   const PartOptions& parts, Context& context,
                                   ExtractStatistics* statistics) {
  std::vector<MeshPart> all;
  parts::Collector collector(all);
  extractParts(collector, map, options, parts, context, statistics);
  return all;
}

void extractPart(ProcessTeam& team, PartSink& sink, const TetMapView& map,
                 const ExtractOptions& options, const PartOptions& parts, Context& context,
                 ExtractStatistics* statistics, PartsSummary* summary) {
  team.run([&] {
    if (parts.parts != 1 && parts.parts != team.size()) {
      throw Error(ErrorCode::InvalidArgument,
                  "There are " + std::to_string(parts.parts) + " parts and " +
                      std::to_string(team.size()) +
                      " processes. Each process makes one part: leave out the number of parts.");
    }
    PartOptions all = parts;
    all.parts = team.size();
    parts::requireSame(team, parts::hashOf(map, options, parts));
    PartSummarySink checked(sink, &team);
    parts::runParts(&team, sink.neededGhostLayers(), map, options, all, context, statistics,
                    [&](parts::ProvenParts& maker, const PartsInfo& info) {
                      checked.begin(info);
                      {
                        Stage stage(context, "parts");
                        checked.part(maker.make(team.rank()));
                      }
                      checked.end();
                    });
    if (summary != nullptr) *summary = checked.result();
  });
}

MeshPart extractPart(ProcessTeam& team, const TetMapView& map, const ExtractOptions& options,
                     const PartOptions& parts, Context& context, ExtractStatistics* statistics) {
  std::vector<MeshPart> own;
  parts::Collector collector(own);
  extractPart(team, collector, map, options, parts, context, statistics);
  return std::move(own.front());
}

}  // namespace hexhex
