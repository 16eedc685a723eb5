#include "client/cli/background_verb.h"

#include <exception>
#include <utility>

namespace haptic::cli {

BackgroundVerb::BackgroundVerb(Command command) : command_(std::move(command)) {
  command_.connection = std::make_shared<std::unique_ptr<client::Connection>>();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void BackgroundVerb::run(const std::stop_token& stop) {
  bool is_told = false;
  command_.background = Background{.stop = stop, .begun = [this, &is_told] {
                                     is_told = true;
                                     begin_.set_value();
                                   }};
  try {
    end_.set_value(command_.action(command_));
  } catch (const std::exception&) {
    end_.set_exception(std::current_exception());
  }
  if (!is_told) {
    begin_.set_value();
  }
}

bool BackgroundVerb::has_begun_within(std::chrono::milliseconds patience) const {
  return begun_.wait_for(patience) == std::future_status::ready;
}

bool BackgroundVerb::has_ended_within(std::chrono::milliseconds patience) const {
  return result_.wait_for(patience) == std::future_status::ready;
}

}  // namespace haptic::cli
