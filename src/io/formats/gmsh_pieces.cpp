// Binary `.msh` files of version 4.1 piece by piece.
#include <algorithm>
#include <array>
#include <atomic>
#include <string>

#include <io/core/number_source.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_window.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/gmsh_elements.hpp>

namespace hexhex::io {

namespace {

constexpr RecordShape kTag{.sizes = 1};
constexpr RecordShape kPoint{.reals = 3};

/// How many nodes elements of a type have: of those that this library writes.
std::size_t nodesOf(std::int64_t type) {
  constexpr std::array<std::array<std::int64_t, 2>, 4> kNodes = {
      {{kGmshPoint, 1}, {kGmshLine, 2}, {kGmshQuad, 4}, {kGmshHexahedron, 8}}};
  for (const auto& [known, nodes] : kNodes) {
    if (type == known) return static_cast<std::size_t>(nodes);
  }
  return 0;
}

/// A file with one block of nodes, which are numbered from 1, and one of hexahedra, as this library
/// writes them.
class GmshPieces final : public PlainMesh {
 public:
  GmshPieces(const InputFile& file, const std::string& name, Context& context)
      : quiet_(context.threads()),
        stage_(quiet_, "read"),
        words_(file, name, context, TextWindow::kWords),
        bytes_(file, name),
        source_(bytes_, 0, stage_) {}

  [[nodiscard]] bool look() {
    if (!lookAtFormat()) return false;
    for (std::string word = words_.token(); !word.empty(); word = words_.token()) {
      if (word == "$Nodes") {
        if (points_ != 0 || !lookInside([this] { return lookAtNodes(); })) return false;
      } else if (word == "$Elements") {
        if (cells_ != 0 || !lookInside([this] { return lookAtElements(); })) return false;
      } else if (word == "$Entities") {
        if (!lookInside([this] { return skipEntities(); })) return false;
      } else if (word != "$PhysicalNames") {
        return false;
      }
      const std::string end = "$End" + word.substr(1);
      for (word = words_.token(); word != end; word = words_.token()) {
        if (word.empty()) return false;
      }
    }
    return 0 < points_ && points_ < cells_;
  }

  void beginPoints() override { source_.moveTo(points_); }
  void read(std::span<Vec3> to) override {
    source_.records(to.size(), kPoint, [&](BinaryRecord& record, std::size_t i) {
      for (double& x : to[i]) x = record.real("a coordinate of a node");
    });
  }
  void beginCells() override { source_.moveTo(cells_); }
  void read(std::span<Hex64> to) override {
    source_.records(to.size(), {.sizes = 9}, [&](BinaryRecord& record, std::size_t i) {
      static_cast<void>(record.size("the tag of an element"));
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexOfNumber(record.size("a node of an element"), points);
      }
    });
  }

 private:
  /// The section $MeshFormat.
  [[nodiscard]] bool lookAtFormat() {
    for (const char* const expected : {"$MeshFormat", "4.1", "1", "8"}) {
      if (words_.token() != expected) return false;
    }
    return lookInside([this] { return source_.integer("the mark of the byte order") == 1; }) &&
           words_.token() == "$EndMeshFormat";
  }

  /// Reads what begins on the next line, and goes on behind it.
  template <class Look>
  [[nodiscard]] bool lookInside(const Look& look) {
    if (!words_.skipLineBreak()) return false;
    source_.moveTo(words_.position());
    if (!look()) return false;
    words_.moveTo(source_.position());
    return true;
  }

  /// Only groups of whole elements are told by entities, which pieces do not carry.
  [[nodiscard]] bool skipEntities() {
    std::array<std::uint64_t, 4> counts{};
    for (std::uint64_t& count : counts) count = source_.size("the number of entities");
    for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        static_cast<void>(source_.integer("the tag of an entity"));
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) {
          static_cast<void>(source_.real("a coordinate of an entity"));
        }
        if (!skipList() || (dimension > 0 && !skipList())) return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool skipList() {
    return skip(source_.size("the length of a list"), {.integers = 1});
  }

  [[nodiscard]] bool skip(std::uint64_t n, RecordShape shape) {
    if (n > source_.room(shape)) return false;
    source_.skip(static_cast<std::size_t>(n), shape);
    return true;
  }

  [[nodiscard]] bool lookAtNodes() {
    const std::uint64_t blocks = source_.size("the number of blocks");
    points = source_.size("the number of nodes");
    if (blocks != 1 || !skip(2, kTag)) return false;
    const bool isOfVolume = source_.integer("the dimension of an entity") == 3;
    static_cast<void>(source_.integer("the tag of an entity"));
    const bool hasParameters = source_.integer("whether nodes have parameters") != 0;
    if (!isOfVolume || hasParameters || source_.size("the number of nodes of a block") != points)
      return false;
    if (points > source_.room(kTag) || !areNumbered()) return false;
    points_ = source_.position();
    return skip(points, kPoint);
  }

  /// Whether the tags that come next are 1, 2, 3, ...
  [[nodiscard]] bool areNumbered() {
    std::atomic<bool> all{true};
    for (std::uint64_t first = 0; first < points && all; first += kPieceElements) {
      source_.records(std::min<std::uint64_t>(kPieceElements, points - first), kTag,
                      [&](BinaryRecord& record, std::size_t i) {
                        if (record.size("the tag of a node") != first + i + 1) all = false;
                      });
    }
    return all;
  }

  [[nodiscard]] bool lookAtElements() {
    const std::uint64_t blocks = source_.size("the number of blocks");
    std::uint64_t left = source_.size("the number of elements");
    if (!skip(2, kTag)) return false;
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const std::int64_t dimension = source_.integer("the dimension of an entity");
      static_cast<void>(source_.integer("the tag of an entity"));
      const std::int64_t type = source_.integer("the type of elements");
      const std::uint64_t count = source_.size("the number of elements of a block");
      const std::size_t nodes = nodesOf(type);
      if (count > left) return false;
      left -= count;
      if (type == kGmshHexahedron) {
        if (cells_ != 0 || dimension != 3) return false;
        cells_ = source_.position();
        cells = count;
      }
      if (nodes == 0 || !skip(count, {.sizes = 1 + nodes})) return false;
    }
    return left == 0;
  }

  Context quiet_;
  Stage stage_;
  TextWindow words_;
  ByteFile bytes_;
  BinarySource source_;
  std::uint64_t points_ = 0;  ///< position of the first one
  std::uint64_t cells_ = 0;
};

std::unique_ptr<PlainMesh> openGmsh(const InputFile& file, const std::string& name,
                                    Context& context) {
  auto mesh = std::make_unique<GmshPieces>(file, name, context);
  return mesh->look() ? std::move(mesh) : nullptr;
}

}  // namespace

void readGmshTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({openGmsh, readGmsh}, sink, input, context);
}

}  // namespace hexhex::io
