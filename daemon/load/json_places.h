#pragma once
// Where the fields of a JSON text stand. protobuf's JSON parser tells no lines, is lax about syntax and lets
// a later key replace an earlier one; this walk over the same text is strict (RFC 8259) and knows where it
// is.

#include <string>
#include <string_view>

#include "load/error.h"

namespace google::protobuf {
class Descriptor;
}

namespace haptic::load {

/// Throws LoadError at the first error of syntax, unknown field, field given twice or null in a list.
void check_json(std::string_view text, const std::string& file, const google::protobuf::Descriptor& type);

/// The place of `field` in a text that check_json accepts, or of the closest field around it.
Place find_in_json(std::string_view text, const std::string& file, const google::protobuf::Descriptor& type,
                   const std::string& field);

}  // namespace haptic::load
