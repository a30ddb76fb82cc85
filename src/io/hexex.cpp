#include <algorithm>
#include <cmath>
#include <cstdint>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/hexex.hpp>
#include <io/input_file.hpp>
#include <io/output_file.hpp>
#include <io/text_scanner.hpp>

namespace hexhex {
namespace {

// The shortest that a vertex ("0 0 0") and a tet ("0 1 2 3" and twelve digits) can be, with
// separators.
constexpr std::size_t kMinimumVertexBytes = 6;
constexpr std::size_t kMinimumTetBytes = 32;

// Elements between two reports of progress: a fraction of a millisecond's work.
constexpr std::size_t kProgressGrain = 4096;

/// Reads one file from top to bottom.
class HexexReader {
 public:
  HexexReader(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName), stage_(stage) {}

  TetMap read() {
    readPoints();
    readTets();
    skipTrailingSections();
    return std::move(map_);
  }

 private:
  void readPoints();
  void readTets();
  void readCorners(std::size_t tet);
  void readParameters(std::size_t tet);
  void skipTrailingSections();
  void skipWalls();
  void skipFeatures();
  void skipIndices(std::size_t count, const char* what);
  void failIfAtEnd(std::size_t done, std::size_t count, const char* what);

  TextScanner scanner_;
  Stage& stage_;
  TetMap map_;
};

void HexexReader::failIfAtEnd(std::size_t done, std::size_t count, const char* what) {
  if (scanner_.skipSpace()) return;
  scanner_.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                           std::to_string(count) + " " + what +
                                           ": it is incomplete.");
}

void HexexReader::readPoints() {
  const std::size_t count = scanner_.readCount("vertices", kMinimumVertexBytes);
  map_.points.resize(count);
  LoopProgress progress(stage_, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, count - i));
    failIfAtEnd(i, count, "vertices");
    for (double& coordinate : map_.points[i]) {
      if (!scanner_.readNumber(coordinate)) {
        scanner_.failNumber("a coordinate of vertex " + std::to_string(i));
      }
    }
  }
}

void HexexReader::readTets() {
  const std::size_t count = scanner_.readCount("tets", kMinimumTetBytes);
  map_.tets.resize(count);
  map_.parameters.resize(count);
  LoopProgress progress(stage_, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, count - i));
    failIfAtEnd(i, count, "tets");
    readCorners(i);
    readParameters(i);
  }
}

void HexexReader::readCorners(std::size_t tet) {
  const auto vertices = static_cast<std::int64_t>(map_.points.size());
  for (Index& corner : map_.tets[tet]) {
    std::int64_t vertex = 0;
    if (!scanner_.readInteger(vertex)) {
      scanner_.failInteger("a vertex of tet " + std::to_string(tet));
    }
    if (vertex < 0 || vertex >= vertices) {
      scanner_.fail(ErrorCode::IndexOutOfRange,
                    "tet " + std::to_string(tet) + " names vertex " +
                        std::string(scanner_.currentToken()) + ", but the " +
                        std::to_string(vertices) + " vertices are numbered from 0.",
                    Place{PlaceKind::Tet, tet});
    }
    corner = static_cast<Index>(vertex);
  }
}

void HexexReader::readParameters(std::size_t tet) {
  for (Vec3& corner : map_.parameters[tet]) {
    for (double& parameter : corner) {
      if (!scanner_.readNumber(parameter)) {
        scanner_.failNumber("a parameter of tet " + std::to_string(tet));
      }
    }
  }
}

// No keyword announces the sections after the tets: their first line tells them apart.
void HexexReader::skipTrailingSections() {
  if (scanner_.countTokensOnLine() == 1) skipWalls();
  const std::size_t tokens = scanner_.countTokensOnLine();
  if (tokens == 0) return;
  if (tokens == 3) skipFeatures();
  if (!scanner_.skipSpace()) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "expected the end of the file, found " + quoted(scanner_.currentToken()) +
                    ". After the last tet only walls (\"W\" and W lines \"v v v distance\") and "
                    "features (\"vertices edges faces\" and their lines) may follow.");
}

void HexexReader::skipWalls() {
  constexpr std::size_t kMinimumWallBytes = 8;  // four digits with separators
  const std::size_t walls = scanner_.readCount("walls", kMinimumWallBytes);
  for (std::size_t i = 0; i < walls; ++i) {
    skipIndices(3, "a vertex of a wall");
    double distance = 0;
    if (!scanner_.readNumber(distance)) scanner_.failNumber("the distance of a wall");
  }
}

void HexexReader::skipFeatures() {
  constexpr std::size_t kMinimumIndexBytes = 2;  // one digit with a separator
  const std::size_t vertices = scanner_.readCount("feature vertices", kMinimumIndexBytes);
  const std::size_t edges = scanner_.readCount("feature edges", 2 * kMinimumIndexBytes);
  const std::size_t faces = scanner_.readCount("feature faces", 3 * kMinimumIndexBytes);
  skipIndices(vertices, "a feature vertex");
  skipIndices(2 * edges, "a vertex of a feature edge");
  skipIndices(3 * faces, "a vertex of a feature face");
}

void HexexReader::skipIndices(std::size_t count, const char* what) {
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t index = 0;
    if (!scanner_.readInteger(index)) scanner_.failInteger(what);
  }
}

/// Refuses what could not be read back.
void requireWritable(const TetMap& map) {
  if (map.parameters.size() != map.tets.size()) {
    throw Error(ErrorCode::InvalidArgument, "The map has " + std::to_string(map.tets.size()) +
                                                " tets but parameters for " +
                                                std::to_string(map.parameters.size()) + ".");
  }
  const auto isFinite = [](const Vec3& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
  };
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    if (isFinite(map.points[i])) continue;
    throw Error(ErrorCode::NotFinite,
                "A coordinate of vertex " + std::to_string(i) + " is not finite.",
                Place{PlaceKind::Vertex, i});
  }
  for (std::size_t i = 0; i < map.parameters.size(); ++i) {
    if (std::all_of(map.parameters[i].begin(), map.parameters[i].end(), isFinite)) continue;
    throw Error(ErrorCode::NotFinite, "A parameter of tet " + std::to_string(i) + " is not finite.",
                Place{PlaceKind::Tet, i});
  }
}

}  // namespace

TetMap parseHexex(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read map");
  return HexexReader(text, fileName, stage).read();
}

TetMap readHexex(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read map");
  const Array<char> bytes = readWholeFile(file);
  return HexexReader(asText(bytes), file.string(), stage).read();
}

void writeHexex(const TetMap& map, const std::filesystem::path& file) {
  requireWritable(map);
  OutputFile output(file);
  output.write(map.points.size()).write('\n');
  for (const Vec3& point : map.points) {
    output.write(point[0]).write(' ').write(point[1]).write(' ').write(point[2]).write('\n');
  }
  output.write(map.tets.size()).write('\n');
  for (std::size_t i = 0; i < map.tets.size(); ++i) {
    const Tet& tet = map.tets[i];
    output.write(tet[0]);
    for (const std::size_t corner : {1U, 2U, 3U}) output.write(' ').write(tet[corner]);
    for (const Vec3& corner : map.parameters[i]) {
      for (const double parameter : corner) output.write(' ').write(parameter);
    }
    output.write('\n');
  }
  output.commit();
}

}  // namespace hexhex
