#include "client/cli/condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "client/lib/error.h"

namespace haptic::cli {
namespace {

struct SubjectWords {
  const char* word;
  Subject subject;
  std::vector<std::string> measured;  // continuous quantities
  std::vector<std::string> counted;   // whole numbers, which may be compared by == as they are
};

const std::array<SubjectWords, 4>& subjects() {
  static const std::array<SubjectWords, 4> table{{
      {"object", Subject::kObject, {"x", "y", "z", "vx", "vy", "vz", "speed"}, {}},
      {"finger", Subject::kFinger, {"force"}, {"touching", "slipping"}},
      {"device", Subject::kDevice, {"force", "x", "y", "z"}, {"armed"}},
      {"tick", Subject::kTick, {}, {}},
  }};
  return table;
}

const std::array<std::pair<const char*, Comparison>, 5> kComparisons{{{"<", Comparison::kLess},
                                                                      {"<=", Comparison::kLessEqual},
                                                                      {">", Comparison::kGreater},
                                                                      {">=", Comparison::kGreaterEqual},
                                                                      {"==", Comparison::kEqual}}};

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// all of the text, finite
std::optional<double> to_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

double number_or_throw(const std::string& text) {
  if (text == "true" || text == "false") {
    return text == "true" ? 1.0 : 0.0;
  }
  const std::optional<double> number = to_number(text);
  if (!number) {
    throw std::invalid_argument(fmt::format("'{}' is no number", text));
  }
  return *number;
}

const SubjectWords& find_subject(const std::string& word) {
  for (const SubjectWords& subject : subjects()) {
    if (word == subject.word) {
      return subject;
    }
  }
  throw std::invalid_argument(fmt::format("'{}' is none of object, finger, device, tick", word));
}

// NAME.FIELD; a name may have dots itself
void take_field(const std::string& word, const SubjectWords& subject, Condition& condition) {
  const std::size_t dot = word.rfind('.');
  condition.name = word.substr(0, dot);
  condition.field = dot == std::string::npos ? "" : word.substr(dot + 1);
  if (condition.name.empty() ||
      (!contains(subject.measured, condition.field) && !contains(subject.counted, condition.field))) {
    throw std::invalid_argument(fmt::format(
        "'{}' should be NAME.FIELD with one of the fields {}{}{}", word, fmt::join(subject.measured, ", "),
        subject.counted.empty() ? "" : ", ", fmt::join(subject.counted, ", ")));
  }
}

void take_comparison(std::span<const std::string> words, bool measured, Condition& condition) {
  const auto found = std::find_if(kComparisons.begin(), kComparisons.end(),
                                  [&](const auto& pair) { return words[0] == pair.first; });
  if (found == kComparisons.end()) {
    throw std::invalid_argument(fmt::format("'{}' is none of < <= > >= ==", words[0]));
  }
  condition.comparison = found->second;
  if (words.size() < 2) {
    throw std::invalid_argument(fmt::format("no number follows {}", words[0]));
  }
  condition.value = number_or_throw(words[1]);
  const bool tolerated = words.size() == 4 && words[2] == "within";
  if (words.size() > 2 && !tolerated) {
    throw std::invalid_argument(fmt::format("'{}' is too much", words[2]));
  }
  if (tolerated && condition.comparison != Comparison::kEqual) {
    throw std::invalid_argument("only == has a tolerance");
  }
  if (tolerated) {
    condition.tolerance = number_or_throw(words[3]);
    if (condition.tolerance < 0.0) {
      throw std::invalid_argument("a tolerance is not negative");
    }
  } else if (measured && condition.comparison == Comparison::kEqual) {
    throw std::invalid_argument("== with a measured quantity needs: within TOLERANCE");
  }
}

std::size_t index_of(const std::vector<std::string>& names, const Condition& condition, const char* kind) {
  const auto found = std::find(names.begin(), names.end(), condition.name);
  if (found == names.end()) {
    v1::Error error;
    error.set_code(v1::Error::NOT_FOUND);
    error.set_message(fmt::format("there is no {} \"{}\"", kind, condition.name));
    client::throw_error(error);
  }
  return static_cast<std::size_t>(found - names.begin());
}

// number k of item i of a packed array; 0 where a frame is shorter than its scene
double packed(const google::protobuf::RepeatedField<double>& values, std::size_t i, std::size_t k) {
  const auto index = static_cast<int>(3 * i + k);
  return index < values.size() ? values[index] : 0.0;
}

double length(const google::protobuf::RepeatedField<double>& values, std::size_t i) {
  return std::hypot(packed(values, i, 0), packed(values, i, 1), packed(values, i, 2));
}

double measure_object(const Condition& condition, const Look& look) {
  const std::size_t i = index_of(look.names.objects, condition, "object");
  const v1::ObjectsFrame& objects = look.frame.objects();
  if (condition.field == "speed") {
    return length(objects.velocity(), i);
  }
  const auto axis = static_cast<std::size_t>(condition.field.back() - 'x');
  return packed(condition.field.size() == 2 ? objects.velocity() : objects.position(), i, axis);
}

double measure_finger(const Condition& condition, const Look& look) {
  std::vector<std::string> names;
  for (const auto& finger : look.names.fingers) {
    names.push_back(finger.name());
  }
  const std::size_t i = index_of(names, condition, "finger");
  const FingerSummary summary = summarise_fingers(look.names, look.frame.hips())[i];
  if (condition.field == "touching") {
    return summary.contacts;
  }
  return condition.field == "slipping" ? summary.slipping
                                       : std::hypot(summary.force[0], summary.force[1], summary.force[2]);
}

double measure_device(const Condition& condition, const Look& look) {
  const std::size_t i = index_of(look.names.devices, condition, "device");
  const v1::DevicesFrame& devices = look.frame.devices();
  if (condition.field == "force") {
    return length(devices.force(), i);
  }
  if (condition.field != "armed") {
    return packed(devices.position(), i, static_cast<std::size_t>(condition.field.back() - 'x'));
  }
  const int item = static_cast<int>(i);
  const bool present = item < devices.present_size() && devices.present(item);
  const bool faulty = item < devices.fault_size() && devices.fault(item) != v1::FAULT_NONE;
  return look.frame.armed() && present && !faulty ? 1.0 : 0.0;
}

}  // namespace

Condition parse_condition(std::span<const std::string> words) {
  if (words.empty()) {
    throw std::invalid_argument("a condition is missing: object, finger, device or tick ...");
  }
  Condition condition;
  condition.text = fmt::format("{}", fmt::join(words, " "));
  const SubjectWords& subject = find_subject(words[0]);
  condition.subject = subject.subject;
  std::size_t used = 1;
  if (subject.subject != Subject::kTick) {
    if (words.size() < 2) {
      throw std::invalid_argument(fmt::format("no NAME.FIELD follows {}", words[0]));
    }
    take_field(words[used++], subject, condition);
  }
  const bool measured = contains(subject.measured, condition.field);
  if (used < words.size()) {
    take_comparison(words.subspan(used), measured, condition);
  } else if (!contains(subject.counted, condition.field)) {
    throw std::invalid_argument("a comparison is missing: < <= > >= ==");
  }
  return condition;
}

double parse_duration(const std::string& text) {
  const std::size_t unit_at = text.find_first_not_of("0123456789.");
  const std::string unit = unit_at == std::string::npos ? "" : text.substr(unit_at);
  const std::optional<double> number = to_number(std::string_view(text).substr(0, unit_at));
  const double scale = unit == "ms" ? 1e-3 : unit == "s" ? 1.0 : unit == "min" ? 60.0 : 0.0;
  constexpr double kDay = 86400.0;  // s; longer is a slip of the hand
  if (!number || scale == 0.0 || *number * scale > kDay) {
    throw std::invalid_argument(
        fmt::format("'{}' is no duration: a number and ms, s or min, up to a day", text));
  }
  return *number * scale;
}

v1::Topic topic_of(const Condition& condition) {
  switch (condition.subject) {
    case Subject::kFinger:
      return v1::HIPS;
    case Subject::kDevice:
      return v1::DEVICES;
    default:
      return v1::OBJECTS;
  }
}

double measure(const Condition& condition, const Look& look) {
  switch (condition.subject) {
    case Subject::kObject:
      return measure_object(condition, look);
    case Subject::kFinger:
      return measure_finger(condition, look);
    case Subject::kDevice:
      return measure_device(condition, look);
    default:
      return static_cast<double>(look.frame.tick());
  }
}

bool holds(const Condition& condition, double measured) noexcept {
  switch (condition.comparison) {
    case Comparison::kLess:
      return measured < condition.value;
    case Comparison::kLessEqual:
      return measured <= condition.value;
    case Comparison::kGreater:
      return measured > condition.value;
    case Comparison::kGreaterEqual:
      return measured >= condition.value;
    case Comparison::kEqual:
      return std::abs(measured - condition.value) <= condition.tolerance;
    default:
      return measured != 0.0;
  }
}

}  // namespace haptic::cli
