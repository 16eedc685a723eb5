#pragma once
// What a later schema must not do to an earlier one: the rules at the head of proto/haptic/v1/control.proto,
// as far as a program can check them.

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

namespace haptic::test {

/// One line for each thing of `before` that is not in `after` as it was: messages, fields (by number: name,
/// type, label, oneof), enums and their values. What `after` has beside that does not matter.
std::vector<std::string> breaking_changes(const google::protobuf::FileDescriptor& before,
                                          const google::protobuf::DescriptorPool& after);

}  // namespace haptic::test
