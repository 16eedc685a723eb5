#pragma once
// What is wrong with a file or a message that describes a scene, a config, a mesh or a path, told so that the
// person who wrote it can find and mend it:
//
//     scenes/box.scene.txtpb:14:18: object[2].shape.box.size.x: -0.1 is out of range (permitted: 1e-06 to
//     1e+06) [file[:line[:column]]: ][field: ]message

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptic::load {

/// Where something stands. Whatever is not known is empty or 0.
struct Place {
  std::string file;
  std::uint32_t line = 0;    // from 1
  std::uint32_t column = 0;  // from 1, in bytes
  std::string field;         // e.g. "object[2].shape.box.size.x", or the column of a CSV file
};

/// "file:line:column: field: ", as far as it is known.
inline std::string to_string(const Place& place) {
  std::string text = place.file;
  if (place.line != 0) text += (text.empty() ? "line " : ":") + std::to_string(place.line);
  if (place.line != 0 && place.column != 0) text += ":" + std::to_string(place.column);
  if (!text.empty()) text += ": ";
  if (!place.field.empty()) text += place.field + ": ";
  return text;
}

/// The one exception that leaves this folder. what() is place and message in one line.
class LoadError : public std::runtime_error {
 public:
  LoadError(Place place, const std::string& message)
      : std::runtime_error(to_string(place) + message), place_(std::move(place)), message_(message) {}

  const std::string& file() const noexcept { return place_.file; }
  std::uint32_t line() const noexcept { return place_.line; }
  std::uint32_t column() const noexcept { return place_.column; }
  const std::string& field() const noexcept { return place_.field; }
  const std::string& message() const noexcept { return message_; }  // without the place

 private:
  Place place_;
  std::string message_;
};

}  // namespace haptic::load
