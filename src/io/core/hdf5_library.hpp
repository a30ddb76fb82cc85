// The HDF5 library, which is loaded when the first file needs it: it brings some thirty others
// along (curl, OpenSSL, Kerberos ...), which take longer to start than most of what the command
// does.
#pragma once

#include <filesystem>

namespace hexhex::io {

/// Loads the library if it is not yet.
/// @param file  which needs it
/// @throws Error FileUnsupported if it is not there, is of another version, or this build is
/// without;
///         std::bad_alloc if memory does not suffice for it
void requireHdf5(const std::filesystem::path& file);

/// What the library calls so. @pre  requireHdf5() was successful
[[nodiscard]] void* hdf5Symbol(const char* name);

}  // namespace hexhex::io
