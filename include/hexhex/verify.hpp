// Checks whether a hexahedral mesh matches the map that it came from, independently of how it was
// made.
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

class Extractor;  // <hexhex/extractor.hpp>

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
  int scale = 1;            ///< scale with which the mesh was extracted
  double tolerance = 1e-2;  ///< of the map, as in ExtractOptions
  /// Number of significant digits in the coordinates of the mesh, relative to the largest
  /// coordinate: 1 to 17. 0: 7 if all are single-precision numbers, otherwise 17.
  int digits = 0;
  /// Also count faces, edges and components of the mesh: a second opinion that takes longer than
  /// the first.
  bool countElements = false;
};

/// Passes if and only if the mesh is that of the map, up to the numbering of vertices and cells and
/// the 24 orientations of each cell. Takes linear time, and memory proportional to the sizes of map
/// and mesh.
///
/// A mesh in canonical order is proven correct one lattice point at a time, by code that shares the
/// prepared map with extraction, but none of its decisions. Any other mesh is compared with one
/// that was proven correct (docs/developer/verification.md). Vertices at the same position are
/// distinguished by their cells.
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options, Context& context);
[[nodiscard]] VerifyReport verify(const TetMapView& map, const HexMesh& mesh,
                                  const VerifyOptions& options = {});

/// Verifies a mesh that arrives in pieces, with the same proof. Passes if and only if the mesh is
/// that of the map in canonical order, as produced by extractTo(). Takes as much memory as a map of
/// this many tets.
///
/// With another sink behind it, it verifies a mesh on its way there: that sink receives each piece
/// once it was compared, and end() only if the whole mesh passed.
class VerifySink : public MeshSink {
 public:
  /// @param map      must outlive the sink, as must the context
  /// @param options  scale and tolerance; coordinates are taken to have full precision
  /// @param next     receives the mesh, too; null: nobody
  VerifySink(const TetMapView& map, const VerifyOptions& options, Context& context,
             MeshSink* next = nullptr);
  /// The same without preparing the map again, for Extractor::extractTo() at options.scale. Ignores
  /// options.tolerance.
  /// @param extractor  must outlive the sink, and serve no other call until it is done
  VerifySink(Extractor& extractor, const VerifyOptions& options, Context& context,
             MeshSink* next = nullptr);
  ~VerifySink() override;
  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override;
  void points(const PointPiece& piece) override;
  void cells(std::uint64_t first, std::span<const Hex> cells) override;
  void cells(std::uint64_t first, std::span<const Hex64> cells) override;
  void end() override;

  /// Valid after end().
  [[nodiscard]] const VerifyReport& report() const noexcept;

 private:
  class HEXHEX_HIDDEN Checker;
  std::unique_ptr<Checker> checker_;
  MeshSink* next_;
};

}  // namespace HEXHEX_API_NAMESPACE
