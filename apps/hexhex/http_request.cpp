#include "http_request.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <unistd.h>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {
namespace {

constexpr std::string_view kNewLine = "\r\n";
constexpr std::string_view kHost = "host";

/// The text before the next separator, which is removed together with it; nothing if there is none.
std::optional<std::string_view> takeUntil(std::string_view separator, std::string_view& text) {
  const std::size_t end = text.find(separator);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(end + separator.size());
  return taken;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Names of headers are the same in capitals.
bool namesHost(std::string_view name) {
  return std::ranges::equal(name, kHost, [](char given, char wanted) {
    return given == wanted || (given >= 'A' && given <= 'Z' && given - 'A' + 'a' == wanted);
  });
}

}  // namespace

std::optional<HttpRequest> parseHttpRequest(std::string_view head) {
  auto line = takeUntil(kNewLine, head);
  if (!line) return std::nullopt;
  const auto method = takeUntil(" ", *line);
  const auto target = method ? takeUntil(" ", *line) : std::nullopt;
  if (!target || (*line != "HTTP/1.1" && *line != "HTTP/1.0")) return std::nullopt;
  HttpRequest request{*method, *target, {}};
  bool several = false;
  while ((line = takeUntil(kNewLine, head)) && !line->empty()) {
    const auto name = takeUntil(":", *line);
    if (!name) return std::nullopt;
    if (!namesHost(*name)) continue;
    several = several || !request.host.empty();
    request.host = trimmed(*line);
  }
  if (several) request.host = {};
  return request;
}

bool sameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return different == 0;
}

std::string makeSecret() {
  std::array<unsigned char, 16> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    throw Error(ErrorCode::Internal,
                "The operating system gives no random numbers, which the secret in the address "
                "of the page consists of. Leave out --serve.");
  }
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace hexhex::command
