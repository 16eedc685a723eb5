#pragma once
// What a script waits for or expects: "object box.y > 0.1". Reading and judging are pure.
//
//     object NAME.x|y|z|vx|vy|vz|speed            m and m/s, world frame
//     finger NAME.force|touching|slipping         N; how many of its HIPs are held, how many of these slip
//     device NAME.force|x|y|z|armed               N and m, world frame; 1 if it may push
//     tick
//
// followed by < <= > >= or == and a number, true or false. == with a measured quantity needs "within
// TOLERANCE". Without a comparison, what is not zero holds.

#include <span>
#include <string>
#include <vector>

#include "client/cli/look.h"

namespace haptic::cli {

enum class Subject { kObject, kFinger, kDevice, kTick };
enum class Comparison { kNotZero, kLess, kLessEqual, kGreater, kGreaterEqual, kEqual };

struct Condition {
  Subject subject = Subject::kTick;
  std::string name;   // of the object, finger or device
  std::string field;  // what of it
  Comparison comparison = Comparison::kNotZero;
  double value = 0.0;
  double tolerance = 0.0;  // of kEqual
  std::string text;        // as it was written
};

/// Throws std::invalid_argument, in words.
Condition parse_condition(std::span<const std::string> words);

/// "2s", "200ms", "1.5min" in seconds. Throws std::invalid_argument.
double parse_duration(const std::string& text);

/// The topic that tells of the subject.
v1::Topic topic_of(const Condition& condition);

/// What the frame says of the subject. Throws client::NotFound if there is none of this name.
double measure(const Condition& condition, const Look& look);

bool holds(const Condition& condition, double measured) noexcept;

}  // namespace haptic::cli
