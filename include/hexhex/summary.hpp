// Summary of a hexahedral mesh in memory, in a file, or arriving in pieces, for comparing meshes
// that need not or cannot fit into memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Totals of a mesh. Meshes with the same points in the same order, bit for bit, have the same
/// `pointChecksum`; meshes with the same cells in the same order have the same `cellChecksum`;
/// however they are stored and divided into pieces. Different meshes have different checksums
/// except with a probability of 1 in 2^64, barring deliberate collisions.
struct MeshSummary {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  Vec3 lower{};  ///< corners of the bounding box; 0 without points
  Vec3 upper{};
  std::uint64_t pointChecksum = 0;
  std::uint64_t cellChecksum = 0;

  [[nodiscard]] bool operator==(const MeshSummary& /*other*/) const = default;
};

/// A sink that summarizes what it receives and rejects what openMeshSink() rejects. Takes hardly
/// any memory.
class SummarySink : public MeshSink {
 public:
  /// @param context  must outlive the sink
  /// @param next     receives the mesh, too; null: nobody
  explicit SummarySink(Context& context, MeshSink* next = nullptr);
  ~SummarySink() override;
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override;
  void points(const PointPiece& piece) override;
  void cells(std::uint64_t first, std::span<const Hex> cells) override;
  void cells(std::uint64_t first, std::span<const Hex64> cells) override;
  void end() override;

  /// Valid after end().
  [[nodiscard]] const MeshSummary& result() const noexcept;

 private:
  class HEXHEX_HIDDEN Adder;
  std::unique_ptr<Adder> adder_;
  MeshSink* next_;
};

/// Summarizes a mesh in memory.
/// @throws Error InvalidArgument for cells with vertices that do not exist; NotFinite
[[nodiscard]] MeshSummary summarize(const HexMesh& mesh, Context& context);

/// Summarizes a mesh in a file, read with readHexMeshTo(): in pieces where possible.
/// @throws Error  as readHexMesh()
[[nodiscard]] MeshSummary summarizeFile(const std::filesystem::path& file,
                                        const ReadOptions& options, Context& context);
[[nodiscard]] MeshSummary summarizeFile(const std::filesystem::path& file, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
