// TetGen's `.node` and `.ele` files (see formats.hpp): two texts, of points and of tets.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

namespace {

/// The first line of a file, and its rows: each has its number, and then as many tokens.
class TetgenRows {
 public:
  TetgenRows(std::string_view text, const std::string& name)
      : scanner_(text, name, TextScanner::Comments::Hash) {}

  /// @param what  the rows hold
  std::size_t readHead(std::string_view what, std::size_t defaultWidth) {
    static_cast<void>(scanner_.peekToken());
    const std::size_t tokens = scanner_.countTokensOnLine();
    count_ = scanner_.readCount(what, 2);
    width_ = defaultWidth;
    if (tokens > 1) width_ = scanner_.readCount("numbers of a row", 1);
    // How many other numbers follow: attributes and a mark of the boundary.
    for (std::size_t i = 2; i < tokens; ++i) more_ += scanner_.readCount("further numbers", 1);
    return count_;
  }

  [[nodiscard]] std::size_t width() const noexcept { return width_; }
  [[nodiscard]] std::int64_t first() const noexcept { return first_; }
  [[nodiscard]] TextScanner& scanner() noexcept { return scanner_; }

  /// Calls read(i) for each row, behind its number.
  template <class Read>
  void readRows(Stage& stage, const Read& read) {
    LoopProgress progress(stage, count_);
    for (std::size_t i = 0; i < count_; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count_ - i));
      const std::int64_t number = scanner_.integer("the number of a row");
      if (i == 0) first_ = number;
      if (number != first_ + static_cast<std::int64_t>(i) || first_ < 0 || first_ > 1) {
        scanner_.fail(ErrorCode::FileSyntax,
                      "rows are numbered one after the other, from 0 or 1; found " +
                          std::to_string(number) + ".");
      }
      read(i);
      for (std::size_t k = 0; k < more_; ++k) static_cast<void>(scanner_.readToken());
    }
  }

 private:
  TextScanner scanner_;
  std::size_t count_ = 0;
  std::size_t width_ = 0;
  std::size_t more_ = 0;
  std::int64_t first_ = 0;
};

}  // namespace

TetCells parseTetgen(std::string_view nodes, const std::string& nodesName, const Input& input,
                     Stage& stage) {
  TetCells mesh;
  TetgenRows points(nodes, nodesName);
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
    throw Error(ErrorCode::FileUnsupported,
                input.name() + ": the file holds no tetrahedra with 4 nodes" +
                    input.counts()->instead() + ". Let TetGen write them, without -o2.");
  }
  tets.readRows(stage, [&](std::size_t i) {
    for (Index& vertex : mesh.cells[i]) {
      const std::int64_t number = tets.scanner().integer({"a vertex of ", "tetrahedron", i});
      const std::int64_t index = number - points.first();
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh.points.size()) {
        tets.scanner().fail(
            ErrorCode::IndexOutOfRange,
            "there is no point " + std::to_string(number) + " in " + nodesName + ".");
      }
      vertex = static_cast<Index>(index);
    }
  });
  return mesh;
}

TetCells readTetgen(const Input& input, Context& context) {
  return inStage(context, "read tets", [&](Stage& stage) {
    if (input.path().empty()) {
      throw Error(ErrorCode::FileUnsupported,
                  input.name() + ": tets in memory have no file .node of points beside them.");
    }
    std::filesystem::path nodes = input.path();
    nodes.replace_extension(".node");
    const Array<char> text = readWholeFile(nodes, stage, "#0123456789");
    return parseTetgen(asText(text), nodes.string(), input, stage);
  });
}

}  // namespace hexhex::io
