#pragma once
// From a scene that somebody asks for to one that the servo thread can run, with what is told about it.

#include <memory>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "ipc/services.h"
#include "load/scene_file.h"

namespace haptic {

class SceneBuilder {
 public:
  /// `devices` are the names in the order of the device set.
  SceneBuilder(v1::Capacity capacity, std::vector<std::string> devices);

  /// The scene of a file; an empty scene if `file` is empty. Its description names mesh files by their whole
  /// paths: whoever saves it elsewhere can load it again. Throws load::LoadError.
  ipc::BuiltScene from_file(const std::string& file) const;

  /// What a client asks for. Throws ipc::SceneError. Any thread.
  ipc::BuiltScene from_request(const v1::LoadScene& request) const;

  /// The scene that runs with a client's edits done; it takes over what they leave alone. Shapes that are in
  /// the running scene already cost nothing. Throws ipc::SceneError. Any thread.
  ipc::BuiltScene from_edit(const v1::EditScene& request, const ipc::RunningScene& running) const;

 private:
  ipc::BuiltScene finish(const std::shared_ptr<const load::LoadedScene>& loaded) const;

  v1::Capacity capacity_;
  std::vector<std::string> devices_;
};

}  // namespace haptic
