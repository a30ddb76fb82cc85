// Cuts an `.ovmb` file into its chunks (see ovmb_reader.hpp).
#include <algorithm>
#include <optional>

#include <io/core/text_scanner.hpp>
#include <io/ovm/ovmb_reader.hpp>

namespace hexhex {
namespace {

constexpr std::uint8_t kMandatory = 1;

/// What stands before the body of a chunk.
struct ChunkHeader {
  std::size_t position = 0;  ///< in the file
  std::string_view type;     ///< four characters
  std::uint8_t version = 0;
  std::uint8_t padding = 0;
  std::uint8_t compression = 0;
  std::uint8_t flags = 0;
  std::uint64_t length = 0;  ///< of the body, including padding
};

std::optional<OvmbChunkType> typeOf(std::string_view name) {
  if (name == "VERT") return OvmbChunkType::Vertices;
  if (name == "TOPO") return OvmbChunkType::Topology;
  if (name == "DIRP") return OvmbChunkType::Directory;
  if (name == "PROP") return OvmbChunkType::Property;
  return std::nullopt;
}

void readFileHeader(OvmbFrame& frame, ByteCursor& cursor) {
  if (!isOvmb(frame.bytes)) {
    cursor.fail(ErrorCode::FileSyntax,
                "an .ovmb file begins with \"OVMB\" and the bytes 0A 0D 0A FF, which are missing "
                "here. If this is a text file of OpenVolumeMesh, give it the extension .ovm.");
  }
  static_cast<void>(cursor.take(kOvmbMagic.size(), "the signature"));
  const auto readByte = [&cursor](const char* what) {
    return unsigned{cursor.read<std::uint8_t>(what)};
  };
  const auto require = [&cursor](bool condition, ErrorCode code, const std::string& sentence) {
    if (!condition) cursor.failAt(cursor.position() - 1, code, sentence);
  };
  // The version of the file is not checked: chunks have versions of their own.
  static_cast<void>(readByte("the version of the file"));
  const unsigned version = readByte("the version of the header");
  require(version == 1, ErrorCode::FileUnsupported,
          "the header has version " + std::to_string(version) + "; only version 1 is supported.");
  const unsigned dimension = readByte("the dimension");
  require(dimension == 3, ErrorCode::FileUnsupported,
          "the dimension must be 3, found " + std::to_string(dimension) + ".");
  // Valences decide what the cells are; this is but a hint.
  const unsigned kind = readByte("the kind of the mesh");
  require(kind <= 2, ErrorCode::FileSyntax,
          "the kind of the mesh must be 0, 1 or 2, found " + std::to_string(kind) + ".");
  const std::size_t reserved = cursor.position();
  if (cursor.read<std::uint32_t>("the reserved part") != 0) {
    cursor.failAt(reserved, ErrorCode::FileSyntax, "the reserved part of the header is not zero.");
  }
  for (std::uint64_t& count : frame.counts) {
    const std::size_t position = cursor.position();
    count = cursor.read<std::uint64_t>("the header");
    if (count > kMaxOvmEntities) {
      cursor.failAt(position, ErrorCode::TooLarge,
                    "the header announces " + std::to_string(count) +
                        " elements of a kind; at most " + std::to_string(kMaxOvmEntities) +
                        " are supported.");
    }
  }
}

ChunkHeader readChunkHeader(ByteCursor& cursor) {
  constexpr std::string_view kWhat = "the header of a chunk";
  ChunkHeader header;
  header.position = cursor.position();
  header.type = cursor.take(4, kWhat);
  header.version = cursor.read<std::uint8_t>(kWhat);
  header.padding = cursor.read<std::uint8_t>(kWhat);
  header.compression = cursor.read<std::uint8_t>(kWhat);
  header.flags = cursor.read<std::uint8_t>(kWhat);
  header.length = cursor.read<std::uint64_t>(kWhat);
  if (header.padding > 7 || header.padding > header.length || header.flags > kMandatory) {
    cursor.failAt(header.position, ErrorCode::FileSyntax,
                  "the chunk " + quoted(header.type) + " has an impossible header.");
  }
  return header;
}

std::string_view takePayload(const ChunkHeader& header, ByteCursor& cursor) {
  const std::string_view body = cursor.take(header.length, "the chunk " + quoted(header.type));
  const std::string_view payload = body.substr(0, body.size() - header.padding);
  const std::string_view padding = body.substr(payload.size());
  if (std::any_of(padding.begin(), padding.end(), [](char byte) { return byte != 0; })) {
    cursor.failAt(cursor.position() - header.padding, ErrorCode::FileSyntax,
                  "the padding at the end of the chunk " + quoted(header.type) + " is not zero.");
  }
  return payload;
}

/// Whether a chunk is of a kind that this library knows; if not, it has to be optional.
bool isKnown(const ChunkHeader& header, const ByteCursor& cursor) {
  const bool known = (typeOf(header.type) || header.type == "EOF ") && header.version == 0 &&
                     header.compression == 0;
  if (known || (header.flags & kMandatory) == 0) return known;
  cursor.failAt(header.position, ErrorCode::FileUnsupported,
                "the chunk " + quoted(header.type) + " (version " + std::to_string(header.version) +
                    ", compression " + std::to_string(header.compression) +
                    ") is not supported, and marked as mandatory. Save the file with an earlier "
                    "version of OpenVolumeMesh, uncompressed.");
}

}  // namespace

OvmbFrame splitOvmb(std::string_view bytes, const std::string& fileName) {
  OvmbFrame frame{bytes, fileName, {}, {}};
  ByteCursor cursor = frame.cursor(bytes);
  readFileHeader(frame, cursor);
  while (true) {
    if (cursor.remaining() == 0) {
      cursor.fail(ErrorCode::FileSyntax,
                  "the file ends without its end chunk: it is truncated. Copy or save it again.");
    }
    const ChunkHeader header = readChunkHeader(cursor);
    const bool known = isKnown(header, cursor);
    const std::string_view payload = takePayload(header, cursor);
    if (!known) continue;
    if (header.type == "EOF ") {
      if (!payload.empty()) {
        cursor.failAt(header.position, ErrorCode::FileSyntax, "the end chunk is not empty.");
      }
      break;
    }
    frame.chunks.push_back({*typeOf(header.type), payload});
  }
  if (cursor.remaining() > 0) {
    cursor.fail(ErrorCode::FileSyntax,
                "there are " + std::to_string(cursor.remaining()) + " bytes after the end chunk.");
  }
  return frame;
}

}  // namespace hexhex
