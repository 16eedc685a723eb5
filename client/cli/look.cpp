#include "client/cli/look.h"

#include <algorithm>
#include <utility>

#include "client/cli/command.h"
#include "client/lib/error.h"

namespace haptic::cli {

Names ask_names(client::Connection& daemon) {
  const v1::Response scene = call(daemon, [](v1::Request& request) { request.mutable_get_scene(); });
  const v1::Response devices = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
  return names_of(scene.scene(), devices.devices());
}

Lookout::Lookout(client::Connection& daemon, v1::Topic topic)
    : daemon_(daemon), subscription_(daemon.subscribe({topic}, 1)), names_(ask_names(daemon)) {}

Lookout::~Lookout() {
  try {
    daemon_.unsubscribe(subscription_);
  } catch (const client::Error&) {
    // the daemon is gone, and the subscription with it
  }
}

std::optional<Look> Lookout::next(std::chrono::milliseconds patience) {
  const client::Clock::time_point deadline = client::Clock::now() + patience;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - client::Clock::now());
    auto message = daemon_.receive(std::max(left, std::chrono::milliseconds(0)));
    if (!message) {
      return std::nullopt;
    }
    if (!message->has_frame() || message->frame().subscription() != subscription_) {
      continue;
    }
    if (message->frame().scene_revision() > names_.scene_revision) {
      names_ = ask_names(daemon_);
    }
    // a frame from before an edit has other indices
    if (message->frame().scene_revision() == names_.scene_revision) {
      return Look{names_, std::move(*message->mutable_frame())};
    }
  }
}

Look look_once(client::Connection& daemon, v1::Topic topic) {
  Lookout lookout(daemon, topic);
  if (std::optional<Look> look = lookout.next(std::chrono::seconds(2))) {
    return std::move(*look);
  }
  throw client::Unreachable("the daemon sends no frames; hapticctl status tells whether it ticks");
}

google::protobuf::Value json(const std::string& text) {
  google::protobuf::Value value;
  value.set_string_value(text);
  return value;
}

google::protobuf::Value json(double number) {
  google::protobuf::Value value;
  value.set_number_value(number);
  return value;
}

google::protobuf::Value json_item(const google::protobuf::RepeatedField<double>& values, int size, int i) {
  google::protobuf::Value value;
  for (int k = size * i; k < size * (i + 1) && k < values.size(); ++k) {
    value.mutable_list_value()->add_values()->set_number_value(values[k]);
  }
  return value;
}

}  // namespace haptic::cli
