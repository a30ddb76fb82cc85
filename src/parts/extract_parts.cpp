// The public functions.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <parts/part_maker.hpp>

#include <hexhex/parts.hpp>

#include <extract/steps.hpp>

namespace hexhex {

namespace {

/// Weights as inSteps() has them.
constexpr std::array<WorkStep, 8> kPartsSteps = {{{"prepare", 0.1},
                                                  {"repair", 0.3},
                                                  {"prepare", 0.1},
                                                  {"scaling", 0.1},
                                                  {"charts", 0.1},
                                                  {"sweep", 0.5},
                                                  {"partition", 0.2},
                                                  {"parts", 4}}};

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

}  // namespace

void extractParts(PartSink& sink, const TetMapView& map, const ExtractOptions& options,
                  const PartOptions& parts, Context& context, ExtractStatistics* statistics) {
  checkOptions(options);
  checkOptions(parts);
  PartOptions needed = parts;
  needed.ghostLayers = std::max(needed.ghostLayers, sink.neededGhostLayers());
  runExtraction({"extractParts", kPartsSteps}, {}, context, statistics,
                [&](ExtractStatistics& filled) {
                  const ScaledMap scaled =
                      prepareScaled(map, options, {1, kMaxStreamedCells}, context, filled);
                  const std::unique_ptr<PartMaker> maker = makePartMaker(
                      {scaled.map, scaled.source, scaled.expectedCells}, needed, context, filled);
                  PartsInfo info = maker->info();
                  info.ghostLayers = parts.ghostLayers;
                  sink.begin(info);
                  for (std::uint32_t p = 0; p < needed.parts; ++p) sink.part(maker->make(p));
                  sink.end();
                });
}

std::vector<MeshPart> extractParts(const TetMapView& map, const ExtractOptions& options,
                                   const PartOptions& parts, Context& context,
                                   ExtractStatistics* statistics) {
  std::vector<MeshPart> all;
  Collector collector(all);
  extractParts(collector, map, options, parts, context, statistics);
  return all;
}

}  // namespace hexhex
