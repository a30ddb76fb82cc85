// What files tell of the polycube of a tet mesh: its vertices, in a second tet mesh, or the axis
// that each triangle of the boundary faces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <base/vector3.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::io {
namespace {

// A pair of tet meshes: the object and its polycube.

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

// Labels of the boundary.

using Flags = std::vector<std::array<std::int8_t, 4>>;
using SurfaceTriangle = std::array<Index, 3>;

/// Tolerance, relative to the object's size, between positions of the surface and of the tets: text
/// files may have only six digits.
constexpr double kSamePosition = 1e-5;

[[noreturn]] void refuseFlags(const std::filesystem::path& file, const std::string& sentence,
                              Place place = {}) {
  throw Error(ErrorCode::FileUnsupported, file.string() + ": " + sentence, place);
}

SurfaceTriangle sortedCorners(SurfaceTriangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// The faces of a tet mesh; those of a single tet form the boundary.
class TetBoundary {
 public:
  explicit TetBoundary(const TetMesh& tets) {
    for (Index t = 0; t < tets.tets.size(); ++t) {
      for (std::size_t face = 0; face < 4; ++face) {
        SurfaceTriangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = tets.tets[t][static_cast<std::size_t>(lattice::kFaceCorners[face][k])];
        }
        const auto [found, isNew] = faces_.try_emplace(sortedCorners(corners), Face{t, face});
        if (!isNew) found->second.isInner = true;
      }
    }
  }

  struct Face {
    Index tet = 0;
    std::size_t face = 0;
    bool isInner = false;
  };
  /// Null if no tet has this face.
  [[nodiscard]] const Face* find(const SurfaceTriangle& triangle) const {
    const auto found = faces_.find(sortedCorners(triangle));
    return found == faces_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(std::count_if(faces_.begin(), faces_.end(),
                                                  [](const auto& f) { return !f.second.isInner; }));
  }
  /// All boundary vertices, ascending.
  [[nodiscard]] std::vector<Index> vertices() const {
    std::vector<Index> all;
    for (const auto& [triangle, face] : faces_) {
      if (!face.isInner) all.insert(all.end(), triangle.begin(), triangle.end());
    }
    sortUnique(all);
    return all;
  }

 private:
  std::map<SurfaceTriangle, Face> faces_;
};

/// Assigns the labels of triangles to the matching faces of tets.
Flags placed(const TriangleLabels& found, const TetMesh& tets, const TetBoundary& boundary,
             const std::filesystem::path& file) {
  Flags flags(tets.tets.size(), {-1, -1, -1, -1});
  for (std::size_t i = 0; i < found.triangles.size(); ++i) {
    const TetBoundary::Face* const face = boundary.find(found.triangles[i]);
    if (face == nullptr || face->isInner) {
      refuseFlags(file,
                  concat("triangle ", i, " (counted from 0) is ",
                         (face == nullptr ? "no face of a tet." : "inside of the tet mesh.")));
    }
    if (found.labels[i] < 0 || found.labels[i] > 5) {
      refuseFlags(file, concat("triangle ", i, " (counted from 0) has the label ", found.labels[i],
                               "; labels are 0 to 5 for +x -x +y -y +z -z."));
    }
    flags[face->tet][face->face] = static_cast<std::int8_t>(found.labels[i]);
  }
  return flags;
}

std::vector<std::int64_t> readLabelNumbers(const Input& input, Stage& stage) {
  Array<char> room;
  TextScanner scanner(input.text(room, stage, "#+-0123456789"), input.name(),
                      TextScanner::Comments::Hash);
  std::vector<std::int64_t> numbers;
  while (scanner.skipSpace()) numbers.push_back(scanner.integer("a label"));
  return numbers;
}

/// Finds boundary vertices by position: sorted along a direction along which few are level.
class Positions {
 public:
  Positions(const TetMesh& tets, const TetBoundary& boundary) : tets_(tets) {
    double size = 0;
    for (const Vec3& p : tets.points) {
      for (const double x : p) size = std::max(size, std::abs(x));
    }
    tolerance_ = std::max(kSamePosition * size, std::numeric_limits<double>::min());
    for (const Index v : boundary.vertices()) {
      // One that is nowhere has no place in an order.
      if (isFinite(tets.points[v])) places_.emplace_back(placeOf(tets.points[v]), v);
    }
    std::sort(places_.begin(), places_.end());
  }

  /// The nearest vertex within the tolerance.
  [[nodiscard]] std::optional<Index> find(const Vec3& p) const {
    std::optional<Index> best;
    double least = 1;
    const double reach = 2 * tolerance_;  // the direction is shorter than that
    auto at =
        std::lower_bound(places_.begin(), places_.end(), std::pair(placeOf(p) - reach, Index{0}));
    for (; at != places_.end() && at->first <= placeOf(p) + reach; ++at) {
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = (p[k] - tets_.points[at->second][k]) / tolerance_;
        squared += d * d;
      }
      if (squared > least) continue;
      least = squared;
      best = at->second;
    }
    return best;
  }

 private:
  // A direction that hardly any object is aligned with: its ratios are not simple.
  static double placeOf(const Vec3& p) { return p[0] + 0.754877666 * p[1] + 0.569840291 * p[2]; }

  const TetMesh& tets_;
  double tolerance_ = 0;
  std::vector<std::pair<double, Index>> places_;
};

/// Labels given per triangle of a surface.
TriangleLabels onSurface(const FlagsFile& flags, std::vector<std::int64_t> labels,
                         const TetMesh& tets, const TetBoundary& boundary, Stage& stage) {
  const TriangleMesh surface = readObj(flags.surface, stage);
  if (labels.size() != surface.triangles.size()) {
    refuseFlags(flags.file,
                concat("there are ", labels.size(), " labels, but ", surface.triangles.size(),
                       " triangles in ", flags.surface.string(), "."));
  }
  const Positions positions(tets, boundary);
  std::vector<Index> vertexOf;
  for (const Vec3& p : surface.points) {
    const std::optional<Index> vertex = positions.find(p);
    vertexOf.push_back(vertex.value_or(kNone));
  }
  TriangleLabels result{surface.triangles, std::move(labels)};
  for (SurfaceTriangle& triangle : result.triangles) {
    for (Index& v : triangle) {
      if (vertexOf[v] == kNone) {
        refuseFlags(flags.surface,
                    concat("vertex ", v + 1,
                           " is no boundary vertex of the tet mesh: no position agrees."));
      }
      v = vertexOf[v];
    }
  }
  return result;
}

/// Labels given per face of a tet, four for each tet.
Flags perFace(const std::vector<std::int64_t>& numbers, const FlagsFile& flags, const TetMesh& tets,
              const TetBoundary& boundary) {
  if (numbers.size() != 4 * tets.tets.size()) {
    refuseFlags(
        flags.file,
        concat("there are ", numbers.size(), " labels; expected four for each of ",
               tets.tets.size(), " tets",
               (numbers.size() == boundary.size()
                    ? ". They are as many as the boundary has triangles: name the surface whose "
                      "triangles they belong to (--surface)."
                    : ", or one for each triangle of a surface (--surface).")));
  }
  Flags result(tets.tets.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < -1 || numbers[i] > 5) {
      refuseFlags(flags.file,
                  concat("label ", i, " (counted from 0) is ", numbers[i],
                         "; labels are 0 to 5 for +x -x +y -y +z -z, and -1 for none."));
    }
    result[i / 4][i % 4] = static_cast<std::int8_t>(numbers[i]);
  }
  return result;
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

io::Flags readFlags(const FlagsFile& flags, const TetMesh& tets, Context& context) {
  const std::string extension = io::lowerCaseExtension(flags.file);
  const io::TetBoundary boundary(tets);
  return io::inStage(context, "read labels", [&](Stage& stage) {
    if (extension == ".vtu" || extension == ".vtk") {
      const auto read = extension == ".vtu" ? io::readVtuLabels : io::readVtkLegacyLabels;
      return io::placed(read(flags.file, flags.array, stage), tets, boundary, flags.file);
    }
    std::vector<std::int64_t> numbers = io::readLabelNumbers(flags.file, stage);
    if (flags.surface.empty()) return io::perFace(numbers, flags, tets, boundary);
    return io::placed(io::onSurface(flags, std::move(numbers), tets, boundary, stage), tets,
                      boundary, flags.file);
  });
}

}  // namespace hexhex
