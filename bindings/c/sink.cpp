#include <utility>

#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/summary.hpp>

#include "options.hpp"

namespace {

using hexhex::Error;
using hexhex::ErrorCode;
using hexhex::MeshSink;

/// Hands pieces to the caller's functions.
class CallbackSink : public MeshSink {
 public:
  explicit CallbackSink(const hexhex_sink* sink)
      : sink_(hexhex::c::readStruct(&hexhex::c::require(sink, "sink"), HEXHEX_SINK_INIT, "sink")) {}

  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    if (sink_.begin != nullptr) goOn(sink_.begin(sink_.user, pointCount, cellCount));
  }
  void points(const hexhex::PointPiece& piece) override {
    if (sink_.points == nullptr) return;
    goOn(sink_.points(sink_.user, piece.first, piece.points.size(),
                      reinterpret_cast<const double*>(piece.points.data()),
                      piece.generatorTet.empty() ? nullptr : piece.generatorTet.data(),
                      piece.generatorCorners.empty() ? nullptr : piece.generatorCorners.data()));
  }
  void cells(std::uint64_t first, std::span<const hexhex::Hex> cells) override {
    if (sink_.cells == nullptr) return;
    goOn(sink_.cells(sink_.user, first, cells.size(),
                     reinterpret_cast<const std::uint32_t*>(cells.data())));
  }
  void cells(std::uint64_t first, std::span<const hexhex::Hex64> cells) override {
    if (sink_.cells64 == nullptr) {
      throw Error(ErrorCode::TooLarge,
                  "The mesh has more vertices than 32 bits can number, and the sink has no "
                  "function cells64.");
    }
    goOn(sink_.cells64(sink_.user, first, cells.size(),
                       reinterpret_cast<const std::uint64_t*>(cells.data())));
  }
  void end() override {
    if (sink_.end != nullptr) goOn(sink_.end(sink_.user));
  }
  [[nodiscard]] const hexhex_sink& given() const noexcept { return sink_; }

 private:
  static void goOn(int answer) {
    if (answer != 0) throw Error(ErrorCode::Cancelled, "The sink asked to stop.");
  }
  hexhex_sink sink_;
};

/// The functions of a writer as a sink, for callers that call them. Where the library gets them
/// back, it goes around them, and so keeps the writer's errors.
int writerBegin(void* writer, std::uint64_t points, std::uint64_t cells) {
  return hexhex_mesh_writer_begin(static_cast<hexhex_mesh_writer*>(writer), points, cells, nullptr);
}
int writerPoints(void* writer, std::uint64_t first, std::size_t count, const double* points,
                 const std::uint32_t* tets, const std::uint8_t* corners) {
  return hexhex_mesh_writer_points(static_cast<hexhex_mesh_writer*>(writer), first, count, points,
                                   tets, corners, nullptr);
}
int writerCells(void* writer, std::uint64_t first, std::size_t count, const std::uint32_t* cells) {
  return hexhex_mesh_writer_cells(static_cast<hexhex_mesh_writer*>(writer), first, count, cells,
                                  nullptr);
}
int writerCells64(void* writer, std::uint64_t first, std::size_t count,
                  const std::uint64_t* cells) {
  return hexhex_mesh_writer_cells64(static_cast<hexhex_mesh_writer*>(writer), first, count, cells,
                                    nullptr);
}
int writerEnd(void* writer) {
  return hexhex_mesh_writer_end(static_cast<hexhex_mesh_writer*>(writer), nullptr);
}

/// The caller's functions, or the writer behind them.
class Target {
 public:
  explicit Target(const hexhex_sink* sink) : callbacks_(sink) {
    if (callbacks_.given().end == &writerEnd) {
      writer_ = std::make_unique<UsedWriter>(
          static_cast<hexhex_mesh_writer*>(callbacks_.given().user), "sink");
    }
  }
  MeshSink& operator*() noexcept { return writer_ ? *(*writer_)->sink : callbacks_; }
  /// Nothing has failed.
  void finish() noexcept {
    if (writer_) (*writer_)->ended = true;
  }

 private:
  CallbackSink callbacks_;
  using UsedWriter = hexhex::c::Used<hexhex_mesh_writer>;
  std::unique_ptr<UsedWriter> writer_;
};

}  // namespace

hexhex_status hexhex_extract_to(const hexhex_sink* sink, const hexhex_map* map,
                                const hexhex_extract_options* options, hexhex_context* context,
                                hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    Target target(sink);
    ContextOrDefault used(context);
    hexhex::ExtractStatistics filled;
    hexhex::extractTo(*target, Used(map, "map")->view, extractOptions(options, used.repaired()),
                      *used, &filled);
    target.finish();
    writeStatistics(filled, statistics);
  });
}

hexhex_status hexhex_extractor_extract_to(hexhex_extractor* extractor, const hexhex_sink* sink,
                                          const hexhex_extract_options* options,
                                          hexhex_context* context, hexhex_statistics* statistics,
                                          hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    Target target(sink);
    ContextOrDefault used(context);
    hexhex::ExtractStatistics filled;
    Used(extractor, "extractor")
        ->extractor.extractTo(*target, extractOptions(options, used.repaired()), *used, &filled);
    target.finish();
    writeStatistics(filled, statistics);
  });
}

hexhex_status hexhex_extract_to_file(const char* file, const hexhex_map* map,
                                     const hexhex_extract_options* options, hexhex_context* context,
                                     hexhex_statistics* statistics, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    ContextOrDefault used(context);
    hexhex::ExtractStatistics filled;
    hexhex::extractToFile(&require(file, "file"), Used(map, "map")->view,
                          extractOptions(options, used.repaired()), *used, &filled);
    writeStatistics(filled, statistics);
  });
}

hexhex_status hexhex_mesh_read_to(const hexhex_sink* sink, const char* file,
                                  const hexhex_read_options* options, hexhex_context* context,
                                  hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    Target target(sink);
    ContextOrDefault used(context);
    hexhex::readHexMeshTo(*target, &require(file, "file"), readOptions(options), *used);
    target.finish();
  });
}

hexhex_status hexhex_summary_writer_create(hexhex_context* context, hexhex_mesh_writer** writer,
                                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(writer, "writer");
    auto handle = std::make_unique<hexhex_mesh_writer>(context);
    auto summary = std::make_unique<hexhex::SummarySink>(handle->context());
    handle->summary = summary.get();
    handle->sink = std::move(summary);
    *writer = enter(std::move(handle));
  });
}

hexhex_status hexhex_summary_writer_get(const hexhex_mesh_writer* writer,
                                        hexhex_mesh_summary* summary, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used given(writer, "writer");
    if (given->summary == nullptr || !given->ended) {
      throw Error(ErrorCode::InvalidArgument,
                  "The writer has added nothing up: make it with hexhex_summary_writer_create(), "
                  "and ask after its end.");
    }
    writeSummary(given->summary->result(), summary);
  });
}

hexhex_status hexhex_mesh_writer_sink(hexhex_mesh_writer* writer, hexhex_sink* sink,
                                      hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(writer, "writer");
    const hexhex_sink result = {.size = sizeof(hexhex_sink),
                                .user = writer,
                                .begin = writerBegin,
                                .points = writerPoints,
                                .cells = writerCells,
                                .cells64 = writerCells64,
                                .end = writerEnd};
    writeStruct(result, require(sink, "sink"), "sink");
  });
}

hexhex_status hexhex_mesh_writer_create(const char* file, const hexhex_write_options* options,
                                        hexhex_context* context, hexhex_mesh_writer** writer,
                                        hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(writer, "writer");
    auto handle = std::make_unique<hexhex_mesh_writer>(context);
    handle->sink =
        hexhex::openMeshSink(&require(file, "file"), writeOptions(options, 0), handle->context());
    *writer = enter(std::move(handle));
  });
}

hexhex_status hexhex_mesh_writer_begin(hexhex_mesh_writer* writer, uint64_t point_count,
                                       uint64_t cell_count, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] { Used(writer, "writer")->sink->begin(point_count, cell_count); });
}

hexhex_status hexhex_mesh_writer_points(hexhex_mesh_writer* writer, uint64_t first, size_t count,
                                        const double* points, const uint32_t* generator_tet,
                                        const uint8_t* generator_corners, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    hexhex::PointPiece piece;
    piece.first = first;
    piece.points = borrowed<hexhex::Vec3>(points, count, "points");
    if (generator_tet != nullptr && generator_corners != nullptr) {
      piece.generatorTet = {generator_tet, count};
      piece.generatorCorners = {generator_corners, count};
    }
    Used(writer, "writer")->sink->points(piece);
  });
}

hexhex_status hexhex_mesh_writer_cells(hexhex_mesh_writer* writer, uint64_t first, size_t count,
                                       const uint32_t* cells, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    Used(writer, "writer")->sink->cells(first, borrowed<hexhex::Hex>(cells, count, "cells"));
  });
}

hexhex_status hexhex_mesh_writer_cells64(hexhex_mesh_writer* writer, uint64_t first, size_t count,
                                         const uint64_t* cells, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    Used(writer, "writer")->sink->cells(first, borrowed<hexhex::Hex64>(cells, count, "cells"));
  });
}

hexhex_status hexhex_mesh_writer_end(hexhex_mesh_writer* writer, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(writer, "writer");
    used->sink->end();
    used->ended = true;
  });
}

void hexhex_mesh_writer_destroy(hexhex_mesh_writer* writer) { hexhex::c::destroy(writer); }
