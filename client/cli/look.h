#pragma once
// One frame, with the names for what is in it.

#include <google/protobuf/struct.pb.h>

#include <chrono>
#include <optional>

#include "client/cli/tables.h"
#include "client/lib/connection.h"

namespace haptic::cli {

struct Look {
  Names names;
  v1::Frame frame;
};

/// Asks the daemon what the scene and the devices are called.
Names ask_names(client::Connection& daemon);

/// A subscription to every tick of one topic that ends with this object. Its frames come with the names of
/// their own scene.
class Lookout {
 public:
  Lookout(client::Connection& daemon, v1::Topic topic);
  ~Lookout();
  Lookout(const Lookout&) = delete;
  Lookout& operator=(const Lookout&) = delete;

  /// Nothing if no frame came in time, or a signal did. Throws client::Error.
  std::optional<Look> next(std::chrono::milliseconds patience);

 private:
  client::Connection& daemon_;
  std::uint32_t subscription_;
  Names names_;
};

/// Names and the next frame of the topic, of the same scene. Throws client::Error.
Look look_once(client::Connection& daemon, v1::Topic topic);

/// Values for an object of JSON that is not a message of the schema.
google::protobuf::Value json(const std::string& text);
google::protobuf::Value json(double number);
/// Item i of a packed array whose items have `size` numbers.
google::protobuf::Value json_item(const google::protobuf::RepeatedField<double>& values, int size, int i);

}  // namespace haptic::cli
