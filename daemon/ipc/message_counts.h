#pragma once
// The length of every list in a message, before anybody acts on it: the bytes of a frame bound a message, but
// not how many items they make. Pure.

#include <cstddef>
#include <optional>

#include "haptic/v1/control.pb.h"

namespace haptic::ipc {

/// Of the first list that is longer than `items`, by the field's path; nothing if all are within.
std::optional<v1::Error> check_counts(const google::protobuf::Message& message, std::size_t items);

}  // namespace haptic::ipc
