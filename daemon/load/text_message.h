#pragma once
// Protobuf messages from files that people write: text format (*.txtpb) or JSON (*.json), by protobuf's own
// parsers. An unknown field, a field given twice and a number that is not finite are errors. The source that
// comes with a message still knows where each field stood, so that what is found wrong later - a name that
// does not exist, a size of zero - is told with file, line and column too.
//
// A message that came over the wire has an empty source: its errors name the field alone.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "load/error.h"

namespace google::protobuf {
class Message;
}

namespace haptic::load {

enum class Syntax { kText, kJson };

/// Where the fields of one message stand. Cheap to copy.
class TextSource {
 public:
  TextSource() = default;  // of a message that was not read from text

  const std::string& file() const noexcept { return file_; }

  /// The place of `field` ("object[2].shape.box.size.x"), or of the closest one around it that the text
  /// gives.
  Place find(const std::string& field) const;

  /// Throws LoadError at that place.
  [[noreturn]] void fail(const std::string& field, const std::string& message) const;

 private:
  friend TextSource parse_message(std::string text, const std::string& file, Syntax syntax,
                                  google::protobuf::Message& message);
  struct Fields;
  std::string file_;
  std::shared_ptr<const Fields> fields_;
};

/// Reads the file into `message`; a name that ends in .json is JSON, any other text format. Throws LoadError.
TextSource read_message(const std::filesystem::path& file, google::protobuf::Message& message);

/// The same from memory; `file` is only a name for errors.
TextSource parse_message(std::string text, const std::string& file, Syntax syntax,
                         google::protobuf::Message& message);

/// An item of a list as field paths write it: "object[2]".
inline std::string item(const std::string& list, int index) {
  return list + "[" + std::to_string(index) + "]";
}

/// Refuses what no message of ours may hold in any field: a number that is not finite, an enumerator that
/// does not exist, text that is not UTF-8, has control characters or is very long.
void check_values(const google::protobuf::Message& message, const TextSource& source);

}  // namespace haptic::load
