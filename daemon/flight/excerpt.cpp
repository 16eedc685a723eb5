#include "flight/excerpt.h"

#include <algorithm>
#include <optional>
#include <set>

#include "load/embedded_mesh.h"

namespace haptic::flight {

namespace {

template <class Message>
bool parse(const Entry& entry, Message& message) {
  return message.ParseFromArray(entry.bytes.data(), static_cast<int>(entry.bytes.size()));
}

class ExcerptWriter {
 public:
  ExcerptWriter(const Excerpt& excerpt, recording::Sink& sink)
      : excerpt_(excerpt), writer_(sink, excerpt.session), begin_(excerpt.first_tick) {}

  void run() {
    const Entry* const start = find_start();
    if (start != nullptr) begin_ = start->tick + 1;
    find_time();
    writer_.write(excerpt_.devices, time_);
    if (start != nullptr) write_state(*start);
    for (const Entry& entry : excerpt_.entries) {
      if (entry.tick < begin_) continue;
      if (entry.kind == EntryKind::kState) {
        write_state(entry);
      } else {
        write_frame(entry);
      }
    }
    writer_.close();
  }

 private:
  // what has no time of its own has that of the first tick
  void find_time() {
    v1::Frame frame;
    for (const Entry& entry : excerpt_.entries) {
      if (entry.kind == EntryKind::kTick && entry.tick >= begin_ && parse(entry, frame)) {
        time_ = frame.realtime_ns();
        return;
      }
    }
  }

  /// The last state before the first tick whose scene is known; nullptr: there is none.
  const Entry* find_start() const {
    const auto is_start = [&](const Entry& entry) {
      v1::WorldState state;
      return entry.kind == EntryKind::kState && entry.tick < excerpt_.first_tick && parse(entry, state) &&
             find_scene(state.scene_revision()) != nullptr;
    };
    const auto found = std::find_if(excerpt_.entries.rbegin(), excerpt_.entries.rend(), is_start);
    return found == excerpt_.entries.rend() ? nullptr : &*found;
  }

  void write_state(const Entry& entry) {
    v1::WorldState state;
    if (parse(entry, state) && write_scene(state.scene_revision())) writer_.write(state, time_);
  }

  void write_frame(const Entry& entry) {
    if (!parse(entry, frame_)) return;
    for (const v1::InputsFrame::Command& command : frame_.inputs().command()) {
      if (command.kind() == v1::InputsFrame::SCENE) write_scene(command.scene_revision());
    }
    if (!write_scene(frame_.scene_revision())) return;
    frame_.set_sequence(entry.sequence);
    frame_.set_subscription(entry.subscription);
    tell_gap(entry);
    time_ = frame_.realtime_ns();
    writer_.write(frame_);
  }

  void tell_gap(const Entry& entry) {
    const bool follows = last_ && last_->subscription == entry.subscription;
    if (follows && entry.sequence > last_->sequence + 1) {
      v1::Gap gap;
      gap.set_subscription(entry.subscription);
      gap.set_first_sequence(last_->sequence + 1);
      gap.set_last_sequence(entry.sequence - 1);
      for (const v1::Topic topic : {v1::OBJECTS, v1::HIPS, v1::DEVICES, v1::INPUTS}) gap.add_topic(topic);
      gap.set_first_tick(last_tick_ + 1);
      gap.set_last_tick(std::max(last_tick_, entry.tick - std::min<std::uint64_t>(entry.tick, 1)));
      writer_.write(gap, time_);
    }
    last_ = entry;
    if (entry.kind == EntryKind::kTick) last_tick_ = entry.tick;
  }

  const KeptScene* find_scene(std::uint64_t revision) const {
    const auto found =
        std::find_if(excerpt_.scenes.begin(), excerpt_.scenes.end(),
                     [&](const KeptScene& scene) { return scene.told->revision() == revision; });
    return found == excerpt_.scenes.end() ? nullptr : &*found;
  }

  /// Once for each. False: it is not known.
  bool write_scene(std::uint64_t revision) {
    if (written_.contains(revision)) return true;
    const KeptScene* const scene = find_scene(revision);
    if (scene == nullptr) return false;
    v1::SceneDescription told = *scene->told;
    if (scene->built) load::embed_meshes(*told.mutable_scene(), *scene->built);
    writer_.write(told, time_);
    written_.insert(revision);
    return true;
  }

  const Excerpt& excerpt_;
  recording::SessionWriter writer_;
  std::uint64_t begin_;              // the first tick that is written
  std::uint64_t time_ = 0;           // of the last frame, ns
  std::set<std::uint64_t> written_;  // revisions of scenes
  std::optional<Entry> last_;        // frame
  std::uint64_t last_tick_ = 0;
  v1::Frame frame_;  // kept for its memory
};

}  // namespace

void write(const Excerpt& excerpt, recording::Sink& sink) { ExcerptWriter(excerpt, sink).run(); }

}  // namespace haptic::flight
