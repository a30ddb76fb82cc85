#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/parts/part_folder.hpp>
#include <io/parts/parts.hpp>
#include <io/parts/piece_data.hpp>

namespace hexhex::io {
namespace {

/// As the value of an attribute.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

class PvtuSink final : public PartSink {
 public:
  PvtuSink(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : stem_(file.stem().string()),
        context_(context),
        team_(team),
        folder_(
            file.parent_path() / stem_,
            [stem = stem_](std::uint32_t part) {
              return stem + '_' + std::to_string(part) + ".vtu";
            },
            team) {
    if (isFirst(team)) index_.emplace(file);
  }

  void begin(const PartsInfo& info) override { info_ = info; }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    VtkPiece piece;
    const VtkDataSet data = partDataSet(part, info_, piece);
    if (head_.empty()) head_ = headOf(data);
    folder_.run([&] {
      OutputFile output(folder_.fileOf(part.part));
      writeVtkXml(output, data, false, stage);
    });
  }

  void end() override {
    Stage stage(context_, "write mesh");
    agree(team_);  // all pieces are written
    if (index_) nameAll(*index_);
    agree(team_);
  }

 private:
  void nameAll(OutputFile& index) {
    index.write(head_);
    for (std::uint32_t part = 0; part < info_.parts; ++part) {
      const std::string piece = folder_.fileOf(part).filename().string();
      index.write("    <Piece Source=\"" + escaped(stem_ + '/' + piece) + "\"/>\n");
    }
    index.write("  </PUnstructuredGrid>\n</VTKFile>\n");
    index.flush();
    folder_.commit(info_.parts);
    try {
      index.commit();
    } catch (...) {
      if (!index.isNamed()) folder_.takeBack();
      throw;
    }
  }

  /// What is the same in all pieces.
  [[nodiscard]] std::string headOf(const VtkDataSet& data) const {
    const bool little = std::endian::native == std::endian::little;
    std::string head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" "
        "version=\"1.0\" byte_order=\"";
    head += little ? "LittleEndian" : "BigEndian";
    head += "\" header_type=\"UInt64\">\n  <PUnstructuredGrid GhostLevel=\"" +
            std::to_string(info_.ghostLayers) + "\">\n";
    const auto addSection = [&](const std::string& name, VtkSection section) {
      head += "    <" + name + globalNumbersOf(section) + ">\n";
      for (const VtkArray& array : data.arrays()) {
        if (array.section != section) continue;
        head += "      <PDataArray type=\"" + std::string(array.type) + "\" Name=\"" +
                std::string(array.name) + "\"";
        if (array.components != 1) {
          head += " NumberOfComponents=\"" + std::to_string(array.components) + "\"";
        }
        head += "/>\n";
      }
      head += "    </" + name + ">\n";
    };
    addSection("PPointData", VtkSection::PointData);
    addSection("PCellData", VtkSection::CellData);
    addSection("PPoints", VtkSection::Points);
    return head;
  }
  static std::string globalNumbersOf(VtkSection section) {
    if (section == VtkSection::Points) return {};
    const bool ofPoints = section == VtkSection::PointData;
    return " GlobalIds=\"" + std::string(ofPoints ? kVtkGlobalPoints : kVtkGlobalCells) + '"';
  }

  std::string stem_;
  Context& context_;
  ProcessTeam* team_;
  std::optional<OutputFile> index_;  ///< of the first process
  PartFolder folder_;
  PartsInfo info_;
  std::string head_;
};

}  // namespace

std::unique_ptr<PartSink> openPvtuSink(const std::filesystem::path& file,
                                       const WriteOptions& /*options*/, Context& context,
                                       ProcessTeam* team) {
  return std::make_unique<PvtuSink>(file, context, team);
}

}  // namespace hexhex::io
