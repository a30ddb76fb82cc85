// What a hexahedral mesh adds up to, in memory, in a file, or while it comes in pieces: to compare
// meshes that need not, or cannot, stand in memory.
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

/// Sums of a mesh. Meshes with the same points in the same order, bit for bit, have the same
/// `pointChecksum`; with the same cells in the same order, the same `cellChecksum`; however they
/// are stored and whatever their pieces are. Different ones have different checksums but for one in
/// 2^64, unless somebody intends it.
struct MeshSurvey {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  Vec3 lower{};  ///< of the bounding box; 0 without points
  Vec3 upper{};
  std::uint64_t pointChecksum = 0;
  std::uint64_t cellChecksum = 0;

  [[nodiscard]] bool operator==(const MeshSurvey& /*other*/) const = default;
};

/// A sink that adds up what comes, and refuses what openMeshSink() refuses. Memory: none to speak
/// of.
class SurveySink : public MeshSink {
 public:
  /// @param context  outlives the sink
  explicit SurveySink(Context& context);
  ~SurveySink() override;
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override;
  void points(const PointPiece& piece) override;
  void cells(std::uint64_t first, std::span<const Hex> cells) override;
  void cells(std::uint64_t first, std::span<const Hex64> cells) override;
  void end() override;

  /// Complete after end().
  [[nodiscard]] const MeshSurvey& result() const noexcept;

 private:
  class HEXHEX_HIDDEN Adder;
  std::unique_ptr<Adder> adder_;
};

/// The survey of a mesh in memory.
/// @throws Error InvalidArgument for cells with vertices that do not exist; NotFinite
[[nodiscard]] MeshSurvey survey(const HexMesh& mesh, Context& context);

/// The survey of a mesh in a file, read with readHexMeshTo(): piece by piece where possible.
/// @throws Error  as readHexMesh()
[[nodiscard]] MeshSurvey surveyFile(const std::filesystem::path& file, const ReadOptions& options,
                                    Context& context);
[[nodiscard]] MeshSurvey surveyFile(const std::filesystem::path& file, Context& context);

}  // namespace HEXHEX_API_NAMESPACE
