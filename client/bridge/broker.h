#pragma once
// One connection to a NATS server, or to the first that answers of several. It reconnects by itself for as
// long as it lives, unless the server ends it for good (kClosed): then make another. One thread at a time.
//
// What libnats takes while there is no connection it would send late, and some of what it must not be given
// ends the connection: so publish() sends only what can go out now.

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptic::bridge {

class BrokerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct BrokerOptions {
  std::vector<std::string> urls;  // see url_problem()
  std::string name;               // of this client, as the server's monitoring shows it
  std::string credentials;        // file with a user's JWT and seed; empty: none
  std::string certificate;        // PEM files for TLS; empty: none, and the system's authorities
  std::string key;
  std::string authority;
  std::chrono::milliseconds write_deadline{1'000};  // a server that takes nothing for so long is left
};

/// Throws BrokerError if the options cannot be used, for instance because a certificate cannot be read.
void check(const BrokerOptions& options);

/// A message that wants an answer.
struct Question {
  std::size_t subject = 0;  // which of those that the broker was made with
  std::string reply;        // where the answer goes
};

class Broker {
 public:
  /// Connects, within 2 s for each URL. `questions`: subjects of requests. Throws BrokerError.
  Broker(const BrokerOptions& options, const std::vector<std::string>& questions);
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;
  /// Ends the connection at once; see flush().
  ~Broker();

  enum class State { kReconnecting, kConnected, kClosed };
  State state() const noexcept;

  /// How often it has connected; ascends by one each time.
  std::uint64_t connections() const noexcept;
  /// The server it is connected to, without user and password.
  std::string server() const;
  /// The last that went wrong, for a person.
  std::string problem() const;
  /// The longest payload that the server takes, bytes.
  std::size_t payload_limit() const noexcept;

  /// False if it cannot go out, or not within the write deadline. True is no promise: a connection that ends
  /// takes with it what is on its way.
  bool publish(const std::string& subject, const std::string& payload);

  /// The next request that has come in, without waiting.
  std::optional<Question> next_question();

  /// Waits until the server has taken all that was published. False if it did not in time.
  bool flush(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Frees what the library keeps for the process; every Broker must be gone.
void close_broker_library();

}  // namespace haptic::bridge
