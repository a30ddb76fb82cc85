// Reads and writes OpenFOAM's polyMesh (see formats.hpp); writes it as a decomposed case, too.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

// Reading.

/// A file of a polyMesh, plain or compressed: its text without comments, punctuation and head.
class FoamFile {
 public:
  /// @param punctuation  further characters that mean nothing
  FoamFile(const std::filesystem::path& file, std::string_view punctuation, Stage& stage)
      : input_(openInput(existing(file), stage.context())) {
    const std::string_view text = input_.text(room_, stage, {});
    text_.assign(text.begin(), text.end());
    const std::size_t head = std::min(text.find("FoamFile"), text.size());
    const std::size_t headEnd = std::min(text.find('}', head), text.size());
    if (text.substr(head, headEnd - head).find("binary") != std::string_view::npos) {
      input_.fail(ErrorCode::FileUnsupported,
                  "binary files are not read. Run `foamFormatConvert` with writeFormat ascii.");
    }
    clear(headEnd == text.size() ? 0 : head, headEnd == text.size() ? 0 : headEnd + 1);
    clearBetween("/*", "*/");
    clearBetween("//", "\n");
    for (char& c : text_) {
      if (punctuation.find(c) != std::string_view::npos) c = ' ';
    }
    scanner_.emplace(text_, input_.name());
  }

  [[nodiscard]] TextScanner& scanner() noexcept { return *scanner_; }
  /// Reads the number of entries of a list.
  [[nodiscard]] std::size_t readCount(std::string_view what, std::size_t bytesEach) {
    const std::size_t count = scanner_->readCount(what, bytesEach);
    if (count > kNone) scanner_->fail(ErrorCode::TooLarge, exceedsLimit(count, what, kNone));
    return count;
  }
  /// Reads a number below `end`.
  [[nodiscard]] Index readIndex(std::string_view what, std::size_t end) {
    const std::int64_t number = scanner_->integer({what, ""});
    if (number >= 0 && static_cast<std::uint64_t>(number) < end) return static_cast<Index>(number);
    scanner_->fail(ErrorCode::IndexOutOfRange, what, " is ", number, ", but it must be below ", end,
                   ".");
  }
  /// Reads a list of at most `most` numbers; "9{0}" is short for nine that are equal.
  [[nodiscard]] Array<Index> readLabels(std::string_view what, std::size_t most) {
    Array<Index> labels(readIndex("the number of entries", most + 1));
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (i == 1 && scanner_->peekToken().empty()) {
        std::fill(labels.begin(), labels.end(), labels[0]);
        break;
      }
      labels[i] = readIndex(what, kNone);
    }
    return labels;
  }

  static std::filesystem::path existing(const std::filesystem::path& file) {
    std::filesystem::path packed = file;
    packed += ".gz";
    std::error_code unknown;
    return !std::filesystem::exists(file, unknown) && std::filesystem::exists(packed, unknown)
               ? packed
               : file;
  }

 private:
  void clear(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) text_[i] = text_[i] == '\n' ? '\n' : ' ';
  }
  void clearBetween(std::string_view open, std::string_view close) {
    for (std::size_t at = text_.find(open); at != std::string::npos; at = text_.find(open, at)) {
      const std::size_t end = text_.find(close, at + open.size());
      clear(at, end == std::string::npos ? text_.size() : end + close.size());
    }
  }

  Input input_;
  Array<char> room_;
  std::string text_;
  std::optional<TextScanner> scanner_;
};

/// Reads a polyMesh into lists: cells by their faces.
class PolyMeshReader {
 public:
  PolyMeshReader(const Input& input, Stage& stage)
      : input_(input), folder_(polyMeshOf(input.path())), stage_(stage) {}

  ElementLists read() {
    readPoints();
    readFaces();
    readCells();
    readPatches();
    readZones();
    return std::move(lists_);
  }

 private:
  static std::filesystem::path polyMeshOf(const std::filesystem::path& file) {
    std::error_code unknown;
    if (std::filesystem::is_directory(file, unknown)) return file;
    std::filesystem::path folder = file.parent_path() / "constant" / "polyMesh";
    const std::filesystem::path piece = file.parent_path() / "processor0" / "constant" / "polyMesh";
    if (std::filesystem::exists(piece, unknown) && !std::filesystem::exists(folder, unknown)) {
      throw Error(ErrorCode::FileUnsupported,
                  file.string() + ": the case is decomposed. Run `reconstructParMesh -constant`.");
    }
    return folder;
  }

  void readPoints() {
    FoamFile file(folder_ / "points", "()", stage_);
    lists_.points.resize(file.readCount("points", 6));
    for (std::size_t i = 0; i < lists_.points.size(); ++i) {
      for (double& x : lists_.points[i])
        x = file.scanner().number({"a coordinate of ", "point", i});
    }
  }

  void readFaces() {
    FoamFile file(folder_ / "faces", "()", stage_);
    faces_.resize(file.readCount("faces", 8));  // bytes of "3(0 1 2)"
    corners_.resize(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      corners_[f] = file.readCount("corners of a face", 2);
      for (std::size_t k = 0; k < corners_[f]; ++k) {
        const Index vertex = file.readIndex("a corner of a face", lists_.points.size());
        if (k < 4) faces_[f][k] = vertex;
      }
    }
  }

  /// Cells have their faces in order: first those that they own, which face out of them.
  void readCells() {
    const auto labels = [&](const char* name) {
      return FoamFile(folder_ / name, "(){}", stage_).readLabels("a cell of a face", faces_.size());
    };
    const Array<Index> owners = labels("owner");
    const Array<Index> neighbours = labels("neighbour");
    if (owners.size() != faces_.size() || neighbours.size() > owners.size()) {
      input_.fail(ErrorCode::FileSyntax, "the polyMesh has ", faces_.size(), " faces, but ",
                  owners.size(), " owners and ", neighbours.size(), " neighbours.");
    }
    for (const Array<Index>* const cells : {&owners, &neighbours}) {
      for (std::size_t f = 0; f < cells->size(); ++f) addFace((*cells)[f], f, cells == &owners);
    }
    for (std::size_t c = 0; c < cells_.size(); ++c) addCell(c);
  }

  void addFace(Index cell, std::size_t face, bool isOwn) {
    // Each cell has a face, so there are no more of them.
    if (cell >= faces_.size()) {
      input_.fail(ErrorCode::IndexOutOfRange, "a face belongs to cell ", cell, " of at most ",
                  faces_.size(), ".");
    }
    if (cell >= cells_.size()) cells_.resize(cell + std::size_t{1});
    Cell& its = cells_[cell];
    if (corners_[face] == 3) ++its.triangles;
    if (corners_[face] > 4) ++its.polygons;
    if (corners_[face] != 4) return;
    Quad loop = faces_[face];
    if (isOwn) std::reverse(loop.begin(), loop.end());  // to be seen from inside
    if (its.quads < its.loops.size()) its.loops[its.quads] = loop;
    ++its.quads;
  }

  void addCell(std::size_t c) {
    const auto& [loops, quads, triangles, polygons] = cells_[c];
    Hex hex{};
    const bool isHex = quads == 6 && triangles + polygons == 0;
    std::string_view type = "polyhedra";
    if (isHex && assembleHex(loops, hex)) type = "hexahedra";
    if (polygons == 0 && quads == 0 && triangles == 4) type = "tetrahedra";
    if (polygons == 0 && quads == 3 && triangles == 2) type = "prisms";
    if (polygons == 0 && quads == 1 && triangles == 4) type = "pyramids";
    ElementBlock& block = lists_.blocks[lists_.blockOf(volumeCells(type), 8)];
    if (type == "hexahedra") block.nodes.insert(block.nodes.end(), hex.begin(), hex.end());
    block.numbers.push_back(c);
    block.regions.push_back(0);
  }

  void readPatches() {
    struct Patch {
      std::string name;
      std::size_t faces = 0;
      std::size_t first = 0;
    };
    FoamFile file(folder_ / "boundary", "();", stage_);
    std::vector<Patch> patches(file.readCount("patches", 4));
    GroupTags tags;
    for (Patch& patch : patches) {
      patch.name = readBegin(file);
      for (std::string_view word; (word = file.scanner().readToken()) != "}";) {
        if (word.empty()) file.scanner().failToken("\"}\"");
        if (word == "nFaces") patch.faces = file.readIndex("nFaces", faces_.size() + 1);
        if (word == "startFace") patch.first = file.readIndex("startFace", faces_.size() + 1);
      }
      tags.reserve(patch.name);
    }
    for (const Patch& patch : patches) {
      const std::int32_t tag = tags.next(patch.name);
      lists_.addName(2, tag, patch.name);
      for (std::size_t f = patch.first; f < std::min(patch.first + patch.faces, faces_.size());
           ++f) {
        if (tag != 0 && corners_[f] == 4) lists_.quads.push_back({faces_[f], tag});
      }
    }
  }

  /// Reads the name of an entry and "{".
  static std::string readBegin(FoamFile& file) {
    std::string name(file.scanner().readToken());
    if (file.scanner().readToken() != "{") file.scanner().failToken("\"{\" behind a name");
    return name;
  }

  void readZones() {
    std::error_code unknown;
    const std::filesystem::path path = folder_ / "cellZones";
    if (!std::filesystem::exists(FoamFile::existing(path), unknown)) return;
    FoamFile file(path, "();", stage_);
    std::vector<std::pair<std::string, Array<Index>>> zones(file.readCount("zones", 4));
    GroupTags tags;
    for (auto& [name, cells] : zones) {
      name = readBegin(file);
      for (std::string_view word; (word = file.scanner().readToken()) != "}";) {
        if (word.empty()) file.scanner().failToken("\"}\"");
        if (!word.starts_with("List<")) continue;
        cells.resize(file.readCount("cells of a zone", 2));
        for (Index& cell : cells) cell = file.readIndex("a cell of a zone", cells_.size());
      }
      tags.reserve(name);
    }
    ElementTags regions;
    for (const auto& [name, cells] : zones) {
      const std::int32_t tag = tags.next(name);
      lists_.addName(3, tag, name);
      for (const Index cell : cells) regions.add(cell, tag);
    }
    regions.sort();
    lists_.setRegions(regions);
  }

  struct Cell {
    QuadLoops loops{};  ///< seen from inside
    std::uint32_t quads = 0;
    std::uint32_t triangles = 0;
    std::uint32_t polygons = 0;
  };

  const Input& input_;
  std::filesystem::path folder_;
  Stage& stage_;
  ElementLists lists_;
  Array<Quad> faces_;           ///< the first corners of each
  Array<std::size_t> corners_;  ///< per face
  std::vector<Cell> cells_;
};

// Writing.

/// Faces in OpenFOAM's order; quads face out of their owners.
struct PolyMesh {
  struct Patch {
    std::string name;
    std::size_t begin;
    std::size_t end;
    /// For processor patches: lines of the patch dictionary, including the type.
    std::string entries;
  };
  Array<Quad> faces;
  Array<Index> owners;      ///< per face
  Array<Index> neighbours;  ///< per inner face
  std::vector<Patch> patches;
};

/// Writes the files of a mesh; commit() renames them.
class PolyMeshWriter {
 public:
  PolyMeshWriter(std::filesystem::path folder, int threads)
      : folder_(std::move(folder)), threads_(threads) {}

  void write(const HexMesh& mesh, const PolyMesh& poly, Stage& stage) {
    LoopProgress progress(stage, mesh.points.size() + 3 * poly.faces.size());
    list("vectorField", "points", mesh.points.size(), 3 * (kNumberRoom + 1) + 3, "", progress,
         [&](char* place, std::size_t i) {
           return put(putNumbers(put(place, '('), mesh.points[i]), ")\n");
         });
    list("faceList", "faces", poly.faces.size(), 4 * (kNumberRoom + 1) + 4, "", progress,
         [&](char* place, std::size_t i) {
           return put(putNumbers(put(place, "4("), poly.faces[i]), ")\n");
         });
    // OpenFOAM's tools read sizes from this note instead of from the files.
    const std::string note = concat("    note        \"nPoints:", mesh.points.size(),
                                    "  nCells:", mesh.cells.size(), "  nFaces:", poly.faces.size(),
                                    "  nInternalFaces:", poly.neighbours.size(), "\";\n");
    writeLabels("owner", poly.owners, note, progress);
    writeLabels("neighbour", poly.neighbours, note, progress);
  }
  void writeZones(const CellGroups& cells) {
    OutputFile& output = begin("regIOobject", "cellZones", "");
    output.write(cells.groups.size()).write("\n(\n");
    LineWriter lines(output, threads_);
    for (const ElementGroup& group : cells.groups) {
      output.write(group.name).write("\n{\n    type cellZone;\ncellLabels      List<label>\n");
      output.write(group.end - group.begin).write("\n(\n");
      lines.write(
          group.end - group.begin, kNumberRoom + 1,
          [&](char* place, std::size_t i) {
            return put(put(place, std::uint64_t{cells.at(group.begin + i)}), '\n');
          },
          nullptr);
      output.write(")\n;\n}\n");
    }
    output.write(")\n");
  }
  /// Writes a file with a list of labels.
  template <class Labels>
  void writeLabels(std::string_view object, const Labels& labels, std::string_view note,
                   LoopProgress& progress) {
    list("labelList", object, labels.size(), kNumberRoom + 1, note, progress,
         [&](char* place, std::size_t i) { return put(put(place, labels[i]), '\n'); });
  }
  template <class Labels>
  void writeLabels(std::string_view object, const Labels& labels, Stage& stage) {
    LoopProgress progress(stage, labels.size());
    writeLabels(object, labels, "", progress);
  }
  void writeBoundary(const std::vector<PolyMesh::Patch>& patches) {
    OutputFile& output = begin("polyBoundaryMesh", "boundary", "");
    output.write(patches.size()).write("\n(\n");
    for (const PolyMesh::Patch& patch : patches) {
      output.write("    ").write(patch.name).write("\n    {\n");
      output.write(patch.entries.empty() ? "        type            patch;\n" : patch.entries);
      output.write("        nFaces          ").write(patch.end - patch.begin).write(";\n");
      output.write("        startFace       ").write(patch.begin).write(";\n    }\n");
    }
    output.write(")\n");
  }

  void commit() {
    for (const std::unique_ptr<OutputFile>& file : files_) file->commit();
    files_.clear();
  }

 private:
  OutputFile& begin(std::string_view kind, std::string_view object, std::string_view note) {
    files_.push_back(std::make_unique<OutputFile>(folder_ / object));
    OutputFile& output = *files_.back();
    output.write("FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       ");
    output.write(kind).write(";\n").write(note).write("    location    \"constant/polyMesh\";\n");
    output.write("    object      ").write(object).write(";\n}\n\n");
    return output;
  }

  template <class Format>
  void list(std::string_view kind, std::string_view object, std::size_t n, std::size_t room,
            std::string_view note, LoopProgress& progress, const Format& format) {
    OutputFile& output = begin(kind, object, note);
    output.write(n).write("\n(\n");
    LineWriter(output, threads_).write(n, room, format, &progress);
    output.write(")\n");
  }

  std::filesystem::path folder_;
  int threads_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

// Global face numbers of parts, computed from the parts alone.

/// The faces of a part, in global order. Faces of cells with consecutive global numbers are
/// consecutive, too, so they are stored as runs: about as many as there are tets, however many
/// cells.
class FaceRuns {
 public:
  struct Run {
    std::uint64_t cell;    ///< global number of the first cell
    std::uint64_t before;  ///< faces of the part before it
  };

  /// Adds a face. @param run  the first cell of the run of its cell
  void add(std::uint64_t run) {
    if (runs_.empty() || runs_.back().cell != run) runs_.push_back({run, count_});
    ++count_;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] const std::vector<Run>& runs() const noexcept { return runs_; }
  /// End of a run, as a face number of the part.
  [[nodiscard]] std::uint64_t endOf(std::size_t run) const {
    return run + 1 < runs_.size() ? runs_[run + 1].before : count_;
  }

 private:
  std::vector<Run> runs_;
  std::uint64_t count_ = 0;
};

/// Global numbers of the faces of one kind, in the order of writeOpenFoam(): inner faces by the
/// smaller of their cells, then by the larger; boundary faces of a tag by cell and side.
class FaceNumbers {
 public:
  void add(const FaceRuns& faces) {
    for (std::size_t i = 0; i < faces.runs().size(); ++i) {
      const FaceRuns::Run& run = faces.runs()[i];
      table_.insert(table_.end(), {run.cell, faces.endOf(i) - run.before});
    }
  }
  /// To be called after the last add(). @param first  the first number. @return  the end of the
  /// numbers
  std::uint64_t finish(std::uint64_t first, ProcessTeam* team) {
    if (team != nullptr) table_ = team->gather(table_).numbers;
    begins_.resize(table_.size() / 2);
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      begins_[i] = {table_[2 * i], table_[2 * i + 1]};
    }
    std::vector<std::uint64_t>().swap(table_);
    std::sort(begins_.begin(), begins_.end());
    std::uint64_t next = first;
    for (auto& [cell, number] : begins_) {
      const std::uint64_t faces = number;
      number = next;
      next += faces;
    }
    return next;
  }
  [[nodiscard]] bool empty() const noexcept { return begins_.empty(); }

  /// Calls use(number) for all faces of a part, in order.
  template <class Use>
  void forEach(const FaceRuns& faces, const Use& use) const {
    for (std::size_t i = 0; i < faces.runs().size(); ++i) {
      const FaceRuns::Run& run = faces.runs()[i];
      const std::uint64_t first = beginOf(run.cell);
      for (std::uint64_t f = run.before; f < faces.endOf(i); ++f) use(first + f - run.before);
    }
  }
  /// The number of one face of a part.
  [[nodiscard]] std::uint64_t of(const FaceRuns& faces, std::uint64_t face) const {
    const auto run = std::prev(std::upper_bound(
        faces.runs().begin(), faces.runs().end(), face,
        [](std::uint64_t f, const FaceRuns::Run& each) { return f < each.before; }));
    return beginOf(run->cell) + face - run->before;
  }

 private:
  [[nodiscard]] std::uint64_t beginOf(std::uint64_t run) const {
    return std::lower_bound(begins_.begin(), begins_.end(), std::pair(run, std::uint64_t{0}))
        ->second;
  }

  std::vector<std::uint64_t> table_;                             ///< cells and numbers of faces
  std::vector<std::pair<std::uint64_t, std::uint64_t>> begins_;  ///< per run: first cell, number
};

constexpr std::size_t kOpenfoamGrain = 4096;

/// Adds inner faces: those of each cell towards larger neighbours, sorted by neighbour.
void addInnerFaces(const HexMesh& mesh, PolyMesh& poly, Stage& stage) {
  const adjacency::FaceNeighbours neighbours = adjacency::findFaceNeighbours(mesh, stage);
  const auto isOwned = [&neighbours](std::size_t cell, std::size_t face) {
    const Index other = neighbours[cell][face];
    return other != kNone && other > cell;
  };
  Array<std::uint64_t> begin(mesh.cells.size() + 1);
  begin[mesh.cells.size()] = 0;
  parallelFor(stage, mesh.cells.size(), kOpenfoamGrain, [&](std::size_t c) {
    begin[c] = 0;
    for (std::size_t face = 0; face < 6; ++face) begin[c] += isOwned(c, face) ? 1 : 0;
  });
  const std::uint64_t count = exclusiveScan(std::span(begin));
  poly.faces.resize(count);
  poly.owners.resize(count);
  poly.neighbours.resize(count);
  parallelFor(stage, mesh.cells.size(), kOpenfoamGrain, [&](std::size_t c) {
    std::array<std::pair<Index, std::size_t>, 6> owned{};  // neighbours and faces, ascending
    std::size_t size = 0;
    for (std::size_t face = 0; face < 6; ++face) {
      if (isOwned(c, face)) owned[size++] = {neighbours[c][face], face};
    }
    std::sort(owned.begin(), owned.begin() + size);
    for (std::size_t i = 0; i < size; ++i) {
      poly.faces[begin[c] + i] = adjacency::faceVertices(mesh.cells[c], owned[i].second);
      poly.owners[begin[c] + i] = static_cast<Index>(c);
      poly.neighbours[begin[c] + i] = owned[i].first;
    }
  });
}

/// Adds boundary faces, group by group.
void addPatches(const QuadGroups& quads, PolyMesh& poly) {
  for (const ElementGroup& group : quads.groups) {
    const std::size_t begin = poly.faces.size();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      if (quads.places[i] == kNoPlace) continue;
      poly.faces.push_back(quads.elements[i]);
      poly.owners.push_back(static_cast<Index>(quads.places[i] / 8));
    }
    if (poly.faces.size() > begin)
      poly.patches.push_back({group.name, begin, poly.faces.size(), {}});
  }
}

bool isMarker(const std::filesystem::path& file) { return lowerCaseExtension(file) == ".foam"; }

}  // namespace

HexMesh readOpenFoam(const Input& input, Stage& stage) {
  return hexMeshOf(PolyMeshReader(input, stage).read(), input);
}

void writeOpenFoam(const HexMesh& mesh, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that an unwritable target is reported at once.
  OutputFolder folder(isMarker(file) ? file.parent_path() / "constant" / "polyMesh" : file);
  std::optional<OutputFile> marker;
  if (isMarker(file)) marker.emplace(file);
  const QuadGroups quads = groupQuads(mesh, options.patchAngle, stage);
  PolyMesh poly;
  withThreads(context.threads(), [&] { addInnerFaces(mesh, poly, stage); });
  addPatches(quads, poly);
  requireInt32(mesh.points.size(), "OpenFOAM numbers vertices");
  requireInt32(poly.faces.size(), "OpenFOAM numbers faces");
  folder.run([&] {
    PolyMeshWriter writer(folder.temporary(), context.threads());
    writer.write(mesh, poly, stage);
    writer.writeBoundary(poly.patches);
    // Without regions, writes empty zones, which replace those of an earlier mesh.
    writer.writeZones(mesh.regions.empty() ? CellGroups{} : groupCells(mesh));
    writer.commit();
  });
  folder.commit();
  if (!marker) return;
  try {
    marker->commit();
  } catch (...) {
    if (!marker->isNamed()) folder.takeBack();
    throw;
  }
}

namespace {

// A decomposed case: `processorK/constant/polyMesh` for each part, with the addressing files that
// decomposePar writes.

/// A face of a part that is not between two of its own cells.
struct OuterFace {
  std::int32_t tag;
  std::uint64_t run;  ///< see FaceRuns
  Index cell;
  std::uint8_t side;
};

/// Orders tags ascending, untagged faces last.
bool comesBefore(std::int32_t a, std::int32_t b) { return (a == 0) != (b == 0) ? b == 0 : a < b; }

/// Marks a face whose smaller cell is in another part.
constexpr std::uint64_t kOfOther = ~std::uint64_t{0};

/// The data of a part that cannot be written before all parts are known.
struct OpenPart {
  struct Border {
    std::uint32_t part;
    std::vector<std::uint64_t> faces;  ///< indices in `owned`, or kOfOther
  };
  std::uint32_t part = 0;
  FaceRuns owned;  ///< inner faces, and faces to other parts, owned by their smaller cells
  std::vector<std::pair<std::int32_t, FaceRuns>> patches;  ///< sorted by tag
  std::vector<Border> borders;
};

/// The faces of one part, in the order of its polyMesh.
class PartFaces {
 public:
  PartFaces(const MeshPart& part, Stage& stage)
      : part_(part), neighbours_(adjacency::findFaceNeighbours(part.mesh, stage)) {
    open.part = part.part;
    for (const PartNeighbour& neighbour : part.neighbours) {
      for (const PartFace& face : neighbour.faces) {
        outside_[sideOf(face.cell, face.side)] = face.otherCell;
      }
    }
    tags_.reserve(part.mesh.features.quads.size());
    for (const FeatureQuad& quad : part.mesh.features.quads) {
      tags_.emplace_back(sorted(quad.vertices), quad.tag);
    }
    std::sort(tags_.begin(), tags_.end());
  }

  void run() {
    std::vector<OuterFace> outer;
    for (std::size_t c = 0; c < part_.mesh.cells.size(); ++c) addCell(static_cast<Index>(c), outer);
    std::stable_sort(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) {
      return comesBefore(a.tag, b.tag);
    });
    for (const OuterFace& face : outer) {
      if (open.patches.empty() || open.patches.back().first != face.tag) {
        open.patches.emplace_back(face.tag, FaceRuns());
      }
      open.patches.back().second.add(face.run);
      add(face.cell, face.side);
    }
    for (const PartNeighbour& neighbour : part_.neighbours) addBorder(neighbour);
  }

  PolyMesh poly;
  OpenPart open;

 private:
  static std::uint64_t sideOf(std::size_t cell, std::size_t side) { return 8 * cell + side; }
  void add(Index cell, std::size_t side) {
    Quad quad = adjacency::faceVertices(part_.mesh.cells[cell], side);
    poly.faces.push_back(quad);
    poly.owners.push_back(cell);
  }
  [[nodiscard]] std::int32_t tagOf(Index cell, std::size_t side) const {
    const Quad quad = sorted(adjacency::faceVertices(part_.mesh.cells[cell], side));
    const auto found =
        std::lower_bound(tags_.begin(), tags_.end(), std::pair(quad, std::int32_t{0}),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    return found != tags_.end() && found->first == quad ? found->second : 0;
  }

  /// Adds the inner faces of a cell to larger cells, sorted by these, and collects its outer faces.
  void addCell(Index cell, std::vector<OuterFace>& outer) {
    owned_.clear();
    const std::uint64_t number = part_.globalCells[cell];
    if (cell == 0 || number != part_.globalCells[cell - 1] + 1) run_ = number;
    for (std::uint8_t side = 0; side < 6; ++side) {
      const Index other = neighbours_[cell][side];
      const auto outside = other != kNone ? outside_.end() : outside_.find(sideOf(cell, side));
      if (other != kNone) {
        if (other > cell) owned_.push_back({part_.globalCells[other], side, other});
      } else if (outside == outside_.end()) {
        outer.push_back({tagOf(cell, side), run_, cell, side});
      } else if (outside->second > number) {
        owned_.push_back({outside->second, side, kNone});
      }
    }
    std::sort(owned_.begin(), owned_.end(), [](const Owned& a, const Owned& b) {
      return a.other != b.other ? a.other < b.other : a.side < b.side;
    });
    for (const Owned& face : owned_) {
      if (face.local == kNone) outerFaces_[sideOf(cell, face.side)] = open.owned.count();
      open.owned.add(run_);
      if (face.local == kNone) continue;
      add(cell, face.side);
      poly.neighbours.push_back(face.local);
    }
  }

  /// Adds the faces to a neighbour. Both parts list them from the same vertex, in opposite
  /// directions.
  void addBorder(const PartNeighbour& neighbour) {
    if (neighbour.faces.empty()) return;
    OpenPart::Border& border = open.borders.emplace_back();
    border.part = neighbour.part;
    for (const PartFace& face : neighbour.faces) {
      add(face.cell, face.side);
      Quad& quad = poly.faces.back();
      std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
      const auto owned = outerFaces_.find(sideOf(face.cell, face.side));
      border.faces.push_back(owned != outerFaces_.end() ? owned->second : kOfOther);
    }
  }

  /// A face of a cell, sorted by the cell on its other side.
  struct Owned {
    std::uint64_t other;  ///< global number
    std::uint8_t side;
    Index local;  ///< kNone if in another part
  };

  const MeshPart& part_;
  adjacency::FaceNeighbours neighbours_;
  std::vector<Owned> owned_;                           ///< of the current cell
  std::uint64_t run_ = 0;                              ///< of the current cell
  std::map<std::uint64_t, std::uint64_t> outside_;     ///< of faces between parts: the other cell
  std::map<std::uint64_t, std::uint64_t> outerFaces_;  ///< of those whose smaller cell is here
  std::vector<std::pair<Quad, std::int32_t>> tags_;
};

std::string processorPatch(std::uint32_t here, std::uint32_t there) {
  return concat(
      "        type            processor;\n        inGroups        1(processor);\n"
      "        matchTolerance  0.0001;\n        transform       unknown;\n"
      "        myProcNo        ",
      here, ";\n        neighbProcNo    ", there, ";\n");
}

class OpenFoamSink final : public PartSink {
 public:
  OpenFoamSink(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : context_(context),
        file_(file),
        case_(lowerCaseExtension(file) == ".foam" ? file.parent_path() : file),
        team_(team) {
    if (case_ != file && isFirst(team)) marker_.emplace(file);
  }

  void begin(const PartsInfo& info) override {
    info_ = info;
    refuseGhosts(info.ghostLayers, "OpenFOAM's decomposed cases");
    requireInt32(info.pointCount, "OpenFOAM numbers vertices");
    // OpenFOAM counts the folders to find the number of parts.
    const std::filesystem::path next = case_ / (concat("processor", info.parts));
    std::error_code unknown;
    if (std::filesystem::exists(next, unknown)) {
      throw Error(ErrorCode::FileWrite,
                  concat(next.string(), " is there, of a case with more parts than ", info.parts,
                         ". Remove the old processor folders first."));
    }
    for (const std::int32_t tag : info.quadTags) boundary_[tag];
    boundary_[0];
  }

  [[nodiscard]] bool takesAnyOrder() const override { return true; }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    WrittenPart& written = add(part.part);
    written.folder.run(
        [&] { withThreadsHere(context_.threads(), [&] { writePart(part, written, stage); }); });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    numberFaces();
    for (const auto& entry : parts_) {
      const WrittenPart& part = entry.second;  // clang 14 captures no structured bindings
      part.folder.run([&] { finishPart(part.open, part.folder, stage); });
    }
    barrier(team_);  // wait until all parts are written
    nameAll();
  }

 private:
  struct WrittenPart {
    explicit WrittenPart(const std::filesystem::path& target) : folder(target) {}
    OutputFolder folder;
    OpenPart open;
  };
  [[nodiscard]] WrittenPart& add(std::uint32_t part) {
    const std::lock_guard lock(mutex_);
    const std::filesystem::path folder = case_ / (concat("processor", part));
    return parts_.try_emplace(part, folder / "constant" / "polyMesh").first->second;
  }

  void writePart(const MeshPart& part, WrittenPart& written, Stage& stage) {
    PartFaces faces(part, stage);
    faces.run();
    PolyMeshWriter writer(written.folder.temporary(), context_.threads());
    writer.write(part.mesh, faces.poly, stage);
    writer.writeZones(part.mesh.regions.empty() ? CellGroups{} : groupCells(part.mesh));
    writer.writeLabels("pointProcAddressing", part.globalPoints, stage);
    writer.writeLabels("cellProcAddressing", part.globalCells, stage);
    writer.commit();
    written.open = std::move(faces.open);
  }

  void numberFaces() {
    for (const auto& [number, part] : parts_) {
      inner_.add(part.open.owned);
      for (const auto& [tag, faces] : part.open.patches) boundary_.at(tag).add(faces);
    }
    std::uint64_t next = inner_.finish(0, team_);
    for (auto& [tag, numbers] : boundary_) next = numbers.finish(next, team_);
    requireInt32(next, "OpenFOAM numbers faces");
    for (const auto& [number, part] : parts_) {
      for (const OpenPart::Border& border : part.open.borders) {
        std::vector<std::uint64_t>& numbers = borders_[{number, border.part}];
        for (const std::uint64_t face : border.faces) {
          numbers.push_back(face == kOfOther ? kOfOther : inner_.of(part.open.owned, face));
        }
      }
    }
    if (team_ != nullptr) exchangeBorders();
  }

  /// Receives the numbers of shared faces from other processes.
  void exchangeBorders() {
    std::vector<std::uint64_t> mine;
    for (const auto& [parts, numbers] : borders_) {
      mine.insert(mine.end(), {parts.second, numbers.size()});
      mine.insert(mine.end(), numbers.begin(), numbers.end());
    }
    team_->showAll(mine, [&](std::uint32_t from, std::span<const std::uint64_t> theirs) {
      while (!theirs.empty()) {
        const std::span<const std::uint64_t> numbers = theirs.subspan(2, theirs[1]);
        if (theirs[0] == team_->rank()) {
          borders_[{from, team_->rank()}].assign(numbers.begin(), numbers.end());
        }
        theirs = theirs.subspan(2 + numbers.size());
      }
    });
  }

  /// Writes the files of a part that need global face numbers.
  void finishPart(const OpenPart& open, const OutputFolder& folder, Stage& stage) {
    std::vector<std::int32_t> addresses = innerAddresses(open);
    std::vector<PolyMesh::Patch> patches;
    std::vector<std::int32_t> patchAddresses;
    std::map<std::int32_t, std::string> names;
    std::vector<ElementGroup> groups;
    addMissingGroups(groups, info_.quadTags, true, "surface", "boundary");
    for (const ElementGroup& group : groups) names[group.tag] = group.name;
    auto own = open.patches.begin();
    for (const auto& [tag, numbers] : boundary_) {
      if (numbers.empty()) continue;
      const std::size_t begin = addresses.size();
      if (own != open.patches.end() && own->first == tag) {
        numbers.forEach(own->second,
                        [&](std::uint64_t number) { addresses.push_back(addressOf(number)); });
        ++own;
      }
      patchAddresses.push_back(static_cast<std::int32_t>(patches.size()));
      patches.push_back({names.at(tag), begin, addresses.size(), {}});
    }
    for (const OpenPart::Border& border : open.borders) {
      const std::size_t begin = addresses.size();
      const std::vector<std::uint64_t>& here = borders_.at({open.part, border.part});
      const std::vector<std::uint64_t>& there = borders_.at({border.part, open.part});
      for (std::size_t i = 0; i < here.size(); ++i) {
        addresses.push_back(here[i] != kOfOther ? addressOf(here[i]) : -addressOf(there[i]));
      }
      patchAddresses.push_back(-1);
      patches.push_back({concat("procBoundary", open.part, "to", border.part), begin,
                         addresses.size(), processorPatch(open.part, border.part)});
    }
    PolyMeshWriter writer(folder.temporary(), context_.threads());
    writer.writeBoundary(patches);
    writer.writeLabels("faceProcAddressing", addresses, stage);
    writer.writeLabels("boundaryProcAddressing", patchAddresses, stage);
    writer.commit();
  }

  /// The addresses of faces between two cells of the part.
  [[nodiscard]] std::vector<std::int32_t> innerAddresses(const OpenPart& open) const {
    std::vector<bool> isOuter(open.owned.count(), false);
    for (const OpenPart::Border& border : open.borders) {
      for (const std::uint64_t face : border.faces) {
        if (face != kOfOther) isOuter[face] = true;
      }
    }
    std::vector<std::int32_t> addresses;
    std::size_t face = 0;
    inner_.forEach(open.owned, [&](std::uint64_t number) {
      if (!isOuter[face++]) addresses.push_back(addressOf(number));
    });
    return addresses;
  }
  /// From 1 on: a negative address means that the face is reversed.
  static std::int32_t addressOf(std::uint64_t face) { return static_cast<std::int32_t>(face + 1); }

  /// Renames all folders to their targets; the marker comes last.
  void nameAll() {
    std::vector<OutputFolder*> done;
    done.reserve(parts_.size());
    try {
      for (auto& [number, part] : parts_) {
        part.folder.commit();
        done.push_back(&part.folder);
      }
      barrier(team_);
      if (marker_) marker_->commit();
      barrier(team_);
    } catch (...) {
      // A named marker is complete but not yet synced to disk; other processes cannot know that.
      const bool isNamed = marker_ && marker_->isNamed();
      if (isNamed && team_ == nullptr) throw;
      std::error_code unknown;
      if (isNamed) std::filesystem::remove(file_, unknown);
      for (; !done.empty(); done.pop_back()) done.back()->takeBack();
      throw;
    }
  }

  struct Before {
    bool operator()(std::int32_t a, std::int32_t b) const { return comesBefore(a, b); }
  };

  Context& context_;
  std::filesystem::path file_;
  std::filesystem::path case_;
  ProcessTeam* team_;
  std::optional<OutputFile> marker_;  ///< first process only
  PartsInfo info_;
  std::mutex mutex_;                            ///< for parts_
  std::map<std::uint32_t, WrittenPart> parts_;  ///< of this process
  FaceNumbers inner_;
  std::map<std::int32_t, FaceNumbers, Before> boundary_;  ///< by tag
  /// By sending and receiving part: numbers of their shared faces whose smaller cell the sender
  /// has.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint64_t>> borders_;
};

}  // namespace

std::unique_ptr<PartSink> openOpenFoamPartSink(const std::filesystem::path& file, Context& context,
                                               ProcessTeam* team) {
  return std::make_unique<OpenFoamSink>(file, context, team);
}

}  // namespace hexhex::io
