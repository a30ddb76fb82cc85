// A folder with a file for each part, for formats that have one.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <io/core/output_folder.hpp>

namespace hexhex {

/// Files appear with the folder. Those of earlier runs with more parts are removed; what else is in
/// the folder stays.
class PartFolder {
 public:
  /// The name of the file of a part, in the folder.
  using FileName = std::function<std::string(std::uint32_t part)>;

  PartFolder(std::filesystem::path folder, FileName name)
      : target_(std::move(folder)), folder_(target_), name_(std::move(name)) {}

  /// Where the file of a part is to be written.
  [[nodiscard]] std::filesystem::path fileOf(std::uint32_t part) const {
    return folder_.temporary() / name_(part);
  }
  /// Runs write(), whose errors name the target instead of the temporary folder.
  template <class Write>
  void run(const Write& write) const {
    try {
      write();
    } catch (const Error& error) {
      throw folder_.named(error);
    }
  }
  /// @param parts  that there are
  void commit(std::uint32_t parts);
  void takeBack() noexcept { folder_.takeBack(); }

 private:
  std::filesystem::path target_;
  OutputFolder folder_;
  FileName name_;
};

}  // namespace hexhex
