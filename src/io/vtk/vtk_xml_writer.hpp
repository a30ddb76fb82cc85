// VTK's XML files, with the arrays appended as raw bytes: of any data set, at once or in pieces.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/vtk/vtk_data_set.hpp>

namespace hexhex {

/// Writes and commits a file, array by array. One thread does it, straight from memory: that is as
/// fast as the file system takes bytes, which lets one thread at a time write to a file. Blocks of
/// compressed arrays come from all threads; the bytes do not depend on their number.
/// @param compress  with zlib; only if requireCompressible() allows it
void writeVtkXml(OutputFile& output, const VtkDataSet& data, bool compress, Stage& stage);

/// @throws Error FileUnsupported without zlib; FileWrite for a device or a pipe
void requireCompressible(const OutputFile& output, const std::string& fileName);

/// A file of a data set that comes in pieces, which bring some of each array: all arrays are
/// written side by side, each from its own position on, which follows from the counts alone.
class VtkXmlPieces {
 public:
  /// @param output, data  outlive this; the output has positions
  VtkXmlPieces(OutputFile& output, const VtkDataSet& data);

  /// Write the next rows of the arrays of points, or of cells.
  void writePoints() { writeRows(true); }
  void writeCells() { writeRows(false); }
  /// Writes the end of the file, and commits it.
  void finish();

 private:
  void writeRows(bool ofPoints);

  OutputFile& output_;
  const VtkDataSet& data_;
  std::vector<FilePart> parts_;  ///< of the arrays
  std::uint64_t end_ = 0;        ///< of the last array
};

}  // namespace hexhex
