#include "ipc/message_counts.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <string>
#include <vector>

#include "ipc/convert.h"

namespace haptic::ipc {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// the parser has bounded how deep messages lie in one another
std::optional<v1::Error> check(const Message& message, std::size_t items, const std::string& path) {
  std::vector<const FieldDescriptor*> fields;
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const std::string name = path.empty() ? field->name() : path + "." + field->name();
    const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (!field->is_repeated()) {
      std::optional<v1::Error> error;
      if (is_message) {
        error = check(reflection.GetMessage(message, field), items, name);
      }
      if (error) {
        return error;
      }
      continue;
    }
    const int size = reflection.FieldSize(message, field);
    if (static_cast<std::size_t>(size) > items) {
      v1::Error error = make_error(v1::Error::INVALID, name + " has " + std::to_string(size) + " items; " +
                                                           std::to_string(items) + " are permitted");
      error.set_field(name);
      return error;
    }
    for (int i = 0; is_message && i < size; ++i) {
      auto error = check(reflection.GetRepeatedMessage(message, field, i), items,
                         name + "[" + std::to_string(i) + "]");
      if (error) {
        return error;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<v1::Error> check_counts(const Message& message, std::size_t items) {
  return check(message, items, "");
}

}  // namespace haptic::ipc
