#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/structure.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <improve/sound_input.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kCellGrain = 4096;

std::string cellsAsText(std::uint64_t count) {
  return concat(count, count == 1 ? " cell" : " cells");
}

void requireNoRepeats(const HexMesh& mesh, const CellFaults& faults, std::size_t parts) {
  if (faults.repeated.empty()) return;
  const std::uint64_t bad = faults.repeated.front();
  Hex corners = mesh.cells[bad];
  std::sort(corners.begin(), corners.end());
  const Index twice = *std::adjacent_find(corners.begin(), corners.end());
  throw Error(
      ErrorCode::RepeatedVertex,
      concat("Cell ", bad / parts, " names vertex ", twice,
             " twice, like a prism that is written as a hexahedron (",
             cellsAsText(faults.repeated.size()),
             " in all). Such a cell is not positive wherever its vertices are: make the mesh "
             "of hexahedra only."),
      Place{PlaceKind::Cell, bad / parts});
}

/// "face (3, 4, 12, 11)"
std::string faceAsText(const FaceConflict& face) {
  std::string text = "face (";
  for (const Index v : face.vertices) text += concat(v, ", ");
  text.resize(text.size() - 2);
  return text + ")";
}

void requireTwoCellsAtFaces(const CellFaults& faults, std::size_t parts) {
  if (faults.overfullFaces == 0) return;
  const FaceConflict& face = faults.firstOverfull;
  throw Error(ErrorCode::NonManifoldFace,
              concat("The ", faceAsText(face), " belongs to ", face.cells, " cells, cells ",
                     face.cell / parts, " and ", face.other / parts,
                     " among them; more than two overlap. Remove cells that are there twice."),
              Place{PlaceKind::Cell, face.cell / parts});
}

constexpr const char* kHowToTurn = "`hexhex convert --reorient` turns such cells round.";

void requireOppositeDirections(const HexMesh& mesh, const CellFaults& faults, std::size_t parts) {
  if (faults.sameDirectionFaces == 0) return;
  const FaceConflict& face = faults.firstSameDirection;
  const auto isMirrored = [&](std::uint64_t cell) {
    return std::binary_search(faults.mirrored.begin(), faults.mirrored.end(), cell);
  };
  const std::uint64_t bad = isMirrored(face.other) ? face.other : face.cell;
  std::string sentence =
      concat("Cells ", face.cell / parts, " and ", face.other / parts, " pass their common ",
             faceAsText(face), " in the same direction: ");
  Hex here = mesh.cells[face.cell];
  Hex there = mesh.cells[face.other];
  std::sort(here.begin(), here.end());
  std::sort(there.begin(), there.end());
  if (here == there) {
    sentence += "they have the same corners. Remove one of them.";
  } else if (!isMirrored(bad)) {
    sentence +=
        "cells around there cannot be listed so that all neighbours agree, as along a Moebius "
        "band. No positions make them positive.";
  } else {
    sentence += concat("cell ", bad / parts, " lists its corners the other way round (",
                       faults.mirrored.size() / parts, " of ",
                       cellsAsText(mesh.cells.size() / parts), " in all). ", kHowToTurn);
  }
  throw Error(ErrorCode::Orientation, sentence, Place{PlaceKind::Cell, bad / parts});
}

void requireUnmirrored(const HexMesh& mesh, const CellFaults& faults, std::size_t parts) {
  if (faults.mirrored.empty()) return;
  if (faults.mirrored.size() == mesh.cells.size()) {
    throw Error(ErrorCode::Orientation,
                "The mesh is mirrored: all cells list their corners the other way round, and are "
                "inside out. `hexhex convert --reorient` turns it round.");
  }
  const std::uint64_t first = faults.mirrored.front() / parts;
  throw Error(
      ErrorCode::Orientation,
      concat("Cell ", first,
             " is in a part of the mesh that is mirrored: it lists its corners the other way "
             "round (",
             faults.mirrored.size() / parts, " of ", cellsAsText(mesh.cells.size() / parts),
             " in all). ", kHowToTurn),
      Place{PlaceKind::Cell, first});
}

/// Whether two cells share faces that meet at an edge.
bool shareFacesAtAnEdge(const Hex& a, const Hex& b) {
  const auto facesOf = [](const Hex& cell) {
    std::array<Quad, 6> faces{};
    for (std::size_t f = 0; f < 6; ++f) faces[f] = sorted(adjacency::faceVertices(cell, f));
    return faces;
  };
  const std::array<Quad, 6> ofB = facesOf(b);
  std::vector<Quad> common;
  for (const Quad& face : facesOf(a)) {
    if (std::find(ofB.begin(), ofB.end(), face) != ofB.end()) common.push_back(face);
  }
  // Of three or more faces, two always meet.
  return common.size() > 2 ||
         (common.size() == 2 &&
          std::find_first_of(common[0].begin(), common[0].end(), common[1].begin(),
                             common[1].end()) != common[0].end());
}

/// A ball that contains the generator of a vertex.
struct Ball {
  Vec3 centre{};
  double radius = 0;
};

Ball generatorOf(const HexMesh& mesh, const TetMapView& map, Index vertex) {
  const Tet& tet = map.tets[mesh.generatorTet[vertex]];
  const auto isCorner = [&](std::size_t i) {
    return (mesh.generatorCorners[vertex] >> i & 1U) != 0;
  };
  Ball ball;
  double count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!isCorner(i)) continue;
    ball.centre = plus(ball.centre, map.points[tet[i]]);
    ++count;
  }
  for (double& x : ball.centre) x /= count;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!isCorner(i)) continue;
    ball.radius = std::max(ball.radius, length(minus(map.points[tet[i]], ball.centre)));
  }
  return ball;
}

/// Lower bound of the distance of a vertex from its generator.
double offsetOf(const HexMesh& mesh, const TetMapView& map, Index vertex) {
  const Ball ball = generatorOf(mesh, map, vertex);
  return std::max(0.0, length(minus(mesh.points[vertex], ball.centre)) - ball.radius);
}

/// Whether the corners of a cell are, on average, farther from their generators than its longest
/// edge is long.
bool isElsewhere(const HexMesh& mesh, const TetMapView& map, const Hex& cell) {
  double longest = 0;
  for (const auto& edge : adjacency::kHexEdges) {
    const Vec3 along = minus(mesh.points[cell[edge[0]]], mesh.points[cell[edge[1]]]);
    longest = std::max(longest, length(along));
  }
  double offset = 0;
  for (const Index v : cell) offset += offsetOf(mesh, map, v);
  return offset > 8 * longest;
}

/// "(1.5, 0, -2)"
std::string pointAsText(const Vec3& point) {
  std::string text = "(";
  for (const double x : point) {
    constexpr int kDigits = 6;
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x,
                                   std::chars_format::general, kDigits);
    text.append(digits.data(), end.ptr).append(", ");
  }
  text.resize(text.size() - 2);
  return text + ")";
}

}  // namespace

void requireSoundCells(const HexMesh& mesh, std::size_t parts, Context& context) {
  const CellFaults faults = findCellFaults(mesh, context);
  if (!faults.any()) return;
  requireNoRepeats(mesh, faults, parts);
  requireTwoCellsAtFaces(faults, parts);
  requireOppositeDirections(mesh, faults, parts);
  requireUnmirrored(mesh, faults, parts);
}

Array<std::uint64_t> cellsThatCannotBePositive(const HexMesh& mesh, std::size_t parts,
                                               const Certificate& certificate, Stage& stage) {
  Array<std::uint64_t> cells;
  if (certificate.allPositive()) return cells;
  const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
  const auto sharesWithAnother = [&](std::size_t c) {
    return std::any_of(mesh.cells[c].begin(), mesh.cells[c].end(), [&](Index v) {
      return std::any_of(around(v).begin(), around(v).end(), [&](Index other) {
        return other != c && shareFacesAtAnEdge(mesh.cells[c], mesh.cells[other]);
      });
    });
  };
  for (std::size_t cell = 0; cell < certificate.validity.size(); ++cell) {
    if (certificate.validity[cell] == Validity::Positive) continue;
    for (std::size_t c = cell * parts; c < (cell + 1) * parts; ++c) {
      if (!sharesWithAnother(c)) continue;
      cells.push_back(cell);
      break;
    }
  }
  return cells;
}

void requireSameObject(const HexMesh& mesh, const TetMapView& map, Stage& stage) {
  std::vector<std::uint64_t> counts(blockCount(mesh.cells.size(), kCellGrain));
  parallelBlocks(stage, mesh.cells.size(), kCellGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t c = begin; c < end; ++c) {
                     counts[block] += isElsewhere(mesh, map, mesh.cells[c]) ? 1U : 0U;
                   }
                 });
  std::uint64_t elsewhere = 0;
  for (const std::uint64_t count : counts) elsewhere += count;
  if (10 * elsewhere <= mesh.cells.size()) return;
  Index worst = 0;
  for (Index v = 1; v < mesh.points.size(); ++v) {
    if (offsetOf(mesh, map, v) > offsetOf(mesh, map, worst)) worst = v;
  }
  throw Error(ErrorCode::InvalidArgument,
              concat("The mesh is not where the map is: ", elsewhere, " of ",
                     cellsAsText(mesh.cells.size()),
                     " are farther from where they come from than they are long. Vertex ", worst,
                     " is at ", pointAsText(mesh.points[worst]), ", but comes from ",
                     pointAsText(generatorOf(mesh, map, worst).centre),
                     ". Give the map that the mesh was extracted from, or none."),
              Place{PlaceKind::Vertex, worst});
}

}  // namespace hexhex::improvement
