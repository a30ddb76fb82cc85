#include <cstdint>

#include <hexhex/error.hpp>

#include <io/gmsh/gmsh_file.hpp>

namespace hexhex {

GmshFile::GmshFile(std::string_view text, const std::string& fileName, Stage& stage)
    : text_(text), bytes_(text), fileName_(fileName), scanner_(text, fileName), stage_(stage) {
  if (scanner_.readToken() != "$MeshFormat") {
    scanner_.fail(ErrorCode::FileSyntax, "a .msh file begins with \"$MeshFormat\", found " +
                                             quoted(scanner_.currentToken()) + ".");
  }
  readVersion();
  readEncoding();
  endSection("MeshFormat");
}

void GmshFile::readVersion() {
  const std::string_view version = scanner_.readToken();
  version4_ = version == "4.1";
  if (version4_ || version == "2.2" || version == "2.1" || version == "2" || version == "2.0") {
    return;
  }
  scanner_.fail(ErrorCode::FileUnsupported,
                "version " + quoted(version) +
                    " of the format is not supported; save the mesh as version 4.1 or 2.2.");
}

void GmshFile::readEncoding() {
  std::int64_t type = 0;
  if (!scanner_.readInteger(type)) scanner_.failInteger("the file type");
  if (type != 0 && type != 1) {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the file type is 0 (text) or 1 (binary), found " + std::to_string(type) + ".");
  }
  binary_ = type == 1;
  std::int64_t size = 0;
  if (!scanner_.readInteger(size)) scanner_.failInteger("the size of numbers");
  if (size != 8) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "numbers of " + std::to_string(size) + " bytes are not supported, only 8.");
  }
  if (!binary_) {
    index_.emplace(text_, stage_);
    return;
  }
  withSource([](auto& source) {
    if (source.integer("the mark of the byte order") == 1) return;
    source.fail(ErrorCode::FileUnsupported,
                "the bytes of numbers come in the order of another kind of computers; save the "
                "mesh as text.");
  });
}

std::optional<std::string_view> GmshFile::nextSection() {
  if (!scanner_.skipSpace()) return {};
  const std::string_view token = scanner_.readToken();
  if (token.front() != '$') {
    scanner_.fail(ErrorCode::FileSyntax,
                  "a section begins with '$' and its name, found " + quoted(token) + ".");
  }
  return token.substr(1);
}

void GmshFile::endSection(std::string_view name) {
  const std::string_view token = scanner_.readToken();
  if (token.starts_with("$End") && token.substr(4) == name) return;
  scanner_.failToken("\"$End" + std::string(name) + "\"");
}

std::string_view GmshFile::skipSection(std::string_view name) {
  const std::string end = "$End" + std::string(name);
  const std::size_t begin = scanner_.position();
  const std::size_t place = text_.find(end, begin);
  if (place == std::string_view::npos) {
    scanner_.fail(ErrorCode::FileSyntax, "the section has no " + quoted(std::string_view(end)) +
                                             ": the file is incomplete.");
  }
  scanner_.moveTo(place + end.size());
  return text_.substr(begin, place + end.size() - begin);
}

}  // namespace hexhex
