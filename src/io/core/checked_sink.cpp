#include <algorithm>
#include <chrono>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <adjacency/corner_range.hpp>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/checked_sink.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex::io {
namespace {

/// A fraction of a millisecond of work.
constexpr std::size_t kCheckedSinkGrain = std::size_t{1} << 14;

/// Refuses an optional array that is present but has the wrong size.
void requireSize(std::size_t size, std::size_t expected, std::string_view elements,
                 const char* values) {
  if (size == 0 || size == expected) return;
  throw Error(ErrorCode::InvalidArgument,
              concat("The mesh has ", expected, " ", elements, " but ", size, " ", values, "."));
}

void requireGenerators(const HexMesh& mesh) {
  requireSize(mesh.generatorCorners.size(), mesh.points.size(), "vertices", "generators");
  requireSize(mesh.generatorTet.size(), mesh.points.size(), "vertices", "generators");
}

void requireFinite(std::span<const Vec3> points, Stage& stage) {
  const std::size_t vertex = firstNotFinite(points, stage);
  if (vertex == points.size()) return;
  throw Error(ErrorCode::NotFinite, concat("A coordinate of vertex ", vertex, " is not finite."),
              Place{PlaceKind::Vertex, vertex});
}

}  // namespace

std::size_t firstNotFinite(std::span<const Vec3> points, Stage& stage) {
  return firstFault(
      stage, points.size(), [&](std::size_t i) { return isFinite(points[i]); }, kCheckedSinkGrain);
}

void requireWritable(const TetMap& map, Stage& stage) {
  const auto requirePerTet = [&map](std::size_t size, const char* what) {
    if (size == map.tets.size()) return;
    throw Error(ErrorCode::InvalidArgument,
                concat("The map has ", map.tets.size(), " tets but ", what, " for ", size, "."));
  };
  requirePerTet(map.parameters.size(), "parameters");
  if (!map.rotations.empty()) requirePerTet(map.rotations.size(), "rotations");
  if (!map.regions.empty()) requirePerTet(map.regions.size(), "regions");
  requireFinite(map.points, stage);
  const auto isInRange = [&map](std::size_t t) {
    return *std::max_element(map.tets[t].begin(), map.tets[t].end()) < map.points.size();
  };
  const std::size_t tet = firstFault(stage, map.tets.size(), [&](std::size_t t) {
    return isInRange(t) && isFinite(map.parameters[t]);
  });
  if (tet == map.tets.size()) return;
  const bool range = isInRange(tet);
  throw Error(range ? ErrorCode::NotFinite : ErrorCode::IndexOutOfRange,
              range ? concat("A parameter of tet ", tet, " is not finite.")
                    : concat("Tet ", tet, " names a vertex that does not exist."),
              Place{PlaceKind::Tet, tet});
}

void requireWritable(const HexMesh& mesh, const WriteOptions& options, Stage& stage) {
  adjacency::requireCornersInRange(mesh, stage);
  requireGenerators(mesh);
  requireSize(mesh.regions.size(), mesh.cells.size(), "cells", "regions");
  mesh::requirePatchAngle(options.patchAngle);
  requireSize(options.scaledJacobians.size(), mesh.cells.size(), "cells", "scaled Jacobians");
  requireFinite(mesh.points, stage);
  for (const OtherCellList& kind : othersOf(options).kinds) {
    const std::string_view what = typeWith(kind.corners).plural;
    requireSize(kind.regions.size(), kind.count(), what, "regions");
    const auto vertex = std::find_if(kind.vertices.begin(), kind.vertices.end(),
                                     [&](Index v) { return v >= mesh.points.size(); });
    if (vertex == kind.vertices.end() && kind.vertices.size() % kind.corners == 0) continue;
    throw Error(ErrorCode::InvalidArgument,
                concat("One of the ", what, " names a vertex that does not exist, or lacks one."));
  }
}

namespace {

std::string numbers(std::uint64_t first, std::uint64_t size) {
  return concat(size, " from number ", first, " on");
}

}  // namespace

SinkCalls::SinkCalls(std::string name, std::string_view stage, Context& context)
    : name_(std::move(name)), stage_(stage), context_(context), quiet_(context.threads()) {}

void SinkCalls::run(FunctionRef<void()> call) {
  const State before = std::exchange(state_, State::Failed);
  if (before == State::Failed) refuse("a call before this one failed");
  if (before == State::Ended) refuse("end() was called before");
  context_.throwIfCancelled();
  const auto begin = std::chrono::steady_clock::now();
  state_ = before;
  try {
    call();
  } catch (...) {
    state_ = State::Failed;
    throw;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  context_.addStageTime(stage_, seconds.count());
}

void SinkCalls::begin(std::uint64_t pointCount, std::uint64_t cellCount) {
  if (state_ != State::Fresh) refuse("begin() was called twice");
  // Keeps products of a count and an element's bytes from overflowing.
  constexpr std::uint64_t kMost = std::uint64_t{1} << 48U;
  if (std::max(pointCount, cellCount) > kMost) {
    throw Error(ErrorCode::TooLarge, concat(name_, ": a mesh of ", pointCount, " vertices and ",
                                            cellCount, " cells is too large for a file."));
  }
  pointCount_ = pointCount;
  cellCount_ = cellCount;
  state_ = State::Points;
}

void SinkCalls::points(const PointPiece& piece) {
  if (state_ == State::Fresh) refuse("points() was called before begin()");
  if (state_ == State::Cells) refuse("points() was called after cells()");
  requireNext("vertices", piece.first, piece.points.size(), nextPoint_, pointCount_);
  if (piece.points.empty()) return;
  if (nextPoint_ == 0) {
    hasTets_ = !piece.generatorTet.empty();
    hasCorners_ = !piece.generatorCorners.empty();
  }
  requireConsistent(piece);
  nextPoint_ += piece.points.size();
}

bool SinkCalls::beginsCells() {
  if (state_ == State::Fresh) refuse("cells() or end() was called before begin()");
  if (nextPoint_ != pointCount_) {
    refuse(
        concat("only ", nextPoint_, " of ", pointCount_, " vertices came before cells() or end()"));
  }
  return std::exchange(state_, State::Cells) == State::Points;
}

template <class Cell>
void SinkCalls::cells(std::uint64_t first, std::span<const Cell> cells) {
  requireNext("cells", first, cells.size(), nextCell_, cellCount_);
  const auto isInRange = [&](std::size_t c) {
    return *std::max_element(cells[c].begin(), cells[c].end()) < pointCount_;
  };
  Stage stage(quiet_, "check");
  std::size_t wrong = 0;
  withThreadsHere(quiet_.threads(),
                  [&] { wrong = firstFault(stage, cells.size(), isInRange, kCheckedSinkGrain); });
  if (wrong < cells.size()) {
    throw Error(
        ErrorCode::InvalidArgument,
        concat(name_, ": a corner of cell ", first + wrong, " is not a vertex of the mesh."),
        Place{PlaceKind::Cell, first + wrong});
  }
  nextCell_ += cells.size();
}
template void SinkCalls::cells(std::uint64_t first, std::span<const Hex> cells);
template void SinkCalls::cells(std::uint64_t first, std::span<const Hex64> cells);

void SinkCalls::end() {
  if (nextCell_ != cellCount_) {
    refuse(concat("only ", nextCell_, " of ", cellCount_, " cells came before end()"));
  }
  state_ = State::Ended;
}

void SinkCalls::requireNext(const char* what, std::uint64_t first, std::uint64_t size,
                            std::uint64_t next, std::uint64_t count) const {
  if (first != next) {
    refuse(concat("number ", next, " of the ", what, " has to come next, but ",
                  numbers(first, size), " came"));
  }
  if (size > count - next) {
    refuse(concat(numbers(first, size), " are more ", what, " than the ", count,
                  " that begin() announced"));
  }
}

void SinkCalls::requireConsistent(const PointPiece& piece) {
  const auto fits = [&piece](std::size_t size, bool expected) {
    return size == (expected ? piece.points.size() : 0);
  };
  if (!fits(piece.generatorTet.size(), hasTets_) ||
      !fits(piece.generatorCorners.size(), hasCorners_)) {
    refuse("the generators of the vertices " + numbers(piece.first, piece.points.size()) +
           " are not as many as the vertices, or are missing in some pieces only");
  }
  Stage stage(quiet_, "check");
  std::size_t wrong = 0;
  withThreadsHere(quiet_.threads(), [&] { wrong = firstNotFinite(piece.points, stage); });
  if (wrong == piece.points.size()) return;
  throw Error(ErrorCode::NotFinite,
              concat(name_, ": a coordinate of vertex ", piece.first + wrong, " is not finite."),
              Place{PlaceKind::Vertex, piece.first + wrong});
}

void SinkCalls::refuse(const std::string& sentence) const {
  throw Error(ErrorCode::InvalidArgument,
              name_ + ": a mesh in pieces came in the wrong way: " + sentence +
                  ". A sink takes begin(), all vertices in order, all cells in order, and end().");
}

namespace {

// Points or cells per piece: a few megabytes.
constexpr std::size_t kPiece = std::size_t{1} << 16;

/// Elements [first, first + count); empty if the array is empty.
template <class T>
std::span<const T> part(const Array<T>& values, std::size_t first, std::size_t count) {
  if (values.empty()) return {};
  return std::span(values).subspan(first, count);
}

}  // namespace

void sendTo(MeshSink& sink, const HexMesh& mesh) {
  requireGenerators(mesh);
  sink.begin(mesh.points.size(), mesh.cells.size());
  for (std::size_t first = 0; first < mesh.points.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, mesh.points.size() - first);
    sink.points({first, part(mesh.points, first, count), part(mesh.generatorTet, first, count),
                 part(mesh.generatorCorners, first, count)});
  }
  for (std::size_t first = 0; first < mesh.cells.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, mesh.cells.size() - first);
    sink.cells(first, part(mesh.cells, first, count));
  }
  sink.end();
}

}  // namespace hexhex::io
