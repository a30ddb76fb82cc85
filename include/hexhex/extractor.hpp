// Extracts several meshes of different scales, orders and kinds from one map, computing what they
// have in common only once.
#pragma once

#include <cstdint>
#include <memory>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

struct ExtractorOptions {
  /// As in ExtractOptions.
  double tolerance = 1e-2;
  /// The largest scale that will be requested, at least 1; for higher-order cells, times the order.
  /// Large values leave less precision for the fractional part.
  int maxScale = 64;
  // As in ExtractOptions:
  RepairedMap* repair = nullptr;  ///< filled by the constructor
  bool round = false;
};

/// A map that has passed all checks, with its topology, transitions and sanitized parameters, for
/// repeated extraction. For a single mesh, extract() takes less memory: an extractor keeps a second
/// copy of the parameters.
///
/// An extractor serves one call at a time; different extractors are independent of each other. It
/// remains usable after an error or a cancellation.
class Extractor {
 public:
  /// Prepares the map.
  /// @param map  its arrays must outlive the extractor and must not change
  /// @throws Error  for every violated condition of an integer-grid map, with its place
  Extractor(const TetMapView& map, const ExtractorOptions& options, Context& context);
  explicit Extractor(const TetMapView& map, const ExtractorOptions& options = {});
  ~Extractor();
  Extractor(Extractor&& other) noexcept;
  Extractor& operator=(Extractor&& other) noexcept;
  Extractor(const Extractor&) = delete;
  Extractor& operator=(const Extractor&) = delete;

  /// Extracts the mesh at options.scale, which is at most maxScale. Ignores options.tolerance and
  /// options.repair, as the map is already prepared. The mesh is identical to that of extract(),
  /// bit for bit, if options.scale and maxScale are below 256; with a larger maxScale, positions
  /// may differ in their last digits.
  /// @param[out] statistics  filled if not null; excludes the time of the preparation
  /// @throws Error InvalidArgument, TooLarge, Cancelled, OutOfMemory
  [[nodiscard]] HexMesh extract(const ExtractOptions& options, Context& context,
                                ExtractStatistics* statistics = nullptr);
  [[nodiscard]] HexMesh extract(int scale = 1);

  /// The same with arcs and patches, like hexhex::extractPiecewiseLinear().
  /// @throws Error  as extract()
  [[nodiscard]] PiecewiseLinearMesh extractPiecewiseLinear(PiecewiseLinearParts parts,
                                                           const ExtractOptions& options,
                                                           Context& context,
                                                           ExtractStatistics* statistics = nullptr);

  /// Extracts cells of order `order`, like hexhex::extractLagrange(). options.scale times the order
  /// is at most maxScale.
  /// @throws Error  as extract(); InvalidArgument for orders beyond kMaxOrder
  [[nodiscard]] LagrangeMesh extractLagrange(int order, const ExtractOptions& options,
                                             Context& context,
                                             ExtractStatistics* statistics = nullptr);

  /// The same in pieces, like hexhex::extractTo().
  void extractTo(MeshSink& sink, const ExtractOptions& options, Context& context,
                 ExtractStatistics* statistics = nullptr);

  /// Checks whether a mesh is that of the map at options.scale, like hexhex::verify(), but without
  /// preparing the map again. Ignores options.tolerance.
  /// @throws Error  as hexhex::verify()
  [[nodiscard]] VerifyReport verify(const HexMesh& mesh, const VerifyOptions& options,
                                    Context& context);

  /// Number of cells of the mesh at scale 1; there are scale^3 times as many at other scales.
  [[nodiscard]] std::uint64_t cellsAtScaleOne() const noexcept;

 private:
  friend class VerifySink;
  class HEXHEX_HIDDEN Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace HEXHEX_API_NAMESPACE
