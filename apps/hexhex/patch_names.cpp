#include "patch_names.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>
#include <hexhex/patches.hpp>

namespace hexhex::command {
namespace {

/// Generates tags that no quad has.
class FreeTags {
 public:
  explicit FreeTags(const HexMesh& mesh) {
    for (const FeatureQuad& quad : mesh.features.quads) last_ = std::max(last_, quad.tag);
  }
  /// @throws Error TooLarge
  [[nodiscard]] std::int32_t next() {
    if (last_ < std::numeric_limits<std::int32_t>::max()) return ++last_;
    throw Error(ErrorCode::TooLarge,
                "A group of quads has the largest possible tag, which leaves none for new groups. "
                "Give it a smaller one.");
  }

 private:
  std::int32_t last_ = 0;
};

/// Drops names of unused tags, which new groups would take over.
void dropUnused(HexFeatures& features) {
  std::set<std::int32_t> used;
  for (const FeatureQuad& quad : features.quads) used.insert(quad.tag);
  std::erase_if(features.names, [&used](const TagName& known) {
    return known.dimension == 2 && !used.contains(known.tag);
  });
}

Quad sorted(Quad vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// Splits tagged groups with several smooth patches, each of which gets its own tag.
void splitTags(HexMesh& mesh, double angle, Context& context) {
  std::map<Quad, std::int32_t> patchOf;
  for (const FeatureQuad& quad : boundaryPatches(mesh, angle, context)) {
    patchOf.emplace(sorted(quad.vertices), quad.tag);
  }
  FreeTags free(mesh);
  std::map<Quad, std::int32_t> newTags;
  for (const NamedPatch& group : namedPatches(mesh, angle, context)) {
    if (group.tag == 0) continue;
    std::map<std::int32_t, std::int32_t> tags;  // of smooth patches
    for (const Quad& quad : group.quads) tags.emplace(patchOf.at(sorted(quad)), 0);
    if (tags.size() == 1) continue;
    std::size_t number = 0;
    for (auto& [patch, tag] : tags) {
      tag = free.next();
      mesh.features.names.push_back({2, tag, fmt::format("{}_{}", group.name, ++number)});
    }
    for (const Quad& quad : group.quads) {
      newTags[sorted(quad)] = tags.at(patchOf.at(sorted(quad)));
    }
  }
  for (FeatureQuad& quad : mesh.features.quads) {
    const auto found = newTags.find(sorted(quad.vertices));
    if (found != newTags.end()) quad.tag = found->second;
  }
}

/// Tags the quads of untagged patches, with numbers above all existing tags.
void tagPatches(HexMesh& mesh, std::vector<NamedPatch>& patches) {
  FreeTags free(mesh);
  for (NamedPatch& patch : patches) {
    if (patch.tag != 0) continue;
    patch.tag = free.next();
    for (const Quad& quad : patch.quads) mesh.features.quads.push_back({quad, patch.tag});
    mesh.features.names.push_back({2, patch.tag, patch.name});
  }
}

}  // namespace

void PatchNames::read(const std::filesystem::path& file) {
  file_ = file.string();
  const auto failToRead = [this] {
    throw Error(ErrorCode::FileNotFound,
                file_ + ": cannot be read: " + std::generic_category().message(errno) + ".");
  };
  std::ifstream lines(file);
  if (!lines) failToRead();
  static_cast<void>(lines.peek());
  if (lines.bad()) failToRead();  // a folder
  std::string line;
  for (std::uint64_t number = 1; std::getline(lines, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    std::istringstream words(line.substr(0, line.find('#')));
    std::string from;
    std::string to;
    std::string more;
    if (!(words >> from)) continue;
    if (words >> to && !(words >> more) && names_.emplace(from, to).second) continue;
    throw Error(
        ErrorCode::FileSyntax,
        fmt::format("{}, line {}: expected a name that a group has and a new one, each name "
                    "once, as in \"patch_1 inlet\".",
                    file_, number),
        {PlaceKind::Line, number, 0});
  }
}

void PatchNames::apply(HexMesh& mesh, double angle, Context& context) const {
  if (!isGiven()) return;
  dropUnused(mesh.features);
  if (split) {
    splitTags(mesh, angle, context);
    dropUnused(mesh.features);  // those of groups that were split
  }
  if (names_.empty()) return;
  std::vector<NamedPatch> patches = namedPatches(mesh, angle, context);
  std::string known;
  for (const NamedPatch& patch : patches) known += (known.empty() ? "" : ", ") + patch.name;
  for (const auto& [from, to] : names_) {
    const auto isMeant = [&name = from](const NamedPatch& patch) { return patch.name == name; };
    if (std::any_of(patches.begin(), patches.end(), isMeant)) continue;
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: no group of boundary quads has the name \"{}\". Groups: {}.",
                            file_, from, known));
  }
  tagPatches(mesh, patches);
  std::vector<TagName>& given = mesh.features.names;
  for (const NamedPatch& patch : patches) {
    const auto found = names_.find(patch.name);
    if (found == names_.end()) continue;
    std::erase_if(given, [&patch](const TagName& each) {
      return each.dimension == 2 && each.tag == patch.tag;
    });
    given.push_back({2, patch.tag, found->second});
  }
  requireOwnNames(mesh, patches, angle, context);
}

/// @param patches  with their previous names
void PatchNames::requireOwnNames(const HexMesh& mesh, const std::vector<NamedPatch>& patches,
                                 double angle, Context& context) const {
  std::map<std::int32_t, std::string> named;
  for (const NamedPatch& patch : namedPatches(mesh, angle, context)) {
    named.emplace(patch.tag, patch.name);
  }
  std::set<std::string> all;
  for (const NamedPatch& patch : patches) {
    const std::string& now = named.at(patch.tag);
    const auto found = names_.find(patch.name);
    // Of two groups with the same name, the second one was named by its tag.
    const std::string byTag =
        fmt::format("surface_{}{}", patch.tag < 0 ? "m" : "", std::abs(std::int64_t{patch.tag}));
    const bool isWanted =
        found == names_.end() ? now == patch.name : now != byTag || found->second == byTag;
    if (isWanted && all.insert(now).second) continue;
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{}: the name \"{}\" is also that of another group; case, and characters "
                    "after the 31st, do not count. Give each group its own.",
                    file_, found == names_.end() ? patch.name : found->second));
  }
}

void PatchNames::apply(LagrangeMesh& mesh, double angle, Context& context) const {
  if (!isGiven()) return;
  HexMesh straight = straightMesh(mesh);
  apply(straight, angle, context);
  mesh.features = std::move(straight.features);
}

void PatchNames::warnOfAngle(const PatchAngle& angle, const HexMesh& mesh, const std::string& file,
                             const WriteOptions& options, Context& context) const {
  if (!isGiven()) angle.warnIfUseless(mesh, file, options, context);
}
void PatchNames::warnOfAngle(const PatchAngle& angle, const LagrangeMesh& mesh,
                             const std::string& file, const WriteOptions& options,
                             Context& context) const {
  if (!angle.isGiven || isGiven()) return;
  angle.warnIfUseless(straightMesh(mesh), file, options, context);
}

void writeNamed(const PatchNames& names, HexMesh& mesh, const std::string& file,
                const WriteOptions& options, Context& context) {
  names.apply(mesh, options.patchAngle, context);
  writeHexMesh(mesh, file, options, context);
}
void writeNamed(const PatchNames& names, LagrangeMesh& mesh, const std::string& file,
                const WriteOptions& options, Context& context) {
  names.apply(mesh, options.patchAngle, context);
  writeLagrangeMesh(mesh, file, options, context);
}

void addPatchNames(CLI::App& parser, PatchNames& names) {
  parser.add_flag("--split-tags", names.split,
                  "Divide tagged groups of boundary quads into smooth patches\n"
                  "(--patch-angle), which are called NAME_1, NAME_2, ...");
  parser
      .add_option_function<std::string>(
          "--names",
          [&names](const std::string& file) {
            try {
              names.read(file);
            } catch (const Error& error) {
              throw CLI::ValidationError("--names", error.what());
            }
          },
          "Rename groups of boundary quads: a file with two words\non each line, such as "
          "\"patch_1 inlet\"; the viewer saves one")
      ->option_text("FILE");
}

}  // namespace hexhex::command
