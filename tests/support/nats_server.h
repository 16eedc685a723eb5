#pragma once
// A nats-server of a test's own on the loopback interface, and a subscriber that keeps what it says.

#include <nats/nats.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace haptic::test {

class NatsServer {
 public:
  /// Starts it at a free port, which it keeps when it is started again.
  explicit NatsServer(std::vector<std::string> options = {}) : options_(std::move(options)) { start(); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;
  ~NatsServer() { kill(); }

  void start() {
    std::vector<std::string> words = {
        "nats-server",    "-a", "127.0.0.1",        "-p", port_.empty() ? "-1" : port_, "--ports_file_dir",
        folder_.file(""), "-l", folder_.file("log")};
    words.insert(words.end(), options_.begin(), options_.end());
    std::vector<char*> arguments;
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
      ::execvp("nats-server", arguments.data());
      ::_exit(127);
    }
    // it writes the file when it listens
    const std::string ports = "nats-server_" + std::to_string(process_) + ".ports";
    for (int i = 0; i < 1000; ++i) {
      const std::string text = folder_.read(ports);
      const std::size_t host = text.find("127.0.0.1:");
      const std::size_t end = text.find('"', host);
      if (host != std::string::npos && end != std::string::npos) {
        port_ = text.substr(host + 10, end - host - 10);
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("nats-server does not start: " + folder_.read("log"));
  }

  void kill() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
      process_ = -1;
    }
  }
  void stall() const { ::kill(process_, SIGSTOP); }
  void go_on() const { ::kill(process_, SIGCONT); }

  pid_t process() const noexcept { return process_; }
  std::string address() const { return "127.0.0.1:" + port_; }
  std::string url() const { return "nats://" + address(); }

 private:
  TemporaryFolder folder_;
  std::vector<std::string> options_;
  std::string port_;
  pid_t process_ = -1;
};

struct NatsMessage {
  std::string subject;
  std::string payload;
};

class NatsListener {
 public:
  explicit NatsListener(const std::string& url, const std::string& subject = "haptic.>") {
    if (natsConnection_ConnectTo(&connection_, url.c_str()) != NATS_OK ||
        natsConnection_SubscribeSync(&subscription_, connection_, subject.c_str()) != NATS_OK ||
        natsConnection_FlushTimeout(connection_, 5000) != NATS_OK) {
      throw std::runtime_error("no connection to " + url);
    }
  }
  NatsListener(const NatsListener&) = delete;
  NatsListener& operator=(const NatsListener&) = delete;
  ~NatsListener() {
    natsSubscription_Destroy(subscription_);
    natsConnection_Destroy(connection_);
  }

  /// The next message on the subject, or nothing in time; those on others are passed over.
  std::optional<NatsMessage> next(const std::string& subject,
                                  std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (true) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      natsMsg* message = nullptr;
      if (left.count() <= 0 || natsSubscription_NextMsg(&message, subscription_, left.count()) != NATS_OK) {
        return std::nullopt;
      }
      NatsMessage out{
          .subject = natsMsg_GetSubject(message),
          .payload = {natsMsg_GetData(message), static_cast<std::size_t>(natsMsg_GetDataLength(message))}};
      natsMsg_Destroy(message);
      if (out.subject == subject) {
        return out;
      }
    }
  }

  /// The next message on the subject as this type. Throws if there is none, or it cannot be read.
  template <class Message>
  Message next_as(const std::string& subject, std::chrono::milliseconds timeout = std::chrono::seconds(10)) {
    const std::optional<NatsMessage> got = next(subject, timeout);
    Message message;
    if (!got || !message.ParseFromString(got->payload)) {
      throw std::runtime_error("no message on " + subject);
    }
    return message;
  }

  /// Asks, and returns the answer's payload; empty if there was none.
  std::string ask(const std::string& subject) {
    natsMsg* reply = nullptr;
    if (natsConnection_RequestString(&reply, connection_, subject.c_str(), "", 5000) != NATS_OK) {
      return {};
    }
    std::string payload(natsMsg_GetData(reply), static_cast<std::size_t>(natsMsg_GetDataLength(reply)));
    natsMsg_Destroy(reply);
    return payload;
  }

 private:
  natsConnection* connection_ = nullptr;
  natsSubscription* subscription_ = nullptr;
};

}  // namespace haptic::test
