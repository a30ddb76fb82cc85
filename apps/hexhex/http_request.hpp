// What `hexhex view --serve` understands of HTTP: GET and HEAD, and nothing else.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hexhex::command {

/// A request as far as it matters here.
struct HttpRequest {
  std::string_view method;
  std::string_view target;  ///< as it was sent; nothing in it is decoded
  std::string_view host;    ///< empty: there is none, or more than one
};

/// @param head  all up to the empty line, which it ends with
/// @returns nothing if that is no request of HTTP 1
[[nodiscard]] std::optional<HttpRequest> parseHttpRequest(std::string_view head);

/// Whether both are the same, in a time that does not tell how much of them is.
[[nodiscard]] bool sameSecret(std::string_view a, std::string_view b);

/// 128 random bits of the operating system as 32 hexadecimal digits.
[[nodiscard]] std::string makeSecret();

}  // namespace hexhex::command
