// How fast the cores are at the moment. Those of a virtual machine may be halves of one core, or be
// shared with others: then one thread is slower, or two are not twice as fast as one, whatever they
// do.
#pragma once

namespace hexhex::bench {

/// Additions per nanosecond, of each of some threads that run at the same time, in a loop that
/// keeps all adders of a core busy. Takes a millisecond or two.
[[nodiscard]] double additionsPerNanosecond(int threads);

}  // namespace hexhex::bench
