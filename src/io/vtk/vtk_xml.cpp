#include <bit>
#include <utility>

#include <io/vtk/vtk_xml.hpp>

namespace hexhex {

void VtkXmlFile::add(std::string section, std::string name, std::string_view type,
                     std::size_t components, std::uint64_t count, std::size_t bytesEach,
                     Write write) {
  std::string tag = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"";
  if (components != 1) tag += " NumberOfComponents=\"" + std::to_string(components) + "\"";
  if (section == "FieldData") tag += " NumberOfTuples=\"" + std::to_string(count) + "\"";
  entries_.push_back({std::move(section), std::move(tag), count * bytesEach, std::move(write)});
}

void VtkXmlFile::write(OutputFile& output, std::string_view type, const std::string& piece,
                       std::span<const std::string_view> sections, Stage& stage) const {
  std::vector<const Entry*> order;
  std::uint64_t offset = 0;
  const auto writeSection = [&](std::string_view section) {
    output.write("      <").write(section).write(">\n");
    for (const Entry& entry : entries_) {
      if (entry.section != section) continue;
      output.write("        ").write(entry.tag).write(" format=\"appended\" offset=\"");
      output.write(offset).write("\"/>\n");
      offset += sizeof(std::uint64_t) + entry.bytes;
      order.push_back(&entry);
    }
    output.write("      </").write(section).write(">\n");
  };
  const bool little = std::endian::native == std::endian::little;
  // From version 2.1 on, VTK takes the edges of higher-order hexahedra in the order of VTK 9.
  output.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"").write(type);
  output.write("\" version=\"2.2\" byte_order=\"").write(little ? "Little" : "Big");
  output.write("Endian\" header_type=\"UInt64\">\n  <").write(type).write(">\n");
  writeSection("FieldData");
  output.write("    <Piece ").write(piece).write(">\n");
  for (const std::string_view section : sections) writeSection(section);
  output.write("    </Piece>\n  </").write(type).write(">\n  <AppendedData encoding=\"raw\">\n_");
  LoopProgress progress(stage, order.size());
  for (const Entry* const entry : order) {
    output.writeBytes(&entry->bytes, sizeof(entry->bytes));
    entry->write(output);
    progress.advance(1);
  }
  output.write("\n  </AppendedData>\n</VTKFile>\n");
  output.commit();
}

}  // namespace hexhex
