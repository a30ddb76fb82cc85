// `hexhex info`: summarizes the content of a file.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/summary.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct InfoArguments {
  MapSource source;
  PatchAngle patchAngle;
  bool pieces = false;
  bool json = false;
};

struct Box {
  Vec3 lower{};
  Vec3 upper{};
};

/// The bounding box; empty if there are no points.
std::optional<Box> boxOf(std::span<const Vec3> points) {
  if (points.empty()) return std::nullopt;
  Box box{points.front(), points.front()};
  for (const Vec3& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min(box.lower[axis], point[axis]);
      box.upper[axis] = std::max(box.upper[axis], point[axis]);
    }
  }
  return box;
}

/// The content of a file; empty fields do not apply.
struct FileContent {
  std::uint64_t tets = 0;  ///< 0: no map
  std::uint64_t cells = 0;
  std::uint64_t points = 0;
  std::optional<Box> box;
  double largestParameter = 0;
  std::optional<Certificate> certificate;
  CellFaults faults;
  std::vector<NamedPatch> boundary;
  std::optional<MeshSummary> summary;
  bool isMap = false;
  std::vector<CellCount> types;  ///< of a mesh

  /// Whether there are cells other than the hexahedra that the other fields describe.
  [[nodiscard]] bool isMixed() const noexcept { return types.size() > 1; }
};

FileContent contentOf(const TetMap& map) {
  FileContent content;
  content.isMap = true;
  content.tets = map.tets.size();
  content.points = map.points.size();
  content.box = boxOf(map.points);
  for (const TetParameters& corners : map.parameters) {
    for (const Vec3& corner : corners) {
      for (const double x : corner) {
        content.largestParameter = std::max(content.largestParameter, std::abs(x));
      }
    }
  }
  return content;
}

FileContent contentOf(const HexMesh& mesh, double patchAngle, Context& context) {
  FileContent content;
  content.cells = mesh.cells.size();
  content.points = mesh.points.size();
  content.box = boxOf(mesh.points);
  if (!mesh.cells.empty()) content.certificate = certify(mesh, context);
  content.faults = findCellFaults(mesh, context);
  content.boundary = namedPatches(mesh, patchAngle, context);
  return content;
}

/// Content that is known without loading the mesh.
FileContent contentOf(const MeshSummary& summary) {
  FileContent content;
  content.cells = summary.cells;
  content.points = summary.points;
  if (summary.points > 0) content.box = Box{summary.lower, summary.upper};
  content.summary = summary;
  return content;
}

/// Reads a single file.
FileContent readFile(const InfoArguments& arguments, Context& context) {
  const MapSource& source = arguments.source;
  std::vector<CellCount> types;
  ReadOptions reading = source.options();
  reading.hexesOnly = true;
  reading.cellCounts = &types;
  FileContent content = [&] {
    if (arguments.pieces) return contentOf(summarizeFile(source.file, reading, context));
    const auto read = readMapOrHexMesh(source.file, reading, context);
    if (const auto* const map = std::get_if<TetMap>(&read)) return contentOf(*map);
    return contentOf(std::get<HexMesh>(read), arguments.patchAngle.degrees, context);
  }();
  if (!content.isMap) content.types = std::move(types);
  return content;
}

FileContent read(const InfoArguments& arguments, Context& context) {
  const MapSource& source = arguments.source;
  refuseIf(arguments.pieces && source.isPair(),
           "--pieces reads hexahedral meshes, but --tets and --polycube are a map.");
  if (source.isPair()) return contentOf(readMap(source, context));
  return readFile(arguments, context);
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

/// "; the first is cell 13"
std::string firstOf(std::uint64_t cell) { return fmt::format("; the first is cell {}", cell); }

/// Prints cells with invalid lists of corners.
void printFaults(const CellFaults& faults, std::uint64_t cells) {
  if (!faults.repeated.empty()) {
    printLine("repeated corners", counted(faults.repeated.size(), "cell") +
                                      (faults.repeated.size() == 1 ? " names" : " name") +
                                      " a vertex twice" + firstOf(faults.repeated.front()));
  }
  constexpr const char* kHow = "`hexhex convert --reorient`";
  if (!faults.mirrored.empty() && faults.mirrored.size() == cells) {
    printLine("orientation", fmt::format("the mesh is mirrored; {} reorients it", kHow));
  } else if (!faults.mirrored.empty()) {
    printLine("orientation", fmt::format("{} mirrored{}; {} reorients such cells",
                                         counted(faults.mirrored.size(), "cell"),
                                         firstOf(faults.mirrored.front()), kHow));
  }
  if (faults.notOrientable != kNone) {
    printLine("not orientable",
              fmt::format("cells around cell {}, as along a Moebius band", faults.notOrientable));
  }
  const auto printFaces = [](const char* label, std::uint64_t count, const FaceConflict& first) {
    if (count == 0) return;
    const auto& [a, b, c, d] = first.vertices;
    printLine(label, fmt::format("{}; the first is ({}, {}, {}, {}), of cells {} and {}",
                                 counted(count, "face"), a, b, c, d, first.cell, first.other));
  };
  printFaces("in the same direction", faults.sameDirectionFaces, faults.firstSameDirection);
  printFaces("of more than two cells", faults.overfullFaces, faults.firstOverfull);
}

void print(const FileContent& content) {
  fmt::print("{}\n", content.isMap ? "a tetrahedral mesh with an integer-grid map"
                     : content.isMixed()
                         ? "a mesh of several types of cells; quality is that of the hexahedra"
                         : "a hexahedral mesh");
  if (content.isMixed()) {
    for (const CellCount& type : content.types) printLine(type.name, std::to_string(type.count));
  } else {
    printLine(content.isMap ? "tets" : "cells",
              std::to_string(content.isMap ? content.tets : content.cells));
  }
  printLine(content.isMap ? "points" : "vertices", std::to_string(content.points));
  if (content.box) {
    const auto& [lower, upper] = *content.box;
    printLine("bounding box",
              fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", lower[0],
                          lower[1], lower[2], upper[0], upper[1], upper[2]));
  }
  if (content.isMap) {
    printLine("parameters", fmt::format("up to {:.6g} in size", content.largestParameter));
  }
  if (content.summary) {
    printLine("checksum of cells", checksumAsText(content.summary->cellChecksum));
    printLine("checksum of vertices", checksumAsText(content.summary->pointChecksum));
  }
  printFaults(content.faults, content.cells);
  if (!content.certificate) return;
  printQuality(*content.certificate);
  if (content.certificate->refuted > 0) {
    printLine("refuted", refutationAsText(*content.certificate));
  }
  printHistogram(content.certificate->quality);
  printPatches(content.boundary);
}

Json faultsAsJson(const CellFaults& faults) {
  const Json none(nullptr);
  return {{"repeated_corners", faults.repeated},
          {"mirrored", faults.mirrored},
          {"not_orientable", faults.notOrientable == kNone ? none : Json(faults.notOrientable)},
          {"faces_in_the_same_direction", faults.sameDirectionFaces},
          {"overfull_faces", faults.overfullFaces}};
}

Json asJson(const FileContent& content, const std::string& file) {
  Json json = {{"file", file}, {"kind", content.isMap ? "map" : "mesh"}};
  json[content.isMap ? "tets" : "cells"] = content.isMap ? content.tets : content.cells;
  json[content.isMap ? "points" : "vertices"] = content.points;
  json["lower"] = content.box ? Json(content.box->lower) : Json(nullptr);
  json["upper"] = content.box ? Json(content.box->upper) : Json(nullptr);
  if (content.isMixed()) {
    for (const CellCount& type : content.types) json["cell_types"][type.name] = type.count;
  }
  if (content.isMap) json["largest_parameter"] = content.largestParameter;
  if (content.summary) json["checksums"] = checksumsAsJson(*content.summary);
  if (content.certificate) {
    json["quality"] = qualityAsJson(*content.certificate);
    json["validity"] = validityAsJson(*content.certificate);
    json["faults"] = faultsAsJson(content.faults);
    json["boundary"] = boundaryAsJson(content.boundary);
  }
  return json;
}

int run(const InfoArguments& arguments) {
  LongRun longRun({}, {{"readMapPair", 1},
                       {"readMapOrHexMesh", 2},
                       {"readHexMeshTo", 2},
                       {"certify", 0.5},
                       {"findCellFaults", 0.3},
                       {"namedPatches", 0.3}});
  const FileContent content = read(arguments, longRun.context());
  longRun.finish();
  const std::string name = arguments.source.description();
  if (arguments.json) {
    fmt::print("{}", jsonText(asJson(content, name)));
  } else {
    fmt::print("{}: ", printable(name));
    print(content);
  }
  return kSuccess;
}

}  // namespace

Command addInfo(CLI::App& app) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* const parser = app.add_subcommand("info", "Describe what a file holds");
  addMapSource(*parser, arguments->source, "FILE",
               "A map or a hexahedral mesh; `hexhex formats` lists the\nformats");
  addInputFormat(*parser, arguments->source);
  CLI::Option* const angle = addPatchAngle(*parser, arguments->patchAngle);
  parser
      ->add_flag("--pieces", arguments->pieces,
                 "Read a mesh piece by piece, which needs hardly any\n"
                 "memory for .vtu; with checksums instead of quality and\npatches")
      ->excludes(angle);
  addJson(*parser, arguments->json);
  parser->footer("Example:\n  hexhex info sphere.vtu");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
