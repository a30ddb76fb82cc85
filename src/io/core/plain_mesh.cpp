#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/bytes.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/plain_mesh.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kTextAtOnce = std::size_t{1} << 20;  // per read of a thread

[[noreturn]] void failPlain(const char* what) {
  throw Error(ErrorCode::FileSyntax, concat("The file has ", what, "."));
}

/// The index of the vertex with this number in the file. @throws Error
std::uint64_t vertexOf(std::uint64_t number, const PlainLayout& layout) {
  // Numbers below firstVertex wrap around.
  if (number - layout.firstVertex < layout.points.count) return number - layout.firstVertex;
  failPlain("a cell with a vertex that does not exist");
}

/// Reads consecutive points or cells. Error messages are terse: the whole-file reader repeats them
/// with details.
class PlainText {
 public:
  PlainText(const ByteFile& file, const PlainLayout& layout, Context& context)
      : layout_(layout), text_(file, context) {}

  void moveTo(const PlainRun& run) { text_.moveTo(run.position); }
  void read(std::span<Vec3> to) {
    text_.elements(to.size(), 3 + layout_.behindPoint, [&](TextScanner& scanner, std::size_t i) {
      for (double& x : to[i]) x = scanner.number("a coordinate");
      skip(scanner, layout_.behindPoint);
    });
  }
  void read(std::span<Hex64> to) {
    const std::size_t tokens = layout_.inFrontOfCell + 8 + layout_.behindCell;
    text_.elements(to.size(), tokens, [&](TextScanner& scanner, std::size_t i) {
      for (std::size_t k = 0; k < layout_.inFrontOfCell; ++k) {
        if (scanner.integer("a number") != 8 && layout_.tellsCorners) failPlain("other cells");
      }
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexOf(static_cast<std::uint64_t>(scanner.integer("a vertex")), layout_);
      }
      skip(scanner, layout_.behindCell);
    });
  }

 private:
  static void skip(TextScanner& scanner, std::size_t references) {
    for (std::size_t k = 0; k < references; ++k) {
      if (!std::in_range<std::int32_t>(scanner.integer("a reference")))
        failPlain("wide references");
    }
  }

  const PlainLayout& layout_;
  TextWindow text_;
};

class PlainBytes {
 public:
  PlainBytes(const ByteFile& file, const PlainLayout& layout, Context& context)
      : file_(file), layout_(layout), quiet_(context.threads()) {}

  void moveTo(const PlainRun& run) { position_ = run.position; }
  void read(std::span<Vec3> to) {
    if (!layout_.isBigEndian) return readPoints<double, false>(to);
    layout_.coordinateBytes == 4 ? readPoints<float, true>(to) : readPoints<double, true>(to);
  }
  void read(std::span<Hex64> to) {
    if (layout_.isBigEndian) return readCells<std::uint32_t, true>(to);
    layout_.integerBytes == 8 ? readCells<std::uint64_t, false>(to)
                              : readCells<std::uint32_t, false>(to);
  }

 private:
  template <class T, bool big>
  static T load(const char* place) {
    if constexpr (big) return loadBig<T>(place);
    return loadLittle<T>(place);
  }
  template <class T, bool big>
  void readPoints(std::span<Vec3> to) {
    forEach(to.size(), layout_.pointBytes(), [to](const char* record, std::size_t i) {
      for (std::size_t k = 0; k < 3; ++k) {
        to[i][k] = load<T, big>(record + k * sizeof(T));
        if (!std::isfinite(to[i][k])) failPlain("a coordinate that is not finite");
      }
    });
  }
  template <class T, bool big>
  void readCells(std::span<Hex64> to) {
    const std::size_t front = layout_.inFrontOfCell * sizeof(T);
    forEach(to.size(), layout_.cellBytes(), [&](const char* record, std::size_t i) {
      if (layout_.tellsCorners && load<T, big>(record) != 8) failPlain("other cells");
      for (std::size_t k = 0; k < 8; ++k) {
        to[i][k] = vertexOf(load<T, big>(record + front + k * sizeof(T)), layout_);
      }
    });
  }

  /// Calls f(bytes, i) for the next n records and advances past them.
  template <class F>
  void forEach(std::size_t n, std::size_t bytesEach, const F& f) {
    constexpr std::size_t kGrain = 4096;
    Stage stage(quiet_, "read");
    parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
      const std::unique_ptr<char[]> room(new char[(end - begin) * bytesEach]);
      file_.readAt(position_ + begin * bytesEach, room.get(), (end - begin) * bytesEach);
      for (std::size_t i = begin; i < end; ++i) f(room.get() + (i - begin) * bytesEach, i);
    });
    position_ += n * bytesEach;
  }

  const ByteFile& file_;
  const PlainLayout& layout_;
  Context quiet_;  // many short loops, which report no progress
  std::uint64_t position_ = 0;
};

/// The file turned out to be invalid after some pieces had been sent.
struct WrongFile {
  Error error;
};

/// Reads the elements of a run and sends them in pieces.
template <class T, class Reader, class Send>
void sendRun(Reader& reader, const PlainRun& run, const Send& send, LoopProgress& progress) {
  Array<T> piece;
  for (std::uint64_t first = 0; first < run.count; first += kPieceElements) {
    piece.resize(std::min<std::uint64_t>(kPieceElements, run.count - first));
    try {
      if (first == 0) reader.moveTo(run);
      reader.read(std::span<T>(piece));
    } catch (const Error& error) {
      throw WrongFile{error};
    }
    send(first, std::span<const T>(piece));
    progress.advance(piece.size());
  }
}

template <class Reader>
void sendPlain(const ByteFile& file, const PlainLayout& layout, MeshSink& sink, Stage& stage) {
  Reader reader(file, layout, stage.context());
  LoopProgress progress(stage, layout.points.count + layout.cells.count);
  sink.begin(layout.points.count, layout.cells.count);
  const auto sendPoints = [&](std::uint64_t first, std::span<const Vec3> points) {
    sink.points({first, points, {}, {}});
  };
  const auto sendCells = [&](std::uint64_t first, std::span<const Hex64> cells) {
    sink.cells(first, cells);
  };
  sendRun<Vec3>(reader, layout.points, sendPoints, progress);
  sendRun<Hex64>(reader, layout.cells, sendCells, progress);
  sink.end();
}

std::optional<PlainLayout> lookAt(const PlainFormat& format, const ByteFile& file,
                                  Context& context) {
  try {
    return format.look(file, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    return {};  // the whole-file reader reports what is wrong
  }
}

}  // namespace

void readPlainMesh(const PlainFormat& format, MeshSink& sink, const Input& input,
                   Context& context) {
  const auto readWhole = [&] {
    return inStage(context, "read mesh",
                   [&](Stage& stage) { return format.readWhole(input, stage); });
  };
  std::error_code unknown;
  // A pipe can be opened only once.
  if (!input.bytes() && std::filesystem::is_regular_file(input.path(), unknown)) {
    const InputFile opened(input.path());
    const ByteFile file(opened, input.name());
    Stage stage(context, "read mesh");
    const std::optional<PlainLayout> layout = lookAt(format, file, context);
    try {
      if (layout) {
        input.counts()->add(kCellKind<8>, layout->cells.count);
        const auto send = layout->isText ? sendPlain<PlainText> : sendPlain<PlainBytes>;
        return send(file, *layout, sink, stage);
      }
    } catch (const WrongFile& wrong) {
      // The whole-file reader reports the first error, with its line.
      static_cast<void>(readWhole());
      throw wrong.error;
    }
  }
  sendTo(sink, readWhole());
}

TextWindow::TextWindow(const ByteFile& file, Context& context, std::size_t size)
    : file_(file), context_(context), quiet_(context.threads()), stage_(quiet_, "read") {
  bytes_.resize(std::min<std::uint64_t>(size, file.size()));
  moveTo(0);
}

void TextWindow::moveTo(std::uint64_t position) {
  begin_ = position;
  size_ = 0;
  open({});
  fill();
}

void TextWindow::open(std::string_view text) {
  source_.emplace(text, file_.name(), stage_);
  source_->makeIndex();
}

bool TextWindow::fill() {
  context_.throwIfCancelled();
  const std::size_t behind = source_->position();
  const std::size_t kept = size_ - behind;
  if (kept > 0) std::memmove(bytes_.data(), bytes_.data() + behind, kept);
  begin_ += behind;
  const std::uint64_t left = file_.size() - std::min<std::uint64_t>(file_.size(), begin_ + kept);
  const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(bytes_.size() - kept, left));
  parallelBlocks(stage_, more, kTextAtOnce,
                 [&](std::size_t from, std::size_t to, std::size_t /*block*/) {
                   file_.readAt(begin_ + kept + from, bytes_.data() + kept + from, to - from);
                 });
  size_ = kept + more;
  // A token at the end of the window may be incomplete: keep it for the next fill.
  std::string_view text(bytes_.data(), size_);
  if (more < left) {
    while (!text.empty() && !isSpace(text.back())) text.remove_suffix(1);
    if (text.empty()) text = {bytes_.data(), size_};
  }
  open(text);
  sawComments_ = sawComments_ || text.find('#') != std::string_view::npos;
  return more > 0;
}

std::string TextWindow::token() {
  while (source_->tokensLeft() == 0 && fill()) {
  }
  return std::string(source_->readToken());
}

std::optional<std::uint64_t> TextWindow::count() {
  const std::string word = token();
  std::uint64_t number = 0;
  // The limit keeps products with a record's bytes from overflowing.
  if (!parseInteger(word, number) || number > file_.size()) return {};
  return number;
}

bool TextWindow::skip(std::uint64_t tokens) {
  while (true) {
    const std::size_t left = source_->tokensLeft();
    if (tokens <= left) {
      // Stop after the last token, not at the next one: binary data may follow.
      if (tokens > 0) {
        source_->skipTokens(static_cast<std::size_t>(tokens) - 1);
        static_cast<void>(source_->readToken());
      }
      return true;
    }
    tokens -= left;
    source_->moveTo(source_->text().size());
    if (!fill()) return false;
  }
}

bool TextWindow::skipLineBreak() {
  const std::string_view rest = source_->text().substr(source_->position());
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos || rest.find_first_not_of(" \r") != end) return false;
  source_->moveTo(source_->position() + end + 1);
  return true;
}

}  // namespace hexhex::io
