// Reads many elements of a text, each the same number of tokens, in parallel.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/token_index.hpp>

namespace hexhex {

/// Elements that a thread reads in a go, which takes less than a millisecond.
inline constexpr std::size_t kElementGrain = 1024;

/// Calls read(scanner, i), which reads element i or throws an Error about it, for all i in [0, n),
/// from several threads, each with a scanner of its own. Then `scanner`, which stands before the
/// first element, is behind the last.
///
/// If elements are wrong or missing, the error is that of the first of them, for any number of
/// threads.
/// @param index  of the text of `scanner`; null for a text with comments, which one thread reads
template <class Read>
void readElements(TextScanner& scanner, const TokenIndex* index, Stage& stage, std::size_t n,
                  std::size_t tokensEach, const Read& read) {
  if (index == nullptr) {
    LoopProgress progress(stage, n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, n - i));
      read(scanner, i);
    }
    return;
  }
  const std::size_t firstToken = index->countBefore(scanner.position());
  const std::size_t complete = std::min(n, (index->count() - firstToken) / tokensEach);
  const auto moveTo = [&](TextScanner& moved, std::size_t element) {
    moved.moveTo(index->find(firstToken + element * tokensEach));
  };

  std::atomic<std::size_t> firstWrong{complete};
  parallelBlocks(stage, complete, kElementGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   if (begin > firstWrong.load(std::memory_order_relaxed)) return;
                   TextScanner local = scanner;
                   moveTo(local, begin);
                   std::size_t i = begin;
                   try {
                     for (; i < end; ++i) read(local, i);
                   } catch (const Error&) {
                     std::size_t known = firstWrong.load(std::memory_order_relaxed);
                     while (i < known && !firstWrong.compare_exchange_weak(known, i)) {
                     }
                   }
                 });
  // Normally nothing is left. Otherwise the first of these throws, now as if alone.
  moveTo(scanner, firstWrong);
  for (std::size_t i = firstWrong; i < n; ++i) read(scanner, i);
}

}  // namespace hexhex
