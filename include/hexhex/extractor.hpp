// Several meshes of one map, of different scales, orders and kinds: what does not depend on these
// is computed once.
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
  /// The largest scale that will be asked for, at least 1; for cells of higher order, times the
  /// order. Large ones leave less room for digits
  /// behind the point.
  int maxScale = 64;
  /// As in ExtractOptions. The repaired map is `repairedMap` of all statistics.
  RepairMode repair = RepairMode::Off;
  bool round = false;
};

/// A map that has passed all checks, with its topology, transitions and sanitized parameters, for
/// repeated extraction. extract() for a single mesh takes less memory: this one keeps the
/// parameters once more.
///
/// An extractor serves one call at a time; different extractors are independent of each other.
/// After an error or a cancellation it is as usable as before.
class Extractor {
 public:
  /// Prepares the map.
  /// @param map  its arrays must outlive the extractor and may not change
  /// @throws Error  for every violated condition of an integer-grid map, with its place
  Extractor(const TetMapView& map, const ExtractorOptions& options, Context& context);
  explicit Extractor(const TetMapView& map, const ExtractorOptions& options = {});
  ~Extractor();
  Extractor(Extractor&& other) noexcept;
  Extractor& operator=(Extractor&& other) noexcept;
  Extractor(const Extractor&) = delete;
  Extractor& operator=(const Extractor&) = delete;

  /// The mesh at options.scale, which is at most maxScale; options.tolerance is ignored, as the map
  /// has been prepared. The same mesh as that of extract(), bit for bit if both scales, this one
  /// and maxScale, are below 256; with a larger maxScale, positions may differ in their last
  /// digits.
  /// @param[out] statistics  filled if not null; without the time of the preparation
  /// @throws Error InvalidArgument, TooLarge, Cancelled, OutOfMemory
  [[nodiscard]] HexMesh extract(const ExtractOptions& options, Context& context,
                                ExtractStatistics* statistics = nullptr);
  [[nodiscard]] HexMesh extract(int scale = 1);

  /// The same with arcs and patches, as hexhex::extractPiecewiseLinear().
  /// @throws Error  likewise
  [[nodiscard]] PiecewiseLinearMesh extractPiecewiseLinear(PiecewiseLinearParts parts,
                                                           const ExtractOptions& options,
                                                           Context& context,
                                                           ExtractStatistics* statistics = nullptr);

  /// Cells of order `order`, as hexhex::extractLagrange(). options.scale times the order is at most
  /// maxScale.
  /// @throws Error  likewise; InvalidArgument for orders beyond kMaxOrder
  [[nodiscard]] LagrangeMesh extractLagrange(int order, const ExtractOptions& options,
                                             Context& context,
                                             ExtractStatistics* statistics = nullptr);

  /// The same in pieces, as extractTo().
  void extractTo(MeshSink& sink, const ExtractOptions& options, Context& context,
                 ExtractStatistics* statistics = nullptr);

  /// Whether a mesh is that of the map at options.scale, as hexhex::verify(), but without preparing
  /// the map once more. options.tolerance is ignored.
  /// @throws Error  likewise
  [[nodiscard]] VerifyReport verify(const HexMesh& mesh, const VerifyOptions& options,
                                    Context& context);

  /// Number of cells of the mesh at scale 1; scale^3 times as many at others.
  [[nodiscard]] std::uint64_t cellsAtScaleOne() const noexcept;

 private:
  class HEXHEX_HIDDEN Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace HEXHEX_API_NAMESPACE
