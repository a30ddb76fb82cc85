// Gmsh 4.1 with partitioned entities, binary: one file with all parts, or a file for each part.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/team.hpp>

#include <base/stage.hpp>
#include <io/core/output_file.hpp>
#include <io/parts/file_set.hpp>
#include <io/parts/gmsh_sections.hpp>
#include <io/parts/part_groups.hpp>
#include <io/parts/parts.hpp>
#include <io/parts/shared_file.hpp>

namespace hexhex::io {
namespace {

/// Copies all that was written to a file.
void copyAll(OutputFile& from, OutputFile& to) {
  from.flush();
  std::string bytes;
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 22;
  for (std::uint64_t begin = 0; begin < from.position(); begin += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min(kPiece, from.position() - begin)));
    from.readBytesAt(begin, bytes.data(), bytes.size());
    to.write(bytes);
  }
}

/// What both kinds of files have in common.
class GmshSink : public PartSink {
 public:
  GmshSink(Context& context, ProcessTeam* team) : context_(context), team_(team) {}
  void begin(const PartsInfo& info) override {
    info_ = info;
    numbers_.emplace(info_);
  }

 protected:
  [[nodiscard]] PartSections sectionsOf(const MeshPart& part, bool onlyOwned, Stage& stage) {
    const MeshGroups groups = groupPart(part, info_, stage);
    if (team_ != nullptr) passQuadsBefore(groups.quads.elements.size());
    return gmshSectionsOf(part, groups, *numbers_, onlyOwned);
  }
  Context& context_;
  ProcessTeam* team_;
  PartsInfo info_;
  std::optional<GmshNumbers> numbers_;

 private:
  /// Quads of processes before this one have smaller numbers.
  void passQuadsBefore(std::uint64_t own) {
    const GatheredNumbers all = team_->gather(std::span(&own, 1));
    for (std::uint32_t r = 0; r < team_->rank(); ++r) {
      static_cast<void>(numbers_->nextQuads(all.numbers[r]));
    }
  }
};

/// How much there is of everything is said in front, and known in the end: nodes and elements wait
/// in files of their own. In a team, all know it when each has its part.
class OneGmshFile final : public GmshSink {
 public:
  OneGmshFile(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), output_(file, team) {
    if (team != nullptr) return;
    nodes_.emplace(file, OutputFile::Target::Regular);
    elements_.emplace(file, OutputFile::Target::Regular);
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    const PartSections sections = sectionsOf(part, true, stage);
    if (team_ != nullptr) return writeTogether(sections);
    sums_.add(sections.sums);
    nodes_->write(sections.nodes.text());
    elements_->write(sections.elements.text());
    ghosts_.add(sections.ghosts.text());
  }
  void end() override {
    Stage stage(context_, "write mesh");
    if (team_ == nullptr) {
      OutputFile& output = output_.output();
      output.write(gmshHead(*numbers_, info_, sums_));
      copyAll(*nodes_, output);
      output.write(gmshElementsHead(sums_));
      copyAll(*elements_, output);
      output.write(gmshGhostsHead(sums_)).write(ghosts_.text()).write(gmshEnd(sums_));
      nodes_.reset();
      elements_.reset();
    }
    output_.commit();
  }

 private:
  static constexpr std::size_t kSections = 3;

  void writeTogether(const PartSections& own) {
    const std::array<const std::string*, kSections> mine = {&own.nodes.text(), &own.elements.text(),
                                                            &own.ghosts.text()};
    std::vector<std::uint64_t> numbers = {mine[0]->size(), mine[1]->size(), mine[2]->size()};
    const std::vector<std::uint64_t> packed = own.sums.packed();
    numbers.insert(numbers.end(), packed.begin(), packed.end());
    const GatheredNumbers gathered = team_->gather(numbers);
    std::array<std::uint64_t, kSections> before{};
    std::array<std::uint64_t, kSections> total{};
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      if (r == team_->rank()) before = total;
      const std::span<const std::uint64_t> theirs = gathered.of(r);
      for (std::size_t k = 0; k < kSections; ++k) total[k] += theirs[k];
      sums_.add(GmshSums::unpacked(theirs.subspan(kSections)));
    }
    const std::array<std::string, kSections + 1> between = {gmshHead(*numbers_, info_, sums_),
                                                            gmshElementsHead(sums_),
                                                            gmshGhostsHead(sums_), gmshEnd(sums_)};
    std::uint64_t place = 0;
    const auto write = [&](std::uint64_t position, const std::string& text) {
      output_.output().writeBytesAt(position, text.data(), text.size());
    };
    for (std::size_t k = 0; k <= kSections; ++k) {
      if (team_->rank() == 0) write(place, between[k]);
      place += between[k].size();
      if (k == kSections) break;
      write(place + before[k], *mine[k]);
      place += total[k];
    }
  }

  SharedFile output_;
  std::optional<OutputFile> nodes_;     ///< never committed
  std::optional<OutputFile> elements_;  ///< likewise
  GmshBytes ghosts_;
  GmshSums sums_;
};

class ManyGmshFiles final : public GmshSink {
 public:
  ManyGmshFiles(std::filesystem::path file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), file_(std::move(file)), files_(team) {}

  void part(MeshPart&& part) override {
    Stage stage(context_, "write mesh");
    std::string file = file_.string();
    file.insert(file.size() - file_.extension().string().size(),
                '_' + std::to_string(part.part + 1));
    OutputFile& output = files_.add(file);
    const PartSections sections = sectionsOf(part, false, stage);
    const GmshSums& sums = sections.sums;
    output.write(gmshHead(*numbers_, info_, sums)).write(sections.nodes.text());
    output.write(gmshElementsHead(sums)).write(sections.elements.text());
    output.write(gmshGhostsHead(sums)).write(sections.ghosts.text()).write(gmshEnd(sums));
    files_.finishLast();
  }
  void end() override { files_.commit(); }

 private:
  std::filesystem::path file_;
  FileSet files_;
};

}  // namespace

std::unique_ptr<PartSink> openGmshPartSink(const std::filesystem::path& file,
                                           const WriteOptions& /*options*/, Context& context,
                                           ProcessTeam* team) {
  return std::make_unique<OneGmshFile>(file, context, team);
}

std::unique_ptr<PartSink> openSplitGmshPartSink(const std::filesystem::path& file,
                                                const WriteOptions& /*options*/, Context& context,
                                                ProcessTeam* team) {
  return std::make_unique<ManyGmshFiles>(file, context, team);
}

}  // namespace hexhex::io
