// Reads Wavefront OBJ and OFF: vertices and polygons as text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {
namespace {

/// Reads OBJ. Unsupported elements are skipped.
class ObjReader {
 public:
  static constexpr std::string_view kFirst = "#abcdefghijklmnopqrstuvwxyz";

  ObjReader(std::string_view text, const std::string& name, Stage& /*stage*/)
      : scanner_(text, name, TextScanner::Comments::Hash) {}

  TriangleMesh read() {
    while (scanner_.skipSpace()) {
      const std::string_view keyword = scanner_.readToken();
      if (keyword == "v") {
        Vec3& p = mesh_.points.emplace_back();
        for (double& x : p) x = scanner_.number("a coordinate");
      } else if (keyword == "f") {
        readFace();
        continue;
      }
      static_cast<void>(scanner_.takeLine());
    }
    return std::move(mesh_);
  }

 private:
  void readFace() {
    const std::size_t count = scanner_.countTokensOnLine();
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) corners_.push_back(readCorner());
    if (count < 3) scanner_.fail(ErrorCode::FileSyntax, "a face has fewer than three corners.");
    addPolygon(mesh_, corners_);
  }

  /// Reads a vertex index: from 1 on, or negative, where -1 is the last vertex before the face.
  Index readCorner() {
    const std::string_view token = scanner_.readToken();
    const std::string_view number = token.substr(0, token.find('/'));
    std::int64_t vertex = 0;
    const bool isInteger = parseInteger(number, vertex);
    const auto count = static_cast<std::int64_t>(mesh_.points.size());
    const std::int64_t place = vertex < 0 ? count + vertex : vertex - 1;
    if (isInteger && place >= 0 && place < count) return static_cast<Index>(place);
    scanner_.fail(ErrorCode::FileSyntax, "a corner of a face is ", quoted(token),
                  ", which names no vertex before it.");
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
};

/// Reads OFF: one vertex or face per line; what follows, such as colours, is skipped.
class OffReader {
 public:
  static constexpr std::string_view kFirst = {};  // comments may come first

  OffReader(std::string_view text, const std::string& name, Stage& /*stage*/)
      : scanner_(text, name, TextScanner::Comments::Hash) {}

  TriangleMesh read() {
    readHead();
    const std::size_t points = scanner_.readCount("vertices", kLeastLine);
    const std::size_t faces = scanner_.readCount("faces", kLeastLine);
    static_cast<void>(scanner_.integer("the number of edges"));
    for (std::size_t i = 0; i < points; ++i) {
      scanner_.failIfAtEnd(i, points, "vertices");
      Vec3& p = mesh_.points.emplace_back();
      for (double& x : p) x = scanner_.number({"a coordinate of ", "vertex", i});
      static_cast<void>(scanner_.takeLine());
    }
    for (std::size_t i = 0; i < faces; ++i) {
      scanner_.failIfAtEnd(i, faces, "faces");
      readFace();
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t kLeastLine = 2;  ///< bytes: a digit and the line end

  void readHead() {
    const std::string_view word = scanner_.readToken();
    if (!word.ends_with("OFF")) {
      scanner_.fail(ErrorCode::FileSyntax, "an .off file begins with \"OFF\", found ", quoted(word),
                    ".");
    }
    if (word.find_first_of("4n") != std::string_view::npos || scanner_.peekToken() == "BINARY") {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "only text with three coordinates per vertex is read.");
    }
  }

  void readFace() {
    const std::size_t count = scanner_.readCount("corners of a face", kLeastLine);
    corners_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t vertex = scanner_.integer("a corner of a face");
      if (!std::in_range<Index>(vertex) || static_cast<Index>(vertex) >= mesh_.points.size()) {
        scanner_.fail(ErrorCode::IndexOutOfRange, "a corner of a face is ", vertex,
                      ", but there are ", mesh_.points.size(), " vertices, counted from 0.");
      }
      corners_.push_back(static_cast<Index>(vertex));
    }
    static_cast<void>(scanner_.takeLine());
    addPolygon(mesh_, corners_);
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
};

}  // namespace

TriangleMesh readObj(const Input& input, Stage& stage) { return readWith<ObjReader>(input, stage); }

TriangleMesh readOff(const Input& input, Stage& stage) { return readWith<OffReader>(input, stage); }

}  // namespace hexhex::io
