// Sources of numbers that let readers ignore whether a file is text or binary.
//
// A source has a position in the file. Records, which are runs of numbers of equal shape, are read
// in parallel by a function f(record, i); a record offers the same functions as its source. If
// several records are wrong, the first one is reported, for any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <io/core/bytes.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {

/// The number of values of each kind in a record.
struct RecordShape {
  std::size_t sizes = 0;     ///< nonnegative integers of 8 bytes
  std::size_t integers = 0;  ///< integers or floats of 4 bytes
  std::size_t reals = 0;     ///< doubles

  [[nodiscard]] std::size_t tokens() const { return sizes + integers + reals; }
  /// In 64 bits, since a file may claim any number of tags.
  [[nodiscard]] std::uint64_t bytes() const {
    return std::uint64_t{8} * sizes + std::uint64_t{4} * integers + std::uint64_t{8} * reals;
  }
};

/// Numbers as text: a scanner that reads runs of elements with several threads.
class TextSource : public TextScanner {
 public:
  /// @param text, stage  must outlive this
  TextSource(std::string_view text, std::string fileName, Stage& stage,
             Comments comments = Comments::None)
      : TextScanner(text, std::move(fileName), comments), stage_(&stage) {}

  /// @pre of tokensLeft(), skipTokens(), room() and skip(). None is made of a text with comments:
  /// one thread reads its elements, and they cannot be skipped.
  void makeIndex() {
    if (mayHaveComments() && text().find('#') != std::string_view::npos) return;
    index_ = std::make_shared<const TokenIndex>(text(), *stage_);
  }
  [[nodiscard]] bool hasIndex() const noexcept { return index_ != nullptr; }

  [[nodiscard]] std::uint64_t size(const NumberName& name) {
    const std::int64_t value = integer(name);
    if (value < 0) fail(ErrorCode::FileSyntax, name.text(), " is negative.");
    return static_cast<std::uint64_t>(value);
  }
  [[nodiscard]] double real(const NumberName& name) { return number(name); }
  /// The last number read, as spelled in the file.
  [[nodiscard]] std::string spelling(std::uint64_t /*number*/) const {
    return std::string(currentToken());
  }

  [[nodiscard]] std::size_t tokensLeft() const {
    return index_->count() - index_->countBefore(position());
  }
  /// Moves to the n-th token from here, or to the end of the text.
  void skipTokens(std::size_t n) { moveTo(index_->find(index_->countBefore(position()) + n)); }
  /// Maximum number of records in the rest of the file.
  [[nodiscard]] std::size_t room(RecordShape shape) const { return tokensLeft() / shape.tokens(); }
  /// Skips n records. @pre  n <= room(shape)
  void skip(std::size_t n, RecordShape shape) { skipTokens(n * shape.tokens()); }

  /// Calls read(source, i), which reads element i or throws an Error about it, for all i in [0, n).
  template <class Read>
  void inSequence(std::size_t n, const Read& read) {
    LoopProgress progress(*stage_, n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, n - i));
      read(*this, i);
    }
  }
  /// The same from several threads, with a source each; moves past the last element.
  ///
  /// If elements are invalid or missing, the error is about the first one, for any number of
  /// threads.
  template <class Read>
  void elements(std::size_t n, std::size_t tokensEach, const Read& read) {
    if (index_ == nullptr || n <= kElementGrain) return inSequence(n, read);
    const std::size_t firstToken = index_->countBefore(position());
    const std::size_t complete = std::min(n, (index_->count() - firstToken) / tokensEach);
    const auto moveToElement = [&](TextSource& moved, std::size_t element) {
      moved.moveTo(index_->find(firstToken + element * tokensEach));
    };
    const std::size_t wrong = firstUnreadable(
        *stage_, complete, kElementGrain, [&](std::size_t begin, std::size_t end, std::size_t& i) {
          TextSource local = *this;
          moveToElement(local, begin);
          for (; i < end; ++i) read(local, i);
        });
    // Normally nothing is left. Otherwise, reading sequentially throws the error of the first one.
    moveToElement(*this, wrong);
    for (std::size_t i = wrong; i < n; ++i) read(*this, i);
  }
  template <class Read>
  void records(std::size_t n, RecordShape shape, const Read& read) {
    elements(n, shape.tokens(), read);
  }

 private:
  Stage* stage_;
  std::shared_ptr<const TokenIndex> index_;
};

/// Bytes of a file, in memory or on disk.
class ByteFile {
 public:
  /// @param bytes  must outlive this, as must the name
  ByteFile(std::string_view bytes, const std::string& name)
      : bytes_(bytes), size_(bytes.size()), name_(&name) {}
  /// @param input  a regular file; must outlive this
  ByteFile(const InputFile& input, const std::string& name)
      : input_(&input), size_(input.size()), name_(&name) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool isInMemory() const noexcept { return input_ == nullptr; }
  /// Bytes of the file, read into `room` unless they are in memory. Thread-safe.
  [[nodiscard]] const char* view(std::size_t position, std::size_t size, char* room) const {
    if (isInMemory()) return bytes_.data() + position;
    input_->readAt(position, room, size);
    return room;
  }
  /// Copies bytes of the file. Thread-safe.
  void readAt(std::uint64_t position, char* to, std::size_t size) const {
    if (!isInMemory()) return input_->readAt(position, to, size);
    std::copy_n(bytes_.data() + position, size, to);
  }
  [[nodiscard]] const std::string& name() const noexcept { return *name_; }
  template <class... Parts>
  [[noreturn]] void fail(std::size_t position, ErrorCode code, Parts... sentence) const {
    fail(position, code, Place{}, sentence...);
  }
  template <class... Parts>
  [[noreturn]] void fail(std::size_t position, ErrorCode code, Place place,
                         Parts... sentence) const {
    throw Error(code, concat(*name_, ", byte ", position, ": ", sentence...), place);
  }

 private:
  const InputFile* input_ = nullptr;
  std::string_view bytes_;
  std::size_t size_;
  const std::string* name_;
};

/// Little-endian binary numbers.
/// @tparam Derived  has read<T>(name), which reads the bytes of a T, and fail()
template <class Derived>
class LittleEndianNumbers {
 public:
  [[nodiscard]] std::uint64_t size(const NumberName& name) { return read<std::uint64_t>(name); }
  [[nodiscard]] std::int64_t integer(const NumberName& name) { return read<std::int32_t>(name); }
  [[nodiscard]] double real(const NumberName& name) { return finite(read<double>(name), name); }
  /// A single-precision number.
  [[nodiscard]] double shortReal(const NumberName& name) {
    return finite(double{read<float>(name)}, name);
  }

 private:
  template <class T>
  T read(const NumberName& name) {
    return static_cast<Derived*>(this)->template read<T>(name);
  }
  double finite(double value, const NumberName& name) const {
    if (std::isfinite(value)) return value;
    static_cast<const Derived*>(this)->fail(ErrorCode::NotFinite, name.text(), " is not finite.");
  }
};

/// The numbers of one record, whose bytes are all in memory.
class BinaryRecord : public LittleEndianNumbers<BinaryRecord> {
 public:
  /// @param position  of the record in the file
  BinaryRecord(const ByteFile& file, std::size_t position, const char* bytes)
      : file_(&file), begin_(bytes), next_(bytes), position_(position) {}

  template <class T>
  [[nodiscard]] T read(const NumberName& /*name*/) {
    const T value = loadLittle<T>(next_);
    next_ += sizeof(T);
    return value;
  }

  [[nodiscard]] std::size_t position() const {
    return position_ + static_cast<std::size_t>(next_ - begin_);
  }
  void moveTo(std::size_t position) { next_ = begin_ + (position - position_); }
  void skip(std::size_t n, RecordShape shape) { next_ += n * shape.bytes(); }
  [[nodiscard]] static std::string spelling(std::uint64_t number) { return std::to_string(number); }

  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    file_->fail(position(), code, sentence...);
  }

 private:
  const ByteFile* file_;
  const char* begin_;
  const char* next_;
  std::size_t position_;
};

/// The numbers of a binary file.
class BinarySource : public LittleEndianNumbers<BinarySource> {
 public:
  /// @param file  must outlive this
  BinarySource(const ByteFile& file, std::size_t position, Stage& stage)
      : file_(&file), position_(position), stage_(&stage) {}

  template <class T>
  [[nodiscard]] T read(const NumberName& name) {
    if (position_ > file_->size() || file_->size() - position_ < sizeof(T)) {
      fail(ErrorCode::FileSyntax, "the file ends within ", name.text(), ".");
    }
    std::array<char, sizeof(T)> room{};
    const T value = loadLittle<T>(file_->view(position_, sizeof(T), room.data()));
    position_ += sizeof(T);
    return value;
  }

  [[nodiscard]] std::size_t position() const { return position_; }
  void moveTo(std::size_t position) { position_ = position; }

  [[nodiscard]] std::size_t room(RecordShape shape) const {
    return (file_->size() - position_) / shape.bytes();
  }
  void skip(std::size_t n, RecordShape shape) { position_ += n * shape.bytes(); }
  /// @pre  n <= room(shape)
  template <class F>
  void records(std::size_t n, RecordShape shape, const F& f) {
    std::size_t wrong = firstUnreadable(
        *stage_, n, kElementGrain, [&](std::size_t /*begin*/, std::size_t end, std::size_t& i) {
          readRecords(i, end, shape, f);
        });
    // Normally nothing is left. Otherwise, reading sequentially from the first failure throws its
    // error again, unless it was an I/O error that does not recur.
    while (wrong < n) readRecords(wrong, std::min(n, wrong + kElementGrain), shape, f);
    skip(n, shape);
  }

  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    file_->fail(position_, code, sentence...);
  }

 private:
  /// Reads records [i, end) and advances i.
  template <class F>
  void readRecords(std::size_t& i, std::size_t end, RecordShape shape, const F& f) const {
    const std::size_t each = shape.bytes();
    const std::size_t size = (end - i) * each;
    const std::unique_ptr<char[]> room(file_->isInMemory() ? nullptr : new char[size]);
    std::size_t position = position_ + i * each;
    const char* bytes = file_->view(position, size, room.get());
    for (; i < end; ++i, position += each, bytes += each) {
      BinaryRecord record(*file_, position, bytes);
      f(record, i);
    }
  }

  const ByteFile* file_;
  std::size_t position_;
  Stage* stage_;
};

/// Refuses n records if the rest of the file is too short for them.
/// @param what  plural, e.g. "nodes"
template <class Source>
void requireRoom(const Source& source, std::uint64_t n, RecordShape shape, std::string_view what) {
  const std::size_t room = source.room(shape);
  if (n <= room) return;
  source.fail(ErrorCode::FileSyntax, lacksRoom(std::to_string(n), what, room));
}

/// Refuses more elements than an Index can number.
template <class Source>
void requireIndexable(const Source& source, std::uint64_t n, std::string_view what) {
  if (n <= kNone) return;
  source.fail(ErrorCode::TooLarge, "has ", n, " ", what, "; at most ", kNone, " are supported.");
}

}  // namespace hexhex::io
