#include "tests/fuzz/schema_mutator.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "proto/framing.h"
#include "proto/protocol.h"

namespace haptic::fuzz {
namespace {

using namespace google::protobuf;

constexpr std::size_t kLargest = 100'000;  // bytes, beyond which nothing is added

std::size_t below(std::size_t end, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

template <class Array>
auto pick(const Array& values, Random& random) {
  return values[below(std::size(values), random)];
}

double any_double(Random& random) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr std::array kSpecial = {
      0.0, -0.0,  1.0,       -1.0,       1e-3,
      0.1, 1e-12, 1e-300,    1e300,      1e15,
      0.5, 1e-16, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()};
  return below(2, random) == 0 ? pick(kSpecial, random)
                               : std::uniform_real_distribution<double>(-2.0, 2.0)(random);
}

std::uint64_t any_integer(Random& random) {
  static constexpr std::array<std::uint64_t, 12> kSpecial = {
      0, 1, 2, 3, 7, 64, 1000, 65536, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, ~std::uint64_t{0}};
  return pick(kSpecial, random);
}

// the names that the message already has are the most telling ones
void collect(const Message& message, std::vector<const Message*>& nodes, std::vector<std::string>& strings) {
  nodes.push_back(&message);
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        collect(field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                     : reflection.GetMessage(message, field),
                nodes, strings);
      } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
        strings.push_back(field->is_repeated() ? reflection.GetRepeatedString(message, field, i)
                                               : reflection.GetString(message, field));
      }
    }
  }
}

// sets the field, or adds an item to it
class Writer {
 public:
  Writer(Message& message, const FieldDescriptor& field) : message_(message), field_(field) {}

  void write(const std::vector<std::string>& strings, Random& random) {
    const Reflection& to = *message_.GetReflection();
    switch (field_.cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        field_.is_repeated() ? to.AddMessage(&message_, &field_) : to.MutableMessage(&message_, &field_);
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        put(&Reflection::SetString, &Reflection::AddString, any_string(strings, random));
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        put(&Reflection::SetDouble, &Reflection::AddDouble, any_double(random));
        break;
      case FieldDescriptor::CPPTYPE_FLOAT:
        put(&Reflection::SetFloat, &Reflection::AddFloat, static_cast<float>(any_double(random)));
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        put(&Reflection::SetBool, &Reflection::AddBool, below(2, random) == 1);
        break;
      case FieldDescriptor::CPPTYPE_ENUM:
        put(&Reflection::SetEnumValue, &Reflection::AddEnumValue, any_enum(random));
        break;
      case FieldDescriptor::CPPTYPE_INT32:
        put(&Reflection::SetInt32, &Reflection::AddInt32, static_cast<std::int32_t>(any_integer(random)));
        break;
      case FieldDescriptor::CPPTYPE_INT64:
        put(&Reflection::SetInt64, &Reflection::AddInt64, static_cast<std::int64_t>(any_integer(random)));
        break;
      case FieldDescriptor::CPPTYPE_UINT32:
        put(&Reflection::SetUInt32, &Reflection::AddUInt32, static_cast<std::uint32_t>(any_integer(random)));
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        put(&Reflection::SetUInt64, &Reflection::AddUInt64, any_integer(random));
        break;
    }
  }

 private:
  template <class Set, class Add, class Value>
  void put(Set set, Add add, Value value) {
    const Reflection& to = *message_.GetReflection();
    if (field_.is_repeated()) {
      (to.*add)(&message_, &field_, value);
    } else {
      (to.*set)(&message_, &field_, value);
    }
  }

  static std::string any_string(const std::vector<std::string>& strings, Random& random) {
    if (!strings.empty() && below(4, random) != 0) {
      return pick(strings, random);
    }
    static const std::array<std::string, 6> kSpecial = {
        "", "a", "../../etc/passwd", std::string(300, 'x'), "\xf0\x9f\x91\x8b", std::string("\0", 1)};
    return pick(kSpecial, random);
  }

  int any_enum(Random& random) const {
    const EnumDescriptor& type = *field_.enum_type();
    const std::size_t i = below(static_cast<std::size_t>(type.value_count()) + 1, random);
    return i == static_cast<std::size_t>(type.value_count()) ? 77 : type.value(static_cast<int>(i))->number();
  }

  Message& message_;
  const FieldDescriptor& field_;
};

// for text that is no message: most is none
class Silence final : public io::ErrorCollector {
 public:
  void AddError(int /*line*/, int /*column*/, const std::string& /*message*/) override {}
};

// among the items of a repeated field, of which there is at least one
void rearrange(Message& message, const FieldDescriptor& field, Random& random) {
  const Reflection& reflection = *message.GetReflection();
  const int last = reflection.FieldSize(message, &field) - 1;
  const int i = static_cast<int>(below(static_cast<std::size_t>(last) + 1, random));
  if (below(2, random) == 0) {
    reflection.SwapElements(&message, &field, i, last);
    reflection.RemoveLast(&message, &field);
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    const auto copy = std::unique_ptr<Message>(reflection.GetRepeatedMessage(message, &field, i).New());
    copy->CopyFrom(reflection.GetRepeatedMessage(message, &field, i));
    reflection.AddMessage(&message, &field)->CopyFrom(*copy);
  } else {
    reflection.SwapElements(&message, &field, i, last);
  }
}

}  // namespace

void mutate(Message& message, Random& random) {
  std::vector<const Message*> nodes;
  std::vector<std::string> strings;
  collect(message, nodes, strings);
  // they are parts of the message, which is ours to change
  Message& node = *const_cast<Message*>(pick(nodes, random));
  const Descriptor& type = *node.GetDescriptor();
  if (type.field_count() == 0) {
    return;
  }
  const FieldDescriptor& field =
      *type.field(static_cast<int>(below(static_cast<std::size_t>(type.field_count()), random)));
  const Reflection& reflection = *node.GetReflection();
  const std::size_t deed = below(8, random);
  if (deed == 0 || message.ByteSizeLong() > kLargest) {
    reflection.ClearField(&node, &field);
  } else if (deed < 4 && field.is_repeated() && reflection.FieldSize(node, &field) > 0) {
    rearrange(node, field, random);
  } else {
    Writer(node, field).write(strings, random);
  }
}

std::size_t mutate_text(Message& scratch, std::uint8_t* data, std::size_t size, std::size_t max_size,
                        Random& random) {
  TextFormat::Parser parser;
  Silence silence;
  parser.RecordErrorsTo(&silence);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (!parser.ParseFromString(text, &scratch)) {
    return 0;
  }
  for (std::size_t i = below(3, random) + 1; i > 0; --i) {
    mutate(scratch, random);
  }
  if (!TextFormat::PrintToString(scratch, &text) || text.size() > max_size) {
    return 0;
  }
  std::copy(text.begin(), text.end(), data);
  return text.size();
}

std::size_t mutate_conversation(std::uint8_t* data, std::size_t size, std::size_t max_size, Random& random) {
  std::vector<v1::Envelope> envelopes;
  try {
    proto::FrameReader reader(proto::kRequestLimit);
    reader.append(
        std::string_view(reinterpret_cast<const char*>(data), size).substr(std::min<std::size_t>(1, size)));
    while (const auto message = reader.next()) {
      envelopes.emplace_back().ParseFromArray(message->data(), static_cast<int>(message->size()));
    }
  } catch (const proto::FramingError&) {
    return 0;
  }
  const std::size_t deed = below(6, random);
  if (envelopes.empty() || deed == 0) {
    envelopes.emplace_back().mutable_request();
  } else if (deed == 1) {
    envelopes.push_back(pick(envelopes, random));
  } else if (deed == 2) {
    std::swap(envelopes[below(envelopes.size(), random)], envelopes.back());
    envelopes.pop_back();
  }
  for (std::size_t i = below(3, random) + 1; i > 0 && !envelopes.empty(); --i) {
    mutate(envelopes[below(envelopes.size(), random)], random);
  }
  std::string bytes(1, size > 0 ? static_cast<char>(data[0]) : '\0');
  for (const v1::Envelope& envelope : envelopes) {
    proto::append_frame(envelope, bytes);
  }
  if (bytes.size() > max_size) {
    return 0;
  }
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

}  // namespace haptic::fuzz
