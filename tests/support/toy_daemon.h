#pragma once
// A daemon for a client's tests, by plain sockets: one object "box" of "wood" at (0, 0.05, 0) that never
// moves, a tick each millisecond, and answers of a few words.

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "haptic/v1/control.pb.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "tests/support/temporary_folder.h"

namespace haptic::test {

class ToyDaemon {
 public:
  ToyDaemon() {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    address().copy(name.sun_path, sizeof(name.sun_path) - 1);
    socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof(name));
    ::listen(socket_, 4);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }
  ToyDaemon(const ToyDaemon&) = delete;
  ToyDaemon& operator=(const ToyDaemon&) = delete;
  ~ToyDaemon() {
    thread_.request_stop();
    thread_.join();
    ::close(socket_);
  }

  std::string address() const { return folder_.file("s"); }
  int connections() const noexcept { return connections_; }
  int leases() const noexcept { return leases_; }
  int releases() const noexcept { return releases_; }
  int heartbeats() const noexcept { return heartbeats_; }

  /// For the clients to come: how the drive lease is refused.
  void refuse_lease(v1::Error::Code code) { lease_refusal_ = code; }

 private:
  // one client after the other
  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      pollfd waiting{socket_, POLLIN, 0};
      if (::poll(&waiting, 1, 10) > 0) {
        const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        ++connections_;
        talk(client, stop);
        ::close(client);
      }
    }
  }

  void talk(int client, const std::stop_token& stop) {
    proto::FrameReader reader(proto::kReplyLimit);
    subscription_ = 0;
    while (!stop.stop_requested()) {
      pollfd readable{client, POLLIN, 0};
      if (::poll(&readable, 1, 1) > 0) {
        char chunk[4096];
        const ssize_t size = ::recv(client, chunk, sizeof(chunk), 0);
        if (size <= 0) {
          return;
        }
        reader.append(std::string_view(chunk, static_cast<std::size_t>(size)));
      }
      while (const auto message = reader.next()) {
        v1::Envelope envelope;
        envelope.ParseFromArray(message->data(), static_cast<int>(message->size()));
        send(client, answer(envelope));
      }
      ++tick_;
      if (subscription_ != 0) {
        send(client, frame());
      }
    }
  }

  static void send(int client, const v1::Envelope& envelope) {
    std::string bytes;
    proto::append_frame(envelope, bytes);
    ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  v1::Envelope answer(const v1::Envelope& asked) {
    v1::Envelope envelope;
    if (asked.has_hello()) {
      envelope.mutable_hello()->set_major(proto::kProtocolMajor);
      return envelope;
    }
    v1::Response& response = *envelope.mutable_response();
    const v1::Request& request = asked.request();
    response.set_id(request.id());
    switch (request.call_case()) {
      case v1::Request::kGetScene:
        describe(*response.mutable_scene());
        break;
      case v1::Request::kListDevices:
        response.mutable_devices();
        break;
      case v1::Request::kSubscribe:
        response.mutable_subscribed()->set_subscription(subscription_ = 1);
        break;
      case v1::Request::kUnsubscribe:
        subscription_ = 0;
        response.mutable_done();
        break;
      case v1::Request::kEditScene:
        edit(request.edit_scene().edit(0), response);
        break;
      case v1::Request::kArm:
        if (armed_) {
          fail(response, v1::Error::NOTHING_TO_DO, "", "it is armed already");
          break;
        }
        armed_ = true;
        response.mutable_done();
        break;
      case v1::Request::kAcquireDrive:
        acquire(response);
        break;
      case v1::Request::kReleaseDrive:
        ++releases_;
        response.mutable_done();
        break;
      case v1::Request::kHeartbeat:
        ++heartbeats_;
        response.mutable_done();
        break;
      default:
        response.mutable_done();
    }
    return envelope;
  }

  void acquire(v1::Response& response) {
    if (lease_refusal_) {
      fail(response, *lease_refusal_, "", "no lease for you");
    } else {
      ++leases_;
      response.mutable_drive_lease()->set_heartbeat_ms(100);
    }
  }

  void edit(const v1::SceneEdit& edit, v1::Response& response) {
    if (edit.remove_object() == "nobody") {
      fail(response, v1::Error::NOT_FOUND, "remove_object", "there is no object \"nobody\"");
    } else if (edit.has_set_gravity() && edit.set_gravity().y() < -1000.0) {
      fail(response, v1::Error::INVALID, "edit[0].set_gravity.y", "-2000 is out of range");
    } else {
      ++revision_;
      describe(*response.mutable_scene());
    }
  }

  static void fail(v1::Response& response, v1::Error::Code code, const std::string& field,
                   const std::string& message) {
    response.mutable_error()->set_code(code);
    response.mutable_error()->set_field(field);
    response.mutable_error()->set_message(message);
  }

  void describe(v1::SceneDescription& scene) const {
    scene.set_revision(revision_);
    scene.add_object()->set_name("box");
    scene.mutable_scene()->add_object()->set_name("box");
    scene.mutable_scene()->add_material()->set_name("wood");
  }

  v1::Envelope frame() {
    v1::Envelope envelope;
    v1::Frame& frame = *envelope.mutable_frame();
    frame.set_sequence(tick_);
    frame.set_subscription(subscription_);
    frame.set_tick(tick_);
    frame.set_scene_revision(revision_);
    for (const double number : {0.0, 0.05, 0.0}) {
      frame.mutable_objects()->add_position(number);
    }
    for (const double number : {1.0, 0.0, 0.0, 0.0}) {
      frame.mutable_objects()->add_orientation(number);
    }
    return envelope;
  }

  TemporaryFolder folder_;
  int socket_ = -1;
  std::atomic<int> connections_ = 0;
  std::atomic<int> leases_ = 0;
  std::atomic<int> releases_ = 0;
  std::atomic<int> heartbeats_ = 0;
  std::optional<v1::Error::Code> lease_refusal_;  // set while no client is there
  std::uint32_t subscription_ = 0;
  std::uint64_t tick_ = 0;
  std::uint64_t revision_ = 1;
  bool armed_ = false;
  std::jthread thread_;
};

}  // namespace haptic::test
