#include "proto/recording/schema_set.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>

#include <set>

#include "proto/recording/error.h"

namespace haptic::recording {
namespace {

namespace pb = google::protobuf;

void add_with_imports(const pb::FileDescriptor& file, std::set<std::string>& seen,
                      pb::FileDescriptorSet& set) {
  if (!seen.insert(file.name()).second) {
    return;
  }
  for (int i = 0; i < file.dependency_count(); ++i) {
    add_with_imports(*file.dependency(i), seen, set);
  }
  file.CopyTo(set.add_file());
}

// collects what is wrong instead of logging it
class Complaints : public pb::DescriptorPool::ErrorCollector {
 public:
  void AddError(const std::string& file, const std::string& element, const pb::Message* /*descriptor*/,
                ErrorLocation /*location*/, const std::string& message) override {
    if (first_.empty()) {
      first_ = file + ": " + element + ": " + message;
    }
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

}  // namespace

Schema schema_of(const pb::Descriptor& type, std::uint16_t id) {
  pb::FileDescriptorSet set;
  std::set<std::string> seen;
  add_with_imports(*type.file(), seen, set);
  return {id, type.full_name(), "protobuf", set.SerializeAsString()};
}

EmbeddedType::EmbeddedType(const Schema& schema)
    : pool_(std::make_unique<pb::DescriptorPool>()), factory_(std::make_unique<pb::DynamicMessageFactory>()) {
  pb::FileDescriptorSet set;
  if (schema.encoding != "protobuf" || !set.ParseFromString(schema.data)) {
    throw FormatError("schema \"" + schema.name + "\" is no set of protobuf descriptors");
  }
  for (const pb::FileDescriptorProto& file : set.file()) {
    Complaints complaints;
    if (pool_->BuildFileCollectingErrors(file, &complaints) == nullptr) {
      throw FormatError("schema \"" + schema.name + "\": " + complaints.first());
    }
  }
  const pb::Descriptor* const type = pool_->FindMessageTypeByName(schema.name);
  if (type == nullptr) {
    throw FormatError("schema \"" + schema.name + "\" does not have the type of its name");
  }
  prototype_ = factory_->GetPrototype(type);
}

EmbeddedType::~EmbeddedType() = default;
EmbeddedType::EmbeddedType(EmbeddedType&&) noexcept = default;
EmbeddedType& EmbeddedType::operator=(EmbeddedType&&) noexcept = default;

std::unique_ptr<pb::Message> EmbeddedType::parse(std::string_view data) const {
  std::unique_ptr<pb::Message> message(prototype_->New());
  if (!message->ParseFromArray(data.data(), static_cast<int>(data.size()))) {
    throw FormatError("a message is no " + prototype_->GetDescriptor()->full_name());
  }
  return message;
}

}  // namespace haptic::recording
