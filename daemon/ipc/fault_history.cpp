#include "ipc/fault_history.h"

namespace haptic::ipc {

std::uint64_t FaultHistory::add(const v1::Fault& fault, std::uint64_t monotonic_ns,
                                std::uint64_t realtime_ns) {
  if (list_.fault_size() == kKept) list_.mutable_fault()->DeleteSubrange(0, 1);
  v1::FaultList::FaultRecord& record = *list_.add_fault();
  *record.mutable_fault() = fault;
  record.set_monotonic_ns(monotonic_ns);
  record.set_realtime_ns(realtime_ns);
  record.set_latched(true);
  ++counts_[fault.kind()];
  return ++last_;
}

void FaultHistory::clear() {
  for (v1::FaultList::FaultRecord& record : *list_.mutable_fault()) record.set_latched(false);
}

void FaultHistory::set_recording(const std::vector<std::uint64_t>& faults, const std::string& path) {
  const auto size = static_cast<std::uint64_t>(list_.fault_size());
  for (const std::uint64_t number : faults) {
    // older ones are no longer kept
    if (number > last_ || last_ - number >= size) continue;
    list_.mutable_fault(static_cast<int>(size - 1 - (last_ - number)))->set_recording(path);
  }
}

}  // namespace haptic::ipc
