// One compressed array of a `.vtu` file while it is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>

namespace hexhex {

/// Takes an array's bytes from front to back and writes them as blocks, compressed by all threads.
/// The bytes of the file do not depend on their number.
class VtuBlocks {
 public:
  /// @param output    has positions; outlives this
  /// @param position  in the file of what is written next
  /// @param bytes     of the array
  /// @param threads   as in Context
  VtuBlocks(OutputFile& output, std::uint64_t position, std::uint64_t bytes, int threads);

  void writeBytes(const void* bytes, std::size_t size);

  /// Writes what is left, once all bytes have come.
  /// @return the position in the file of what is written next
  [[nodiscard]] std::uint64_t finish();

 private:
  void compress();

  OutputFile& output_;
  Context quiet_;
  Stage stage_;
  std::uint64_t headPosition_;
  std::uint64_t position_;
  std::uint64_t lastBlock_;           ///< bytes of a last block that is shorter, else 0
  std::vector<std::uint64_t> sizes_;  ///< of the compressed blocks so far
  std::uint64_t blocks_;
  Array<char> collected_;  ///< not compressed yet
  std::size_t used_ = 0;
  std::vector<Array<char>> compressed_;
};

}  // namespace hexhex
