// The public functions of the samples: they check the options and chain the steps.
#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <utility>

#include <hexhex/error.hpp>
#include <hexhex/samples.hpp>

#include <samples/kinds.hpp>
#include <samples/steps.hpp>
#include <samples/tet_grid.hpp>

namespace hexhex {

namespace {

constexpr std::array<SampleKindName, 8> kKinds = {{
    {SampleKind::Box, "box", "2 x 2 x 2 blocks, regular"},
    {SampleKind::Cylinder, "cylinder", "5-block O-grid, four inner edges of valence 3"},
    {SampleKind::Sphere, "sphere",
     "7-block O-grid, valence 3 along the inner cube's edges and its rays"},
    {SampleKind::Star, "star", "column with one inner edge of any valence from 3"},
    {SampleKind::Tetrahedron, "tetrahedron",
     "4 blocks, four edges of valence 3 that meet in the centre"},
    {SampleKind::Torus, "torus", "solid torus (genus 1), O-grid section"},
    {SampleKind::Shell, "shell", "spherical shell, 6 blocks: a cavity, two boundary components"},
    {SampleKind::HandleBody, "handle-body", "plate with two holes, genus 2"},
}};

constexpr std::array<ChartStyleName, 4> kChartStyles = {{
    {ChartStyle::Aligned, "aligned"},
    {ChartStyle::Blocks, "blocks"},
    {ChartStyle::Random, "random"},
    {ChartStyle::Scattered, "scattered"},
}};

constexpr std::array<DefectKindName, 4> kDefectKinds = {{
    {DefectKind::Interior, "interior"},
    {DefectKind::Singular, "singular"},
    {DefectKind::Boundary, "boundary"},
    {DefectKind::Sliver, "sliver"},
}};

/// Deliberate damage should be local.
constexpr int kMaxDefects = 10000;
/// With more, the number of hexahedra of a sample would be almost meaningless; the parameters
/// inside a block stay below 2^30 units.
constexpr int kMaxCells = 10000;
/// See kUnitsPerCell.
constexpr int kMaxRefine = 500;
constexpr int kMinValence = 3;
constexpr int kMaxValence = 12;
constexpr double kMaxOffset = 1e9;
constexpr double kNoiseEnd = 0.25;
/// With sides h of a sub-block and differences of corners that change by d, the determinant h^3 / 2
/// of its tets changes by at most 3 d h^2 + 7 d^2 h + 4 d^3. They stay positive for d = h / 8, i.e.
/// for noise of h / 16; divided by kNoiseReserve, with some slack for rounding h to units.
constexpr double kNoisePerSubBlock = 1 / (18 * samples::kNoiseReserve);

/// @param legal  formulated so that it is false for NaN
/// @param range  "from 1 to 5"
template <class Number>
void requireOption(bool legal, const char* option, Number value, const std::string& range) {
  if (legal) return;
  throw Error(ErrorCode::InvalidArgument, std::string("The option '") + option +
                                              "' of a sample is " + std::to_string(value) +
                                              "; choose a number " + range + ".");
}

void requireInteger(const char* option, int value, int least, int greatest) {
  requireOption(value >= least && value <= greatest, option, value,
                "from " + std::to_string(least) + " to " + std::to_string(greatest));
}

void requireReal(const char* option, double value, double greatest, const char* range) {
  requireOption(value >= 0 && value <= greatest, option, value, range);
}

template <class Entries, class Kind>
bool isListed(const Entries& entries, Kind kind) {
  return std::any_of(entries.begin(), entries.end(),
                     [kind](const auto& entry) { return entry.kind == kind; });
}

void requireLegal(SampleKind kind, const SampleOptions& options) {
  if (!isListed(kKinds, kind) || !isListed(kChartStyles, options.charts) ||
      !isListed(kDefectKinds, options.defectKind)) {
    throw Error(
        ErrorCode::InvalidArgument,
        "The kind, chart style or defect of a sample is none of the enumerators; choose one "
        "of those declared in hexhex/samples.hpp.");
  }
  requireInteger("cells", options.cells, 1, kMaxCells);
  requireInteger("refine", options.refine, 1, kMaxRefine);
  if (kind == SampleKind::Star) {
    requireInteger("valence", options.valence, kMinValence, kMaxValence);
  }
  requireInteger("defects", options.defects, 0, kMaxDefects);
  requireReal("jitter", options.jitter, 1, "from 0 to 1");
  requireReal("onLattice", options.onLattice, 1, "from 0 to 1");
  requireReal("stretch", options.stretch, 0.9, "from 0 to 0.9");
  requireReal("offset", options.offset, kMaxOffset, "from 0 to 1e9");
  requireOption(options.noise >= 0 && options.noise < kNoiseEnd, "noise", options.noise,
                "from 0 to below 0.25");
  if (options.stretch > 0 && (options.jitter > 0 || options.onLattice > 0)) {
    throw Error(ErrorCode::InvalidArgument,
                "A sample cannot be stretched and jittered or put on the lattice: blocks on the "
                "two sides of a vertex are stretched differently. Choose one.");
  }
  const double limit = kNoisePerSubBlock * options.cells / options.refine;
  if (options.noise > limit) {
    throw Error(ErrorCode::InvalidArgument,
                "The option 'noise' of a sample is " + std::to_string(options.noise) +
                    ", which could flip tets; with " + std::to_string(options.cells) +
                    " cells and refine " + std::to_string(options.refine) +
                    " choose a number from 0 to " + std::to_string(limit) +
                    ", or more cells, or a smaller refine.");
  }
}

void requireIndexable(std::size_t blocks, int refine) {
  const std::uint64_t tets = 12 * blocks * samples::power(refine, 3);
  if (tets < kNone) return;
  throw Error(ErrorCode::TooLarge, "A sample of " + std::to_string(blocks) +
                                       " blocks with refine " + std::to_string(refine) +
                                       " would have " + std::to_string(tets) +
                                       " tets, more than 32-bit indices can count; choose a "
                                       "smaller refine.");
}

}  // namespace

std::span<const SampleKindName> sampleKinds() noexcept { return kKinds; }

std::span<const ChartStyleName> chartStyles() noexcept { return kChartStyles; }

std::span<const DefectKindName> defectKinds() noexcept { return kDefectKinds; }

Sample generateSample(SampleKind kind, const SampleOptions& options) try {
  requireLegal(kind, options);
  const samples::BlockModel model = samples::blockModel(kind, options.valence);
  requireIndexable(model.blocks.size(), options.refine);
  const samples::BlockComplex complex(model.blocks);

  samples::TetGrid grid(model, complex, options.cells, options.refine);
  if (options.jitter > 0) {
    samples::jitter(grid, complex, options.jitter, options.noise, options.seed);
  }
  if (options.onLattice > 0) {
    samples::roundToLattice(grid, complex, options.onLattice, options.noise, options.seed);
  }
  if (options.defects > 0) {
    samples::damage(grid, complex, options.defectKind, options.defects, options.seed);
  }

  Sample sample;
  sample.answer =
      samples::expectedAnswer(complex, static_cast<std::uint64_t>(options.cells), options.features);
  if (options.features) samples::addFeatures(grid, complex, sample.map);
  samples::addCharts(std::move(grid), complex, options, sample.map);
  return sample;
} catch (const std::bad_alloc&) {
  throw Error(
      ErrorCode::OutOfMemory,
      "The memory of this machine does not suffice for the sample; choose a smaller refine.");
}

}  // namespace hexhex
