#include <cmath>
#include <cstdint>
#include <string>

#include <hexhex/error.hpp>

#include <io/core/bytes.hpp>
#include <io/core/number_source.hpp>
#include <io/gmsh/gmsh_nodes.hpp>

namespace hexhex {
namespace {

bool areFinite(const char* place, std::size_t reals) {
  for (std::size_t k = 0; k < reals; ++k) {
    if (!std::isfinite(loadLittle<double>(place + k * sizeof(double)))) return false;
  }
  return true;
}

/// Points, and the tag of each.
class GmshNodesReader {
 public:
  template <class Source>
  void read41(Source& source);
  template <class Source>
  void read22(Source& source, std::size_t count);

  GmshNodes finish(const TextScanner& scanner);

 private:
  template <class Source>
  std::size_t readBlock(Source& source, std::size_t done);
  template <class Source>
  void readPoint(Source& record, std::size_t node);

  Array<Vec3> points_;
  Array<std::uint64_t> tags_;
};

template <class Source>
void GmshNodesReader::read41(Source& source) {
  const std::uint64_t blocks = source.size("the number of blocks of nodes");
  const std::uint64_t total = source.size("the number of nodes");
  static_cast<void>(source.size("the smallest tag of a node"));
  static_cast<void>(source.size("the largest tag of a node"));
  requireRoom(source, total, {.sizes = 1, .reals = 3}, "nodes");
  requireIndexable(source, total, "nodes");
  points_.resize(total);
  tags_.resize(total);
  std::size_t done = 0;
  for (std::uint64_t block = 0; block < blocks; ++block) done += readBlock(source, done);
  if (done == total) return;
  source.fail(ErrorCode::FileSyntax, "the blocks have " + std::to_string(done) + " of the " +
                                         std::to_string(total) + " nodes of the section.");
}

/// Nodes of one entity: all tags, then all points.
/// @param done  nodes before them
/// @return how many they are
template <class Source>
std::size_t GmshNodesReader::readBlock(Source& source, std::size_t done) {
  const std::int64_t dimension = source.integer("the dimension of an entity");
  static_cast<void>(source.integer("the tag of an entity"));
  const bool parametric = source.integer("whether nodes have parameters") != 0;
  const std::uint64_t count = source.size("the number of nodes of a block");
  if (dimension < 0 || dimension > 3) {
    source.fail(ErrorCode::FileSyntax,
                "an entity has the dimension " + std::to_string(dimension) + ".");
  }
  if (count > points_.size() - done) {
    source.fail(ErrorCode::FileSyntax, "the blocks have more nodes than the " +
                                           std::to_string(points_.size()) + " of the section.");
  }
  requireRoom(source, count, {.sizes = 1}, "nodes");
  const auto takeTag = [&](const char* place, std::size_t i) {
    tags_[done + i] = loadLittle<std::uint64_t>(place);
    return true;
  };
  source.records(count, {.sizes = 1}, takeTag, [&](Source& record, std::size_t i) {
    tags_[done + i] = record.size("the tag of a node");
  });
  const std::size_t reals = 3 + (parametric ? static_cast<std::size_t>(dimension) : 0);
  requireRoom(source, count, {.reals = reals}, "nodes");
  const auto takePoint = [&](const char* place, std::size_t i) {
    return areFinite(place, reals) && loadPoint(place, points_[done + i]);
  };
  source.records(count, {.reals = reals}, takePoint, [&](Source& record, std::size_t i) {
    readPoint(record, done + i);
    for (std::size_t k = 3; k < reals; ++k) {
      static_cast<void>(record.real("a parameter of a node"));
    }
  });
  return count;
}

template <class Source>
void GmshNodesReader::read22(Source& source, std::size_t count) {
  const RecordShape shape{.integers = 1, .reals = 3};
  requireRoom(source, count, shape, "nodes");
  points_.resize(count);
  tags_.resize(count);
  source.records(count, shape, [&](Source& record, std::size_t i) {
    tags_[i] = static_cast<std::uint64_t>(record.integer("the number of a node"));
    readPoint(record, i);
  });
}

template <class Source>
void GmshNodesReader::readPoint(Source& record, std::size_t node) {
  for (double& coordinate : points_[node]) coordinate = record.real("a coordinate of a node");
}

GmshNodes GmshNodesReader::finish(const TextScanner& scanner) {
  GmshNodes nodes{std::move(points_), NodeTags(tags_)};
  const Index repeated = nodes.tags.repeated();
  if (repeated == kNone) return nodes;
  scanner.fail(ErrorCode::FileSyntax,
               "two nodes have the tag " + std::to_string(tags_[repeated]) + ".");
}

}  // namespace

GmshNodes readGmshNodes(GmshFile& file) {
  GmshNodesReader reader;
  if (file.version4()) {
    file.withSource([&](auto& source) { reader.read41(source); });
  } else {
    const std::size_t count = file.scanner().readCount("nodes", 8);
    file.withSource([&](auto& source) { reader.read22(source, count); });
  }
  return reader.finish(file.scanner());
}

}  // namespace hexhex
