// Over real sockets: whoever scrapes gets the page, and nobody else gets anything for long.

#include "ipc/metrics_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <memory>
#include <string>
#include <thread>

#include "ipc/listen_socket.h"
#include "tests/support/eventually.h"

namespace haptic::ipc {
namespace {

using std::chrono::milliseconds;

class Scraper {
 public:
  explicit Scraper(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }

  void send(const std::string& bytes) const {
    ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  /// All that comes until the other side ends the connection.
  std::string read() const {
    std::string all;
    char chunk[1000];
    for (ssize_t size = 0; (size = ::recv(socket_.get(), chunk, sizeof(chunk), 0)) > 0;) {
      all.append(chunk, static_cast<std::size_t>(size));
    }
    return all;
  }

  bool connected() const noexcept { return connected_; }

 private:
  Descriptor socket_{::socket(AF_INET, SOCK_STREAM, 0)};
  bool connected_ = false;
};

class Metrics : public testing::Test {
 protected:
  void TearDown() override {
    boost::asio::post(io_, [this] { server_->stop(); });
    thread_.join();
  }

  void serve(MetricsSettings settings = {}, const std::string& page = "hapticd_armed 1\n") {
    server_ = std::make_unique<MetricsServer>(io_, settings, [page] { return page; });
    const std::string& address = server_->addresses().front();  // http://127.0.0.1:PORT/metrics
    port_ = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
    server_->start();
    thread_ = std::thread([this] { io_.run(); });
  }

  std::string ask(const std::string& request) const {
    const Scraper scraper(port_);
    scraper.send(request);
    return scraper.read();
  }

  boost::asio::io_context io_;
  std::unique_ptr<MetricsServer> server_;
  std::thread thread_;
  std::uint16_t port_ = 0;
};

std::string first_line(const std::string& text) { return text.substr(0, text.find("\r\n")); }

TEST_F(Metrics, AreTheAnswerToGet) {
  serve();
  const std::string answer = ask("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(first_line(answer), "HTTP/1.1 200 OK");
  EXPECT_NE(answer.find("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"), std::string::npos);
  EXPECT_TRUE(answer.ends_with("\r\n\r\nhapticd_armed 1\n")) << answer;
  EXPECT_EQ(ask("GET /metrics?x=1 HTTP/1.0\r\n\r\n").substr(9, 3), "200");
}

TEST_F(Metrics, AreOnTheLoopbackInterfaceAlone) {
  serve();
  for (const std::string& address : server_->addresses()) {
    EXPECT_TRUE(address.starts_with("http://127.0.0.1:") || address.starts_with("http://[::1]:")) << address;
  }
}

TEST_F(Metrics, NothingElseIsServed) {
  serve();
  EXPECT_EQ(first_line(ask("GET / HTTP/1.1\r\n\r\n")), "HTTP/1.1 404 Not Found");
  EXPECT_EQ(first_line(ask("GET /metrics/../etc/passwd HTTP/1.1\r\n\r\n")), "HTTP/1.1 404 Not Found");
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
    EXPECT_EQ(first_line(ask(std::string(method) + " /metrics HTTP/1.1\r\n\r\n")),
              "HTTP/1.1 405 Method Not Allowed")
        << method;
  }
}

TEST_F(Metrics, GarbageIsRefusedAndTheNextOneIsServed) {
  serve();
  EXPECT_EQ(first_line(ask(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 15))),
            "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(first_line(ask("GET /metrics HTTP/1.1\r\nX: " + std::string(20000, 'x') + "\r\n\r\n")),
            "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(first_line(ask("GET /metrics HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n")),
            "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(first_line(ask("GET /metrics HTTP/1.1\r\n\r\n")), "HTTP/1.1 200 OK");
}

TEST_F(Metrics, WhoSendsTooSlowlyIsCutOff) {
  serve({.patience = milliseconds(100)});
  const Scraper slow(port_);
  slow.send("GET /met");
  EXPECT_EQ(slow.read(), "");
}

TEST_F(Metrics, WhoDoesNotReadTheAnswerIsCutOff) {
  // more than the sockets hold between them
  serve({.connections = 1, .patience = milliseconds(100)}, std::string(std::size_t{64} << 20U, '#'));
  const Scraper lazy(port_);
  lazy.send("GET /metrics HTTP/1.1\r\n\r\n");
  // the only place is free again
  EXPECT_TRUE(test::eventually(
      [&] { return first_line(ask("GET / HTTP/1.1\r\n\r\n")) == "HTTP/1.1 404 Not Found"; }));
}

TEST_F(Metrics, OnlyAFewAreServedAtOnce) {
  serve({.connections = 2, .patience = milliseconds(60000)});
  const Scraper first(port_);
  const Scraper second(port_);
  first.send("GET ");
  second.send("GET ");
  const Scraper third(port_);
  EXPECT_EQ(third.read(), "");
  first.send("/metrics HTTP/1.1\r\n\r\n");
  EXPECT_EQ(first_line(first.read()), "HTTP/1.1 200 OK");
}

TEST_F(Metrics, APortThatIsTakenIsToldByTheFieldOfTheConfig) {
  serve();
  try {
    const MetricsServer second(io_, {.port = port_}, [] { return std::string(); });
    FAIL() << "it listens";
  } catch (const ListenError& error) {
    EXPECT_EQ(std::string(error.what()).find("metrics.port: cannot listen on http://127.0.0.1:"), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace haptic::ipc
