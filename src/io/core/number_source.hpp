// The numbers of a file, for readers that need not know whether they are text or bytes.
//
// A source stands somewhere in the file; records, which are equal runs of numbers, are read in
// parallel through a function f(record, i). Of several errors the first one is reported, for any
// number of threads.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <io/core/bytes.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex {

/// How many numbers of each kind a record has.
struct RecordShape {
  std::size_t sizes = 0;     ///< integers of 8 bytes, none negative
  std::size_t integers = 0;  ///< integers and single precision numbers: 4 bytes
  std::size_t reals = 0;     ///< double precision: 8 bytes

  [[nodiscard]] std::size_t tokens() const { return sizes + integers + reals; }
  [[nodiscard]] std::size_t bytes() const { return 8 * sizes + 4 * integers + 8 * reals; }
};

/// Numbers as text.
class TextSource {
 public:
  /// @param scanner  which the source moves
  TextSource(TextScanner& scanner, const TokenIndex& index, Stage& stage)
      : scanner_(&scanner), index_(&index), stage_(&stage) {}

  [[nodiscard]] std::uint64_t size(const char* what) {
    const std::int64_t value = integer(what);
    if (value < 0) fail(ErrorCode::FileSyntax, std::string(what) + " is negative.");
    return static_cast<std::uint64_t>(value);
  }
  [[nodiscard]] std::int64_t integer(const char* what) {
    std::int64_t value = 0;
    if (!scanner_->readInteger(value)) scanner_->failInteger(what);
    return value;
  }
  [[nodiscard]] double real(const char* what) {
    double value = 0;
    if (!scanner_->readNumber(value)) scanner_->failNumber(what);
    return value;
  }

  [[nodiscard]] std::size_t position() const { return scanner_->position(); }
  void moveTo(std::size_t position) { scanner_->moveTo(position); }

  /// How many records there can be in the rest of the file.
  [[nodiscard]] std::size_t room(RecordShape shape) const {
    return (index_->count() - index_->countBefore(position())) / shape.tokens();
  }
  /// Goes on behind n records, for which there is room.
  void skip(std::size_t n, RecordShape shape) {
    moveTo(index_->find(index_->countBefore(position()) + n * shape.tokens()));
  }
  template <class F>
  void records(std::size_t n, RecordShape shape, const F& f) {
    readElements(*scanner_, index_, *stage_, n, shape.tokens(),
                 [&](TextScanner& scanner, std::size_t i) {
                   TextSource record(scanner, *index_, *stage_);
                   f(record, i);
                 });
  }
  /// Text has no records of a fixed size.
  template <class Quick, class F>
  void records(std::size_t n, RecordShape shape, const Quick& /*quick*/, const F& f) {
    records(n, shape, f);
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& sentence) const {
    scanner_->fail(code, sentence);
  }
  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place) const {
    scanner_->fail(code, sentence, place);
  }

 private:
  TextScanner* scanner_;
  const TokenIndex* index_;
  Stage* stage_;
};

/// Bytes of a file, in memory or on the disk.
class ByteFile {
 public:
  explicit ByteFile(std::string_view bytes) : bytes_(bytes), size_(bytes.size()) {}
  /// @param input  a regular file; outlives this
  explicit ByteFile(const InputFile& input) : input_(&input), size_(input.size()) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Bytes of the file, for which there is room if they are not in memory. Thread-safe.
  [[nodiscard]] std::string_view view(std::size_t position, std::size_t size, char* room) const {
    if (input_ == nullptr) return bytes_.substr(position, size);
    input_->readAt(position, room, size);
    return {room, size};
  }
  /// Everything if it is in memory, else nothing.
  [[nodiscard]] std::string_view inMemory() const noexcept { return bytes_; }

 private:
  const InputFile* input_ = nullptr;
  std::string_view bytes_;
  std::size_t size_;
};

/// Numbers as bytes, the least first.
class BinarySource {
 public:
  /// @param file  outlives this, and so does the name
  BinarySource(const ByteFile& file, std::size_t position, const std::string& fileName,
               Stage& stage)
      : file_(&file),
        window_(file.inMemory()),
        position_(position),
        fileName_(&fileName),
        stage_(&stage) {}

  [[nodiscard]] std::uint64_t size(const char* what) { return read<std::uint64_t>(what); }
  [[nodiscard]] std::int64_t integer(const char* what) { return read<std::int32_t>(what); }
  [[nodiscard]] double real(const char* what) { return finite(read<double>(what), what); }
  /// A number of single precision.
  [[nodiscard]] double shortReal(const char* what) {
    return finite(double{read<float>(what)}, what);
  }

  [[nodiscard]] std::size_t position() const { return position_; }
  void moveTo(std::size_t position) { position_ = position; }

  [[nodiscard]] std::size_t room(RecordShape shape) const {
    return (file_->size() - position_) / shape.bytes();
  }
  void skip(std::size_t n, RecordShape shape) { position_ += n * shape.bytes(); }
  template <class F>
  void records(std::size_t n, RecordShape shape, const F& f) {
    const auto number = [&f](BinarySource& record, const char* /*place*/, std::size_t i) {
      f(record, i);
      return true;
    };
    readRecords(n, shape, number, f);
  }
  /// The same, faster: quick(place, i) takes record i from its bytes, and returns false if anything
  /// is wrong with it; then f(record, i) has to say what.
  template <class Quick, class F>
  void records(std::size_t n, RecordShape shape, const Quick& quick, const F& f) {
    const auto bytes = [&quick](BinarySource& /*record*/, const char* place, std::size_t i) {
      return quick(place, i);
    };
    readRecords(n, shape, bytes, f);
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place = {}) const {
    throw Error(code, *fileName_ + ", byte " + std::to_string(position_) + ": " + sentence, place);
  }

 private:
  /// @param take  reads record i, or returns false or throws if it is wrong
  /// @param f     throws about a record that is wrong
  template <class Take, class F>
  void readRecords(std::size_t n, RecordShape shape, const Take& take, const F& f) {
    const std::size_t begin = position_;
    std::atomic<std::size_t> firstWrong{n};
    parallelBlocks(
        *stage_, n, kElementGrain, [&](std::size_t from, std::size_t to, std::size_t /*block*/) {
          if (from > firstWrong.load(std::memory_order_relaxed)) return;
          const std::size_t size = (to - from) * shape.bytes();
          const std::unique_ptr<char[]> room(window_.empty() ? new char[size] : nullptr);
          BinarySource source(*this, begin + from * shape.bytes(), size, room.get());
          const char* place = source.window_.data() + source.position_ - source.windowBegin_;
          std::size_t i = from;
          try {
            while (i < to && take(source, place, i)) {
              ++i;
              place += shape.bytes();
              source.position_ = begin + i * shape.bytes();
            }
          } catch (const Error&) {  // record i is wrong, and told about below
          }
          if (i == to) return;
          lowerTo(i, firstWrong);
        });
    if (firstWrong < n) {  // throws again
      BinarySource source(*file_, begin + firstWrong * shape.bytes(), *fileName_, *stage_);
      f(source, firstWrong);
    }
    skip(n, shape);
  }

  /// A source that has a part of the file at hand.
  BinarySource(const BinarySource& whole, std::size_t position, std::size_t size, char* room)
      : file_(whole.file_),
        window_(whole.file_->view(position, size, room)),
        windowBegin_(position),
        position_(position),
        fileName_(whole.fileName_),
        stage_(whole.stage_) {}

  [[nodiscard]] double finite(double value, const char* what) const {
    if (!std::isfinite(value)) {
      fail(ErrorCode::NotFinite, std::string(what) + " is not finite.");
    }
    return value;
  }
  template <class T>
  T read(const char* what) {
    const std::size_t place = position_ - windowBegin_;
    if (window_.size() < sizeof(T) || place > window_.size() - sizeof(T)) return readAlone<T>(what);
    const T value = loadLittle<T>(window_.data() + place);
    position_ += sizeof(T);
    return value;
  }
  template <class T>
  T readAlone(const char* what) {
    if (position_ > file_->size() || file_->size() - position_ < sizeof(T)) {
      fail(ErrorCode::FileSyntax, std::string("the file ends within ") + what + ".");
    }
    std::array<char, sizeof(T)> room{};
    const T value = loadLittle<T>(file_->view(position_, sizeof(T), room.data()).data());
    position_ += sizeof(T);
    return value;
  }

  const ByteFile* file_;
  std::string_view window_;  ///< what is at hand
  std::size_t windowBegin_ = 0;
  std::size_t position_;
  const std::string* fileName_;
  Stage* stage_;
};

/// Refuses n records if the rest of the file has no room for so many.
/// @param what  plural, e.g. "nodes"
template <class Source>
void requireRoom(const Source& source, std::uint64_t n, RecordShape shape, std::string_view what) {
  const std::size_t room = source.room(shape);
  if (n <= room) return;
  source.fail(ErrorCode::FileSyntax, "announces " + std::to_string(n) + " " + std::string(what) +
                                         ", but the rest of the file has room for at most " +
                                         std::to_string(room) +
                                         ": either the number is wrong or the file is incomplete.");
}

/// Refuses more elements than indices can number.
template <class Source>
void requireIndexable(const Source& source, std::uint64_t n, std::string_view what) {
  if (n <= kNone) return;
  source.fail(ErrorCode::TooLarge, "has " + std::to_string(n) + " " + std::string(what) +
                                       "; at most " + std::to_string(kNone) + " are supported.");
}

}  // namespace hexhex
