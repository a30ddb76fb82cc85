#include <system_error>

#include <hexhex/error.hpp>

#include <io/parts/file_set.hpp>

namespace hexhex::io {

void FileSet::commit(const std::function<void(std::size_t i, OutputFile& file)>& change) {
  agree(team_);  // all are written
  std::size_t done = 0;
  try {
    for (; done < files_.size(); ++done) {
      OutputFile& output = *files_[done].output;
      output.resume();
      if (change) change(done, output);
      output.commit();
    }
    agree(team_);
  } catch (...) {
    std::error_code unknown;
    if (done < files_.size() && files_[done].output->isNamed()) ++done;
    while (done-- > 0) std::filesystem::remove(files_[done].path, unknown);
    throw;
  }
}

std::string padded(std::uint32_t part, std::uint32_t parts) {
  std::string number = std::to_string(part);
  const std::size_t digits = std::to_string(parts - 1).size();
  return number.insert(0, digits - number.size(), '0');
}

void refuseGhosts(std::uint32_t layers, const std::string& what) {
  if (layers == 0) return;
  throw Error(ErrorCode::FileUnsupported, what + " hold no ghost cells. Leave out --ghosts.");
}

}  // namespace hexhex::io
