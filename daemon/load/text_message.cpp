#include "load/text_message.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "load/json_places.h"
#include "load/read_file.h"

namespace haptic::load {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using google::protobuf::TextFormat;

/// What a source remembers of its text. Text format: the parser's own record. JSON: the text, which is walked
/// again when a place is asked for.
struct TextSource::Fields {
  const Descriptor* type = nullptr;
  Syntax syntax = Syntax::kText;
  TextFormat::ParseInfoTree tree;
  std::string json;
};

namespace {

class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    if (!error) error = {line, column, message};
  }
  struct Error {
    int line, column;
    std::string message;
  };
  std::optional<Error> error;
};

// the parser counts from 0 and says -1 where it knows nothing
std::uint32_t from_one(int number) { return static_cast<std::uint32_t>(number < 0 ? 0 : number + 1); }

/// One step of a field path: "size" or "object[2]".
struct Step {
  std::string name;
  int index = -1;
};

Step next_step(std::string_view& path) {
  const std::size_t end = std::min(path.find('.'), path.size());
  std::string_view part = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  Step step;
  const std::size_t bracket = part.find('[');
  if (bracket != std::string_view::npos) {
    std::from_chars(part.data() + bracket + 1, part.data() + part.size(), step.index);
    part = part.substr(0, bracket);
  }
  step.name = part;
  return step;
}

Place find_in_tree(const TextFormat::ParseInfoTree& root, const Descriptor& root_type,
                   const std::string& file, const std::string& field_path) {
  Place place{file, 0, 0, field_path};
  const TextFormat::ParseInfoTree* tree = &root;
  const Descriptor* type = &root_type;
  std::string_view path = field_path;
  while (tree != nullptr && type != nullptr && !path.empty()) {
    const Step step = next_step(path);
    const FieldDescriptor* field = type->FindFieldByName(step.name);
    if (field == nullptr || (field->is_repeated() && step.index < 0)) break;
    const TextFormat::ParseLocation location =
        tree->GetLocation(field, field->is_repeated() ? step.index : -1);
    if (location.line >= 0) {
      place.line = from_one(location.line);
      place.column = from_one(location.column);
    }
    type = field->message_type();
    tree = type != nullptr ? tree->GetTreeForNested(field, field->is_repeated() ? step.index : -1) : nullptr;
  }
  return place;
}

// protobuf writes "(object[0].airMargin): what is wrong"
LoadError json_value_error(std::string_view what, std::string_view text, const std::string& file,
                           const Descriptor& type) {
  std::string field;
  if (what.starts_with('(') && what.find(')') != std::string_view::npos) {
    for (const char c : what.substr(1, what.find(')') - 1)) {
      if (c >= 'A' && c <= 'Z') {
        field += '_';
        field += static_cast<char>(c - 'A' + 'a');
      } else {
        field += c;
      }
    }
    what.remove_prefix(what.find(')') + 1);
    what.remove_prefix(std::min(what.find_first_not_of(": "), what.size()));
  }
  const std::string message(what.substr(0, what.find('\n')));
  return {field.empty() ? Place{file, 1, 1, ""} : find_in_json(text, file, type, field), message};
}

bool is_clean_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x20 || lead == 0x7f) return false;
    const std::size_t length = lead < 0x80 ? 1 : (lead >> 5U) == 6 ? 2 : (lead >> 4U) == 14 ? 3 : 4;
    if ((length == 4 && (lead >> 3U) != 30) || i + length > text.size()) return false;
    std::uint32_t code = length == 1 ? lead : lead & (0x7fU >> length);
    for (std::size_t k = 1; k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next >> 6U) != 2) return false;
      code = (code << 6U) | (next & 0x3fU);
    }
    constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < kSmallest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
    i += length;
  }
  return true;
}

class ValueCheck {
 public:
  explicit ValueCheck(const TextSource& source) : source_(source) {}

  void message(const Message& message, const std::string& path) const {
    const Reflection& reflection = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
      const std::string name = path.empty() ? field->name() : path + "." + field->name();
      if (!field->is_repeated()) {
        value(message, reflection, field, -1, name);
        continue;
      }
      const int size = reflection.FieldSize(message, field);
      for (int i = 0; i < size; ++i) {
        value(message, reflection, field, i, item(name, i));
      }
    }
  }

 private:
  void value(const Message& owner, const Reflection& reflection, const FieldDescriptor* field, int index,
             const std::string& name) const {
    const bool repeated = index >= 0;
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        message(repeated ? reflection.GetRepeatedMessage(owner, field, index)
                         : reflection.GetMessage(owner, field),
                name);
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        if (!std::isfinite(repeated ? reflection.GetRepeatedDouble(owner, field, index)
                                    : reflection.GetDouble(owner, field))) {
          source_.fail(name, "is not a finite number");
        }
        break;
      case FieldDescriptor::CPPTYPE_ENUM: {
        const int number = repeated ? reflection.GetRepeatedEnumValue(owner, field, index)
                                    : reflection.GetEnumValue(owner, field);
        if (field->enum_type()->FindValueByNumber(number) == nullptr) {
          source_.fail(name, "the value " + std::to_string(number) + " does not exist");
        }
        break;
      }
      case FieldDescriptor::CPPTYPE_STRING: {
        constexpr std::size_t kLongest = 4096;
        const std::string text =
            repeated ? reflection.GetRepeatedString(owner, field, index) : reflection.GetString(owner, field);
        if (text.size() > kLongest) source_.fail(name, "is too long (permitted: up to 4096 bytes)");
        if (!is_clean_utf8(text)) source_.fail(name, "is not UTF-8 text without control characters");
        break;
      }
      default:
        break;
    }
  }

  const TextSource& source_;
};

}  // namespace

Place TextSource::find(const std::string& field) const {
  if (!fields_) return {file_, 0, 0, field};
  return fields_->syntax == Syntax::kText ? find_in_tree(fields_->tree, *fields_->type, file_, field)
                                          : find_in_json(fields_->json, file_, *fields_->type, field);
}

void TextSource::fail(const std::string& field, const std::string& message) const {
  throw LoadError(find(field), message);
}

TextSource parse_message(std::string text, const std::string& file, Syntax syntax, Message& message) {
  const auto fields = std::make_shared<TextSource::Fields>();
  fields->type = message.GetDescriptor();
  fields->syntax = syntax;
  if (syntax == Syntax::kText) {
    FirstError errors;
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&errors);
    parser.WriteLocationsTo(&fields->tree);
    parser.SetRecursionLimit(64);
    if (!parser.ParseFromString(text, &message)) {
      const FirstError::Error error = errors.error.value_or(FirstError::Error{-1, -1, "cannot be parsed"});
      throw LoadError({file, from_one(error.line), from_one(error.column), ""}, error.message);
    }
  } else {
    check_json(text, file, *fields->type);
    message.Clear();
    const auto status = google::protobuf::util::JsonStringToMessage(text, &message);
    if (!status.ok()) {
      throw json_value_error({status.message().data(), status.message().size()}, text, file, *fields->type);
    }
    fields->json = std::move(text);
  }
  TextSource source;
  source.file_ = file;
  source.fields_ = fields;
  check_values(message, source);
  return source;
}

TextSource read_message(const std::filesystem::path& file, Message& message) {
  const Syntax syntax = file.extension() == ".json" ? Syntax::kJson : Syntax::kText;
  return parse_message(read_file(file, kMaxTextBytes), file.string(), syntax, message);
}

void check_values(const Message& message, const TextSource& source) {
  ValueCheck(source).message(message, "");
}

}  // namespace haptic::load
