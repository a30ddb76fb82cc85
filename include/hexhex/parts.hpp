// Meshes in parts, for distributed programs: each part has its own cells, their vertices with
// global numbers, and what it shares with its neighbours. (docs/user/parts.md)
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

class ProcessTeam;  // <hexhex/team.hpp>

/// Method that assigns cells to parts.
enum class PartitionMethod : std::uint8_t {
  Curve,   ///< a curve through recursive bisections of the object; always available
  Scotch,  ///< Scotch, if its library is installed: smaller interfaces
  Metis    ///< METIS 5, if its library is installed
};

struct PartOptions {
  /// Number of parts, from 1 to kMaxParts. Parts may be empty; some are if there are more parts
  /// than cells.
  std::uint32_t parts = 1;
  /// Number of layers of ghost cells (cells of other parts), from 0 to kMaxGhostLayers. The first
  /// layer consists of the cells with a vertex of the part, each further one of the cells with a
  /// vertex of the previous layer.
  std::uint32_t ghostLayers = 0;
  PartitionMethod method = PartitionMethod::Curve;
  /// Whether to prove, before a sink receives a part, that it belongs to the mesh of the map, just
  /// as verify() does for whole meshes.
  bool verify = false;
};

inline constexpr std::uint32_t kMaxParts = 1U << 20;
inline constexpr std::uint32_t kMaxGhostLayers = 16;

/// A cell face between two parts.
struct PartFace {
  Index cell = 0;         ///< own cell of the part
  std::uint8_t side = 0;  ///< VTK face number: 0 4 7 3, 1 2 6 5, 0 1 5 4, 3 7 6 2, 0 3 2 1, 4 5 6 7
  std::uint64_t otherCell = 0;  ///< global number of the cell on the other side
  bool operator==(const PartFace&) const = default;
};

/// Interface between a part and one of its neighbours. The lists of both sides have the same
/// lengths and orders.
struct PartNeighbour {
  std::uint32_t part = 0;
  Array<Index> vertices;  ///< shared by own cells of both parts, ascending
  Array<PartFace> faces;  ///< between own cells of both parts
};

/// One part of a mesh. Indices are local; global numbers refer to the undivided mesh returned by
/// extract().
struct MeshPart {
  std::uint32_t part = 0;
  std::uint32_t parts = 1;

  /// Vertices of own cells come first, in ascending order of global numbers, then vertices of
  /// ghosts only, in the same order. Own cells come first, ascending, then ghosts by layer,
  /// ascending within each. Regions cover all cells, features only own cells.
  HexMesh mesh;
  std::uint64_t ownPoints = 0;
  std::uint64_t ownCells = 0;

  Array<std::uint64_t> globalPoints;  ///< per point
  Array<std::uint64_t> globalCells;   ///< per cell
  /// Per point: the part that owns it, i.e. the smallest part with a cell at the point.
  Array<std::uint32_t> pointOwners;
  Array<std::uint32_t> ghostParts;        ///< per ghost: the part that owns it
  Array<std::uint32_t> ghostLayers;       ///< per ghost: its layer, starting at 1
  std::vector<PartNeighbour> neighbours;  ///< ascending by part
};

/// What is known about a mesh in parts before the first part is made.
struct PartsInfo {
  std::uint32_t parts = 1;
  std::uint32_t ghostLayers = 0;
  std::uint64_t pointCount = 0;  ///< of the whole mesh
  std::uint64_t cellCount = 0;
  // All distinct tags and regions of the map, ascending; tags exclude 0, "no feature". Empty if
  // there are none.
  std::vector<std::int32_t> vertexTags = {};
  std::vector<std::int32_t> edgeTags = {};
  std::vector<std::int32_t> quadTags = {};
  std::vector<std::int32_t> regions = {};
};

/// Receives the parts of a mesh one by one, in order and from one thread at a time unless it allows
/// otherwise. An exception thrown by a sink ends the extraction and propagates to its caller.
class PartSink {
 public:
  PartSink() = default;
  PartSink(const PartSink&) = delete;
  PartSink& operator=(const PartSink&) = delete;
  virtual ~PartSink() = default;

  virtual void begin(const PartsInfo& info) = 0;
  /// Called for each part, including empty ones.
  virtual void part(MeshPart&& part) = 0;
  /// Whether several threads may call part() at a time, for parts in any order.
  [[nodiscard]] virtual bool takesAnyOrder() const { return false; }
  /// Called after the last part.
  virtual void end() = 0;
  /// Number of ghost layers that the sink needs: parts have at least as many, whatever was
  /// requested.
  [[nodiscard]] virtual std::uint32_t neededGhostLayers() const { return 0; }
};

/// Extracts the mesh of extract(), bit for bit, in parts; always uses the atlas engine. Memory
/// holds the map and one part, or with several threads as many parts as these, if all of them fit
/// in a gigabyte; twice as many if the sink takes them in order. Nothing grows with the whole mesh.
/// @throws Error  as extract(); InvalidArgument for options out of range, and for a method whose
///         library is not installed; TooLarge for a part with 2^32 vertices or cells
void extractParts(PartSink& sink, const TetMapView& map, const ExtractOptions& options,
                  const PartOptions& parts, Context& context,
                  ExtractStatistics* statistics = nullptr);

/// Returns all parts.
[[nodiscard]] std::vector<MeshPart> extractParts(const TetMapView& map,
                                                 const ExtractOptions& options,
                                                 const PartOptions& parts, Context& context,
                                                 ExtractStatistics* statistics = nullptr);

/// Balance of the parts and size of their interfaces.
struct PartsSummary {
  std::uint64_t cells = 0;           ///< in all parts
  std::uint64_t vertices = 0;        ///< each counted once, by its owner
  std::uint64_t largest = 0;         ///< cells in the largest part
  std::uint64_t smallest = 0;        ///< cells in the smallest part
  std::uint64_t empty = 0;           ///< parts without cells
  std::uint64_t sharedVertices = 0;  ///< vertices of more than one part, counted once per part
  std::uint64_t sharedFaces = 0;     ///< between two parts
  std::uint64_t mostNeighbours = 0;  ///< maximum number of neighbours of a part
};

/// Forwards parts to another sink and checks that they are consistent: any two neighbours have the
/// same lists of vertices and faces, by global numbers, except with a probability of 1 in 2^64; and
/// all cell and vertex numbers occur. In a team of processes, each process has a sink for its
/// part, and end() combines them.
class PartSummarySink final : public PartSink {
 public:
  explicit PartSummarySink(PartSink& sink, ProcessTeam* team = nullptr)
      : sink_(sink), team_(team) {}
  void begin(const PartsInfo& info) override;
  void part(MeshPart&& part) override;
  [[nodiscard]] bool takesAnyOrder() const override { return sink_.takesAnyOrder(); }
  /// @throws Error VerificationFailed if parts are inconsistent; the other sink's end() is not
  ///         called then
  void end() override;
  [[nodiscard]] std::uint32_t neededGhostLayers() const override {
    return sink_.neededGhostLayers();
  }
  /// Valid after end().
  [[nodiscard]] const PartsSummary& result() const noexcept { return sums_.summary; }

 private:
  /// What is known of one part, or of several together.
  struct Sums {
    PartsSummary summary;
    std::uint64_t cells = 0;     ///< sum of the numbers of all own cells
    std::uint64_t vertices = 0;  ///< sum of the numbers of all owned vertices
    std::uint64_t borders = 0;   ///< sum in which the entries of both neighbours cancel out
    void add(const Sums& others);
  };
  static Sums sumsOf(const MeshPart& part);

  PartSink& sink_;
  ProcessTeam* team_;
  PartsInfo info_;
  std::mutex mutex_;  ///< for sums_
  Sums sums_;
};

/// Opens files for the parts of a mesh; docs/user/parts.md lists the files of each format. The
/// complete files appear when end() returns; a sink destroyed earlier leaves nothing behind. Files
/// with the same names are replaced; additional files from earlier runs with more parts are
/// deleted.
/// @param options  only the format and the patch angle are used
/// @param context  must outlive the sink
/// @param team     if not null, each process of the team opens a sink in ProcessTeam::run(), and
///                 all processes call its functions together, each for its own part: the one with
///                 the number of its rank
/// @throws Error FileUnsupported for a format without parts, or that a team cannot write;
///         FileWrite, here and from the sink; NotFinite; TooLarge for numbers that the format
///         cannot store
[[nodiscard]] std::unique_ptr<PartSink> openPartSink(const std::filesystem::path& file,
                                                     const WriteOptions& options, Context& context,
                                                     ProcessTeam* team = nullptr);

/// Throws FileUnsupported unless openPartSink() supports the format.
/// @param byTeam  whether a team writes the files
void requirePartFormat(const std::filesystem::path& file, const WriteOptions& options,
                       bool byTeam = false);

/// A format for meshes in parts. Its name and extension are those of the corresponding format for
/// whole meshes, if there is one.
struct PartFormat {
  std::string_view name;
  std::string_view extension;
  std::string_view description;  ///< the files that it consists of
  bool byTeams = false;          ///< whether several processes can write it together
};
[[nodiscard]] std::span<const PartFormat> partFormats() noexcept;

}  // namespace HEXHEX_API_NAMESPACE
