#include "service/signals.h"

#include <utility>

namespace haptic::service {

Signals::Signals() noexcept {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  sigaddset(&set_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that is too large is an error as a full disk is
}

int Signals::wait() const noexcept {
  int signal = 0;
  sigwait(&set_, &signal);
  return signal;
}

SignalThread::SignalThread(const Signals& signals, std::function<void()> reload, std::function<void()> stop)
    : thread_([&signals, on_hangup = std::move(reload), on_end = std::move(stop)] {
        while (signals.wait() == SIGHUP) on_hangup();
        on_end();
      }) {}

SignalThread::~SignalThread() {
  pthread_kill(thread_.native_handle(), SIGINT);
  thread_.join();
}

}  // namespace haptic::service
