#include "extract_parts.hpp"

#include <memory>
#include <string>

#include <fmt/core.h>

#include "expected_words.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

void addPartsOptions(CLI::App& parser, PartsChoice& choice) {
  std::string extensions;
  for (const PartFormat& format : partFormats()) {
    if (format.extension.empty()) continue;
    extensions += (extensions.empty() ? "" : ", ") + std::string(format.extension);
  }
  addValue(parser, "--parts", choice.parts, "N",
           "Write the mesh in this many parts, for distributed solvers,\none file each or all in "
           "one: " +
               extensions)
      ->check(CLI::Range(1U, kMaxParts));
  addValue(parser, "--ghosts", choice.options.ghostLayers, "LAYERS [0]",
           "Layers of cells of other parts around each part")
      ->check(CLI::Range(0U, kMaxGhostLayers));
  addChoice<PartitionMethod>(
      parser, "--partition", choice.options.method, "METHOD [curve]",
      {{"curve", PartitionMethod::Curve},
       {"scotch", PartitionMethod::Scotch},
       {"metis", PartitionMethod::Metis}},
      "How to divide the mesh: curve (recursive bisection);\nscotch or metis, if that library "
      "is installed");
  parser.add_flag(
      "--mpi", choice.mpi,
      "Make one part in each MPI process, as several processes\nstarted by mpirun do anyway");
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
