// How often a repair succeeds: damages random valid maps, repairs and extracts them, and compares
// the meshes with those of the undamaged maps, cell by cell up to numbering.
//
//   hexhex_repair_trials [NUMBER PER KIND OF DEFECT] [FIRST SEED]
//
// Prints a table by kind of defect. Exit code 1 if any mesh came out wrong and unnoticed, or fewer
// than 99 of 100 maps with up to 20 bad tets came out right.
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <hexhex/hexhex.hpp>

#include <repair/same_connectivity.hpp>

namespace hexhex::bench {
namespace {

/// SplitMix64: the same maps on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15U) {}
  int below(int count) {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return static_cast<int>((z ^ (z >> 31)) % static_cast<std::uint64_t>(count));
  }
  double share() { return below(1000001) / 1e6; }

 private:
  std::uint64_t state_;
};

struct Trial {
  SampleKind kind;
  SampleOptions options;
};

Trial draw(DefectKind defect, std::uint64_t seed) {
  Random random(4 * seed + static_cast<std::uint64_t>(defect));
  Trial trial;
  const auto kinds = sampleKinds();
  trial.kind = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))].kind;
  SampleOptions& options = trial.options;
  options.cells = 1 + random.below(5);
  options.refine = 2 + random.below(4);
  constexpr std::array<int, 7> kValences = {3, 5, 6, 7, 8, 9, 12};
  options.valence = kValences[static_cast<std::size_t>(random.below(7))];
  options.charts = static_cast<ChartStyle>(random.below(3));
  if (random.below(2) == 0) options.jitter = 0.7 * random.share();
  if (random.below(3) == 0) options.onLattice = random.share();
  if (random.below(4) == 0) options.offset = 1e6;
  if (random.below(4) == 0) options.noise = 0.002 * random.share() * options.cells / options.refine;
  options.defectKind = defect;
  options.defects = 1 + random.below(20);
  options.seed = seed;
  return trial;
}

struct Tally {
  int maps = 0;
  int right = 0;
  int refused = 0;  ///< with an error
  int noticed = 0;  ///< wrong, and verification or another check said so
  int wrong = 0;    ///< wrong and unnoticed
  int refined = 0;  ///< right with a finer tet mesh
  int badTets = 0;
  double seconds = 0;

  void add(const Tally& other) {
    maps += other.maps;
    right += other.right;
    refused += other.refused;
    noticed += other.noticed;
    wrong += other.wrong;
    refined += other.refined;
    badTets += other.badTets;
    seconds += other.seconds;
  }
};

std::string commandFor(const Trial& trial) {
  std::string name;
  for (const SampleKindName& entry : sampleKinds()) {
    if (entry.kind == trial.kind) name = entry.name;
  }
  for (const DefectKindName& entry : defectKinds()) {
    if (entry.kind == trial.options.defectKind) name += ", " + std::string(entry.name);
  }
  const SampleOptions& o = trial.options;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s, cells %d, refine %d, valence %d, charts %d, jitter %g, on-lattice %g, "
                "noise %g, offset %g, defects %d, seed %llu",
                name.c_str(), o.cells, o.refine, o.valence, static_cast<int>(o.charts), o.jitter,
                o.onLattice, o.noise, o.offset, o.defects, static_cast<unsigned long long>(o.seed));
  return text.data();
}

/// One map. Nothing is counted if it has more than 20 bad tets, or turned out valid.
Tally run(const Trial& trial) {
  Tally tally;
  Sample damaged;
  try {
    damaged = generateSample(trial.kind, trial.options);
  } catch (const Error&) {
    return tally;  // no such vertices in this sample
  }
  SampleOptions sound = trial.options;
  sound.defects = 0;
  const HexMesh wanted = extract(generateSample(trial.kind, sound).map);
  Context context(1);
  RepairedMap repaired;
  bool extracted = false;
  try {
    ExtractOptions options;
    options.repair = &repaired;
    const HexMesh mesh = extract(damaged.map, options, context);
    extracted = true;
    if (repaired.map) {
      tally.right = test::sameConnectivity(mesh, wanted) ? 1 : 0;
      tally.refined = tally.right == 1 && repaired.report.splitEdges > 0 ? 1 : 0;
      const bool verified = verify(*repaired.map, mesh).passed();
      if (tally.right == 0) (verified ? tally.wrong : tally.noticed) = 1;
      tally.seconds = repaired.report.seconds;
    }
  } catch (const Error& error) {
    tally.refused = 1;
    if (repaired.report.badTets <= 20) {
      std::printf("  refused: %s\n    %s\n", commandFor(trial).c_str(), error.what());
    }
  }
  const std::uint64_t badTets = repaired.report.badTets;
  if (badTets == 0 && extracted) return {};
  if (badTets > 20) return {};
  if (tally.wrong > 0) std::printf("  WRONG: %s\n", commandFor(trial).c_str());
  tally.maps = 1;
  tally.badTets = static_cast<int>(badTets);
  return tally;
}

void print(const char* label, const Tally& tally) {
  const double maps = tally.maps > 0 ? tally.maps : 1;
  std::printf("| %-8s | %5d | %8.1f | %6.2f %% | %7d | %7d | %5d | %7d | %6.1f ms |\n", label,
              tally.maps, tally.badTets / maps, 100 * tally.right / maps, tally.refused,
              tally.noticed, tally.wrong, tally.refined, 1e3 * tally.seconds / maps);
}

int runAll(int perKind, std::uint64_t firstSeed) {
  std::array<Tally, 4> tallies;
  Tally all;
  for (const DefectKindName& kind : defectKinds()) {
    Tally& tally = tallies[static_cast<std::size_t>(kind.kind)];
    for (std::uint64_t seed = firstSeed; tally.maps < perKind; ++seed) {
      tally.add(run(draw(kind.kind, seed)));
    }
    all.add(tally);
  }
  std::printf(
      "\n| defect   |  maps | bad tets |    right | refused | noticed | wrong | refined |"
      "      time |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const DefectKindName& kind : defectKinds()) {
    print(std::string(kind.name).c_str(), tallies[static_cast<std::size_t>(kind.kind)]);
  }
  print("all", all);
  return all.wrong == 0 && all.right >= 0.99 * all.maps ? 0 : 1;
}

}  // namespace
}  // namespace hexhex::bench

int main(int argc, char** argv) {
  const int perKind = argc > 1 ? std::atoi(argv[1]) : 500;
  const std::uint64_t firstSeed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  return hexhex::bench::runAll(perKind, firstSeed);
}
