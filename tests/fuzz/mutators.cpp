#include "mutators.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <vector>

namespace hexhex::fuzz {

namespace {

template <class T>
T numberAt(const std::string& file, std::size_t place) {
  T number{};
  std::memcpy(&number, file.data() + place, sizeof(T));
  return number;
}

template <class T>
void putNumber(std::string& file, std::size_t place, T number) {
  std::memcpy(file.data() + place, &number, sizeof(T));
}

/// What readers should not be afraid of: limits of types, and what is just beside a right number.
std::int64_t oddNumber(std::int64_t right, Dice& dice) {
  constexpr std::array<std::int64_t, 12> kOdd = {
      0, 1, -1, 2, 127, 256, 1 << 16, 2147483647, 4294967295, 4294967296, 1LL << 62, -(1LL << 62)};
  if (dice.below(2) == 0) return kOdd[dice.below(kOdd.size())];
  // Modulo 2^64: the number in the file can be any.
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(right) + dice.below(5) - 2);
}

/// Loses, doubles, moves or exchanges one of the parts, or changes the inside of one.
/// @param begin  of the inside of a part
void changeParts(std::vector<std::string>& parts, Dice& dice, const ChangeBytes& change,
                 std::size_t begin) {
  const std::size_t chosen = dice.below(parts.size());
  const auto place = parts.begin() + static_cast<std::ptrdiff_t>(chosen);
  switch (dice.below(8)) {
    case 0:
      parts.erase(place);
      break;
    case 1:
      parts.insert(place, std::string(*place));
      break;
    case 2:
      std::swap(*place, parts[dice.below(parts.size())]);
      break;
    default:
      *place = place->substr(0, begin) + change(place->substr(std::min(begin, place->size())));
  }
}

/// A run of digits in a text.
struct Number {
  std::size_t begin = 0;
  std::size_t size = 0;
};

std::vector<Number> numbersIn(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  std::vector<Number> numbers;
  for (std::size_t i = text.find_first_of(kDigits); i != std::string_view::npos;
       i = text.find_first_of(kDigits, i)) {
    const std::size_t end = std::min(text.find_first_not_of(kDigits, i), text.size());
    if (end - i < 18) numbers.push_back({i, end - i});
    i = end;
  }
  return numbers;
}

std::string changeNumber(const std::string& text, Dice& dice) {
  const std::vector<Number> numbers = numbersIn(text);
  if (numbers.empty()) return text;
  const Number& chosen = numbers[dice.below(numbers.size())];
  const std::int64_t right = std::stoll(text.substr(chosen.begin, chosen.size));
  std::string changed = text;
  return changed.replace(chosen.begin, chosen.size, std::to_string(oddNumber(right, dice)));
}

/// An array behind the tags of a .vtu file.
struct AppendedArray {
  Number offset;  ///< where the tag tells it
  std::string bytes;
};

}  // namespace

/// 48 bytes with numbers of elements from the 16th on; then chunks: a name, a byte for the version,
/// one for the number of bytes that fill the chunk up to eight, two more, eight for the length.
std::string changeOvmb(const std::string& file, Dice& dice, const ChangeBytes& change) {
  constexpr std::size_t kHeader = 48;
  constexpr std::size_t kChunkHeader = 16;
  constexpr std::size_t kPadding = 5;
  constexpr std::size_t kLength = 8;
  if (file.size() < kHeader) return file;
  std::string head = file.substr(0, kHeader);
  if (dice.below(8) == 0) {
    const std::size_t place = 16 + 8 * dice.below(4);
    putNumber(head, place, oddNumber(numberAt<std::int64_t>(head, place), dice));
    return head + file.substr(kHeader);
  }
  std::vector<std::string> chunks;
  for (std::size_t at = kHeader; at + kChunkHeader <= file.size();) {
    const auto length = numberAt<std::uint64_t>(file, at + kLength);
    if (length > file.size() - at - kChunkHeader) return file;
    const auto padding = static_cast<unsigned char>(file[at + kPadding]);
    if (padding > length) return file;
    chunks.push_back(file.substr(at, kChunkHeader + length - padding));
    at += kChunkHeader + length;
  }
  if (chunks.empty()) return file;
  changeParts(chunks, dice, change, kChunkHeader);
  for (std::string& chunk : chunks) {
    const std::size_t padding = (8 - chunk.size() % 8) % 8;
    chunk.append(padding, '\0');
    chunk[kPadding] = static_cast<char>(padding);
    putNumber(chunk, kLength, std::uint64_t{chunk.size() - kChunkHeader});
    head += chunk;
  }
  return head;
}

/// The number 1 and the version; then sections: a code, and the place of the next section, as an
/// int or, from version 3 on, as a long.
std::string changeMeshb(const std::string& file, Dice& dice, const ChangeBytes& change) {
  constexpr std::size_t kHeader = 8;
  if (file.size() < kHeader) return file;
  const bool wide = numberAt<std::int32_t>(file, 4) >= 3;
  const std::size_t inside = wide ? 12 : 8;
  std::vector<std::string> sections;
  for (std::size_t at = kHeader; at + inside <= file.size();) {
    const auto next = static_cast<std::uint64_t>(wide ? numberAt<std::int64_t>(file, at + 4)
                                                      : numberAt<std::int32_t>(file, at + 4));
    const std::size_t end = next == 0 ? file.size() : next;
    if (end > file.size() || end < at + inside) return file;
    sections.push_back(file.substr(at, end - at));
    at = end;
  }
  if (sections.empty()) return file;
  changeParts(sections, dice, change, inside);
  std::string changed = file.substr(0, kHeader);
  for (std::string& section : sections) {
    if (section.size() < inside) section.resize(inside);
    const std::size_t next = &section == &sections.back() ? 0 : changed.size() + section.size();
    if (wide) {
      putNumber(section, 4, static_cast<std::int64_t>(next));
    } else {
      putNumber(section, 4, static_cast<std::int32_t>(next));
    }
    changed += section;
  }
  return changed;
}

std::string changeAppended(const std::string& file, Dice& dice, const ChangeBytes& change) {
  const std::size_t tag = file.find("<AppendedData");
  const std::size_t begin = tag == std::string::npos ? tag : file.find('_', tag);
  if (begin == std::string::npos || file.find("encoding=\"raw\"", tag) > begin) return file;
  std::string head = file.substr(0, begin + 1);
  if (dice.below(4) == 0) return changeText(head, dice) + file.substr(begin + 1);
  const std::size_t inside = head.find("header_type=\"UInt64\"") == std::string::npos ? 4 : 8;
  constexpr std::string_view kOffset = "offset=\"";
  std::vector<AppendedArray> arrays;
  for (std::size_t at = head.find(kOffset); at != std::string::npos; at = head.find(kOffset, at)) {
    at += kOffset.size();
    const std::size_t end = std::min(head.find('"', at), head.size());
    if (end == at || end - at > 9 || head.find_first_not_of("0123456789", at) < end) return file;
    const std::size_t place = begin + 1 + std::stoul(head.substr(at, end - at));
    if (place + inside > file.size()) return file;
    const std::uint64_t length =
        inside == 8 ? numberAt<std::uint64_t>(file, place) : numberAt<std::uint32_t>(file, place);
    if (length > file.size() - place - inside) return file;
    arrays.push_back({{at, end - at}, file.substr(place, inside + length)});
  }
  if (arrays.empty()) return file;
  std::string& bytes = arrays[dice.below(arrays.size())].bytes;
  bytes = bytes.substr(0, inside) + change(bytes.substr(inside));
  std::string data;
  std::vector<std::size_t> places;
  for (AppendedArray& array : arrays) {
    const std::size_t length = array.bytes.size() - inside;
    if (inside == 8) {
      putNumber(array.bytes, 0, std::uint64_t{length});
    } else {
      putNumber(array.bytes, 0, static_cast<std::uint32_t>(length));
    }
    places.push_back(data.size());
    data += array.bytes;
  }
  for (std::size_t i = arrays.size(); i-- > 0;) {  // from behind, as texts may become longer
    head.replace(arrays[i].offset.begin, arrays[i].offset.size, std::to_string(places[i]));
  }
  return head + data + "\n  </AppendedData>\n</VTKFile>\n";
}

std::string changeText(const std::string& file, Dice& dice) {
  if (dice.below(2) == 0) return changeNumber(file, dice);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t end = std::min(file.find('\n', at), file.size() - 1);
    lines.push_back(file.substr(at, end + 1 - at));
    at = end + 1;
  }
  if (lines.empty()) return file;
  changeParts(
      lines, dice, [&](const std::string& line) { return changeNumber(line, dice); }, 0);
  std::string changed;
  for (const std::string& line : lines) changed += line;
  return changed;
}

}  // namespace hexhex::fuzz
