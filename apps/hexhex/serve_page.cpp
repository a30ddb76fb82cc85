#include "serve_page.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <list>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <span>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <arpa/inet.h>
#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {
namespace {

// What is understood of HTTP: GET and HEAD, and nothing else.

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

/// A request as far as it matters here.
struct HttpRequest {
  std::string_view method;
  std::string_view target;  ///< as it was sent; nothing in it is decoded
  std::string_view host;    ///< empty: there is none, or more than one
};

/// @param head  all up to the empty line, which it ends with
/// @returns nothing if that is no request of HTTP 1
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

/// Whether both are the same, in a time that does not tell how much of them is.
bool sameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return different == 0;
}

/// 128 random bits of the operating system as 32 hexadecimal digits.
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

using Clock = std::chrono::steady_clock;

constexpr const char* kLoopback = "127.0.0.1";

/// How long after Ctrl-C the server ends, at most: short for people, long for the processor.
constexpr std::chrono::milliseconds kPatience{100};

/// What a client may take: for its request, until it has read something of the answer, and to close
/// the connection. Browsers on the same machine take milliseconds.
constexpr std::chrono::seconds kRequestTime{5};
constexpr std::chrono::seconds kAnswerTime{30};
constexpr std::chrono::seconds kFarewellTime{2};

/// Browsers send less than one kilobyte.
constexpr std::size_t kMaxRequest = 8192;

/// Browsers open up to six.
constexpr std::size_t kMaxConnections = 32;

/// Closes itself.
class Socket {
 public:
  explicit Socket(int number) : number_(number) {}
  ~Socket() {
    if (number_ >= 0) ::close(number_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

/// Whether a call would only have had to wait.
bool onlyEarly() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

enum class Phase { Request, Answer, Farewell, Over };

struct Connection {
  explicit Connection(int number) : socket(number) {}
  Socket socket;
  Phase phase = Phase::Request;
  Clock::time_point deadline = Clock::now() + kRequestTime;
  std::string request;                  ///< as far as it has come
  std::string head;                     ///< of the answer
  std::span<const std::string> body{};  ///< of the answer, piece by piece
  std::size_t piece = 0;                ///< what is sent next: 0 for the head, then the body
  std::size_t sent = 0;                 ///< of that piece

  void enter(Phase next, Clock::duration time) {
    phase = next;
    deadline = Clock::now() + time;
  }
};

/// What is sent to whom.
class Pages {
 public:
  Pages(const ServedPage& page, int port)
      : page_(page), port_(port), path_("/" + makeSecret() + "/") {}

  [[nodiscard]] std::string address() const {
    return fmt::format("http://{}:{}{}", kLoopback, port_, path_);
  }

  /// Sets head and body.
  void answer(Connection& client) const {
    const auto request = parseHttpRequest(client.request);
    if (!request) return refuse(client, "400 Bad Request");
    if (!isHost(request->host)) return refuse(client, "403 Forbidden");
    const bool headOnly = request->method == "HEAD";
    if (!headOnly && request->method != "GET") return refuse(client, "405 Method Not Allowed");
    if (sameSecret(request->target, path_)) {
      succeed(client, "text/html; charset=utf-8", std::span(&page_.html, 1), headOnly);
    } else if (sameSecret(request->target, path_ + kMeshUrl)) {
      succeed(client, "application/octet-stream", page_.data, headOnly);
    } else {
      refuse(client, "404 Not Found");
    }
  }

  static void refuse(Connection& client, std::string_view status) {
    client.head = headOf(status, "text/plain", status.size() + 1) + fmt::format("{}\n", status);
    client.body = {};
    client.enter(Phase::Answer, kAnswerTime);
  }

 private:
  [[nodiscard]] bool isHost(std::string_view given) const {
    constexpr int kUnnamed = 80;  // that browsers leave out
    return std::ranges::any_of(std::initializer_list<std::string_view>{kLoopback, "localhost"},
                               [&](std::string_view name) {
                                 return given == fmt::format("{}:{}", name, port_) ||
                                        (port_ == kUnnamed && given == name);
                               });
  }

  static void succeed(Connection& client, std::string_view type, std::span<const std::string> body,
                      bool headOnly) {
    std::size_t size = 0;
    for (const std::string& part : body) size += part.size();
    client.head = headOf("200 OK", type, size);
    if (!headOnly) client.body = body;
    client.enter(Phase::Answer, kAnswerTime);
  }

  /// The page's own Content-Security-Policy is in it; this one adds what cannot be said there.
  static std::string headOf(std::string_view status, std::string_view type, std::size_t size) {
    return fmt::format(
        "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n"
        "Allow: GET, HEAD\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
        "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n"
        "Cross-Origin-Opener-Policy: same-origin\r\n"
        "Content-Security-Policy: frame-ancestors 'none'\r\n\r\n",
        status, type, size);
  }

  const ServedPage& page_;
  int port_;
  std::string path_;
};

/// Reads what has come of a request, and answers it once it is complete.
void receive(Connection& client, const Pages& pages) {
  std::array<char, kMaxRequest> bytes;
  const ssize_t count = ::recv(client.socket.number(), bytes.data(), bytes.size(), 0);
  if (count <= 0) {
    if (count == 0 || !onlyEarly()) client.phase = Phase::Over;
    return;
  }
  if (client.phase == Phase::Farewell) return;  // what comes after a request is of no interest
  client.request.append(bytes.data(), static_cast<std::size_t>(count));
  constexpr std::string_view kEnd = "\r\n\r\n";
  const std::size_t end = client.request.find(kEnd);
  if (end != std::string::npos && end + kEnd.size() <= kMaxRequest) {
    client.request.resize(end + kEnd.size());
    pages.answer(client);
  } else if (client.request.size() >= kMaxRequest) {
    Pages::refuse(client, "431 Request Header Fields Too Large");
  }
}

/// Sends as much as the client takes.
void send(Connection& client) {
  while (client.piece <= client.body.size()) {
    const std::string& piece = client.piece == 0 ? client.head : client.body[client.piece - 1];
    const std::string_view rest = std::string_view(piece).substr(client.sent);
    const ssize_t count =
        ::send(client.socket.number(), rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) {
      if (!onlyEarly()) client.phase = Phase::Over;
      return;
    }
    client.deadline = Clock::now() + kAnswerTime;
    client.sent += static_cast<std::size_t>(count);
    if (client.sent < piece.size()) return;
    ++client.piece;
    client.sent = 0;
  }
  // To close at once would take the answer away from clients that are still sending.
  ::shutdown(client.socket.number(), SHUT_WR);
  client.enter(Phase::Farewell, kFarewellTime);
}

/// A listening socket.
int listenAt(int port, sockaddr_in& address) {
  const int number = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const general = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  const int yes = 1;  // or a port would be taken for a minute after its last connection
  if (number >= 0 && ::setsockopt(number, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      ::bind(number, general, size) == 0 && ::listen(number, SOMAXCONN) == 0 &&
      ::getsockname(number, general, &size) == 0) {
    return number;
  }
  if (number >= 0) ::close(number);
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("Port {} of this machine cannot be used. Leave out --port for a free one.",
                  port));
}

/// All connections, in the order in which they came.
class Connections {
 public:
  Connections(int listener, const Pages& pages) : listener_(listener), pages_(pages) {}

  /// Waits until something happens, but not for long, and does what is to be done.
  void serve() {
    std::vector<pollfd> waiting = {{listener_, POLLIN, 0}};
    for (const Connection& client : clients_) {
      const short event = client.phase == Phase::Answer ? POLLOUT : POLLIN;
      waiting.push_back({client.socket.number(), event, 0});
    }
    if (::poll(waiting.data(), waiting.size(), static_cast<int>(kPatience.count())) < 0) return;
    auto found = waiting.begin();
    for (Connection& client : clients_) {
      if ((++found)->revents != 0)
        client.phase == Phase::Answer ? send(client) : receive(client, pages_);
    }
    const auto now = Clock::now();
    clients_.remove_if([now](const Connection& client) {
      return client.phase == Phase::Over || client.deadline < now;
    });
    if (waiting.front().revents != 0) acceptOne();
  }

 private:
  void acceptOne() {
    const int number = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (number >= 0) {
      clients_.emplace_back(number);
      if (clients_.size() > kMaxConnections) dropOne();
    } else if (!onlyEarly()) {
      // No descriptor is left, or the like: one place has to become free.
      if (!clients_.empty()) dropOne();
      ::poll(nullptr, 0, static_cast<int>(kPatience.count()));
    }
  }

  /// The oldest one that has not asked yet, so that strangers do not keep the page from its owner.
  void dropOne() {
    const auto idle = std::ranges::find(clients_, Phase::Request, &Connection::phase);
    clients_.erase(idle != clients_.end() ? idle : clients_.begin());
  }

  int listener_;
  const Pages& pages_;
  std::list<Connection> clients_;
};

}  // namespace

void servePage(const ServedPage& page, int port,
               const std::function<void(const std::string& address)>& onReady, Context& context) {
  sockaddr_in address{};
  const Socket listener(listenAt(port, address));
  const Pages pages(page, ntohs(address.sin_port));
  Connections connections(listener.number(), pages);
  onReady(pages.address());
  while (!context.cancelled()) connections.serve();
}

}  // namespace hexhex::command
