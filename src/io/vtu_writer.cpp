// The writing half of vtu.hpp: one thread, straight from the mesh's arrays. That is as fast as the
// file system takes bytes, which lets one thread at a time write to a file.
#include <algorithm>
#include <cstdint>
#include <span>

#include <hexhex/quality.hpp>

#include <base/stage.hpp>
#include <io/output_file.hpp>
#include <io/tag_rows.hpp>
#include <io/vtu.hpp>
#include <io/vtu_content.hpp>
#include <io/vtu_layout.hpp>

namespace hexhex {
namespace {

// What is written between two looks at the caller's wish to cancel: some milliseconds' work.
constexpr std::size_t kSliceBytes = std::size_t{1} << 22;

/// Writes the arrays of one mesh.
class ArrayWriter {
 public:
  ArrayWriter(OutputFile& output, const HexMesh& mesh, std::span<const double> quality,
              const VtuLayout& layout, Stage& stage)
      : output_(output),
        mesh_(mesh),
        quality_(quality),
        layout_(layout),
        progress_(stage, layout.tailPosition()) {}

  void write(const VtuArray& array) {
    output_.writeBytes(&array.bytes, sizeof(array.bytes));
    switch (array.content) {
      case VtuContent::GeneratorTet:
        return fromMemory(mesh_.generatorTet.data(), array.bytes);
      case VtuContent::GeneratorCorners:
        return fromMemory(mesh_.generatorCorners.data(), array.bytes);
      case VtuContent::ScaledJacobian:
        return fromMemory(quality_.data(), array.bytes);
      case VtuContent::Regions:
        return fromMemory(mesh_.regions.data(), array.bytes);
      case VtuContent::VertexTags:
        return fromMemory(vertexTags(mesh_).data(), array.bytes);
      case VtuContent::EdgeTags:
        return fromMemory(rowsOf(mesh_.features.edges).data(), array.bytes);
      case VtuContent::QuadTags:
        return fromMemory(rowsOf(mesh_.features.quads).data(), array.bytes);
      case VtuContent::Points:
        return fromMemory(mesh_.points.data(), array.bytes);
      case VtuContent::GeneratorKind:
      case VtuContent::Connectivity:
      case VtuContent::Offsets:
      case VtuContent::Types:
        computed(array);
    }
  }

 private:
  void fromMemory(const void* values, std::uint64_t bytes) {
    const char* const data = static_cast<const char*>(values);
    for (std::uint64_t begin = 0; begin < bytes; begin += kSliceBytes) {
      const std::size_t size = std::min<std::uint64_t>(kSliceBytes, bytes - begin);
      output_.writeBytes(data + begin, size);
      progress_.advance(size);
    }
  }

  void computed(const VtuArray& array) {
    const bool ofPoints = array.content == VtuContent::GeneratorKind;
    const std::size_t count = ofPoints ? mesh_.points.size() : mesh_.cells.size();
    if (count == 0) return;
    const std::size_t bytesEach = array.bytes / count;
    const std::size_t slice = kSliceBytes / bytesEach;
    for (std::size_t begin = 0; begin < count; begin += slice) {
      const std::size_t size = std::min(slice, count - begin);
      writeSlice(array.content, begin, size);
      progress_.advance(size * bytesEach);
    }
  }

  void writeSlice(VtuContent content, std::size_t begin, std::size_t size) {
    if (content == VtuContent::GeneratorKind) {
      writeGeneratorKinds(output_, std::span(mesh_.generatorCorners).subspan(begin, size));
    } else if (content == VtuContent::Connectivity) {
      writeConnectivity(output_, std::span<const Hex>(mesh_.cells).subspan(begin, size),
                        layout_.wideConnectivity());
    } else if (content == VtuContent::Offsets) {
      writeOffsets(output_, begin, size, layout_.wideOffsets());
    } else {
      writeTypes(output_, size);
    }
  }

  OutputFile& output_;
  const HexMesh& mesh_;
  std::span<const double> quality_;
  const VtuLayout& layout_;
  LoopProgress progress_;
};

}  // namespace

void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  Array<double> computedQuality;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computedQuality = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  VtuShape shape;
  shape.points = mesh.points.size();
  shape.cells = mesh.cells.size();
  shape.generatorTets = !mesh.generatorTet.empty();
  shape.generatorCorners = !mesh.generatorCorners.empty();
  shape.scaledJacobians = true;
  shape.vertexTags = !mesh.features.vertices.empty();
  shape.regions = !mesh.regions.empty();
  shape.edgeTags = mesh.features.edges.size();
  shape.quadTags = mesh.features.quads.size();
  const VtuLayout layout(shape);
  ArrayWriter writer(output, mesh, quality, layout, stage);
  output.write(layout.head());
  for (const VtuArray& array : layout.arrays()) writer.write(array);
  output.write(VtuLayout::tail());
  output.commit();
}

}  // namespace hexhex
