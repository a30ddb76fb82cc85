// The HDF5 library, loaded when the first file needs it: it depends on some thirty other libraries
// (curl, OpenSSL, Kerberos ...), which take longer to load than most commands take to run.
#pragma once

#include <filesystem>

namespace hexhex::io {

/// Loads the library unless it is loaded already.
/// @param file  the file that needs it
/// @throws Error FileUnsupported if the library is missing, has another version, or this build has
///         no support for it; std::bad_alloc if there is not enough memory to load it
void requireHdf5(const std::filesystem::path& file);

/// The address of a symbol of the library. @pre  requireHdf5() succeeded
[[nodiscard]] void* hdf5Symbol(const char* name);

}  // namespace hexhex::io
