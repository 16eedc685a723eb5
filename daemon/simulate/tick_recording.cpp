#include "simulate/tick_recording.h"

#include "ipc/convert.h"
#include "ipc/encode.h"
#include "load/describe_scene.h"
#include "load/embedded_mesh.h"
#include "load/state_message.h"
#include "proto/csv/csv_file.h"
#include "proto/recording/error.h"

namespace haptic::simulate {
namespace {

// what a viewer cannot make of the scene's own words
std::vector<view::Surface> surfaces_of(const load::LoadedScene& loaded) {
  std::vector<view::Surface> surfaces(loaded.scene.objects.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (!loaded.message.object(static_cast<int>(i)).shape().has_mesh()) continue;
    const engine::Object& object = loaded.scene.objects[i];
    view::Surface& surface = surfaces[i];
    std::vector<std::uint32_t> number(object.cells->vertices().size(), engine::kNone);
    for (const engine::Index face : load::surface_faces(object)) {
      for (const engine::Index vertex : object.cells->rims()[face].vertices) {
        if (number[vertex] == engine::kNone) {
          number[vertex] = static_cast<std::uint32_t>(surface.points.size() / 3);
          const glm::dvec3& point = object.cells->vertices()[vertex];
          surface.points.insert(surface.points.end(), {point.x, point.y, point.z});
        }
        surface.indices.push_back(number[vertex]);
      }
    }
  }
  return surfaces;
}

// what goes wrong with the file, as the other files of a run tell it
template <class Do>
void or_output_error(Do action) {
  try {
    action();
  } catch (const recording::IoError& error) {
    throw csv::OutputError(error.what());
  }
}

}  // namespace

TickRecording::TickRecording(const std::string& path, const load::LoadedScene& scene, double rate_hz,
                             std::span<const std::string> devices)
    : rate_hz_(rate_hz) {
  using recording::FileSink;
  v1::DeviceList list;
  devices_.reserve(devices.size());
  for (const std::string& name : devices) {
    devices_.emplace_back().set_name(name);
    *list.add_device()->mutable_description() = devices_.back();
  }
  or_output_error([&] {
    sink_ = std::make_unique<FileSink>(path, FileSink::IfThere::kReplace, FileSink::Durable::kNo);
    writer_ = std::make_unique<recording::SessionWriter>(
        *sink_, recording::Session{.program = "hapticd simulate " HAPTIC_VERSION,
                                   .daemon_version = HAPTIC_VERSION,
                                   .rate_hz = rate_hz});
    v1::SceneDescription description = load::describe(scene);
    description.set_revision(1);
    load::embed_meshes(*description.mutable_scene(), scene.scene);
    writer_->write(list, 0);
    writer_->write(description, 0, surfaces_of(scene));
  });
}

void TickRecording::write(const servo::Snapshot& snapshot) {
  ipc::fill_frame(snapshot, ipc::kTickTopics, ipc::Selection{}, 0, frame_);
  frame_.set_sequence(++sequence_);
  or_output_error([&] { writer_->write(frame_); });
}

void TickRecording::write(const engine::State& state, const servo::Snapshot& snapshot) {
  v1::WorldState message;
  message.set_tick(snapshot.tick);
  message.set_scene_revision(snapshot.scene_revision);
  message.set_rate_hz(rate_hz_);
  for (const v1::DeviceDescription& device : devices_) message.add_device(device.name());
  load::write_state(state, message);
  or_output_error([&] { writer_->write(message, snapshot.monotonic_ns); });
}

void TickRecording::write(const safety::Fault& fault, std::uint64_t time_ns) {
  frame_.Clear();
  frame_.set_sequence(++sequence_);
  frame_.set_tick(fault.tick);
  frame_.set_monotonic_ns(time_ns);
  frame_.set_realtime_ns(time_ns);
  frame_.set_scene_revision(1);
  v1::Event& event = *frame_.mutable_event();
  event.set_tick(fault.tick);
  event.set_kind(v1::Event::FAULT_LATCHED);
  *event.mutable_fault() = ipc::to_wire(fault, devices_);
  event.set_message("fault latched: " + ipc::in_words(event.fault()));
  or_output_error([&] { writer_->write(frame_); });
}

void TickRecording::close() {
  or_output_error([&] {
    writer_->close();
    sink_->close();
  });
}

}  // namespace haptic::simulate
