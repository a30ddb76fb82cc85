// `.hexex` files (see formats.hpp).
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/vertex_lists.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/number_source.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

// Minimum bytes of a vertex ("0 0 0") and a tet ("0 1 2 3" and twelve digits), with separators.
constexpr std::size_t kMinimumVertexBytes = 6;
constexpr std::size_t kMinimumTetBytes = 32;

// Each is a coordinate, corner or parameter.
constexpr std::size_t kTokensOfVertex = 3;
constexpr std::size_t kTokensOfTet = 16;

/// The boundary triangles: vertices ascending, in lexicographic order.
std::vector<std::array<Index, 3>> boundaryTriangles(const TetMap& map, Stage& stage) {
  constexpr std::size_t kGrain = 4096;  // vertices per block: a few tenths of a millisecond
  const adjacency::VertexLists<Index, std::uint64_t> tetsAt(
      map.points.size(), stage, [&map](const auto& add) {
        for (std::size_t t = 0; t < map.tets.size(); ++t) {
          for (const Index v : map.tets[t]) add(v, static_cast<Index>(t));
        }
      });
  return collectFromBlocks<std::array<Index, 3>>(
      stage, map.points.size(), kGrain,
      [&](std::size_t begin, std::size_t end, std::vector<std::array<Index, 3>>& boundary) {
        adjacency::forEachFace(
            std::span<const Tet>(map.tets), begin, end, tetsAt, [&](const auto& tets) {
              if (tets.size() > 1) return;
              boundary.push_back(adjacency::faceVertices(map.tets[tets[0].cell], tets[0].face));
              std::sort(boundary.back().begin(), boundary.back().end());
            });
      });
}

/// Reads a file from top to bottom.
class HexexReader {
 public:
  static constexpr std::string_view kFirst = "+0123456789";  // begins with the number of vertices

  HexexReader(std::string_view text, const std::string& fileName, Stage& stage, bool keepWalls)
      : scanner_(text, fileName, stage), stage_(stage), keepWalls_(keepWalls) {
    scanner_.makeIndex();
  }

  TetMap read() {
    readPoints();
    readTets();
    readTrailingSections();
    return std::move(map_);
  }

 private:
  void readPoints() {
    const std::size_t count = scanner_.readCount("vertices", kMinimumVertexBytes);
    map_.points.resize(count);
    scanner_.elements(count, kTokensOfVertex, [&](TextScanner& scanner, std::size_t vertex) {
      scanner.failIfAtEnd(vertex, count, "vertices");
      for (double& coordinate : map_.points[vertex]) {
        coordinate = scanner.number({"a coordinate of ", "vertex", vertex});
      }
    });
  }

  void readTets() {
    const std::size_t count = scanner_.readCount("tets", kMinimumTetBytes);
    map_.tets.resize(count);
    map_.parameters.resize(count);
    scanner_.elements(count, kTokensOfTet,
                      [this](TextScanner& scanner, std::size_t i) { readTet(scanner, i); });
  }

  void readTet(TextScanner& scanner, std::size_t tet) {
    scanner.failIfAtEnd(tet, map_.tets.size(), "tets");
    const auto vertices = static_cast<std::int64_t>(map_.points.size());
    for (Index& corner : map_.tets[tet]) {
      const std::int64_t vertex = scanner.integer({"a vertex of ", "tet", tet});
      if (vertex < 0 || vertex >= vertices) {
        scanner.fail(ErrorCode::IndexOutOfRange, Place{PlaceKind::Tet, tet}, "tet ", tet,
                     " names vertex ", scanner.currentToken(), ", but the ", vertices,
                     " vertices are numbered from 0.");
      }
      corner = static_cast<Index>(vertex);
    }
    for (Vec3& corner : map_.parameters[tet]) {
      for (double& parameter : corner) parameter = scanner.number({"a parameter of ", "tet", tet});
    }
  }

  // The sections after the tets have no keywords: their first lines distinguish them.
  void readTrailingSections() {
    std::vector<FeatureFace> walls;
    if (scanner_.countTokensOnLine() == 1) walls = readWalls();
    const std::size_t tokens = scanner_.countTokensOnLine();
    if (tokens == 3) readFeatures();
    if (tokens != 0 && scanner_.skipSpace()) {
      scanner_.fail(ErrorCode::FileSyntax, "expected the end of the file, found ",
                    quoted(scanner_.currentToken()),
                    ". After the last tet only walls (\"W\" and W lines \"v v v distance\") and "
                    "features (\"vertices edges faces\" and their lines) may follow.");
    }
    if (!keepWalls_) walls.clear();
    removeRepeated(map_.features.vertices);
    removeRepeated(map_.features.edges);
    removeRepeated(map_.features.faces);
    keepFacesThatSaySomething(std::move(walls));
  }

  /// Adds interior walls to the features, and drops features on the boundary if they cover all of
  /// it: without tags they carry no information, and would hide its smooth patches. Programs that
  /// trace motorcycle complexes list the boundary among both walls and features.
  void keepFacesThatSaySomething(std::vector<FeatureFace> walls) {
    std::vector<FeatureFace>& faces = map_.features.faces;
    if (faces.empty() && walls.empty()) return;
    const std::vector<std::array<Index, 3>> boundary = boundaryTriangles(map_, stage_);
    const auto isOnBoundary = [&boundary](const FeatureFace& face) {
      return std::binary_search(boundary.begin(), boundary.end(), keyOf(face));
    };
    const auto listed = std::count_if(faces.begin(), faces.end(), isOnBoundary);
    if (static_cast<std::size_t>(listed) == boundary.size()) std::erase_if(faces, isOnBoundary);
    std::erase_if(walls, isOnBoundary);
    // Features first, so that they win over walls with the same vertices.
    faces.insert(faces.end(), walls.begin(), walls.end());
    removeRepeated(faces);
  }

  std::vector<FeatureFace> readWalls() {
    constexpr std::size_t kMinimumWallBytes = 8;  // four digits with separators
    std::vector<FeatureFace> walls(scanner_.readCount("walls", kMinimumWallBytes));
    for (FeatureFace& wall : walls) {
      wall = {readVertices<3>("a vertex of a wall"), kHexexWallTag};
      static_cast<void>(scanner_.number("the distance of a wall"));
    }
    return walls;
  }

  void readFeatures() {
    constexpr std::size_t kMinimumIndexBytes = 2;  // one digit with a separator
    Features& features = map_.features;
    features.vertices.resize(scanner_.readCount("feature vertices", kMinimumIndexBytes));
    features.edges.resize(scanner_.readCount("feature edges", 2 * kMinimumIndexBytes));
    features.faces.resize(scanner_.readCount("feature faces", 3 * kMinimumIndexBytes));
    for (FeatureVertex& vertex : features.vertices) {
      vertex = {readVertices<1>("a feature vertex")[0], kHexexFeatureTag};
    }
    for (FeatureEdge& edge : features.edges) {
      edge = {readVertices<2>("a vertex of a feature edge"), kHexexFeatureTag};
    }
    for (FeatureFace& face : features.faces) {
      face = {readVertices<3>("a vertex of a feature face"), kHexexFeatureTag};
    }
  }

  template <std::size_t n>
  std::array<Index, n> readVertices(const char* what) {
    std::array<Index, n> vertices{};
    const auto count = static_cast<std::int64_t>(map_.points.size());
    for (Index& vertex : vertices) {
      const std::int64_t index = scanner_.integer(what);
      if (index < 0 || index >= count) {
        scanner_.fail(ErrorCode::IndexOutOfRange, what, " is ", scanner_.currentToken(),
                      ", but the ", count, " vertices are numbered from 0.");
      }
      vertex = static_cast<Index>(index);
    }
    return vertices;
  }

  TextSource scanner_;
  Stage& stage_;
  bool keepWalls_;
  TetMap map_;
};

void requireFeaturesInRange(const TetMap& map) {
  Index largest = 0;
  const auto look = [&largest](const auto& feature) {
    for (const Index v : verticesOf(feature)) largest = std::max(largest, v);
  };
  std::for_each(map.features.vertices.begin(), map.features.vertices.end(), look);
  std::for_each(map.features.edges.begin(), map.features.edges.end(), look);
  std::for_each(map.features.faces.begin(), map.features.faces.end(), look);
  if (map.features.empty() || largest < map.points.size()) return;
  throw Error(ErrorCode::InvalidArgument,
              concat("A feature names vertex ", largest, ", but the map has ", map.points.size(),
                     " vertices, numbered from 0."));
}

/// Writes tagged features; the format has no place for their tags.
void writeFeatures(const Features& features, LineWriter& lines, OutputFile& output) {
  const auto isTagged = [](const auto& feature) { return feature.tag != 0; };
  const auto count = [&](const auto& list) {
    return static_cast<std::uint64_t>(std::count_if(list.begin(), list.end(), isTagged));
  };
  const std::array<std::uint64_t, 3> counts = {count(features.vertices), count(features.edges),
                                               count(features.faces)};
  if (counts == std::array<std::uint64_t, 3>{}) return;
  const auto write = [&](const auto& list) {
    lines.write(
        list.size(), 3 * (kNumberRoom + 1),
        [&](char* place, std::size_t i) {
          if (!isTagged(list[i])) return place;
          return put(putNumbers(place, verticesOf(list[i])), '\n');
        },
        nullptr);
  };
  output.write(counts[0]).write(' ').write(counts[1]).write(' ').write(counts[2]).write('\n');
  write(features.vertices);
  write(features.edges);
  write(features.faces);
}

}  // namespace

TetMap readHexex(const Input& input, const ReadOptions& options, Stage& stage) {
  return readWith<HexexReader>(input, stage, options.keepWalls);
}

void writeHexex(const TetMap& map, OutputFile& output, const WriteOptions& /*options*/,
                Stage& stage) {
  withThreads(stage.context().threads(), [&] { requireWritable(map, stage); });
  requireFeaturesInRange(map);
  LineWriter lines(output, stage.context().threads());
  LoopProgress progress(stage, map.points.size() + map.tets.size());
  output.write(map.points.size()).write('\n');
  lines.write(
      map.points.size(), kTokensOfVertex * (kNumberRoom + 1),
      [&map](char* place, std::size_t i) { return put(putNumbers(place, map.points[i]), '\n'); },
      &progress);
  output.write(map.tets.size()).write('\n');
  lines.write(
      map.tets.size(), kTokensOfTet * (kNumberRoom + 1),
      [&map](char* place, std::size_t i) {
        place = putNumbers(place, map.tets[i]);
        for (const Vec3& corner : map.parameters[i]) place = putNumbers(put(place, ' '), corner);
        return put(place, '\n');
      },
      &progress);
  writeFeatures(map.features, lines, output);
}

}  // namespace hexhex::io
