// The numbers of a file, for readers that need not know whether they are text or bytes.
//
// A source stands somewhere in the file; records, which are equal runs of numbers, are read in
// parallel through a function f(record, i). Of several errors the first one is reported, for any
// number of threads.
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/ovmb_bytes.hpp>
#include <io/text_elements.hpp>
#include <io/text_scanner.hpp>
#include <io/token_index.hpp>

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

/// Numbers as bytes, the least first.
class BinarySource {
 public:
  BinarySource(std::string_view file, std::size_t position, const std::string& fileName,
               Stage& stage)
      : file_(file), position_(position), fileName_(&fileName), stage_(&stage) {}

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
    return (file_.size() - position_) / shape.bytes();
  }
  void skip(std::size_t n, RecordShape shape) { position_ += n * shape.bytes(); }
  template <class F>
  void records(std::size_t n, RecordShape shape, const F& f) {
    const std::size_t begin = position_;
    const auto readOne = [&](std::size_t i) {
      BinarySource record(file_, begin + i * shape.bytes(), *fileName_, *stage_);
      f(record, i);
    };
    std::atomic<std::size_t> firstWrong{n};
    parallelFor(*stage_, n, kElementGrain, [&](std::size_t i) {
      if (i > firstWrong.load(std::memory_order_relaxed)) return;
      try {
        readOne(i);
      } catch (const Error&) {
        std::size_t known = firstWrong.load(std::memory_order_relaxed);
        while (i < known && !firstWrong.compare_exchange_weak(known, i)) {
        }
      }
    });
    if (firstWrong < n) readOne(firstWrong);  // throws again
    skip(n, shape);
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place = {}) const {
    throw Error(code, *fileName_ + ", byte " + std::to_string(position_) + ": " + sentence, place);
  }

 private:
  [[nodiscard]] double finite(double value, const char* what) const {
    if (!std::isfinite(value)) {
      fail(ErrorCode::NotFinite, std::string(what) + " is not finite.");
    }
    return value;
  }
  template <class T>
  T read(const char* what) {
    if (file_.size() - position_ < sizeof(T)) {
      fail(ErrorCode::FileSyntax, std::string("the file ends within ") + what + ".");
    }
    const T value = loadLittle<T>(file_.data() + position_);
    position_ += sizeof(T);
    return value;
  }

  std::string_view file_;
  std::size_t position_;
  const std::string* fileName_;
  Stage* stage_;
};

}  // namespace hexhex
