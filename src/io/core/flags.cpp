// Labels of a tet mesh's boundary: the axis that each triangle faces in a polycube.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <base/sorted.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/surface/surface.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::io {
namespace {

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

/// Finds boundary vertices by position.
class Positions {
 public:
  Positions(const TetMesh& tets, const TetBoundary& boundary) : tets_(tets) {
    double size = 0;
    for (const Vec3& p : tets.points) {
      for (const double x : p) size = std::max(size, std::abs(x));
    }
    tolerance_ = std::max(kSamePosition * size, std::numeric_limits<double>::min());
    for (const Index v : boundary.vertices()) buckets_[bucketOf(tets.points[v])].push_back(v);
  }

  /// The nearest vertex within the tolerance.
  [[nodiscard]] std::optional<Index> find(const Vec3& p) const {
    std::optional<Index> best;
    double least = 1;
    const Bucket middle = bucketOf(p);
    for (int i = 0; i < 27; ++i) {
      const auto bucket =
          buckets_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (bucket == buckets_.end()) continue;
      for (const Index v : bucket->second) {
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const double d = (p[k] - tets_.points[v][k]) / tolerance_;
          squared += d * d;
        }
        if (squared > least) continue;
        least = squared;
        best = v;
      }
    }
    return best;
  }

 private:
  using Bucket = std::array<std::int64_t, 3>;
  [[nodiscard]] Bucket bucketOf(const Vec3& p) const {
    Bucket bucket{};
    // All vertices are far below the limit; NaN is clamped as well.
    constexpr double kLimit = 0x1p60;
    for (std::size_t k = 0; k < 3; ++k) {
      bucket[k] = std::llround(std::fmin(std::fmax(p[k] / tolerance_, -kLimit), kLimit));
    }
    return bucket;
  }

  const TetMesh& tets_;
  double tolerance_ = 0;
  std::map<Bucket, std::vector<Index>> buckets_;
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
