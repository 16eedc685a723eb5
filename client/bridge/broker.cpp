#include "client/bridge/broker.h"

#include <nats/nats.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "client/bridge/subject.h"
#include "client/lib/backoff.h"

namespace haptic::bridge {
namespace {

constexpr std::size_t kUsualPayloadLimit = std::size_t{1024} * 1024;  // of a server that has not told
constexpr int kReconnectBuffer = 64 * 1024;                           // what libnats may send late; bytes
constexpr std::int64_t kConnectTimeout = 2'000;                       // ms
constexpr std::int64_t kPingInterval = 5'000;                         // ms
constexpr int kPings = 2;  // unanswered, then the server counts as gone

struct Delete {
  void operator()(natsOptions* options) const noexcept { natsOptions_Destroy(options); }
  void operator()(natsConnection* connection) const noexcept { natsConnection_Destroy(connection); }
  void operator()(natsSubscription* subscription) const noexcept { natsSubscription_Destroy(subscription); }
  void operator()(natsMsg* message) const noexcept { natsMsg_Destroy(message); }
};
using OptionsPtr = std::unique_ptr<natsOptions, Delete>;
using ConnectionPtr = std::unique_ptr<natsConnection, Delete>;
using SubscriptionPtr = std::unique_ptr<natsSubscription, Delete>;
using MessagePtr = std::unique_ptr<natsMsg, Delete>;

// the status, and what is known of it beside; without the place in the library's source
std::string words(natsStatus status) {
  std::string text = natsStatus_GetText(status);
  natsStatus last = NATS_OK;
  const char* const known = nats_GetLastError(&last);
  if (last != status || known == nullptr) {
    return text;
  }
  std::string detail = known;
  if (const std::size_t place = detail.find("): "); detail.starts_with('(') && place != std::string::npos) {
    detail.erase(0, place + 3);
  }
  return detail.empty() || detail == text ? text : text + ": " + detail;
}

void require(natsStatus status, const std::string& what) {
  if (status != NATS_OK) {
    throw BrokerError(what + ": " + words(status));
  }
}

// with some chance in it, so that many bridges do not come back to a server all at once
std::int64_t wait_before_attempt(natsConnection* /*connection*/, int attempts, void* /*closure*/) {
  thread_local std::minstd_rand chance{std::random_device{}()};
  const std::int64_t doublings = std::clamp(attempts - 1, 0, 10);
  const std::int64_t wait =
      std::min<std::int64_t>(client::kFirstWait.count() << doublings, client::kLongestWait.count());
  return wait + std::uniform_int_distribution<std::int64_t>(0, wait / 4)(chance);
}

// state() and problem() tell; without this libnats would print errors
void ignore_error(natsConnection* /*connection*/, natsSubscription* /*subscription*/, natsStatus /*status*/,
                  void* /*closure*/) {}

void set_identity(natsOptions* options, const BrokerOptions& wish) {
  const bool wants_tls = !wish.certificate.empty() || !wish.authority.empty() ||
                         std::any_of(wish.urls.begin(), wish.urls.end(),
                                     [](const std::string& url) { return url.starts_with("tls://"); });
  if (wants_tls) {
    require(natsOptions_SetSecure(options, true), "TLS");
  }
  if (!wish.authority.empty()) {
    require(natsOptions_LoadCATrustedCertificates(options, wish.authority.c_str()), wish.authority);
  }
  if (!wish.certificate.empty()) {
    require(natsOptions_LoadCertificatesChain(options, wish.certificate.c_str(), wish.key.c_str()),
            wish.certificate + ", " + wish.key);
  }
  if (!wish.credentials.empty()) {
    require(natsOptions_SetUserCredentialsFromFiles(options, wish.credentials.c_str(), nullptr),
            wish.credentials);
  }
}

OptionsPtr make_options(const BrokerOptions& wish) {
  natsOptions* made = nullptr;
  require(natsOptions_Create(&made), "options of the broker");
  OptionsPtr options(made);
  std::vector<const char*> urls;
  urls.reserve(wish.urls.size());
  for (const std::string& url : wish.urls) {
    urls.push_back(url.c_str());
  }
  const auto deadline = static_cast<std::int64_t>(wish.write_deadline.count());
  const std::initializer_list<natsStatus> set = {
      natsOptions_SetServers(made, urls.data(), static_cast<int>(urls.size())),
      natsOptions_SetName(made, wish.name.c_str()),
      natsOptions_SetTimeout(made, kConnectTimeout),
      natsOptions_SetMaxReconnect(made, -1),
      natsOptions_SetReconnectBufSize(made, kReconnectBuffer),
      natsOptions_SetCustomReconnectDelay(made, wait_before_attempt, nullptr),
      natsOptions_SetErrorHandler(made, ignore_error, nullptr),
      natsOptions_SetPingInterval(made, kPingInterval),
      natsOptions_SetMaxPingsOut(made, kPings),
      natsOptions_SetWriteDeadline(made, deadline),
  };
  for (const natsStatus status : set) {
    require(status, "options of the broker");
  }
  set_identity(made, wish);
  return options;
}

}  // namespace

struct Broker::Impl {
  ConnectionPtr connection;
  std::vector<SubscriptionPtr> questions;  // go before the connection
};

void check(const BrokerOptions& options) { make_options(options); }

Broker::Broker(const BrokerOptions& options, const std::vector<std::string>& questions)
    : impl_(std::make_unique<Impl>()) {
  const OptionsPtr made = make_options(options);
  natsConnection* connection = nullptr;
  const natsStatus status = natsConnection_Connect(&connection, made.get());
  impl_->connection.reset(connection);
  if (status != NATS_OK) {
    std::string urls;
    for (const std::string& url : options.urls) {
      urls += " " + without_secrets(url);
    }
    throw BrokerError("no connection to" + urls + ": " + words(status));
  }
  for (const std::string& subject : questions) {
    natsSubscription* subscription = nullptr;
    require(natsConnection_SubscribeSync(&subscription, connection, subject.c_str()), subject);
    impl_->questions.emplace_back(subscription);
  }
}

Broker::~Broker() = default;

Broker::State Broker::state() const noexcept {
  switch (natsConnection_Status(impl_->connection.get())) {
    case NATS_CONN_STATUS_CONNECTED:
      return State::kConnected;
    case NATS_CONN_STATUS_CLOSED:
      return State::kClosed;
    default:
      return State::kReconnecting;
  }
}

std::uint64_t Broker::connections() const noexcept {
  natsStatistics* statistics = nullptr;
  std::uint64_t reconnects = 0;
  if (natsStatistics_Create(&statistics) == NATS_OK &&
      natsConnection_GetStats(impl_->connection.get(), statistics) == NATS_OK) {
    natsStatistics_GetCounts(statistics, nullptr, nullptr, nullptr, nullptr, &reconnects);
  }
  natsStatistics_Destroy(statistics);
  return reconnects + 1;
}

std::string Broker::server() const {
  char url[512] = "";
  natsConnection_GetConnectedUrl(impl_->connection.get(), url, sizeof(url));
  return without_secrets(url);
}

std::string Broker::problem() const {
  const char* text = nullptr;
  const natsStatus status = natsConnection_GetLastError(impl_->connection.get(), &text);
  if (text != nullptr && *text != '\0') {
    return text;
  }
  return status == NATS_OK ? std::string() : natsStatus_GetText(status);
}

std::size_t Broker::payload_limit() const noexcept {
  const std::int64_t told = natsConnection_GetMaxPayload(impl_->connection.get());
  return told > 0 ? static_cast<std::size_t>(told) : kUsualPayloadLimit;
}

bool Broker::publish(const std::string& subject, const std::string& payload) {
  return payload.size() <= payload_limit() && state() == State::kConnected &&
         natsConnection_Publish(impl_->connection.get(), subject.c_str(), payload.data(),
                                static_cast<int>(payload.size())) == NATS_OK;
}

std::optional<Question> Broker::next_question() {
  for (std::size_t i = 0; i < impl_->questions.size(); ++i) {
    natsSubscription* const subscription = impl_->questions[i].get();
    std::uint64_t waiting = 0;
    natsMsg* message = nullptr;
    while (natsSubscription_QueuedMsgs(subscription, &waiting) == NATS_OK && waiting > 0 &&
           natsSubscription_NextMsg(&message, subscription, 1) == NATS_OK) {
      const MessagePtr owner(message);
      const char* const reply = natsMsg_GetReply(message);
      if (reply != nullptr && *reply != '\0') {
        return Question{.subject = i, .reply = reply};
      }
    }
  }
  return std::nullopt;
}

bool Broker::flush(std::chrono::milliseconds timeout) {
  return natsConnection_FlushTimeout(impl_->connection.get(), timeout.count()) == NATS_OK;
}

void close_broker_library() { nats_CloseAndWait(2'000); }

}  // namespace haptic::bridge
