#include <system_error>

#include <io/parts/part_folder.hpp>

namespace hexhex::io {

void PartFolder::commit(std::uint32_t parts) {
  folder_->commit();
  try {
    // From now on nothing names them.
    std::error_code error;
    for (std::uint32_t part = parts;
         std::filesystem::remove_all(target_ / name_(part), error) > 0;) {
      if (error) break;
      ++part;
    }
  } catch (...) {  // no memory for a name
    takeBack();
    throw;
  }
}

}  // namespace hexhex::io
