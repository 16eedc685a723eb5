#pragma once
// Fields of a message that somebody names by a dotted path: "dynamic.linear_viscosity".

#include <string>

namespace google::protobuf {
class Message;
}

namespace haptic::load {

/// Takes the field at `path` of `from` over into `to`, a message of the same type; a list is taken as a
/// whole, and a field that `from` does not have is cleared. Throws LoadError at `place`, naming the fields
/// that there are, if the path leads nowhere.
void take_field(const std::string& place, const std::string& path, const google::protobuf::Message& from,
                google::protobuf::Message& to);

}  // namespace haptic::load
