// `hexhex generate`: generates maps with known properties.
#include <map>
#include <memory>
#include <span>
#include <string>

#include <fmt/core.h>

#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct GenerateArguments {
  SampleKind kind{};
  std::string output;
  OutputChoice choice;
  SampleOptions options;
  bool quiet = false;
};

template <class Entry>
auto choicesOf(std::span<const Entry> entries) {
  std::map<std::string, decltype(Entry::kind)> choices;
  for (const Entry& entry : entries) choices.emplace(entry.name, entry.kind);
  return choices;
}

int run(const GenerateArguments& arguments) {
  const WriteOptions writing = arguments.choice.options();
  requireMapFormat(arguments.output, writing);
  // Signals take effect between the two steps: a file is written completely or not at all.
  Context context;
  const CancelOnSignal cancelOnSignal(context);
  requireWritable(arguments.output);
  const Sample sample = generateSample(arguments.kind, arguments.options);
  context.throwIfCancelled();
  writeMap(sample.map, arguments.output, writing, context);
  if (arguments.quiet) return kSuccess;
  fmt::print("{}\n", printable(arguments.output));
  printLine("map", fmt::format("{}, {}", counted(sample.map.tets.size(), "tet"),
                               counted(sample.map.points.size(), "point")));
  fmt::print("Mesh to expect at scale 1\n");
  printLine("vertices", std::to_string(sample.answer.vertices));
  printExpectation(sample.answer.expected);
  return kSuccess;
}

std::string describeKinds() {
  std::string text = "Kinds:\n";
  for (const SampleKindName& entry : sampleKinds()) {
    text += fmt::format("  {:<14}{}\n", entry.name, entry.description);
  }
  return text +
         "\nExample:\n"
         "  hexhex generate star --valence 7 --charts random --jitter 0.5 -o star.hexex";
}

void addSampleOptions(CLI::App& parser, SampleOptions& options) {
  const auto add = [&parser](const char* optionName, auto& value, const char* description) {
    return addValue(parser, optionName, value, fmt::format("NUMBER [{}]", value), description);
  };
  add("--cells", options.cells, "Hexahedra along each block edge, at least 1")
      ->check(wholeNumberFrom(1));
  add("--refine", options.refine, "Tet sub-blocks along each block edge, at least 1")
      ->check(wholeNumberFrom(1));
  add("--valence", options.valence, "Hexahedra around the inner edge of a star, 3 to 12")
      ->check(wholeNumberFrom(3));
  add("--jitter", options.jitter, "Move free tet vertices by this share of a sub-block,\n0 to 1");
  add("--stretch", options.stretch,
      "Make the map seamless instead of integer: a random length\nof hexahedra along each chain of "
      "blocks, up to this far\nfrom 1, 0 to 0.9");
  add("--on-lattice", options.onLattice,
      "Share of free tet coordinates to put exactly on\nintegers, 0 to 1");
  add("--noise", options.noise, "Add up to this to every corner on its own");
  add("--offset", options.offset, "Draw chart translations up to this size, at most 1e9");
  add("--seed", options.seed, "Seed of the random numbers");
}

}  // namespace

Command addGenerate(CLI::App& app) {
  const auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* const parser =
      app.add_subcommand("generate", "Generate a map whose mesh is known in advance");
  addChoice(*parser, "KIND", arguments->kind, "REQUIRED", choicesOf(sampleKinds()),
            "What to generate: one of the kinds below")
      ->required();
  addMapOutput(*parser, arguments->output);
  addOutputChoice(*parser, arguments->choice);
  addValue(*parser, "--map-array", arguments->choice.mapArray, "NAME [igm]",
           "Name of the map's array in .vtu and .vtk files");
  addChoice(*parser, "--charts", arguments->options.charts, "STYLE [aligned]",
            choicesOf(chartStyles()),
            "aligned: as many identities as possible; blocks: a\n"
            "random rotation and integer translation per block;\nrandom: per tet; "
            "scattered: for one tet in eight");
  addSampleOptions(*parser, arguments->options);
  parser->add_flag(
      "--features", arguments->options.features,
      "Tag corners, curves, patches and blocks (files: .ovm,\n.ovmb; .hexex without the "
      "numbers)");
  addValue(*parser, "--defects", arguments->options.defects, "NUMBER [0]",
           "Damage the map: flip or flatten at least this many tets,\nin one place")
      ->check(wholeNumberFrom(0));
  addChoice(*parser, "--defect-kind", arguments->options.defectKind, "KIND [interior]",
            choicesOf(defectKinds()),
            "Which vertices are moved: interior, singular, boundary\n"
            "(until tets flip), or sliver (until they collapse)");
  addQuiet(*parser, arguments->quiet);
  parser->footer(describeKinds());
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
