#include "patch_names.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
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

std::int32_t lastTag(const HexMesh& mesh) {
  std::int32_t last = 0;
  for (const FeatureQuad& quad : mesh.features.quads) last = std::max(last, quad.tag);
  return last;
}

Quad sorted(Quad vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

/// Gives smooth patches of a tagged group tags of their own, if there are several.
void splitTags(HexMesh& mesh, double angle, Context& context) {
  std::map<Quad, std::int32_t> patchOf;
  for (const FeatureQuad& quad : boundaryPatches(mesh, angle, context)) {
    patchOf.emplace(sorted(quad.vertices), quad.tag);
  }
  std::int32_t last = lastTag(mesh);
  std::map<Quad, std::int32_t> newTags;
  for (const NamedPatch& group : namedPatches(mesh, angle, context)) {
    if (group.tag == 0) continue;
    std::map<std::int32_t, std::int32_t> tags;  // of smooth patches
    for (const Quad& quad : group.quads) tags.emplace(patchOf.at(sorted(quad)), 0);
    if (tags.size() == 1) continue;
    std::size_t number = 0;
    for (auto& [patch, tag] : tags) {
      tag = ++last;
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

/// Tags the quads of patches that have no tag, with numbers behind the tags that there are.
void tagPatches(HexMesh& mesh, std::vector<NamedPatch>& patches) {
  std::int32_t last = lastTag(mesh);
  for (NamedPatch& patch : patches) {
    if (patch.tag != 0) continue;
    patch.tag = ++last;
    for (const Quad& quad : patch.quads) mesh.features.quads.push_back({quad, patch.tag});
    mesh.features.names.push_back({2, patch.tag, patch.name});
  }
}

}  // namespace

void PatchNames::read(const std::filesystem::path& file) {
  file_ = file.string();
  std::ifstream lines(file);
  if (!lines) {
    throw Error(ErrorCode::FileNotFound,
                file_ + ": cannot be read: " + std::generic_category().message(errno) + ".");
  }
  std::string line;
  for (std::uint64_t number = 1; std::getline(lines, line); ++number) {
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
  if (split) splitTags(mesh, angle, context);
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
}

void PatchNames::apply(LagrangeMesh& mesh, double angle, Context& context) const {
  if (!isGiven()) return;
  HexMesh straight = straightMesh(mesh);
  apply(straight, angle, context);
  mesh.features = std::move(straight.features);
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
          "\"patch_1 inlet\"; the viewer saves it")
      ->option_text("FILE");
}

}  // namespace hexhex::command
