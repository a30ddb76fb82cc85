// `hexhex info`: what a file holds.
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/survey.hpp>

#include "command.hpp"
#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct Arguments {
  MapSource source;
  bool pieces = false;
};

void printBox(const Vec3& lower, const Vec3& upper) {
  printLine("bounding box",
            fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", lower[0], lower[1],
                        lower[2], upper[0], upper[1], upper[2]));
}

void printBoundingBox(std::span<const Vec3> points) {
  if (points.empty()) return;
  Vec3 lower = points.front();
  Vec3 upper = points.front();
  for (const Vec3& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], point[axis]);
      upper[axis] = std::max(upper[axis], point[axis]);
    }
  }
  printBox(lower, upper);
}

void printMap(const TetMap& map) {
  fmt::print("a tetrahedral mesh with an integer-grid map\n");
  printLine("tets", std::to_string(map.tets.size()));
  printLine("points", std::to_string(map.points.size()));
  printBoundingBox(map.points);
  double largest = 0;
  for (const TetParameters& corners : map.parameters) {
    for (const Vec3& corner : corners) {
      for (const double parameter : corner) largest = std::max(largest, std::abs(parameter));
    }
  }
  printLine("parameters", fmt::format("up to {:.6g} in size", largest));
}

void printHistogram(const QualitySummary& quality) {
  constexpr double kLowest = -1;
  const double step = 2.0 / static_cast<double>(quality.histogram.size());
  for (std::size_t i = 0; i < quality.histogram.size(); ++i) {
    if (quality.histogram[i] == 0) continue;
    const double from = kLowest + step * static_cast<double>(i);
    printLine(fmt::format("  {:4.1f} to {:4.1f}", from, from + step),
              counted(quality.histogram[i], "cell"));
  }
}

void printMesh(const HexMesh& mesh, Context& context) {
  fmt::print("a hexahedral mesh\n");
  printLine("cells", std::to_string(mesh.cells.size()));
  printLine("vertices", std::to_string(mesh.points.size()));
  printBoundingBox(mesh.points);
  if (mesh.cells.empty()) return;
  const Certificate certificate = certify(mesh, context);
  printQuality(certificate);
  if (certificate.refuted > 0) printLine("refuted", refutationAsText(certificate));
  printHistogram(certificate.quality);
}

/// What is known without the whole mesh in memory.
void printSurvey(const MeshSurvey& survey) {
  fmt::print("a hexahedral mesh\n");
  printLine("cells", std::to_string(survey.cells));
  printLine("vertices", std::to_string(survey.points));
  if (survey.points > 0) printBox(survey.lower, survey.upper);
  printLine("checksum of cells", checksumAsText(survey.cellChecksum));
  printLine("checksum of vertices", checksumAsText(survey.pointChecksum));
}

int run(const Arguments& arguments) {
  Context context;
  const CancelOnSignal cancelOnSignal(context);
  const std::string name = printable(arguments.source.description());
  if (arguments.pieces && arguments.source.isPair()) {
    throw Error(ErrorCode::InvalidArgument,
                "--pieces reads hexahedral meshes, but --tets and --polycube are a map.");
  }
  if (arguments.pieces) {
    const MeshSurvey survey =
        surveyFile(arguments.source.file, arguments.source.options(), context);
    fmt::print("{}: ", name);
    printSurvey(survey);
    return kSuccess;
  }
  if (arguments.source.isPair()) {
    const TetMap map = readMap(arguments.source, context);
    fmt::print("{}: ", name);
    printMap(map);
    return kSuccess;
  }
  const auto content = readMapOrHexMesh(arguments.source.file, arguments.source.options(), context);
  fmt::print("{}: ", name);
  if (const auto* const map = std::get_if<TetMap>(&content)) {
    printMap(*map);
  } else {
    printMesh(std::get<HexMesh>(content), context);
  }
  return kSuccess;
}

}  // namespace

Command addInfo(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const parser = app.add_subcommand("info", "Tell what a file holds");
  addMapSource(*parser, arguments->source, "FILE",
               "A map or a hexahedral mesh; `hexhex formats` lists the\nformats");
  parser
      ->add_option("--input-format", arguments->source.format,
                   "Read this format, whatever the extension")
      ->option_text("NAME");
  parser->add_flag("--pieces", arguments->pieces,
                   "Read a mesh piece by piece, which needs hardly any\n"
                   "memory for .vtu; with checksums instead of quality");
  parser->footer("Example:\n  hexhex info sphere.vtu");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
