#include "tests/support/phantom_mock.h"

#include <fcntl.h>
#include <linux/phantom.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>

namespace haptic::test {

namespace {

constexpr const char* kNode = "/dev/phantom0";
constexpr const char* kSysPath = "/devices/pci0000:00/0000:05:00.0/phantom/phantom0";
constexpr std::chrono::milliseconds kPeriod{2};

}  // namespace

struct PhantomMock::Impl {
  explicit Impl(MockBus& on) : bus(on) {}

  MockBus& bus;
  UMockdevIoctlBase* handler = nullptr;
  std::array<gulong, 2> signals{};
  int fifo = -1;

  mutable std::mutex mutex;
  PhantomState state;
  const void* owner = nullptr;  // who has it open
  bool holds_outputs = false;
  phm_regs held{};
  std::uint32_t held_control = 0;
  std::array<std::uint32_t, 8> inputs{};
  std::uint64_t pending = 0;  // interrupts since the last read of registers
  bool interrupts_come = true;
  bool gone = false;
  std::chrono::milliseconds delay{0};

  std::atomic<bool> ends{false};
  std::thread interrupts;

  void plug_in();
  void release();
  void apply(const phm_regs& registers);
  void interrupt();
  void drain() const;
  long set_register(const phm_reg& wanted);
  void get_registers(phm_regs& registers);
  void answer(UMockdevIoctlClient* client);

  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  static void on_vanished(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
};

void PhantomMock::Impl::plug_in() {
  bus.add(std::string("P: ") + kSysPath +
          "\nN: phantom0\nE: DEVNAME=/dev/phantom0\nE: SUBSYSTEM=phantom\nE: MAJOR=240\nE: MINOR=0\n");
  const std::string path = bus.real_path(kNode);
  ::unlink(path.c_str());
  if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no FIFO for the card's node");
  fifo = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fifo < 0) throw std::runtime_error("the card's node cannot be opened");
  handler = umockdev_ioctl_base_new();
  signals = {g_signal_connect(handler, "handle-ioctl", G_CALLBACK(&Impl::on_ioctl), this),
             g_signal_connect(handler, "client-vanished", G_CALLBACK(&Impl::on_vanished), this)};
  bus.attach(kNode, handler);
  interrupts = std::thread([this] {
    while (!ends) {
      std::this_thread::sleep_for(kPeriod);
      const std::lock_guard lock(mutex);
      interrupt();
    }
  });
}

void PhantomMock::Impl::release() {
  owner = nullptr;
  state.is_open = false;
  state.is_running = false;
  holds_outputs = false;
}

void PhantomMock::Impl::apply(const phm_regs& registers) {
  const std::array<std::uint32_t, 8> before = state.outputs;
  for (std::size_t i = 0; i < std::min<std::size_t>(registers.count, 8); ++i) {
    if ((registers.mask >> i & 1U) != 0) state.outputs[i] = registers.values[i];
  }
  if (before != state.outputs) {
    state.motors.push_back({state.outputs[0], state.outputs[1], state.outputs[2]});
  }
}

void PhantomMock::Impl::interrupt() {
  if (!state.is_running || !interrupts_come) return;
  if (holds_outputs) {
    apply(held);
    held_control ^= PHN_CTL_AMP;
    state.control = held_control;
    ++state.amp_toggles;
  }
  const char byte = 0;
  if (pending++ == 0 && ::write(fifo, &byte, 1) != 1) throw std::runtime_error("no interrupt can be sent");
}

void PhantomMock::Impl::drain() const {
  std::array<char, 16> bytes{};
  while (::read(fifo, bytes.data(), bytes.size()) > 0) {
  }
}

long PhantomMock::Impl::set_register(const phm_reg& wanted) {
  if (wanted.reg != PHN_CONTROL) return 0;  // written to input space, to no effect here
  std::uint32_t value = wanted.value;
  if ((value & PHN_CTL_IRQ) != 0 && !state.is_running) {
    state.is_running = true;
    pending = 0;
    drain();
  }
  if (holds_outputs) {
    value = (value & ~std::uint32_t{PHN_CTL_AMP}) | (held_control & PHN_CTL_AMP);
    held_control = value;
  }
  state.control = value;
  if ((value & PHN_CTL_IRQ) == 0) state.is_running = false;
  return 0;
}

void PhantomMock::Impl::get_registers(phm_regs& registers) {
  for (std::size_t i = 0; i < 8; ++i) {
    if ((registers.mask >> i & 1U) != 0) registers.values[i] = inputs[i];
  }
  state.read_mask |= registers.mask;
  pending = 0;
  drain();
}

void PhantomMock::Impl::answer(UMockdevIoctlClient* client) {
  if (owner != client) {
    release();  // that the last one has closed it may not have been told yet
    owner = client;
    state.is_open = true;
  }
  ++state.ioctls;
  if (gone) return umockdev_ioctl_client_complete(client, -1, ENODEV);
  const gulong request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  if (request == PHN_NOT_OH) {
    if (state.is_running) return umockdev_ioctl_client_complete(client, -1, EINVAL);
    holds_outputs = true;
    return umockdev_ioctl_client_complete(client, 0, 0);
  }
  if (request == PHN_SETREG) {
    UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof(phm_reg), nullptr);
    phm_reg wanted{};
    std::memcpy(&wanted, data->data, sizeof wanted);
    umockdev_ioctl_client_complete(client, set_register(wanted), 0);
    return g_object_unref(data);
  }
  if (request != PHN_GETREGS && request != PHN_SETREGS) {
    return umockdev_ioctl_client_complete(client, -1, ENOTTY);
  }
  UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof(phm_regs), nullptr);
  phm_regs registers{};
  std::memcpy(&registers, data->data, sizeof registers);
  if (request == PHN_GETREGS) {
    get_registers(registers);
    std::memcpy(data->data, &registers, sizeof registers);
  } else {
    ++state.writes;
    if (holds_outputs) {
      held = registers;
    } else {
      apply(registers);
    }
  }
  umockdev_ioctl_client_complete(client, 0, 0);
  g_object_unref(data);
}

gboolean PhantomMock::Impl::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                                     gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  std::chrono::milliseconds delay{0};
  {
    const std::lock_guard lock(mock.mutex);
    std::swap(delay, mock.delay);
  }
  std::this_thread::sleep_for(delay);
  const std::lock_guard lock(mock.mutex);
  mock.answer(client);
  return TRUE;
}

void PhantomMock::Impl::on_vanished(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  Impl& mock = *static_cast<Impl*>(self);
  const std::lock_guard lock(mock.mutex);
  if (mock.owner == client) mock.release();
}

PhantomMock::PhantomMock(MockBus& bus) : impl_(std::make_unique<Impl>(bus)) { impl_->plug_in(); }

PhantomMock::~PhantomMock() {
  impl_->ends = true;
  impl_->interrupts.join();
  for (const gulong signal : impl_->signals) g_signal_handler_disconnect(impl_->handler, signal);
  umockdev_testbed_detach_ioctl(impl_->bus.testbed(), kNode, nullptr);
  umockdev_testbed_remove_device(impl_->bus.testbed(), (std::string("/sys") + kSysPath).c_str());
  g_object_unref(impl_->handler);
  ::close(impl_->fifo);
}

PhantomState PhantomMock::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state;
}

void PhantomMock::set_input(std::size_t index, std::uint32_t value) {
  const std::lock_guard lock(impl_->mutex);
  impl_->inputs.at(index) = value;
}

void PhantomMock::leave_behind(const std::array<std::uint32_t, 8>& outputs) {
  const std::lock_guard lock(impl_->mutex);
  impl_->held.count = 8;
  impl_->held.mask = 0xff;
  std::copy(outputs.begin(), outputs.end(), std::begin(impl_->held.values));
  impl_->state.outputs = outputs;
}

void PhantomMock::set_interrupts(bool come) {
  const std::lock_guard lock(impl_->mutex);
  impl_->interrupts_come = come;
}

void PhantomMock::delay_next(std::chrono::milliseconds delay) {
  const std::lock_guard lock(impl_->mutex);
  impl_->delay = delay;
}

void PhantomMock::unplug() {
  const std::lock_guard lock(impl_->mutex);
  impl_->gone = true;
}

}  // namespace haptic::test
