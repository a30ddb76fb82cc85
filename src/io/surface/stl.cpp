// Reads STL: three corners per triangle, text or binary.
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>
#include <io/core/bytes.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {
namespace {

class StlReader {
 public:
  static constexpr std::string_view kFirst = {};

  StlReader(std::string_view text, const std::string& name, Stage& /*stage*/)
      : text_(text), name_(name) {}

  /// Some programs begin binary files with "solid" as well; the file size decides.
  TriangleMesh read() {
    TextScanner begin(text_.substr(0, kHead), name_);
    const bool isText = lowerCase(begin.peekToken()) == "solid";
    const std::uint64_t count =
        text_.size() < kHead ? 0 : loadLittle<std::uint32_t>(text_.data() + kHead - 4);
    const bool fits = text_.size() >= kHead && text_.size() == kHead + count * kEach;
    if (isText && !fits) {
      readText();
    } else {
      readBytes(count);
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::size_t kHead = 84;  ///< including the number of triangles
  static constexpr std::size_t kEach = 50;  ///< a normal, three corners, two bytes
  static constexpr std::size_t kNormal = 12;

  void readBytes(std::uint64_t count) {
    ByteCursor cursor(text_, text_, name_);
    static_cast<void>(cursor.take(kHead, "the head of a binary .stl file"));
    if (cursor.remaining() / kEach < count) {
      cursor.failAt(kHead - 4, ErrorCode::FileSyntax,
                    lacksRoom(std::to_string(count), "triangles", cursor.remaining() / kEach));
    }
    mesh_.points.reserve(3 * count);
    for (std::uint64_t t = 0; t < count; ++t) {
      static_cast<void>(cursor.take(kNormal, "a normal"));
      for (int i = 0; i < 3; ++i) {
        Vec3& point = mesh_.points.emplace_back();
        for (double& x : point) x = double{cursor.read<float>("a coordinate")};
        if (isFinite(point)) continue;
        cursor.failAt(cursor.position() - kNormal, ErrorCode::NotFinite,
                      concat("a corner of triangle ", t, " is not finite."));
      }
      static_cast<void>(cursor.take(2, "the bytes behind a triangle"));
    }
    nameTriangles();
  }

  void readText() {
    TextScanner scanner(text_, name_);
    std::size_t corners = 0;  // of the current facet
    while (scanner.skipSpace()) {
      const std::string word = lowerCase(scanner.readToken());
      if (word == "vertex") {
        ++corners;
        Vec3& point = mesh_.points.emplace_back();
        for (double& x : point) x = scanner.number("a coordinate of a corner");
      } else if (word == "endloop") {
        if (corners != 3) {
          scanner.fail(ErrorCode::FileSyntax, "a facet has ", corners,
                       " corners in place of three.");
        }
        corners = 0;
      } else if (word == "solid" || word == "facet" || word == "endsolid") {
        static_cast<void>(scanner.takeLine());
      } else if (word != "outer" && word != "loop" && word != "endfacet") {
        scanner.fail(ErrorCode::FileSyntax, "expected a word of the format STL, found ",
                     quoted(std::string_view(word)), ".");
      }
    }
    if (corners != 0) scanner.fail(ErrorCode::FileSyntax, "the file ends within a facet.");
    nameTriangles();
  }

  void nameTriangles() {
    for (Index v = 0; v < mesh_.points.size(); v += 3) mesh_.triangles.push_back({v, v + 1, v + 2});
  }

  std::string_view text_;
  const std::string& name_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh readStl(const Input& input, Stage& stage) { return readWith<StlReader>(input, stage); }

}  // namespace hexhex::io
