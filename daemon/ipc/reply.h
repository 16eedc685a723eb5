#pragma once
// The way back to the client that asked. May be kept until the answer is known; if the client is gone by
// then, nothing happens. io thread.

#include <functional>
#include <string>
#include <utility>

#include "haptic/v1/control.pb.h"
#include "ipc/convert.h"

namespace haptic::ipc {

class Reply {
 public:
  /// `send` takes the response, to which the id is added.
  Reply(std::uint64_t request, std::function<void(v1::Response&&)> send)
      : request_(request), send_(std::move(send)) {}

  void send(v1::Response response) const {
    response.set_id(request_);
    send_(std::move(response));
  }

  void done() const {
    v1::Response response;
    response.mutable_done();
    send(std::move(response));
  }

  void fail(v1::Error error) const {
    v1::Response response;
    *response.mutable_error() = std::move(error);
    send(std::move(response));
  }

  void fail(v1::Error::Code code, const std::string& message) const { fail(make_error(code, message)); }

 private:
  std::uint64_t request_;
  std::function<void(v1::Response&&)> send_;
};

}  // namespace haptic::ipc
