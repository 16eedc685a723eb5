#include "client/cli/look.h"

#include "client/cli/command.h"
#include "client/lib/error.h"

namespace haptic::cli {

Names ask_names(client::Connection& daemon) {
  const v1::Response scene = call(daemon, [](v1::Request& request) { request.mutable_get_scene(); });
  const v1::Response devices = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
  return names_of(scene.scene(), devices.devices());
}

Look look_once(client::Connection& daemon, v1::Topic topic) {
  daemon.subscribe({topic}, 1);
  Look look;
  look.names = ask_names(daemon);
  while (const auto message = daemon.receive(std::chrono::seconds(2))) {
    if (!message->has_frame()) {
      continue;
    }
    if (message->frame().scene_revision() == look.names.scene_revision) {
      look.frame = message->frame();
      return look;
    }
    if (message->frame().scene_revision() > look.names.scene_revision) {
      look.names = ask_names(daemon);
    }
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
