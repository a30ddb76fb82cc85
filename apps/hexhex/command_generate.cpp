// `hexhex generate`: maps with known answers.
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
  std::string kind;
  std::string charts = "aligned";
  std::string defectKind = "interior";
  std::string output;
  OutputChoice choice;
  SampleOptions options;
  bool quiet = false;
};

/// The kind or style of this name; the parser has checked it.
template <class Entry>
auto kindNamed(std::span<const Entry> entries, std::string_view name) {
  return std::find_if(entries.begin(), entries.end(),
                      [&](const Entry& entry) { return entry.name == name; })
      ->kind;
}

template <class Entry>
std::vector<std::string> namesOf(std::span<const Entry> entries) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return names;
}

int run(const GenerateArguments& arguments) {
  const WriteOptions writing = arguments.choice.options();
  requireMapFormat(arguments.output, writing);
  SampleOptions options = arguments.options;
  options.charts = kindNamed(chartStyles(), arguments.charts);
  options.defectKind = kindNamed(defectKinds(), arguments.defectKind);
  // A signal takes effect between the two steps: a file is written whole or not at all.
  Context context;
  const CancelOnSignal cancelOnSignal(context);
  requireWritable(arguments.output);
  const Sample sample = generateSample(kindNamed(sampleKinds(), arguments.kind), options);
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
    return parser.add_option(optionName, value, description)
        ->option_text(fmt::format("NUMBER [{}]", value));
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
  add("--seed", options.seed, "Another seed, another map");
}

}  // namespace

Command addGenerate(CLI::App& app) {
  const auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* const parser =
      app.add_subcommand("generate", "Generate a map whose mesh is known in advance");
  parser->add_option("KIND", arguments->kind, "What to generate: one of the kinds below")
      ->required()
      ->check(oneOf(namesOf(sampleKinds())))
      ->option_text("REQUIRED");
  addMapOutput(*parser, arguments->output);
  addOutputChoice(*parser, arguments->choice);
  parser
      ->add_option("--map-array", arguments->choice.mapArray,
                   "The name of the map's array in .vtu and .vtk files")
      ->option_text("NAME [igm]");
  parser
      ->add_option("--charts", arguments->charts,
                   "aligned: as many identities as possible; blocks: a\n"
                   "random rotation and integer translation per block;\nrandom: per tet; "
                   "scattered: for one tet in eight")
      ->check(oneOf(namesOf(chartStyles())))
      ->option_text("STYLE [aligned]");
  addSampleOptions(*parser, arguments->options);
  parser->add_flag(
      "--features", arguments->options.features,
      "Tag corners, curves, patches and blocks (files: .ovm,\n.ovmb; .hexex without the "
      "numbers)");
  parser
      ->add_option("--defects", arguments->options.defects,
                   "Damage the map: flip or flatten at least so many tets,\nin one place")
      ->check(wholeNumberFrom(0))
      ->option_text("NUMBER [0]");
  parser
      ->add_option("--defect-kind", arguments->defectKind,
                   "Which vertices are moved: interior, singular, boundary\n"
                   "(until tets flip), or sliver (until they collapse)")
      ->check(oneOf(namesOf(defectKinds())))
      ->option_text("KIND [interior]");
  addQuiet(*parser, arguments->quiet);
  parser->footer(describeKinds());
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
