// Writes `.ovm` files (see ovm_mesh.hpp).
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {
namespace {

/// A number and what separates it from the next.
constexpr std::size_t kRoomPerNumber = kNumberRoom + 1;

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
  template <class Number, std::size_t n>
  void writeLines(std::span<const std::array<Number, n>> arrays);
  void writeLines(std::span<const std::int32_t> numbers);
  void writeLines(const OvmLists& lists);
  template <class Values>
  void writeSection(const char* keyword, const Values& values) {
    output_.write(keyword).write('\n').write(values.size()).write('\n');
    writeLines(values);
  }
  void writeProperty(const OvmProperty& property);

  const OvmOutput& mesh_;
  OutputFile& output_;
  LineWriter lines_;
  LoopProgress progress_;
};

std::size_t OvmTextWriter::totalOf(const OvmOutput& mesh) {
  std::size_t total = mesh.points.size() + mesh.topology.edges.size() + mesh.topology.faces.size() +
                      mesh.topology.cells.size();
  for (const OvmProperty& property : mesh.properties) {
    total += mesh.topology.count(property.entity);
  }
  return total;
}

template <class Number, std::size_t n>
void OvmTextWriter::writeLines(std::span<const std::array<Number, n>> arrays) {
  lines_.write(
      arrays.size(), n * kRoomPerNumber,
      [arrays](char* place, std::size_t i) { return put(putNumbers(place, arrays[i]), '\n'); },
      &progress_);
}

void OvmTextWriter::writeLines(std::span<const std::int32_t> numbers) {
  lines_.write(
      numbers.size(), kRoomPerNumber,
      [numbers](char* place, std::size_t i) { return put(put(place, numbers[i]), '\n'); },
      &progress_);
}

void OvmTextWriter::writeLines(const OvmLists& lists) {
  lines_.write(
      lists.size(), (lists.length + 1) * kRoomPerNumber,
      [&lists](char* place, std::size_t i) {
        place = put(place, lists.length);
        for (const Index handle : lists[i]) place = put(put(place, ' '), handle);
        return put(place, '\n');
      },
      &progress_);
}

void OvmTextWriter::writeProperty(const OvmProperty& property) {
  constexpr std::array<const char*, 3> kTypes = {"int", "vec3d", "vec2d"};  // as the variant
  output_.write(kOvmPropertyWords[static_cast<std::size_t>(property.entity)]).write(' ');
  output_.write(kTypes[property.values.index()]).write(" \"").write(property.name).write("\"\n");
  std::visit([this](const auto& values) { writeLines(std::span(values)); }, property.values);
}

void OvmTextWriter::write() {
  output_.write("OVM ASCII\n");
  writeSection("Vertices", mesh_.points);
  writeSection("Edges", std::span(mesh_.topology.edges));
  writeSection("Faces", mesh_.topology.faces);
  writeSection("Polyhedra", mesh_.topology.cells);
  for (const OvmProperty& property : mesh_.properties) writeProperty(property);
  output_.commit();
}

}  // namespace

void writeOvmText(const OvmOutput& mesh, OutputFile& output, Stage& stage) {
  OvmTextWriter(mesh, output, stage).write();
}

}  // namespace hexhex::io
