#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <io/core/number_source.hpp>
#include <io/gmsh/gmsh_elements.hpp>

namespace hexhex {
namespace {

template <std::size_t corners>
class Elements41Reader {
 public:
  Elements41Reader(const GmshTags& tags, GmshCells<corners>& cells) : tags_(tags), cells_(cells) {}

  template <class Source>
  void read(Source& source);
  [[nodiscard]] bool hasOthers() const noexcept { return hasOthers_; }

 private:
  /// Cells of one entity: where they are in the file, how many, and their region.
  struct CellBlock {
    std::size_t position;
    std::size_t count;
    std::int32_t tag;
  };

  template <class Source>
  std::uint64_t readBlock(Source& source);
  template <class Source>
  void readCells(Source& source);
  template <class Source>
  void readFeatures(Source& source, std::int64_t type, std::size_t count, std::int32_t tag);

  const GmshTags& tags_;
  GmshCells<corners>& cells_;
  std::vector<CellBlock> wanted_;
  std::size_t cellCount_ = 0;
  bool hasOthers_ = false;
};

/// Cells are read last, when it is known how many there are.
template <std::size_t corners>
template <class Source>
void Elements41Reader<corners>::read(Source& source) {
  const std::uint64_t blocks = source.size("the number of blocks of elements");
  const std::uint64_t total = source.size("the number of elements");
  static_cast<void>(source.size("the smallest tag of an element"));
  static_cast<void>(source.size("the largest tag of an element"));
  std::uint64_t done = 0;
  for (std::uint64_t block = 0; block < blocks; ++block) done += readBlock(source);
  if (done != total) {
    source.fail(ErrorCode::FileSyntax, "the blocks have " + std::to_string(done) +
                                           " elements instead of the " + std::to_string(total) +
                                           " of the section.");
  }
  requireIndexable(source, cellCount_, kCellKind<corners>.plural);
  cells_.resize(cellCount_);
  const std::size_t end = source.position();
  readCells(source);
  source.moveTo(end);
}

/// Reads a block, but only notes where cells are.
/// @return the number of its elements
template <std::size_t corners>
template <class Source>
std::uint64_t Elements41Reader<corners>::readBlock(Source& source) {
  const std::int64_t dimension = source.integer("the dimension of an entity");
  const std::int64_t entity = source.integer("the tag of an entity");
  const std::int64_t type = source.integer("the type of elements");
  const std::uint64_t count = source.size("the number of elements of a block");
  const std::int32_t tag = tags_.ofEntity({dimension, entity});
  const RecordShape shape{.sizes = 1 + requireGmshType(source, type)};
  requireRoom(source, count, shape, "elements");
  if (cells_.isCell(type)) {
    wanted_.push_back({source.position(), count, tag});
    cellCount_ += count;
  } else if (count > 0) {
    hasOthers_ = true;
  }
  if (tag != 0 && cells_.isFeature(type)) {
    readFeatures(source, type, count, tag);
  } else {
    source.skip(count, shape);
  }
  return count;
}

template <std::size_t corners>
template <class Source>
void Elements41Reader<corners>::readCells(Source& source) {
  std::size_t first = 0;
  for (const CellBlock& block : wanted_) {
    source.moveTo(block.position);
    const auto loadCell = [&](const char* place, std::size_t i) {
      // The first number is the element's tag.
      return cells_.loadCorners(place + sizeof(std::uint64_t), first + i);
    };
    const RecordShape shape{.sizes = corners + 1};
    source.records(block.count, shape, loadCell, [&](Source& record, std::size_t i) {
      static_cast<void>(record.size("the tag of an element"));
      cells_.readCorners(record, first + i, true);
    });
    cells_.setRegions(first, block.count, block.tag);
    first += block.count;
  }
}

/// Reads elements of a block, which have the same tag.
template <std::size_t corners>
template <class Source>
void Elements41Reader<corners>::readFeatures(Source& source, std::int64_t type, std::size_t count,
                                             std::int32_t tag) {
  std::array<std::uint64_t, 4> nodes{};
  const std::size_t size = nodesOfGmshType(type);
  for (std::size_t i = 0; i < count; ++i) {
    static_cast<void>(source.size("the tag of an element"));
    for (std::size_t k = 0; k < size; ++k) nodes[k] = source.size("a node of an element");
    cells_.addFeature(source, type, nodes, tag);
  }
}

template <std::size_t corners>
bool readAllElements41(GmshFile& file, const GmshTags& tags, GmshCells<corners>& cells) {
  Elements41Reader<corners> reader(tags, cells);
  file.withSource([&reader](auto& source) { reader.read(source); });
  return reader.hasOthers();
}

}  // namespace

bool readElements41(GmshFile& file, const GmshTags& tags, GmshCells<4>& cells) {
  return readAllElements41(file, tags, cells);
}

bool readElements41(GmshFile& file, const GmshTags& tags, GmshCells<8>& cells) {
  return readAllElements41(file, tags, cells);
}

}  // namespace hexhex
