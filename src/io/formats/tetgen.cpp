// Reads TetGen's `.node`, `.ele` and `.face` files (see formats.hpp).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

/// The header line of a file and its rows; each row has its number and a fixed number of tokens.
class TetgenRows {
 public:
  TetgenRows(std::string_view text, const std::string& name)
      : scanner_(text, name, TextScanner::Comments::Hash) {}

  /// @param what        name of the rows
  /// @param width       how many numbers each row starts with
  /// @param tellsWidth  whether the header line gives this width
  std::size_t readHead(std::string_view what, std::size_t width, bool tellsWidth = true) {
    static_cast<void>(scanner_.peekToken());
    const std::size_t tokens = scanner_.countTokensOnLine();
    const std::size_t before = tellsWidth ? 2 : 1;
    count_ = scanner_.readCount(what, 2);
    width_ = width;
    if (tellsWidth && tokens > 1) width_ = scanner_.readCount("numbers of a row", 1);
    // Numbers of attributes and boundary markers.
    for (std::size_t i = before; i < tokens; ++i) more_ += scanner_.readCount("further numbers", 1);
    return count_;
  }

  [[nodiscard]] std::size_t width() const noexcept { return width_; }
  [[nodiscard]] TextScanner& scanner() noexcept { return scanner_; }

  /// Calls read(i) for each row, after its number.
  template <class Read>
  void readRows(Stage& stage, const Read& read) {
    LoopProgress progress(stage, count_);
    for (std::size_t i = 0; i < count_; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count_ - i));
      const std::int64_t number = scanner_.integer("the number of a row");
      if (i == 0) first_ = number;
      if (number != first_ + static_cast<std::int64_t>(i) || first_ < 0 || first_ > 1) {
        scanner_.fail(ErrorCode::FileSyntax,
                      "rows are numbered one after the other, from 0 or 1; found ", number, ".");
      }
      read(i);
      for (std::size_t k = 0; k < more_; ++k) readFurther(i, k);
    }
    const auto isSame = [this](std::int32_t tag) { return tag == tags_[0]; };
    const bool saysNothing = tags_.empty() || (std::all_of(tags_.begin(), tags_.end(), isSame) &&
                                               std::abs(tags_[0]) <= 1);
    if (!areTags_ || saysNothing) tags_.clear();
  }

  /// The first of the remaining numbers of each row as tags, if all are integers; empty if all are
  /// equal to one of -1, 0 and 1, which TetGen sets by default.
  [[nodiscard]] const Array<std::int32_t>& tags() const noexcept { return tags_; }

  /// Reads the index of a point.
  /// @param what  the element that refers to it
  Index readVertex(const TetgenRows& points, std::string_view what, std::size_t i) {
    const std::int64_t number = scanner_.integer({"a vertex of ", what, i});
    const std::int64_t index = number - points.first_;
    if (index < 0 || static_cast<std::uint64_t>(index) >= points.count_) {
      scanner_.fail(ErrorCode::IndexOutOfRange, "there is no point ", number,
                    " in the .node file.");
    }
    return static_cast<Index>(index);
  }

 private:
  void readFurther(std::size_t i, std::size_t k) {
    if (k > 0) return static_cast<void>(scanner_.readToken());
    const double value = scanner_.number({"a number behind ", "row", i});
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    areTags_ = areTags_ && std::abs(value) <= kMost && value == std::floor(value);
    tags_.push_back(areTags_ ? static_cast<std::int32_t>(value) : 0);
  }

  TextScanner scanner_;
  std::size_t count_ = 0;
  std::size_t width_ = 0;
  std::size_t more_ = 0;
  std::int64_t first_ = 0;
  Array<std::int32_t> tags_;
  bool areTags_ = true;
};

}  // namespace

TetCells parseTetgen(const TetgenText& nodes, const TetgenText& faces, const Input& input,
                     Stage& stage) {
  TetCells mesh;
  TetgenRows points(nodes.text, nodes.name);
  mesh.points.resize(points.readHead("points", 3));
  if (points.width() != 3) {
    points.scanner().fail(ErrorCode::FileUnsupported, "points must have 3 coordinates.");
  }
  points.readRows(stage, [&](std::size_t i) {
    for (double& coordinate : mesh.points[i]) {
      coordinate = points.scanner().number({"a coordinate of ", "point", i});
    }
  });
  Array<char> room;
  TetgenRows tets(input.text(room, stage, "#0123456789"), input.name());
  mesh.cells.resize(tets.readHead("tetrahedra", 4));
  const VolumeCells* const type = volumeCells("tetrahedra", tets.width());
  if (type == nullptr) {
    tets.scanner().fail(ErrorCode::FileUnsupported, "tetrahedra must have 4 nodes.");
  }
  input.counts()->add(*type, mesh.cells.size());
  if (tets.width() != 4) {
    input.fail(ErrorCode::FileUnsupported, "the file holds no tetrahedra with 4 nodes" +
                                               input.counts()->instead() +
                                               ". Let TetGen write them, without -o2.");
  }
  tets.readRows(stage, [&](std::size_t i) {
    for (Index& vertex : mesh.cells[i]) vertex = tets.readVertex(points, "tetrahedron", i);
  });
  mesh.regions = tets.tags();
  if (faces.text.empty()) return mesh;
  TetgenRows triangles(faces.text, faces.name);
  std::vector<FeatureFace> found(triangles.readHead("faces", 3, false));
  triangles.readRows(stage, [&](std::size_t i) {
    for (Index& vertex : found[i].vertices) vertex = triangles.readVertex(points, "face", i);
  });
  for (std::size_t i = 0; i < triangles.tags().size(); ++i) {
    found[i].tag = triangles.tags()[i];
    if (found[i].tag != 0) mesh.features.faces.push_back(found[i]);
  }
  return mesh;
}

TetCells readTetgen(const Input& input, Stage& stage) {
  if (input.path().empty()) {
    input.fail(ErrorCode::FileUnsupported,
               "tets in memory have no file .node of points beside them.");
  }
  std::filesystem::path nodes = input.path();
  nodes.replace_extension(".node");
  const Array<char> text = readWholeFile(nodes, stage, "#0123456789");
  std::filesystem::path faces = nodes;
  faces.replace_extension(".face");
  Array<char> faceText;
  std::error_code unknown;
  if (std::filesystem::exists(faces, unknown)) {
    faceText = readWholeFile(faces, stage, "#0123456789");
  }
  return parseTetgen({asText(text), nodes.string()}, {asText(faceText), faces.string()}, input,
                     stage);
}

}  // namespace hexhex::io
