#include "client/view/foxglove_messages.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace haptic::gateway::foxglove_protocol {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeadBytes = 13;
constexpr std::size_t kShownBytes = 40;  // of what a client said, in words back to it
constexpr char kMessageData = 1;

// the calls of the protocol that belong to capabilities that are not offered
constexpr std::array<std::string_view, 9> kOthers = {"advertise",
                                                     "unadvertise",
                                                     "getParameters",
                                                     "setParameters",
                                                     "subscribeParameterUpdates",
                                                     "unsubscribeParameterUpdates",
                                                     "subscribeConnectionGraph",
                                                     "unsubscribeConnectionGraph",
                                                     "fetchAsset"};

std::string to_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::optional<std::uint32_t> number_of(const Json& json) {
  if (!json.is_number_unsigned()) {
    return std::nullopt;
  }
  const auto number = json.get<std::uint64_t>();
  return number <= std::numeric_limits<std::uint32_t>::max()
             ? std::optional(static_cast<std::uint32_t>(number))
             : std::nullopt;
}

std::optional<std::uint32_t> number_at(const Json& json, const char* name) {
  const auto found = json.is_object() ? json.find(name) : json.end();
  return found == json.end() ? std::nullopt : number_of(*found);
}

const Json* list_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found == json.end() || !found->is_array() ? nullptr : &*found;
}

Request parse_subscribe(const Json& json) {
  const Json* const list = list_at(json, "subscriptions");
  if (list == nullptr) {
    return Invalid{"subscribe has a list \"subscriptions\""};
  }
  Subscribe request;
  request.subscriptions.reserve(list->size());
  for (const Json& item : *list) {
    const auto id = number_at(item, "id");
    const auto channel = number_at(item, "channelId");
    if (!id || !channel) {
      return Invalid{"each of \"subscriptions\" has the numbers \"id\" and \"channelId\", below 2^32"};
    }
    request.subscriptions.push_back({*id, *channel});
  }
  return request;
}

Request parse_unsubscribe(const Json& json) {
  const Json* const list = list_at(json, "subscriptionIds");
  if (list == nullptr) {
    return Invalid{"unsubscribe has a list \"subscriptionIds\""};
  }
  Unsubscribe request;
  request.ids.reserve(list->size());
  for (const Json& item : *list) {
    const auto id = number_of(item);
    if (!id) {
      return Invalid{"each of \"subscriptionIds\" is a number below 2^32"};
    }
    request.ids.push_back(*id);
  }
  return request;
}

void append(std::uint64_t number, int bytes, std::string& out) {
  for (int i = 0; i < bytes; ++i) {
    out += static_cast<char>((number >> (8 * i)) & 0xffU);
  }
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      three = three << 8U | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= bytes.size() - i ? kLetters[three >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return out;
}

std::string server_info(std::string_view name, std::string_view session_id) {
  return to_text({{"op", "serverInfo"},
                  {"name", std::string(name)},
                  {"capabilities", Json::array()},
                  {"sessionId", std::string(session_id)}});
}

std::string advertise(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "protobuf"},
                    {"schemaName", channel.schema_name},
                    {"schemaEncoding", "protobuf"},
                    {"schema", base64(channel.schema)}});
  }
  return to_text({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string status(Level level, std::string_view message, std::string_view id) {
  Json json = {{"op", "status"}, {"level", static_cast<int>(level)}, {"message", std::string(message)}};
  if (!id.empty()) {
    json["id"] = std::string(id);
  }
  return to_text(json);
}

std::string remove_status(std::string_view id) {
  return to_text({{"op", "removeStatus"}, {"statusIds", Json::array({std::string(id)})}});
}

std::string message_head(std::uint32_t subscription, std::uint64_t log_time_ns) {
  std::string head;
  head.reserve(kHeadBytes);
  head += kMessageData;
  append(subscription, 4, head);
  append(log_time_ns, 8, head);
  return head;
}

Request parse_text(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) {
    return Invalid{"a text message is one JSON object"};
  }
  const auto op = json.find("op");
  if (op == json.end() || !op->is_string()) {
    return Invalid{"a message has a string \"op\""};
  }
  const auto& name = op->get_ref<const std::string&>();
  if (name == "subscribe") {
    return parse_subscribe(json);
  }
  if (name == "unsubscribe") {
    return parse_unsubscribe(json);
  }
  if (std::find(kOthers.begin(), kOthers.end(), name) != kOthers.end()) {
    return Unsupported{name};
  }
  return Invalid{"there is no op \"" + name.substr(0, kShownBytes) + "\""};
}

Request parse_bytes(std::string_view bytes) {
  if (bytes.empty()) {
    return Nothing{};
  }
  switch (bytes.front()) {
    case 1:
      return Unsupported{"publishing"};
    case 2:
      return Unsupported{"services"};
    case 3:
      return Unsupported{"playback"};
    default:
      return Invalid{"there is no opcode " + std::to_string(static_cast<unsigned char>(bytes.front()))};
  }
}

}  // namespace haptic::gateway::foxglove_protocol
