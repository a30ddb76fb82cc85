#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

#include <io/core/format_lookup.hpp>
#include <io/core/letter_case.hpp>
#include <io/core/zlib_blocks.hpp>

namespace hexhex {
namespace {

bool holdsMaps(const Format& format) {
  return format.readMap != nullptr || format.writeMap != nullptr;
}
bool holdsMeshes(const Format& format) {
  return format.readMesh != nullptr || format.writeMesh != nullptr || !format.missing.empty();
}

/// What a format is looked for.
struct FormatPurpose {
  bool (*fits)(const Format& format);
  const char* what;
};
constexpr FormatPurpose kForMaps = {holdsMaps, "maps"};
constexpr FormatPurpose kForMeshes = {holdsMeshes, "hexahedral meshes"};
constexpr FormatPurpose kForBoth = {
    [](const Format& format) { return holdsMaps(format) || holdsMeshes(format); },
    "maps or hexahedral meshes"};
constexpr FormatPurpose kForTets = {[](const Format& format) { return format.readTets != nullptr; },
                                    "tetrahedral meshes"};

/// ".mesh, .vtu": what file names can mean.
std::string listExtensions(bool (*fits)(const Format&)) {
  std::string list;
  std::string_view last;
  for (const Format& format : allFormats()) {
    if (!fits(format) || format.extension.empty() || format.extension == last) continue;
    last = format.extension;
    list += (list.empty() ? "" : ", ") + std::string(last);
  }
  return list;
}

const Format& formatNamed(std::string_view name, const std::filesystem::path& file,
                          const FormatPurpose& purpose) {
  name = usualFormatName(name);
  for (const Format& format : allFormats()) {
    if (format.name == name && purpose.fits(format)) return format;
  }
  throw Error(ErrorCode::FileUnsupported, file.string() + ": \"" + std::string(name) +
                                              "\" is no format of " + purpose.what +
                                              ". Formats: " + listFormatNames(purpose.fits) + ".");
}

const Format& findFormat(const std::filesystem::path& file, std::string_view name,
                         const FormatPurpose& purpose) {
  if (!name.empty()) return formatNamed(name, file, purpose);
  const std::string extension = lowerCaseExtension(file);
  for (const Format& format : allFormats()) {
    if (!extension.empty() && format.extension == extension && purpose.fits(format)) return format;
  }
  const std::string problem =
      extension.empty() ? "the file name has no extension"
                        : "the extension \"" + extension + "\" is no format of " + purpose.what;
  const std::span<const Format> formats = allFormats();
  const bool tetsOnly = std::any_of(formats.begin(), formats.end(), [&](const Format& format) {
    return purpose.fits == holdsMaps && !extension.empty() && format.extension == extension &&
           format.readTets != nullptr;
  });
  throw Error(ErrorCode::FileUnsupported,
              file.string() + ": " + problem + ". Maps: " + listExtensions(holdsMaps) +
                  "; hexahedral meshes: " + listExtensions(holdsMeshes) + "." +
                  (tetsOnly ? " Tets without a map need a second mesh with their parameters "
                              "(--tets, --polycube)."
                            : ""));
}

}  // namespace

const Format& mapFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForMaps);
}

const Format& hexMeshFormat(const std::filesystem::path& file, std::string_view name) {
  const Format& format = findFormat(file, name, kForMeshes);
  if (format.missing.empty()) return format;
  throw Error(ErrorCode::FileUnsupported, file.string() +
                                              ": this build of hexhex cannot write the format \"" +
                                              std::string(format.name) + "\". Install " +
                                              std::string(format.missing) + " and build it anew.");
}

const Format& mapOrHexMeshFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForBoth);
}

const Format& tetFormat(const std::filesystem::path& file, std::string_view name) {
  return findFormat(file, name, kForTets);
}

std::string listFormatNames(bool (*fits)(const Format&)) {
  std::string list;
  for (const Format& format : allFormats()) {
    if (fits(format)) list += (list.empty() ? "" : ", ") + std::string(format.name);
  }
  return list;
}

std::span<const FileFormat> fileFormats() {
  static const std::vector<FileFormat> list = [] {
    std::vector<FileFormat> result;
    result.reserve(allFormats().size());
    for (const Format& format : allFormats()) {
      if (!format.missing.empty()) continue;
      result.push_back({format.name, format.extension, format.description,
                        format.readMap != nullptr, format.writeMap != nullptr,
                        format.readTets != nullptr, format.readMesh != nullptr,
                        format.writeMesh != nullptr, format.openSink != nullptr,
                        format.compresses && hasZlib()});
    }
    return result;
  }();
  return list;
}

}  // namespace hexhex
