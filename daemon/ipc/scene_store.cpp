#include "ipc/scene_store.h"

#include <chrono>
#include <utility>

namespace haptic::ipc {

SceneStore::SceneStore(Services& services, ServoLink& servo)
    : services_(services),
      servo_(servo),
      current_(services.scene),
      last_revision_(services.scene.revision()) {}

void SceneStore::load(const v1::LoadScene& request, Reply reply) {
  if (request.source_case() == v1::LoadScene::SOURCE_NOT_SET) {
    reply.fail(v1::Error::INVALID, "load_scene needs a scene or a path");
    return;
  }
  if (building_.valid() || next_) {
    reply.fail(v1::Error::BUSY, "another scene is being loaded; try again");
    return;
  }
  reply_ = std::move(reply);
  building_ =
      std::async(std::launch::async, [build = services_.build_scene, request] { return build(request); });
}

void SceneStore::poll(SteadyClock::time_point now) {
  if (!building_.valid() || building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  try {
    swap(building_.get(), now);
  } catch (const SceneError& error) {
    reply_->fail(error.wire);
  } catch (const std::exception& error) {
    reply_->fail(v1::Error::FAILED, error.what());
  }
}

void SceneStore::swap(BuiltScene built, SteadyClock::time_point now) {
  built.prepared->revision = ++last_revision_;
  built.description.set_revision(last_revision_);
  servo::Command command;
  command.kind = servo::CommandKind::kSwapScene;
  command.scene = built.prepared.get();
  const bool sent = servo_.submit(command, now, [this, reply = *reply_](Outcome outcome) {
    if (outcome == Outcome::kDone) {
      v1::Response response;
      *response.mutable_scene() = current_;
      reply.send(std::move(response));
    } else {
      reply.fail(v1::Error::FAILED, "the servo thread has not taken the scene");
    }
  });
  if (!sent) {
    reply_->fail(v1::Error::BUSY, "the servo thread has too many commands waiting; try again");
    return;
  }
  static_cast<void>(built.prepared.release());  // the command holds it
  next_ = std::move(built.description);
}

void SceneStore::swapped(bool done) {
  if (done && next_) {
    current_ = std::move(*next_);
  }
  next_.reset();
}

}  // namespace haptic::ipc
