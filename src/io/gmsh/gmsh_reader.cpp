// The reading half of gmsh.hpp: the sections of a file, in its order.
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/error.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/gmsh_cells.hpp>
#include <io/gmsh/gmsh_elements.hpp>
#include <io/gmsh/gmsh_file.hpp>
#include <io/gmsh/gmsh_groups.hpp>
#include <io/gmsh/gmsh_nodes.hpp>
#include <io/gmsh/gmsh_tags.hpp>

namespace hexhex {
namespace {

/// Reads the sections of one file from top to bottom.
template <std::size_t corners>
class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& fileName, Stage& stage)
      : file_(text, fileName, stage), fileName_(fileName) {}

  CellMesh<corners> read();

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  void readSection(std::string_view name);
  void readNodes();
  void readElements();
  void requireCells() const;

  GmshFile file_;
  const std::string& fileName_;
  GmshTags tags_;
  NodeTags nodes_;
  bool hasNodes_ = false;
  bool hasElements_ = false;
  bool hasOtherElements_ = false;
  CellMesh<corners> mesh_;
};

template <std::size_t corners>
CellMesh<corners> GmshReader<corners>::read() {
  while (const std::optional<std::string_view> name = file_.nextSection()) readSection(*name);
  requireCells();
  return std::move(mesh_);
}

template <std::size_t corners>
void GmshReader<corners>::readSection(std::string_view name) {
  if (name == "PhysicalNames") return readGmshNames(file_.skipSection(name), tags_);
  if (name == "Entities" && file_.version4()) return readGmshEntities(file_, tags_);
  if (name == "Nodes") {
    readNodes();
  } else if (name == "Elements") {
    readElements();
  } else {
    file_.skipSection(name);
    return;
  }
  file_.endSection(name);
}

template <std::size_t corners>
void GmshReader<corners>::readNodes() {
  file_.scanner().failIfRepeated(hasNodes_, "$Nodes");
  hasNodes_ = true;
  GmshNodes nodes = readGmshNodes(file_);
  nodes_ = std::move(nodes.tags);
  mesh_.points = std::move(nodes.points);
}

template <std::size_t corners>
void GmshReader<corners>::readElements() {
  file_.scanner().failIfRepeated(hasElements_, "$Elements");
  hasElements_ = true;
  if (!hasNodes_) {
    file_.scanner().fail(ErrorCode::FileUnsupported,
                         "the section $Elements stands before the section $Nodes; exchange them.");
  }
  GmshCells<corners> cells(nodes_, mesh_);
  hasOtherElements_ =
      file_.version4() ? readElements41(file_, tags_, cells) : readElements22(file_, tags_, cells);
}

template <std::size_t corners>
void GmshReader<corners>::requireCells() const {
  if (!hasElements_) {
    throw Error(ErrorCode::FileUnsupported, fileName_ + ": the file holds no " +
                                                std::string(kKind.plural) +
                                                ": it has no section $Elements.");
  }
  if (mesh_.cells.empty() && hasOtherElements_) {
    throw Error(ErrorCode::FileUnsupported,
                fileName_ + ": the file holds no " + std::string(kKind.plural) + " with " +
                    std::to_string(corners) + " nodes (type " + std::to_string(kKind.gmshType) +
                    "), but other elements only.");
  }
}

}  // namespace

HexMesh parseGmsh(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<GmshReader<8>>(text, fileName, "read mesh", context));
}

HexMesh readGmsh(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readWith<GmshReader<8>>(file, "read mesh", context));
}

TetCells parseGmshTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<GmshReader<4>>(text, fileName, "read tets", context);
}

TetCells readGmshTets(const std::filesystem::path& file, Context& context) {
  return readWith<GmshReader<4>>(file, "read tets", context);
}

}  // namespace hexhex
