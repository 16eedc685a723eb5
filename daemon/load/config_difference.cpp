#include "load/config_difference.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <string_view>

namespace haptic::load {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::util::MessageDifferencer;

class Paths final : public MessageDifferencer::Reporter {
 public:
  using Fields = std::vector<MessageDifferencer::SpecificField>;

  void ReportAdded(const Message& /*running*/, const Message& /*wanted*/, const Fields& path) override {
    add(path);
  }
  void ReportDeleted(const Message& /*running*/, const Message& /*wanted*/, const Fields& path) override {
    add(path);
  }
  void ReportModified(const Message& /*running*/, const Message& /*wanted*/, const Fields& path) override {
    // after the fields of a message that have changed, the message itself is told, too
    if (path.back().field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) add(path);
  }

  std::vector<std::string> found;

 private:
  void add(const Fields& path) {
    std::string text;
    for (const MessageDifferencer::SpecificField& step : path) {
      if (!text.empty()) text += ".";
      text += step.field->name();
      // an entry that only the running config has is told by its index there
      if (step.field->is_repeated()) text += "[" + std::to_string(std::max(step.index, step.new_index)) + "]";
    }
    found.push_back(text);
  }
};

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

bool is_taken_over(std::string_view path) {
  if (begins(path, "limits.") || begins(path, "drive.") || path == "limits" || path == "drive") return true;
  const std::size_t entry = path.find("].");
  if (!begins(path, "listen[") || entry == std::string_view::npos) return false;
  const std::string_view field = path.substr(entry + 2);
  // tls itself coming or going makes another kind of listener
  return begins(field, "unix.allow[") || begins(field, "tcp.allow[") || begins(field, "tcp.tls.");
}

}  // namespace

ConfigDifference compare(const v1::DaemonConfig& running, const v1::DaemonConfig& wanted) {
  Paths paths;
  MessageDifferencer differencer;
  differencer.ReportDifferencesTo(&paths);
  differencer.Compare(running, wanted);
  ConfigDifference difference;
  for (std::string& path : paths.found) {
    (is_taken_over(path) ? difference.taken_over : difference.needs_restart).push_back(std::move(path));
  }
  return difference;
}

v1::DaemonConfig after_reload(const v1::DaemonConfig& running, const v1::DaemonConfig& wanted) {
  v1::DaemonConfig after = running;
  *after.mutable_limits() = wanted.limits();
  *after.mutable_drive() = wanted.drive();
  const std::vector<std::string> others = compare(running, wanted).needs_restart;
  const bool same_places = std::none_of(others.begin(), others.end(),
                                        [](const std::string& path) { return begins(path, "listen"); });
  if (same_places) *after.mutable_listen() = wanted.listen();
  return after;
}

}  // namespace haptic::load
