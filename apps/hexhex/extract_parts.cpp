#include "extract_parts.hpp"

#include <map>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

void addPartsOptions(CLI::App& parser, PartsChoice& choice) {
  std::string extensions;
  for (const PartFormat& format : partFormats()) {
    if (format.extension.empty()) continue;
    extensions += (extensions.empty() ? "" : ", ") + std::string(format.extension);
  }
  parser
      .add_option("--parts", choice.parts,
                  "Write the mesh in so many parts, for solvers on many\nmachines, a file for "
                  "each or all in one: " +
                      extensions)
      ->check(CLI::Range(1U, kMaxParts))
      ->option_text("N");
  parser
      .add_option("--ghosts", choice.options.ghostLayers,
                  "Layers of cells of other parts around each part")
      ->check(CLI::Range(0U, kMaxGhostLayers))
      ->option_text("LAYERS [0]");
  parser
      .add_option(
          "--partition", choice.options.method,
          "Who cuts the mesh: curve, into halves of halves along a\ncurve; scotch or metis, "
          "if that library is on this machine")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, PartitionMethod>{{"curve", PartitionMethod::Curve},
                                                 {"scotch", PartitionMethod::Scotch},
                                                 {"metis", PartitionMethod::Metis}}))
      ->option_text("METHOD [curve]");
  parser.add_flag("--mpi", choice.mpi,
                  "Make one part in each process of an MPI. Several ones that\nmpirun starts do "
                  "that anyway");
}

void printParts(const PartsRecord& record) {
  const PartsSummary& summary = record.summary;
  printLine("parts", fmt::format("{}, of {} to {} cells", record.options.parts, summary.smallest,
                                 summary.largest));
  printLine("shared", fmt::format("{} vertices, {}, at most {} of a part", summary.sharedVertices,
                                  counted(summary.sharedFaces, "face"),
                                  counted(summary.mostNeighbours, "neighbour")));
}

PartsRecord extractInParts(const TetMap& map, const std::filesystem::path& output,
                           const WriteOptions& writing, const ExtractOptions& extraction,
                           const PartOptions& options, ProcessTeam* team, Context& context,
                           ExtractStatistics& statistics) {
  if (team != nullptr) {
    PartsSummary summary;
    const std::unique_ptr<PartSink> files = openPartSink(output, writing, context, team);
    extractPart(*team, *files, map, extraction, options, context, &statistics, &summary);
    return {options, summary};
  }
  const std::unique_ptr<PartSink> files = openPartSink(output, writing, context);
  PartSummarySink checked(*files);
  extractParts(checked, map, extraction, options, context, &statistics);
  return {options, checked.result()};
}

}  // namespace hexhex::command
