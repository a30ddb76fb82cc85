// A mesh as OpenFOAM stores it, by faces, and its files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

/// Faces as OpenFOAM lists them; quads look out of their owners.
struct PolyMesh {
  struct Patch {
    std::string name;
    std::size_t begin;
    std::size_t end;
    /// Of a patch between two parts: lines of its dictionary, the type among them.
    std::string entries;
  };
  Array<Quad> faces;
  Array<Index> owners;      ///< per face
  Array<Index> neighbours;  ///< per inner face
  std::vector<Patch> patches;
};

/// Writes the files of a mesh; commit() gives them their names.
class PolyMeshWriter {
 public:
  PolyMeshWriter(std::filesystem::path folder, int threads)
      : folder_(std::move(folder)), threads_(threads) {}

  void write(const HexMesh& mesh, const PolyMesh& poly, Stage& stage);
  void writeZones(const CellGroups& cells);
  /// A file that is a list of labels.
  /// @param labelOf  of (place with room for a number, index): puts a label, returns the end
  void writeLabels(std::string_view object, std::size_t n, Stage& stage,
                   const std::function<char*(char*, std::size_t)>& labelOf);
  void writeBoundary(const std::vector<PolyMesh::Patch>& patches);

  void commit() {
    for (const std::unique_ptr<OutputFile>& file : files_) file->commit();
    files_.clear();
  }

 private:
  OutputFile& begin(std::string_view kind, std::string_view object, std::string_view note);

  template <class Format>
  void list(std::string_view kind, std::string_view object, std::size_t n, std::size_t room,
            std::string_view note, LoopProgress& progress, const Format& format);

  std::filesystem::path folder_;
  int threads_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

}  // namespace hexhex::io
