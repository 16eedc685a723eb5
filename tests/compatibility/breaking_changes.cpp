#include "tests/compatibility/breaking_changes.h"

namespace haptic::test {
namespace {

using namespace google::protobuf;

using Lines = std::vector<std::string>;

// all that readers of the wire, of text format and of JSON depend on, beside name and number
std::string shape_of(const FieldDescriptor& field) {
  std::string shape = field.is_repeated() ? "repeated " : field.has_optional_keyword() ? "optional " : "";
  shape += field.message_type() != nullptr ? field.message_type()->full_name()
           : field.enum_type() != nullptr  ? field.enum_type()->full_name()
                                           : field.type_name();
  const OneofDescriptor* const oneof = field.real_containing_oneof();
  return shape + (oneof != nullptr ? " in " + oneof->name() : "") + (field.is_packed() ? " packed" : "");
}

void compare(const EnumDescriptor& before, const DescriptorPool& pool, Lines& lines) {
  const EnumDescriptor* const after = pool.FindEnumTypeByName(before.full_name());
  if (after == nullptr) {
    lines.push_back("enum " + before.full_name() + " is gone");
    return;
  }
  for (int i = 0; i < before.value_count(); ++i) {
    const EnumValueDescriptor& value = *before.value(i);
    const EnumValueDescriptor* const now = after->FindValueByName(value.name());
    if (now == nullptr) {
      lines.push_back("value " + value.full_name() + " is gone");
    } else if (now->number() != value.number()) {
      lines.push_back("value " + value.full_name() + " was " + std::to_string(value.number()) + ", is " +
                      std::to_string(now->number()));
    }
  }
}

void compare(const FieldDescriptor& before, const Descriptor& message, Lines& lines) {
  const FieldDescriptor* const after = message.FindFieldByNumber(before.number());
  if (after == nullptr) {
    lines.push_back("field " + before.full_name() + " = " + std::to_string(before.number()) + " is gone");
    return;
  }
  if (after->name() != before.name() || after->json_name() != before.json_name()) {
    lines.push_back("field " + before.full_name() + " is now called " + after->name());
  }
  if (shape_of(*after) != shape_of(before)) {
    lines.push_back("field " + before.full_name() + " was " + shape_of(before) + ", is " + shape_of(*after));
  }
}

void compare(const Descriptor& before, const DescriptorPool& pool, Lines& lines) {
  const Descriptor* const after = pool.FindMessageTypeByName(before.full_name());
  if (after == nullptr) {
    lines.push_back("message " + before.full_name() + " is gone");
    return;
  }
  for (int i = 0; i < before.field_count(); ++i) {
    compare(*before.field(i), *after, lines);
  }
  for (int i = 0; i < before.nested_type_count(); ++i) {
    compare(*before.nested_type(i), pool, lines);
  }
  for (int i = 0; i < before.enum_type_count(); ++i) {
    compare(*before.enum_type(i), pool, lines);
  }
}

}  // namespace

Lines breaking_changes(const FileDescriptor& before, const DescriptorPool& after) {
  Lines lines;
  for (int i = 0; i < before.message_type_count(); ++i) {
    compare(*before.message_type(i), after, lines);
  }
  for (int i = 0; i < before.enum_type_count(); ++i) {
    compare(*before.enum_type(i), after, lines);
  }
  return lines;
}

}  // namespace haptic::test
