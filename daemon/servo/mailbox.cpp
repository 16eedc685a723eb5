#include "servo/mailbox.h"

#include <algorithm>
#include <memory>

namespace haptic::servo {

namespace {

void clear(Snapshot& snapshot) noexcept {
  snapshot.objects.clear();
  snapshot.hips.clear();
  snapshot.contacts.clear();
  snapshot.devices.clear();
}

}  // namespace

SnapshotRing::SnapshotRing(const Capacity& capacity) : buffers_(kSlots + 2) {
  for (Buffer& buffer : buffers_) {
    buffer.objects.reserve(capacity.objects);
    buffer.hips.reserve(capacity.hips);
    buffer.contacts.reserve(capacity.contacts);
    buffer.devices.reserve(capacity.devices);
    returned_.push(&buffer);
  }
  returned_.pop(spare_);
}

void SnapshotRing::publish() noexcept {
  const std::uint64_t number = published_.load(std::memory_order_relaxed);
  spare_->number = number;
  Buffer* const unread = slots_[number % kSlots].exchange(spare_, std::memory_order_acq_rel);
  if (unread != nullptr) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    spare_ = unread;
  } else {
    returned_.pop(spare_);
  }
  published_.store(number + 1, std::memory_order_release);
  clear(*spare_);
}

const Snapshot* SnapshotRing::take() noexcept {
  if (taken_ != nullptr) returned_.push(taken_);
  taken_ = nullptr;
  const std::uint64_t published = published_.load(std::memory_order_acquire);
  // the writer has taken back whatever lies a whole ring behind it
  if (published > kSlots) next_read_ = std::max(next_read_, published - kSlots);
  while (next_read_ < published) {
    Buffer* const buffer = slots_[next_read_ % kSlots].exchange(nullptr, std::memory_order_acq_rel);
    ++next_read_;
    if (buffer == nullptr) continue;
    // had the writer come round meanwhile, the others in the ring are older than this one; it finds and
    // counts them on its next round
    next_read_ = buffer->number + 1;
    taken_ = buffer;
    return taken_;
  }
  return nullptr;
}

Mailbox::~Mailbox() {
  commands.consume_all([](const Command& command) {
    delete command.scene;
    delete command.copy;
  });
  events.consume_all([](const Event& event) {
    delete event.scene;
    delete event.copy;
  });
}

}  // namespace haptic::servo
