#pragma once
// Schemas that stand alone in a file: everything that a message's type is made of.

#include <memory>
#include <string>

#include "proto/recording/records.h"

namespace google::protobuf {
class Descriptor;
class DescriptorPool;
class DynamicMessageFactory;
class Message;
}  // namespace google::protobuf

namespace haptic::recording {

/// The type as a schema record: a FileDescriptorSet with all that it imports, each file after its imports.
Schema schema_of(const google::protobuf::Descriptor& type, std::uint16_t id);

/// A message type as a file tells it, known to this program or not.
class EmbeddedType {
 public:
  /// Throws FormatError if the schema is no type of protobuf.
  explicit EmbeddedType(const Schema& schema);
  ~EmbeddedType();
  EmbeddedType(EmbeddedType&&) noexcept;
  EmbeddedType& operator=(EmbeddedType&&) noexcept;

  /// Valid as long as this. Throws FormatError if the bytes are no such message.
  std::unique_ptr<google::protobuf::Message> parse(std::string_view data) const;

 private:
  std::unique_ptr<google::protobuf::DescriptorPool> pool_;
  std::unique_ptr<google::protobuf::DynamicMessageFactory> factory_;
  const google::protobuf::Message* prototype_ = nullptr;
};

}  // namespace haptic::recording
