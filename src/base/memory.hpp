// How arrays (hexhex::Array) get their memory.
#pragma once

namespace hexhex {

/// Whether large arrays ask for huge pages from now on, in the whole process: as it is the
/// allocator that asks, nobody can tell it but a global. For ablations alone.
void useHugePages(bool use);

}  // namespace hexhex
