// Short parallel loops, many times.
#pragma once

#include <base/parallel.hpp>

namespace hexhex {

/// withThreads(), but where that many threads are at work anyway, f() is called as it is: entering
/// takes some microseconds, which matters once for each of many pieces.
template <class F>
void withThreadsHere(int threads, const F& f) {
  if (currentThreads() == effectiveThreads(threads)) {
    f();
  } else {
    withThreads(threads, f);
  }
}

}  // namespace hexhex
