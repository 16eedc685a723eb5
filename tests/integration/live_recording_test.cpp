// What a client records of a daemon over the socket, while others edit, load, pause and reset, is replayed
// elsewhere to the bit. The daemon is the real one but for its clock: it ticks as fast as the recording
// client reads, so that no tick is lost on any machine.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <sstream>
#include <thread>

#include "client/cli/inputs_recorder.h"
#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "daemon/scene_builder.h"
#include "ipc/server.h"
#include "load/config_file.h"
#include "proto/recording/session.h"
#include "servo/servo_loop.h"
#include "simulate/replay_file.h"
#include "tests/support/places.h"
#include "tests/support/servo_rig.h"
#include "tests/support/temporary_folder.h"

namespace haptic {
namespace {

const std::string kScenes = test::source_dir() + "/config/scenes/";

v1::Response ask(client::Connection& daemon, const std::function<void(v1::Request&)>& fill) {
  v1::Request request;
  fill(request);
  return daemon.call(std::move(request));
}

/// The daemon, with two hands that close on what is between them and carry it about.
class Daemon {
 public:
  Daemon() {
    ipc::BuiltScene scene = builder_.from_file(kScenes + "grasp.scene.txtpb");
    scene.prepared->revision = 1;
    scene.description.set_revision(1);
    ipc::ServerSettings settings;
    settings.listen.emplace_back().mutable_unix()->set_path(folder_.file("s"));
    ipc::Services services{
        .mailbox = *mailbox_,
        .version = "test",
        .rate_hz = 1000.0,
        .devices = std::vector<v1::DeviceDescription>(2),
        .real_time = {},
        .scene = scene.description,
        .running = scene.prepared->world.shared_scene(),
        .build_scene = [&](const v1::LoadScene& request) { return builder_.from_request(request); },
        .edit_scene = [&](const v1::EditScene& request,
                          const ipc::RunningScene& running) { return builder_.from_edit(request, running); }};
    services.devices[0].set_name("left");
    services.devices[1].set_name("right");
    loop_ = std::make_unique<servo::ServoLoop>(servo::ServoSettings{.limits = test::wide_limits()},
                                               std::vector<drivers::Device*>{&left_, &right_},
                                               std::move(scene.prepared), *mailbox_);
    server_ = std::make_unique<ipc::Server>(std::move(settings), std::move(services));
    serving_ = std::thread([this] { server_->run(); });
    ticking_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  ~Daemon() {
    ticking_.request_stop();
    ticking_.join();
    server_->stop();
    serving_.join();
  }

  client::Options address() const {
    client::Options options;
    options.address = folder_.file("s");
    return options;
  }

  /// From now on ticks run no faster than a client reads them, which calls read() for each.
  void wait_for_reader() {
    read_ = tick_.load();
    waits_ = true;
  }
  void read(std::uint64_t tick) { read_ = tick; }

 private:
  // ahead of the reader by half of what the ring of snapshots holds, and slowly from there on: who waits for
  // an answer does not read
  void tick(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const std::uint64_t tick = tick_;
      const bool is_ahead = waits_ && tick > read_ + servo::SnapshotRing::kSlots / 2;
      if (is_ahead) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (!waits_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const auto time = static_cast<double>(tick);
      const double gap = 0.045 - 0.029 * std::min(1.0, time / 200.0);
      const double x = 0.03 + 0.01 * std::sin(0.01 * time);
      left_.sample.position = {x, 0.0, -gap};
      right_.sample.position = {x, 0.0, gap};
      // the left one is gone for a while, again and again
      left_.connected = tick % 400 < 350;
      loop_->tick({.tick = tick, .time = static_cast<drivers::Nanoseconds>(tick * 1'000'000)});
      ++tick_;
    }
  }

  test::TemporaryFolder folder_;
  SceneBuilder builder_{load::default_capacity(), {"left", "right"}};
  test::HandDevice left_{"left"};
  test::HandDevice right_{"right"};
  std::unique_ptr<servo::Mailbox> mailbox_ = std::make_unique<servo::Mailbox>(
      servo::Capacity{.objects = 8, .fingers = 4, .hips = 64, .contacts = 256, .devices = 2});
  std::unique_ptr<servo::ServoLoop> loop_;
  std::unique_ptr<ipc::Server> server_;
  std::atomic<std::uint64_t> tick_{0};
  std::atomic<std::uint64_t> read_{0};
  std::atomic<bool> waits_{false};
  std::thread serving_;
  std::jthread ticking_;
};

/// A client that records into a file as hapticctl does.
class Recorder {
 public:
  explicit Recorder(Daemon& daemon) : daemon_(daemon), connection_(daemon.address()) {
    daemon_.wait_for_reader();
    v1::Subscribe looks;
    looks.add_topic(v1::OBJECTS);
    looks.add_topic(v1::HIPS);
    looks.set_decimation(20);
    looks.set_delivery(v1::LOSSLESS);
    connection_.subscribe(looks);
    inputs_.begin();
  }

  const std::string& file() const { return sink_.path(); }

  void record(std::uint64_t ticks) {
    for (const std::uint64_t until = last_ + ticks; last_ < until;) {
      const auto message = connection_.receive(std::chrono::seconds(10));
      ASSERT_TRUE(message);
      ASSERT_FALSE(message->has_gap());
      if (inputs_.take(*message)) {
        last_ = message->frame().tick();
        daemon_.read(last_);
      } else if (message->has_frame()) {
        writer_.write(message->frame());
      }
    }
  }

  /// Records while another client asks on a thread of its own, and for a while after.
  v1::Response record_while(client::Connection& other, const std::function<void(v1::Request&)>& fill) {
    std::atomic<bool> done = false;
    v1::Response response;
    std::thread asking([&] {
      EXPECT_NO_THROW(response = ask(other, fill));
      done = true;
    });
    while (!done) record(1);
    asking.join();
    record(40);
    return response;
  }

  void close() {
    writer_.close();
    sink_.close();
  }

 private:
  Daemon& daemon_;
  client::Connection connection_;
  test::TemporaryFolder folder_;
  recording::FileSink sink_{folder_.file("live.mcap"), recording::FileSink::IfThere::kReplace,
                            recording::FileSink::Durable::kNo};
  recording::SessionWriter writer_{
      sink_, {.program = "test", .daemon_version = "test", .rate_hz = 1000.0, .viewers = false}};
  cli::InputsRecorder inputs_{connection_, writer_};
  std::uint64_t last_ = 0;
};

TEST(LiveRecording, IsReplayedToTheBitWhateverOthersDoMeanwhile) {
  Daemon daemon;
  client::Connection other(daemon.address());
  Recorder recorder(daemon);
  recorder.record(300);
  const auto meanwhile = [&](const std::function<void(v1::Request&)>& fill) {
    recorder.record_while(other, fill);
  };
  meanwhile([](v1::Request& request) {
    v1::SceneEdit& edit = *request.mutable_edit_scene()->add_edit();
    edit.mutable_set_gravity()->set_y(-0.3);
  });
  meanwhile([](v1::Request& request) { request.mutable_reset_scene(); });
  meanwhile([](v1::Request& request) { request.mutable_pause(); });
  meanwhile([](v1::Request& request) { request.mutable_step()->set_ticks(5); });
  meanwhile([](v1::Request& request) { request.mutable_resume(); });
  meanwhile([](v1::Request& request) {
    request.mutable_load_scene()->set_path(kScenes + "teapot.scene.txtpb");  // its mesh is in a file
  });
  meanwhile([](v1::Request& request) {
    v1::SceneEdit& edit = *request.mutable_edit_scene()->add_edit();
    edit.mutable_set_gravity()->set_y(-0.3);
  });
  recorder.close();

  std::ostringstream out;
  EXPECT_TRUE(simulate::replay({.file = recorder.file()}, out)) << out.str();
  EXPECT_EQ(out.str().find("missing"), std::string::npos) << out.str();
  // tests/data/recordings/renew
  const char* const keep = std::getenv("HAPTIC_KEEP_RECORDING");
  if (keep != nullptr) {
    std::filesystem::copy_file(recorder.file(), keep, std::filesystem::copy_options::overwrite_existing);
  }
}

TEST(LiveRecording, AScenesMeshesAreEmbeddedOnlyWhereThatIsAskedFor) {
  Daemon daemon;
  client::Connection other(daemon.address());
  const v1::Response loaded = ask(other, [](v1::Request& request) {
    request.mutable_load_scene()->set_path(kScenes + "layers.scene.txtpb");
  });
  EXPECT_FALSE(loaded.scene().scene().object(0).shape().mesh().has_embedded());
  const v1::Response embedded =
      ask(other, [](v1::Request& request) { request.mutable_get_scene()->set_embed_meshes(true); });
  const v1::Shape::Mesh& mesh = embedded.scene().scene().object(0).shape().mesh();
  EXPECT_EQ(static_cast<std::uint32_t>(mesh.embedded().tag_size()), embedded.scene().object(0).cells());
  // and so it can be sent back
  EXPECT_NO_THROW(ask(other, [&](v1::Request& request) {
    *request.mutable_load_scene()->mutable_scene() = embedded.scene().scene();
  }));
}

TEST(LiveRecording, ScenesThatHaveRunAreKeptWhileSomebodyRecords) {
  Daemon daemon;
  client::Connection other(daemon.address());
  const auto edit = [](v1::Request& request) {
    request.mutable_edit_scene()->add_edit()->mutable_set_gravity()->set_x(0.1);
  };
  const auto get = [&](std::uint64_t revision) {
    return ask(other, [&](v1::Request& request) { request.mutable_get_scene()->set_revision(revision); })
        .scene()
        .revision();
  };
  ask(other, edit);
  EXPECT_THROW(get(1), client::NotFound);
  Recorder recorder(daemon);
  const v1::SceneDescription third = recorder.record_while(other, edit).scene();
  EXPECT_EQ(third.revision(), 3u);
  EXPECT_EQ(third.carry().from_revision(), 2u);
  EXPECT_EQ(get(2), 2u);
  EXPECT_EQ(get(3), 3u);
  EXPECT_THROW(get(1), client::NotFound);
}

}  // namespace
}  // namespace haptic
