// Does a hexahedral mesh agree with the map that it came from? Independent of how it was made.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// One comparison, e.g. {"cells", "4320", "4319", false}.
struct VerifyItem {
  std::string name;      ///< stable key
  std::string expected;  ///< from the map
  std::string found;     ///< in the mesh
  bool passed = false;
};

struct VerifyReport {
  std::vector<VerifyItem> items;
  [[nodiscard]] bool passed() const noexcept {
    for (const VerifyItem& item : items) {
      if (!item.passed) return false;
    }
    return !items.empty();
  }
};

struct VerifyOptions {
  int scale = 1;            ///< the scale that the mesh was extracted with
  double tolerance = 1e-2;  ///< of the map, as in ExtractOptions
  /// Significant digits of the mesh's coordinates, relative to the largest of them: 1 to 17. 0: 7
  /// if all are single-precision numbers, otherwise 17.
  int digits = 0;
  /// Whether to count faces, edges and components of the mesh as well: a second opinion, which
  /// takes longer than the first.
  bool countElements = false;
};

/// Passes if and only if the mesh is that of the map, up to the numbers of vertices and of cells
/// and the 24 orientations of each cell. Linear time, and memory in proportion to map and mesh.
///
/// A mesh in canonical order is proven right lattice point by lattice point, by code that shares
/// the prepared map with extraction, and no decision; any other one is compared with a mesh that
/// was proven right (docs/verification.md). Vertices at the same place are told apart by their
/// cells.
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options, Context& context);
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options = {});

/// Verifies a mesh that comes in pieces: by the same proof, which passes if and only if the mesh is
/// that of the map in canonical order, as extractTo() hands it over. Memory: what a map of this
/// many tets needs, and a few bytes per vertex.
class VerifySink : public MeshSink {
 public:
  /// @param map      outlives the sink, and so does the context
  /// @param options  scale and tolerance; coordinates have all their digits
  VerifySink(const TetMapView& map, const VerifyOptions& options, Context& context);
  ~VerifySink() override;
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override;
  void points(const PointPiece& piece) override;
  void cells(std::uint64_t first, std::span<const Hex> cells) override;
  void cells(std::uint64_t first, std::span<const Hex64> cells) override;
  void end() override;

  /// Complete after end().
  [[nodiscard]] const VerifyReport& report() const noexcept;

 private:
  class HEXHEX_HIDDEN Checker;
  std::unique_ptr<Checker> checker_;
};

}  // namespace HEXHEX_API_NAMESPACE
