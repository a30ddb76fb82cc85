// Builds a map from a pair of tet meshes: the object and its polycube.
#include <algorithm>
#include <array>
#include <string>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kTetPairGrain = std::size_t{1} << 13;

/// How messages name the two meshes, and the error if they do not match.
struct PairNames {
  std::string tets;
  std::string polycube;
  ErrorCode mismatch;
};

std::string vertices(const Tet& tet) {
  std::string text;
  for (const Index vertex : tet) text += concat((text.empty() ? "" : " "), vertex);
  return text;
}

void requireSame(std::size_t tets, std::size_t polycube, const char* what, const PairNames& names) {
  if (tets == polycube) return;
  throw Error(
      names.mismatch,
      concat(names.tets, " has ", tets, " ", what, ", but ", names.polycube, " has ", polycube,
             ": the two meshes must have the same vertices and tets, in the same order."));
}

/// Whether two tets have the same corners, in any order.
bool sameVertices(const Tet& a, const Tet& b) {
  return std::is_permutation(a.begin(), a.end(), b.begin());
}

TetMap combine(const TetMesh& tets, const TetMesh& polycube, const PairNames& names, Stage& stage) {
  requireSame(tets.points.size(), polycube.points.size(), "vertices", names);
  requireSame(tets.tets.size(), polycube.tets.size(), "tets", names);
  const std::size_t count = tets.tets.size();
  const auto inRange = [&](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](Index v) { return v < tets.points.size(); });
  };
  const std::size_t fault = firstFault(stage, count, [&](std::size_t t) {
    return sameVertices(tets.tets[t], polycube.tets[t]) && inRange(tets.tets[t]);
  });
  if (fault < count) {
    const Place place{PlaceKind::Tet, fault};
    if (!inRange(tets.tets[fault])) {
      throw Error(ErrorCode::IndexOutOfRange,
                  concat("Tet ", fault, " of ", names.tets, " names a vertex that does not exist."),
                  place);
    }
    throw Error(names.mismatch,
                concat("Tet ", fault, " has the vertices ", vertices(tets.tets[fault]), " in ",
                       names.tets, ", but ", vertices(polycube.tets[fault]), " in ", names.polycube,
                       ": the two meshes must have the same tets, in the same order."),
                place);
  }
  TetMap map;
  map.points = tets.points;
  map.tets = tets.tets;
  map.features = tets.features;
  map.regions = tets.regions;
  map.parameters.resize(count);
  parallelFor(stage, count, kTetPairGrain, [&](std::size_t t) {
    for (std::size_t i = 0; i < 4; ++i) map.parameters[t][i] = polycube.points[map.tets[t][i]];
  });
  return map;
}

}  // namespace

}  // namespace hexhex::io

namespace hexhex {

TetMap mapFromPair(const TetMesh& tets, const TetMesh& polycube, Context& context) {
  const io::PairNames names = {"The mesh", "the polycube", ErrorCode::InvalidArgument};
  constexpr std::array<WorkStep, 1> kOnly = {{{"pair meshes", 1}}};
  return inSteps(context, "mapFromPair", kOnly, [&] {
    return io::inStage(context, "pair meshes",
                       [&](Stage& stage) { return io::combine(tets, polycube, names, stage); });
  });
}

TetMap readMapPair(const std::filesystem::path& tets, const std::filesystem::path& polycube,
                   Context& context) {
  constexpr std::array<WorkStep, 3> kSteps = {
      {{"readTetMesh", 1}, {"readTetMesh", 1}, {"pair meshes", 0.2}}};
  return inSteps(context, "readMapPair", kSteps, [&] {
    const TetMesh first = readTetMesh(tets, {}, context);
    const TetMesh second = readTetMesh(polycube, {}, context);
    const io::PairNames names = {tets.string(), polycube.string(), ErrorCode::FileUnsupported};
    return io::inStage(context, "pair meshes",
                       [&](Stage& stage) { return io::combine(first, second, names, stage); });
  });
}

}  // namespace hexhex
