#include "log/fields.h"

#include <iterator>

namespace haptic::log {

namespace {

FieldList& of_this_thread() noexcept {
  thread_local FieldList fields;
  return fields;
}

}  // namespace

Fields::Fields(FieldList fields) : before_(of_this_thread().size()) {
  FieldList& all = of_this_thread();
  all.insert(all.end(), std::make_move_iterator(fields.begin()), std::make_move_iterator(fields.end()));
}

Fields::~Fields() { of_this_thread().resize(before_); }

const FieldList& current_fields() noexcept { return of_this_thread(); }

}  // namespace haptic::log
