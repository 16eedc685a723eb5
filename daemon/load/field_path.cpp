#include "load/field_path.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <memory>

#include "load/error.h"
#include "load/read_file.h"

namespace haptic::load {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const FieldDescriptor& find(const std::string& place, const Descriptor& type, const std::string& name) {
  const FieldDescriptor* const field = type.FindFieldByName(name);
  if (field != nullptr) return *field;
  std::string known;
  for (int i = 0; i < type.field_count(); ++i) known += (i == 0 ? "" : ", ") + type.field(i)->name();
  throw LoadError({"", 0, 0, place},
                  in_quotes(name) + " is no field of " + type.name() + " (permitted: " + known + ")");
}

void take_whole(const FieldDescriptor& field, const Message& from, Message& to) {
  const bool is_there =
      field.is_repeated() || !field.has_presence() || from.GetReflection()->HasField(from, &field);
  if (!is_there) {
    to.GetReflection()->ClearField(&to, &field);
    return;
  }
  const std::unique_ptr<Message> copy(from.New());
  copy->CopyFrom(from);
  to.GetReflection()->SwapFields(&to, copy.get(), {&field});
}

void take(const std::string& place, const std::string& path, std::size_t begin, const Message& from,
          Message& to) {
  const std::size_t end = std::min(path.find('.', begin), path.size());
  const FieldDescriptor& field = find(place, *to.GetDescriptor(), path.substr(begin, end - begin));
  if (end == path.size()) {
    take_whole(field, from, to);
    return;
  }
  if (field.is_repeated() || field.message_type() == nullptr) {
    throw LoadError({"", 0, 0, place}, in_quotes(path.substr(0, end)) + " has no fields of its own" +
                                           (field.is_repeated() ? ": it is set as a whole" : ""));
  }
  // what neither has stays away, but the rest of the path is looked at all the same
  const bool is_nowhere =
      !from.GetReflection()->HasField(from, &field) && !to.GetReflection()->HasField(to, &field);
  const std::unique_ptr<Message> scratch(to.New());
  Message& target = is_nowhere ? *scratch : to;
  take(place, path, end + 1, from.GetReflection()->GetMessage(from, &field),
       *target.GetReflection()->MutableMessage(&target, &field));
}

}  // namespace

void take_field(const std::string& place, const std::string& path, const Message& from, Message& to) {
  take(place, path, 0, from, to);
}

}  // namespace haptic::load
