#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/number_source.hpp>
#include <io/core/text_scanner.hpp>
#include <io/gmsh/gmsh_elements.hpp>

namespace hexhex {
namespace {

template <std::size_t corners>
class Elements22Reader {
 public:
  Elements22Reader(const GmshTags& tags, GmshCells<corners>& cells, Stage& stage)
      : tags_(tags), cells_(cells), stage_(stage) {}

  void read(TextSource& source, std::size_t count);
  void read(BinarySource& source, std::size_t count);
  [[nodiscard]] bool hasOthers() const noexcept { return hasOthers_; }

 private:
  [[nodiscard]] std::int32_t tagOf(std::int64_t type, std::int64_t physical) const {
    return tags_.ofPhysical({dimensionOfGmshType(type), withoutSign(physical)});
  }
  static std::int64_t readPhysical(TextSource& source);
  static std::int64_t readPhysical(BinarySource& record, std::size_t tags);
  void readOther(TextSource& source, std::int64_t type, std::size_t nodes, std::int32_t tag);
  void readCells(BinarySource& source, std::size_t first, std::size_t count, std::size_t tags);
  void readFeatures(BinarySource& source, std::int64_t type, std::size_t count, std::size_t tags);

  const GmshTags& tags_;
  GmshCells<corners>& cells_;
  Stage& stage_;
  bool hasOthers_ = false;
};

template <std::size_t corners>
void Elements22Reader<corners>::read(TextSource& source, std::size_t count) {
  LoopProgress progress(stage_, count);
  // Enough for all; lines have different lengths, so that only reading tells how many there are.
  cells_.resize(count);
  std::size_t cells = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count - i));
    static_cast<void>(source.integer("the number of an element"));
    const std::int64_t type = source.integer("the type of an element");
    const std::size_t nodes = requireGmshType(source, type);
    const std::int32_t tag = tagOf(type, readPhysical(source));
    if (cells_.isCell(type)) {
      cells_.setRegions(cells, 1, tag);
      cells_.readCorners(source, cells++, false);
    } else {
      readOther(source, type, nodes, tag);
    }
  }
  cells_.keep(cells);
}

/// The physical group of an element, which is the first of its tags, or 0.
template <std::size_t corners>
std::int64_t Elements22Reader<corners>::readPhysical(TextSource& source) {
  const std::uint64_t tags = source.size("the number of tags");
  std::int64_t physical = 0;
  for (std::uint64_t tag = 0; tag < tags; ++tag) {
    const std::int64_t number = source.integer("a tag");
    if (tag == 0) physical = number;
  }
  return physical;
}

template <std::size_t corners>
void Elements22Reader<corners>::readOther(TextSource& source, std::int64_t type, std::size_t nodes,
                                          std::int32_t tag) {
  hasOthers_ = true;
  std::array<std::uint64_t, 4> corner{};
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::int64_t number = source.integer("a node of an element");
    if (node < corner.size()) corner[node] = static_cast<std::uint64_t>(number);
  }
  if (tag != 0 && cells_.isFeature(type)) cells_.addFeature(source, type, corner, tag);
}

template <std::size_t corners>
void Elements22Reader<corners>::read(BinarySource& source, std::size_t count) {
  cells_.resize(count);
  std::size_t cells = 0;
  for (std::size_t done = 0; done < count;) {
    const std::int64_t type = source.integer("the type of elements");
    const std::int64_t follow = source.integer("the number of elements that follow");
    const std::int64_t tags = source.integer("the number of tags");
    if (follow <= 0 || static_cast<std::uint64_t>(follow) > count - done || tags < 0) {
      source.fail(
          ErrorCode::FileSyntax,
          "a block of " + std::to_string(follow) + " elements with " + std::to_string(tags) +
              " tags each cannot be: " + std::to_string(count - done) + " elements are left.");
    }
    const auto size = static_cast<std::size_t>(follow);
    const auto ownTags = static_cast<std::size_t>(tags);
    const RecordShape shape{.integers = 1 + ownTags + requireGmshType(source, type)};
    requireRoom(source, size, shape, "elements");
    done += size;
    if (cells_.isCell(type)) {
      readCells(source, cells, size, ownTags);
      cells += size;
      continue;
    }
    hasOthers_ = true;
    if (cells_.isFeature(type)) {
      readFeatures(source, type, size, ownTags);
    } else {
      source.skip(size, shape);
    }
  }
  cells_.keep(cells);
}

/// The same of an element in a block, behind whose number the tags stand.
template <std::size_t corners>
std::int64_t Elements22Reader<corners>::readPhysical(BinarySource& record, std::size_t tags) {
  static_cast<void>(record.integer("the number of an element"));
  if (tags == 0) return 0;
  const std::int64_t physical = record.integer("a tag");
  record.skip(tags - 1, {.integers = 1});
  return physical;
}

/// Reads cells of a block, from number `first` on.
template <std::size_t corners>
void Elements22Reader<corners>::readCells(BinarySource& source, std::size_t first,
                                          std::size_t count, std::size_t tags) {
  const RecordShape shape{.integers = 1 + tags + corners};
  Array<std::int64_t> physicals(count);
  source.records(count, shape, [&](BinarySource& record, std::size_t i) {
    physicals[i] = readPhysical(record, tags);
    cells_.readCorners(record, first + i, false);
  });
  // Cells of a group mostly follow each other.
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin + 1;
    while (end < count && physicals[end] == physicals[begin]) ++end;
    cells_.setRegions(first + begin, end - begin,
                      tagOf(kCellKind<corners>.gmshType, physicals[begin]));
    begin = end;
  }
}

/// Reads what may be features of a block.
template <std::size_t corners>
void Elements22Reader<corners>::readFeatures(BinarySource& source, std::int64_t type,
                                             std::size_t count, std::size_t tags) {
  std::array<std::uint64_t, 4> nodes{};
  const std::size_t size = nodesOfGmshType(type);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t physical = readPhysical(source, tags);
    for (std::size_t k = 0; k < size; ++k) {
      nodes[k] = static_cast<std::uint64_t>(source.integer("a node of an element"));
    }
    const std::int32_t tag = tagOf(type, physical);
    if (tag != 0) cells_.addFeature(source, type, nodes, tag);
  }
}

template <std::size_t corners>
bool readAllElements22(GmshFile& file, const GmshTags& tags, GmshCells<corners>& cells) {
  const std::size_t count = file.scanner().readCount("elements", 8);
  Elements22Reader<corners> reader(tags, cells, file.stage());
  file.withSource([&](auto& source) { reader.read(source, count); });
  return reader.hasOthers();
}

}  // namespace

bool readElements22(GmshFile& file, const GmshTags& tags, GmshCells<4>& cells) {
  return readAllElements22(file, tags, cells);
}

bool readElements22(GmshFile& file, const GmshTags& tags, GmshCells<8>& cells) {
  return readAllElements22(file, tags, cells);
}

}  // namespace hexhex
