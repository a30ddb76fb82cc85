// The text half of ovm_output.hpp's writers.
#include <charconv>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/ovm/ovm_output.hpp>

namespace hexhex {
namespace {

/// A number and what separates it from the next.
constexpr std::size_t kRoomPerNumber = kNumberRoom + 1;

constexpr const char* keywordOf(OvmEntity entity) {
  switch (entity) {
    case OvmEntity::Vertex:
      return "VProp";
    case OvmEntity::Edge:
      return "EProp";
    case OvmEntity::Face:
      return "FProp";
    case OvmEntity::Cell:
      return "CProp";
    case OvmEntity::HalfEdge:
      return "HEProp";
    case OvmEntity::HalfFace:
      return "HFProp";
    case OvmEntity::Mesh:
      break;
  }
  return "MProp";
}

class OvmTextWriter {
 public:
  OvmTextWriter(const OvmOutput& mesh, OutputFile& output, Stage& stage)
      : mesh_(mesh),
        output_(output),
        lines_(output_, stage.context().threads()),
        progress_(stage, totalOf(mesh)) {}

  void write();

 private:
  static std::size_t totalOf(const OvmOutput& mesh);
  void beginSection(const char* keyword, std::size_t count) {
    output_.write(keyword).write('\n').write(count).write('\n');
  }
  template <class Number, std::size_t n>
  void writeArrays(std::span<const std::array<Number, n>> arrays);
  void writeLists(const OvmLists& lists);
  void writeProperty(const OvmPropertyValues& property);

  const OvmOutput& mesh_;
  OutputFile& output_;
  LineWriter lines_;
  LoopProgress progress_;
};

std::size_t OvmTextWriter::totalOf(const OvmOutput& mesh) {
  std::size_t total = mesh.points.size() + mesh.topology.edges.size() + mesh.topology.faces.size() +
                      mesh.topology.cells.size();
  for (const OvmPropertyValues& property : listProperties(mesh.properties)) {
    total += property.points != nullptr ? property.points->size() : property.integers->size();
  }
  return total;
}

template <class Number, std::size_t n>
void OvmTextWriter::writeArrays(std::span<const std::array<Number, n>> arrays) {
  lines_.write(
      arrays.size(), n * kRoomPerNumber,
      [arrays](char* place, std::size_t i) { return put(putNumbers(place, arrays[i]), '\n'); },
      &progress_);
}

void OvmTextWriter::writeLists(const OvmLists& lists) {
  lines_.write(
      lists.size(), (lists.length + 1) * kRoomPerNumber,
      [&lists](char* place, std::size_t i) {
        place = put(place, lists.length);
        for (const Index handle : lists[i]) place = put(put(place, ' '), handle);
        return put(place, '\n');
      },
      &progress_);
}

void OvmTextWriter::writeProperty(const OvmPropertyValues& property) {
  const bool points = property.points != nullptr;
  output_.write(keywordOf(property.entity)).write(points ? " vec3d \"" : " int \"");
  output_.write(property.name).write("\"\n");
  if (points) {
    writeArrays(std::span<const Vec3>(*property.points));
    return;
  }
  const Array<std::int32_t>& values = *property.integers;
  lines_.write(
      values.size(), kRoomPerNumber,
      [&values](char* place, std::size_t i) {
        return put(std::to_chars(place, place + kNumberRoom, values[i]).ptr, '\n');
      },
      &progress_);
}

void OvmTextWriter::write() {
  const OvmTopology& topology = mesh_.topology;
  output_.write("OVM ASCII\n");
  beginSection("Vertices", mesh_.points.size());
  writeArrays(mesh_.points);
  beginSection("Edges", topology.edges.size());
  writeArrays(std::span<const std::array<Index, 2>>(topology.edges));
  beginSection("Faces", topology.faces.size());
  writeLists(topology.faces);
  beginSection("Polyhedra", topology.cells.size());
  writeLists(topology.cells);
  for (const OvmPropertyValues& property : listProperties(mesh_.properties)) {
    writeProperty(property);
  }
  output_.commit();
}

}  // namespace

void writeOvmTextFile(const OvmOutput& mesh, OutputFile& output, Stage& stage) {
  OvmTextWriter(mesh, output, stage).write();
}

}  // namespace hexhex
