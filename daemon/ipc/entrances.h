#pragma once
// The ways in: sockets that listen where the config says, and for each client that comes through one, whom
// the rules of that one take it for. io thread, where nothing else is said.

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ipc/peer.h"
#include "ipc/server_settings.h"
#include "ipc/stream.h"

namespace haptic::ipc {

class Entrances {
 public:
  /// Who has come in. `assess` tells who it is by the rules of the moment in which it is called, as long as
  /// the entrances are there.
  using OnClient = std::function<void(std::shared_ptr<Stream> stream, std::function<Peer()> assess)>;

  /// Opens all that the settings name, and lets nobody in yet. The settings must outlive it; their limits are
  /// read anew for each client. Throws ListenError, also for a passed socket that no entry of the config
  /// names.
  Entrances(boost::asio::io_context& io, const ServerSettings& settings, OnClient on_client);
  ~Entrances();
  Entrances(const Entrances&) = delete;
  Entrances& operator=(const Entrances&) = delete;

  void open();
  void close();

  /// Reads what another config says of the entrances that are there: certificates, and who may come in.
  /// Nothing has changed until what it gives is called on the io thread. Any thread. Throws ListenError.
  std::function<void()> prepare(const std::vector<v1::Listen>& listen);

  /// As clients name them, with the port that was given. Any thread.
  const std::vector<std::string>& addresses() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptic::ipc
