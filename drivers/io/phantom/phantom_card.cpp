#include "drivers/io/phantom/phantom_card.h"

#include <fcntl.h>
#include <linux/phantom.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "drivers/device_error.h"

namespace haptic::drivers::io {

namespace {

[[noreturn]] void refuse(const std::string& path, int error) {
  if (error == ENOENT || error == ENXIO || error == ENODEV) {
    throw DeviceAbsent(path +
                       ": no such card; is the kernel's module \"phantom\" loaded (modprobe phantom)?");
  }
  if (error == EINVAL) throw DeviceError(path + ": another program has it open");
  throw DeviceError(path + ": " + std::generic_category().message(error));
}

/// `arguments` is one pointer, or nothing.
template <class... Arguments>
void call(const std::string& path, int file, unsigned long request, Arguments... arguments) {
  int result = 0;
  do {
    result = ::ioctl(file, request, arguments...);
  } while (result < 0 && errno == EINTR);
  if (result < 0) throw DeviceError(path + ": " + std::generic_category().message(errno));
}

}  // namespace

PhantomCard::PhantomCard(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (file_ < 0) refuse(path, errno);
}

PhantomCard::~PhantomCard() { ::close(file_); }

void PhantomCard::hold_outputs() { call(path_, file_, PHN_NOT_OH); }

void PhantomCard::start() {
  phm_reg control{.reg = PHN_CONTROL, .value = PHN_CTL_IRQ};
  call(path_, file_, PHN_SETREG, &control);
}

void PhantomCard::stop() {
  phm_reg control{.reg = PHN_CONTROL, .value = 0};
  call(path_, file_, PHN_SETREG, &control);
}

bool PhantomCard::wait(std::chrono::milliseconds timeout) {
  pollfd interrupt{.fd = file_, .events = POLLIN, .revents = 0};
  const int ready = ::poll(&interrupt, 1, static_cast<int>(timeout.count()));
  if (ready < 0 && errno != EINTR) throw DeviceError(path_ + ": " + std::generic_category().message(errno));
  if (ready <= 0) return false;
  if ((interrupt.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0)
    throw DeviceError(path_ + ": it does not run");
  return (interrupt.revents & POLLIN) != 0;
}

Registers PhantomCard::read(RegisterMask mask) {
  phm_regs registers{.count = 8, .mask = mask, .values = {}};
  call(path_, file_, PHN_GETREGS, &registers);
  Registers values{};
  std::copy(std::begin(registers.values), std::end(registers.values), values.begin());
  return values;
}

void PhantomCard::write(RegisterMask mask, const Registers& values) {
  phm_regs registers{.count = 8, .mask = mask, .values = {}};
  std::copy(values.begin(), values.end(), std::begin(registers.values));
  call(path_, file_, PHN_SETREGS, &registers);
}

}  // namespace haptic::drivers::io
