// A mesh in parts, for programs that work on many machines: each part has its own cells, their
// vertices with global numbers, and what it shares with its neighbours. (docs/parts.md)
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

class ProcessTeam;  // <hexhex/team.hpp>

/// Who says which cells make a part.
enum class PartitionMethod : std::uint8_t {
  Curve,   ///< a curve through halves of halves of the object; always there
  Scotch,  ///< Scotch, if its library is on this machine: smaller borders
  Metis    ///< METIS 5, likewise
};

struct PartOptions {
  /// Number of parts, from 1 to kMaxParts. Parts may be empty, as some are if there are more than
  /// cells.
  std::uint32_t parts = 1;
  /// Layers of cells of other parts that a part has beside its own, from 0 to kMaxGhostLayers: the
  /// first one are the cells with a vertex of the part, each further one those with a vertex of the
  /// one before.
  std::uint32_t ghostLayers = 0;
  PartitionMethod method = PartitionMethod::Curve;
  /// Whether each part is proven to be one of the mesh of the map before a sink gets it, as
  /// verify() proves whole meshes.
  bool verify = false;
};

inline constexpr std::uint32_t kMaxParts = 1U << 20;
inline constexpr std::uint32_t kMaxGhostLayers = 16;

/// A face of a cell between two parts.
struct PartFace {
  Index cell = 0;         ///< of the part's own cells
  std::uint8_t side = 0;  ///< of VTK's six faces: 0 4 7 3, 1 2 6 5, 0 1 5 4, 3 7 6 2, 0 3 2 1,
                          ///< 4 5 6 7
  std::uint64_t otherCell = 0;  ///< the cell on the other side, by its global number
  bool operator==(const PartFace&) const = default;
};

/// What a part has in common with another one. Both have lists of the same lengths and orders.
struct PartNeighbour {
  std::uint32_t part = 0;
  Array<Index> vertices;  ///< of own cells of both, ascending
  Array<PartFace> faces;  ///< between own cells of both
};

/// One part of a mesh. Its numbers are local; global ones are those of the mesh in one piece, that
/// of extract().
struct MeshPart {
  std::uint32_t part = 0;
  std::uint32_t parts = 1;

  /// First the vertices of the part's own cells, ascending by global number, then those of ghosts
  /// alone, likewise. First its own cells, ascending, then ghosts by layer, ascending in each.
  /// Regions are those of all cells, features those of own cells.
  HexMesh mesh;
  std::uint64_t ownPoints = 0;
  std::uint64_t ownCells = 0;

  Array<std::uint64_t> globalPoints;  ///< per point of the mesh
  Array<std::uint64_t> globalCells;   ///< per cell
  /// Per point: the part that owns it, the smallest of those with a cell at it.
  Array<std::uint32_t> pointOwners;
  Array<std::uint32_t> ghostParts;        ///< per ghost: whose own cell it is
  Array<std::uint32_t> ghostLayers;       ///< per ghost: its layer, from 1
  std::vector<PartNeighbour> neighbours;  ///< ascending by part
};

/// What is known of a mesh in parts before the first part is made.
struct PartsInfo {
  std::uint32_t parts = 1;
  std::uint32_t ghostLayers = 0;
  std::uint64_t pointCount = 0;  ///< of the mesh
  std::uint64_t cellCount = 0;
  // All different ones of the map, ascending; tags without 0, "no feature". Empty without any.
  std::vector<std::int32_t> vertexTags = {};
  std::vector<std::int32_t> edgeTags = {};
  std::vector<std::int32_t> quadTags = {};
  std::vector<std::int32_t> regions = {};
};

/// Receives the parts of a mesh, one after the other. All calls come from one thread at a time.
/// What a sink throws ends the extraction and reaches its caller.
class PartSink {
 public:
  PartSink() = default;
  PartSink(const PartSink&) = delete;
  PartSink& operator=(const PartSink&) = delete;
  virtual ~PartSink() = default;

  virtual void begin(const PartsInfo& info) = 0;
  /// Parts in order, each of them, empty ones too.
  virtual void part(MeshPart&& part) = 0;
  /// After the last one.
  virtual void end() = 0;
  /// How many layers of ghosts the sink needs, whatever was asked for: parts have at least these.
  [[nodiscard]] virtual std::uint32_t neededGhostLayers() const { return 0; }
};

/// Extracts the mesh of extract(), bit for bit, in parts; always with the atlas engine. Nothing in
/// memory grows with the whole mesh: there are the map, and one part.
/// @throws Error  as extract(); InvalidArgument for options out of range, and for a method whose
///                library is not on this machine; TooLarge for a part of 2^32 vertices or cells
void extractParts(PartSink& sink, const TetMapView& map, const ExtractOptions& options,
                  const PartOptions& parts, Context& context,
                  ExtractStatistics* statistics = nullptr);

/// All of them.
[[nodiscard]] std::vector<MeshPart> extractParts(const TetMapView& map,
                                                 const ExtractOptions& options,
                                                 const PartOptions& parts, Context& context,
                                                 ExtractStatistics* statistics = nullptr);

/// How even parts are, and how much they share.
struct PartsSummary {
  std::uint64_t cells = 0;           ///< of all parts
  std::uint64_t vertices = 0;        ///< each counted once, by its owner
  std::uint64_t largest = 0;         ///< cells of the largest part
  std::uint64_t smallest = 0;        ///< of the smallest one
  std::uint64_t empty = 0;           ///< parts without cells
  std::uint64_t sharedVertices = 0;  ///< vertices of more than one part, counted once in each
  std::uint64_t sharedFaces = 0;     ///< between two parts
  std::uint64_t mostNeighbours = 0;  ///< of a part
};

/// Hands parts on to another sink, and compares what they say of each other: any two that are
/// neighbours have the same lists of vertices and faces, by global numbers, but for an accident of
/// one in 2^64; and all numbers of cells and vertices are there. In a team of processes, each has
/// a survey of its part, and end() adds them up.
class PartSurvey final : public PartSink {
 public:
  explicit PartSurvey(PartSink& sink, ProcessTeam* team = nullptr) : sink_(sink), team_(team) {}
  void begin(const PartsInfo& info) override;
  void part(MeshPart&& part) override;
  /// @throws Error VerificationFailed if parts disagree; then the other sink's end() is not called
  void end() override;
  [[nodiscard]] std::uint32_t neededGhostLayers() const override {
    return sink_.neededGhostLayers();
  }
  /// Complete after end().
  [[nodiscard]] const PartsSummary& result() const noexcept { return summary_; }

 private:
  void addUp();

  PartSink& sink_;
  ProcessTeam* team_;
  PartsInfo info_;
  PartsSummary summary_;
  std::uint64_t cellSum_ = 0;    ///< of the numbers of all own cells
  std::uint64_t vertexSum_ = 0;  ///< of all owned vertices
  std::uint64_t borders_ = 0;    ///< what both neighbours say cancels out
};

/// Opens files for the parts of a mesh; docs/parts.md says which files each format has. They
/// appear, complete, when end() returns; a sink that is destroyed before leaves nothing. Files of
/// the same names are replaced; those of earlier runs with more parts go away.
/// @param options  the format and the patch angle count
/// @param context  outlives the sink
/// @param team     if not null, each of its processes opens a sink, in ProcessTeam::run(), whose
///                 functions are called in all of them together, for the process's own part: that
///                 of its rank
/// @throws Error FileUnsupported for a format without parts, or that a team cannot write;
///         FileWrite, now and later; NotFinite; TooLarge for numbers that the format does not hold
[[nodiscard]] std::unique_ptr<PartSink> openPartSink(const std::filesystem::path& file,
                                                     const WriteOptions& options, Context& context,
                                                     ProcessTeam* team = nullptr);

/// Throws FileUnsupported unless openPartSink() knows the format.
/// @param byTeam  whether for a team
void requirePartFormat(const std::filesystem::path& file, const WriteOptions& options,
                       bool byTeam = false);

/// A format of parts: its name and extension are those of the format of whole meshes, if there is
/// one.
struct PartFormat {
  std::string_view name;
  std::string_view extension;
  std::string_view description;  ///< which files there are
  bool byTeams = false;          ///< whether processes can write it together
};
[[nodiscard]] std::span<const PartFormat> partFormats() noexcept;

}  // namespace HEXHEX_API_NAMESPACE
