#include "serve_page.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <httplib.h>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {
namespace {

constexpr const char* kLoopback = "127.0.0.1";

/// How long after Ctrl-C the server ends, at most: short for people, long for the processor.
constexpr std::chrono::milliseconds kPatience{100};

/// Stops a server when a context is cancelled.
class StopOnCancel {
 public:
  StopOnCancel(httplib::Server& server, const Context& context)
      : thread_([this, &server, &context] {
          while (!ended_ && !context.cancelled()) std::this_thread::sleep_for(kPatience);
          server.stop();
        }) {}
  ~StopOnCancel() {
    ended_ = true;
    thread_.join();
  }
  StopOnCancel(const StopOnCancel&) = delete;
  StopOnCancel& operator=(const StopOnCancel&) = delete;

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

/// The chunks of the mesh as one body, without a copy.
void sendMesh(const ServedPage& page, httplib::Response& response) {
  std::size_t size = 0;
  for (const std::string& chunk : page.data) size += chunk.size();
  response.set_content_provider(
      size, "application/octet-stream",
      [&page](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::size_t begin = 0;
        for (const std::string& chunk : page.data) {
          if (offset < begin + chunk.size()) {
            const std::size_t skipped = offset - begin;
            return sink.write(chunk.data() + skipped, std::min(length, chunk.size() - skipped));
          }
          begin += chunk.size();
        }
        return false;
      });
}

void addRoutes(httplib::Server& server, const ServedPage& page, int port) {
  const std::vector<std::string> hosts = {fmt::format("{}:{}", kLoopback, port),
                                          fmt::format("localhost:{}", port)};
  server.set_default_headers(
      {{"Cache-Control", "no-store"}, {"X-Content-Type-Options", "nosniff"}});
  server.set_pre_routing_handler(
      [hosts](const httplib::Request& request, httplib::Response& response) {
        if (std::ranges::find(hosts, request.get_header_value("Host")) != hosts.end())
          return httplib::Server::HandlerResponse::Unhandled;
        response.status = 403;
        return httplib::Server::HandlerResponse::Handled;
      });
  server.Get("/", [&page](const httplib::Request& /*request*/, httplib::Response& response) {
    response.set_content(page.html, "text/html; charset=utf-8");
  });
  server.Get(kMeshUrl, [&page](const httplib::Request& /*request*/, httplib::Response& response) {
    sendMesh(page, response);
  });
  // Browsers ask for it unasked.
  server.Get("/favicon.ico", [](const httplib::Request& /*request*/, httplib::Response& response) {
    response.status = 204;
  });
}

}  // namespace

void servePage(const ServedPage& page, int port,
               const std::function<void(const std::string& address)>& onReady, Context& context) {
  httplib::Server server;
  // By default several servers may share a port, and browsers would meet either.
  server.set_socket_options([](socket_t /*socket*/) {});
  const int bound = port == 0                              ? server.bind_to_any_port(kLoopback)
                    : server.bind_to_port(kLoopback, port) ? port
                                                           : -1;
  if (bound <= 0) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("Port {} of this machine cannot be used. Leave out --port for a free "
                            "one.",
                            port));
  }
  addRoutes(server, page, bound);
  const StopOnCancel stopOnCancel(server, context);
  onReady(fmt::format("http://{}:{}/", kLoopback, bound));
  server.listen_after_bind();
}

}  // namespace hexhex::command
