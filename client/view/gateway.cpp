#include "client/view/gateway.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <map>
#include <utility>

#include "client/view/browser_session.h"
#include "client/view/foxglove_feed.h"
#include "client/view/foxglove_session.h"

namespace haptic::gateway {
namespace asio = boost::asio;

namespace {

constexpr std::chrono::milliseconds kGoodbye{2'000};

std::string time_of_start() {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count());
}

}  // namespace

class Gateway::Impl {
 public:
  Impl(Options options, std::function<void(const std::string&)> log)
      : log_(std::move(log)),
        frames_per_second_(options.frames_per_second),
        door_(options.daemon, options.identity),
        feed_(io_, door_, options.frames_per_second, log_),
        server_(io_, std::move(options.web), log_,
                [this](std::shared_ptr<WebSocket> socket, const Admission& admission) {
                  welcome(std::move(socket), admission);
                }),
        stop_timer_(io_) {}

  void run() {
    server_.start();
    io_.run();
  }

  void stop() {
    asio::post(io_, [this] { leave(); });
  }

  void stop_on_signals() {
    signals_.add(SIGTERM);
    signals_.add(SIGINT);
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) {
        leave();
      }
    });
  }

  const std::string& url() const noexcept { return server_.url(); }

 private:
  void welcome(std::shared_ptr<WebSocket> socket, const Admission& admission) {
    std::shared_ptr<Session> session;
    if (admission.language == Language::kHaptic) {
      session = std::make_shared<BrowserSession>(std::move(socket), admission.rights,
                                                 std::make_shared<DaemonLink>(io_, door_), frames_per_second_,
                                                 log_);
    } else {
      session = std::make_shared<FoxgloveSession>(std::move(socket), feed_, run_);
    }
    const std::uint64_t id = ++last_session_;
    sessions_.emplace(id, session);
    session->start([this, id] {
      // the session may be in the middle of its own function
      asio::post(io_, [this, id] {
        sessions_.erase(id);
        if (leaving_ && sessions_.empty()) {
          io_.stop();
        }
      });
    });
  }

  void leave() {
    leaving_ = true;
    signals_.cancel();
    server_.stop();
    if (sessions_.empty()) {
      io_.stop();
      return;
    }
    for (const auto& [id, session] : sessions_) {
      session->leave();
    }
    stop_timer_.expires_after(kGoodbye);
    stop_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) {
        io_.stop();
      }
    });
  }

  Log log_;
  double frames_per_second_;
  std::string run_ = time_of_start();
  asio::io_context io_{1};
  DaemonDoor door_;
  FoxgloveFeed feed_;
  WebServer server_;
  std::map<std::uint64_t, std::shared_ptr<Session>> sessions_;
  std::uint64_t last_session_ = 0;
  asio::steady_timer stop_timer_;
  asio::signal_set signals_{io_};
  bool leaving_ = false;
};

Gateway::Gateway(Options options, std::function<void(const std::string&)> log)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(log))) {}
Gateway::~Gateway() = default;
void Gateway::run() { impl_->run(); }
void Gateway::stop() { impl_->stop(); }
void Gateway::stop_on_signals() { impl_->stop_on_signals(); }
const std::string& Gateway::url() const noexcept { return impl_->url(); }

}  // namespace haptic::gateway
