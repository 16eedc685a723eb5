#include "client/cli/inputs_recorder.h"

#include <gtest/gtest.h>

#include <optional>

#include "proto/recording/recording.h"
#include "tests/support/memory_sink.h"
#include "tests/support/test_daemon.h"

namespace haptic::cli {
namespace {

class InputsRecorderTest : public ::testing::Test {
 protected:
  InputsRecorderTest() { daemon_.servo().publish(1); }

  /// What the daemon sends, up to the frame of this tick.
  void take_until(std::uint64_t tick) {
    for (;;) {
      const auto message = connection_.receive(std::chrono::seconds(5));
      ASSERT_TRUE(message);
      EXPECT_TRUE(recorder_.take(*message));
      if (message->has_frame() && message->frame().tick() == tick) return;
    }
  }

  /// The ticks of a topic's messages in the file.
  template <class Of>
  std::vector<std::uint64_t> ticks(const std::string& topic) {
    const recording::MemorySource source(sink_.bytes);
    const recording::Recording recording(source);
    std::vector<std::uint64_t> all;
    for (auto messages = recording.messages({.topics = {topic}}); messages.next();) {
      Of message;
      messages.parse(message);
      all.push_back(message.tick());
    }
    return all;
  }

  test::TestDaemon daemon_;
  client::Connection connection_{{.address = daemon_.address(), .identity = {}}};
  test::MemorySink sink_;
  recording::SessionWriter writer_{sink_, {.program = "test", .daemon_version = "9.9", .viewers = false}};
  InputsRecorder recorder_{connection_, writer_};
};

TEST_F(InputsRecorderTest, WritesTheStateAndWhatComesAfterIt) {
  recorder_.begin();
  daemon_.servo().publish(2);
  daemon_.servo().publish(3);
  take_until(3);
  writer_.close();
  EXPECT_EQ(ticks<v1::WorldState>(recording::kStateTopic), (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(ticks<v1::Frame>(recording::channel_of(v1::INPUTS)), (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(recorder_.lost(), 0u);
}

TEST_F(InputsRecorderTest, AfterAGapAsksForTheStateAgain) {
  recorder_.begin();
  daemon_.servo().publish(2);
  take_until(2);
  daemon_.servo().publish(10);  // 3 to 9 are lost on the way
  take_until(10);
  daemon_.servo().publish(11);
  take_until(11);
  writer_.close();
  EXPECT_EQ(recorder_.lost(), 7u);
  EXPECT_EQ(ticks<v1::WorldState>(recording::kStateTopic), (std::vector<std::uint64_t>{1, 10}));
  // that of tick 10 lies before the state
  EXPECT_EQ(ticks<v1::Frame>(recording::channel_of(v1::INPUTS)), (std::vector<std::uint64_t>{2, 11}));
}

TEST_F(InputsRecorderTest, LeavesWhatIsOfOtherSubscriptionsAlone) {
  recorder_.begin();
  connection_.subscribe({v1::OBJECTS}, 1);
  daemon_.servo().publish(2);
  std::optional<v1::Envelope> message;
  do {
    message = connection_.receive(std::chrono::seconds(5));
    ASSERT_TRUE(message);
  } while (recorder_.take(*message));
  EXPECT_TRUE(message->frame().has_objects());
}

}  // namespace
}  // namespace haptic::cli
