#include "ipc/scene_store.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "load/embedded_mesh.h"

namespace haptic::ipc {

namespace {

// for who records all scenes, while one is loaded after the other
constexpr std::size_t kScenesKept = 8;

// of the meshes that come from files, as they are embedded
std::size_t mesh_bytes(const v1::SceneDescription& description) {
  constexpr std::size_t kVertexBytes = 3 * sizeof(double);
  constexpr std::size_t kCellBytes = 4 * 3 + 1;  // numbers of vertices of some three bytes, and a tag
  std::size_t bytes = 0;
  for (int i = 0; i < description.object_size() && i < description.scene().object_size(); ++i) {
    if (!description.scene().object(i).shape().has_mesh()) {
      continue;
    }
    bytes += description.object(i).vertices() * kVertexBytes + description.object(i).cells() * kCellBytes;
  }
  return bytes;
}

}  // namespace

SceneStore::SceneStore(Services& services, ServoLink& servo)
    : services_(services),
      servo_(servo),
      current_(services.scene),
      running_(services.running ? services.running : std::make_shared<const engine::Scene>()),
      last_revision_(services.scene.revision()) {}

void SceneStore::load(const v1::LoadScene& request, Reply reply) {
  if (request.source_case() == v1::LoadScene::SOURCE_NOT_SET) {
    reply.fail(v1::Error::INVALID, "load_scene needs a scene or a path");
    return;
  }
  if (is_busy(reply)) {
    return;
  }
  build([make = services_.build_scene, request] { return make(request); }, std::move(reply));
}

void SceneStore::edit(const v1::EditScene& request, Reply reply) {
  if (is_busy(reply)) {
    return;
  }
  if (request.expected_revision() != 0 && request.expected_revision() != current_.revision()) {
    v1::Error error = make_error(v1::Error::BUSY, "revision " + std::to_string(current_.revision()) +
                                                      " of the scene runs; look at it and try again");
    error.set_field("expected_revision");
    reply.fail(std::move(error));
    return;
  }
  RunningScene running{current_.scene(), running_, current_.revision()};
  build(
      [make = services_.edit_scene, request, running = std::move(running)] { return make(request, running); },
      std::move(reply));
}

bool SceneStore::is_busy(const Reply& reply) const {
  if (!building_.valid() && !next_) {
    return false;
  }
  reply.fail(v1::Error::BUSY, "another scene is being loaded; try again");
  return true;
}

void SceneStore::build(std::function<BuiltScene()> make, Reply reply) {
  reply_ = std::move(reply);
  building_ = std::async(std::launch::async, std::move(make));
}

void SceneStore::poll(SteadyClock::time_point now) {
  if (!building_.valid() || building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  try {
    swap(building_.get(), now);
  } catch (const SceneError& error) {
    reply_->fail(error.wire);
  } catch (const std::bad_alloc&) {
    reply_->fail(v1::Error::FAILED, "there is not enough memory for this scene");
  } catch (const std::exception& error) {
    reply_->fail(v1::Error::FAILED, error.what());
  }
}

void SceneStore::swap(BuiltScene built, SteadyClock::time_point now) {
  built.prepared->revision = ++last_revision_;
  built.description.set_revision(last_revision_);
  std::shared_ptr<const engine::Scene> running = built.prepared->world.shared_scene();
  servo::Command command;
  command.kind = servo::CommandKind::kSwapScene;
  command.scene = built.prepared.get();
  const bool sent = servo_.submit(command, now, [this, reply = *reply_](Outcome outcome) {
    if (outcome == Outcome::kDone) {
      v1::Response response;
      *response.mutable_scene() = current_;
      reply.send(std::move(response));
    } else if (outcome == Outcome::kOutdated) {
      reply.fail(v1::Error::BUSY, "another scene runs than the one that was edited; try again");
    } else {
      reply.fail(v1::Error::FAILED, "the servo thread has not taken the scene");
    }
  });
  if (!sent) {
    reply_->fail(v1::Error::BUSY, "the servo thread has too many commands waiting; try again");
    return;
  }
  static_cast<void>(built.prepared.release());  // the command holds it
  next_running_ = std::move(running);
  next_ = std::move(built.description);
}

void SceneStore::describe(const v1::GetScene& request, std::size_t most_bytes, const Reply& reply) const {
  const v1::SceneDescription* description = &current_;
  const engine::Scene* scene = running_.get();
  if (request.revision() != 0 && request.revision() != current_.revision()) {
    const auto kept = std::find_if(before_.begin(), before_.end(), [&](const Kept& entry) {
      return entry.description.revision() == request.revision();
    });
    if (kept == before_.end()) {
      reply.fail(v1::Error::NOT_FOUND,
                 "revision " + std::to_string(request.revision()) + " of the scene is not kept");
      return;
    }
    description = &kept->description;
    scene = kept->scene.get();
  }
  v1::Response response;
  *response.mutable_scene() = *description;
  if (request.embed_meshes()) {
    const std::size_t bytes = mesh_bytes(*description);
    if (bytes > most_bytes) {
      reply.fail(v1::Error::INVALID, "the meshes of the scene take about " + std::to_string(bytes) +
                                         " bytes, and an answer may have " + std::to_string(most_bytes) +
                                         " (limits.pending_control of the config)");
      return;
    }
    load::embed_meshes(*response.mutable_scene()->mutable_scene(), *scene);
  }
  reply.send(std::move(response));
}

void SceneStore::keep_scenes(bool keep) {
  keeps_scenes_ = keep;
  if (!keep) {
    before_.clear();
  }
}

void SceneStore::swapped(bool done) {
  if (done && next_) {
    if (keeps_scenes_) {
      before_.push_front({std::move(current_), std::move(running_)});
      before_.resize(std::min(before_.size(), kScenesKept));
    }
    current_ = std::move(*next_);
    running_ = std::move(next_running_);
  }
  next_.reset();
  next_running_.reset();
}

}  // namespace haptic::ipc
