#include "load/state_message.h"

#include <gtest/gtest.h>

#include "engine/world.h"
#include "tests/support/small_world.h"
#include "tests/unit/load/load_support.h"

namespace haptic::load {
namespace {

TEST(StateMessage, ReadsBackTheSameBits) {
  engine::World world = test::two_fingers_two_objects();
  for (int i = 0; i < 20; ++i) {
    test::run(world, 100 * i, 100 * (i + 1));
    v1::WorldState message;
    write_state(world.state(), message);
    v1::WorldState sent;
    ASSERT_TRUE(sent.ParseFromString(message.SerializeAsString()));
    const engine::State state = read_state(sent, world.scene());
    EXPECT_EQ(engine::hash(state), engine::hash(world.state()));
    EXPECT_EQ(sent.state_hash(), engine::hash(world.state()));
  }
}

TEST(StateMessage, KeepsTheSignOfZeroAndTheSmallestNumber) {
  const engine::World world = test::two_fingers_two_objects();
  engine::State state = world.state();
  state.bodies[0].velocity = {-0.0, 5e-324, 1.0 / 3.0};
  v1::WorldState message;
  write_state(state, message);
  EXPECT_EQ(engine::hash(read_state(message, world.scene())), engine::hash(state));
}

TEST(StateMessage, OfAProxyThatIsNowhereIsRefused) {
  const engine::World world = test::two_fingers_two_objects();
  v1::WorldState good;
  write_state(world.state(), good);
  const auto field_of = [&](v1::ConstraintState state, std::uint32_t cell, std::uint32_t feature) {
    v1::WorldState message = good;
    message.set_proxy_state(0, state);
    message.set_proxy_cell(0, cell);
    message.set_proxy_feature(0, feature);
    return error_of([&] { read_state(message, world.scene()); }).field();
  };
  const std::string at = "state.proxy_cell[0]";
  EXPECT_EQ(field_of(v1::TET, 0, 0), at);
  EXPECT_EQ(field_of(v1::TET, 1, 1), at);
  EXPECT_EQ(field_of(v1::TET, 1'000'000, 0), at);
  EXPECT_EQ(field_of(v1::SUR, 1, 1'000'000), at);
  EXPECT_EQ(field_of(v1::SUR, 1, 0), at);
  EXPECT_EQ(field_of(v1::EDG, 1, 1'000'000), at);
  EXPECT_EQ(field_of(v1::VER, 0, 1), at);
  EXPECT_EQ(field_of(v1::OUT, 1, 0), at);
}

}  // namespace
}  // namespace haptic::load
