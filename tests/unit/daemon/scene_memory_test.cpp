// A scene for which there is not enough memory, wherever it is missed: it is not built, and the next one is.

#include <gtest/gtest.h>

#include "daemon/scene_builder.h"
#include "load/config_file.h"
#include "load/text_message.h"
#include "rt/memory_reserve.h"
#include "tests/support/failing_allocation.h"

// protobuf loses a few bytes for each message that it copies when memory runs out
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:google::protobuf::\nleak:haptic::v1::\n";
}

namespace haptic {
namespace {

constexpr std::size_t kBytes = std::size_t{4} * 1024 * 1024;

const char* const kRequest = R"(scene {
  material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
  material { name: "air" free {} }
  object { name: "box" shape { box { size { x: 0.1 y: 0.1 z: 0.1 } } } inside: "wood" outside: "air"
           air_margin: 0.1 dynamic {} }
  object { name: "ball" shape { icosphere { radius: 0.1 subdivisions: 1 } } inside: "wood" }
  finger { name: "index" device: "left" stiffness: 100 fingertip { radius: 0.01 cap_angle: 1 hips: 5 direction { z: 1 } } }
})";

v1::LoadScene request() {
  v1::LoadScene message;
  load::parse_message(kRequest, "", load::Syntax::kText, message);
  return message;
}

void never() noexcept { ADD_FAILURE() << "the reserve is not for scenes"; }

TEST(SceneMemory, MissedAnywhereTheSceneIsNotBuiltAndTheReserveIsLeft) {
  const rt::MemoryReserve reserve(kBytes, &never);
  const SceneBuilder builder(load::default_capacity(), {"left"});
  const v1::LoadScene wanted = request();
  test::make_this_thread_fallible();
  const std::size_t objects = builder.from_request(wanted).prepared->world.scene().objects.size();
  std::uint64_t spared = 0;
  for (bool built = false; !built; ++spared) {
    const rt::MemoryMayRunOut tolerated;
    test::fail_allocations(spared, 1);
    try {
      const ipc::BuiltScene scene = builder.from_request(wanted);
      built = test::stop_failing() == 0;
      EXPECT_TRUE(built) << "after " << spared << " a failure was passed over";
      EXPECT_EQ(scene.prepared->world.scene().objects.size(), objects);
    } catch (const std::bad_alloc&) {
      EXPECT_EQ(test::stop_failing(), 1U);
    }
  }
  EXPECT_FALSE(reserve.is_spent());
  EXPECT_GT(spared, 100U);  // each of so many has failed in its turn
}

}  // namespace
}  // namespace haptic
