#pragma once
// Changes inputs as their schema allows: random bytes seldom get past a parser, and what lies behind it wants
// trying, too. By reflection, so that it knows each field as soon as the schema has it.

#include <google/protobuf/message.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "haptic/v1/control.pb.h"

namespace haptic::fuzz {

using Random = std::minstd_rand;

/// Changes one thing somewhere in the message: sets a field to a likely or an extreme value, clears it, or
/// adds, doubles, swaps or removes an item.
void mutate(google::protobuf::Message& message, Random& random);

/// Mutates text format in place, as LLVMFuzzerCustomMutator does; returns the new size. 0: the text is no
/// such message, or there is no room.
std::size_t mutate_text(google::protobuf::Message& scratch, std::uint8_t* data, std::size_t size,
                        std::size_t max_size, Random& random);

/// Likewise a byte that chooses something, then framed envelopes.
std::size_t mutate_conversation(std::uint8_t* data, std::size_t size, std::size_t max_size, Random& random);

}  // namespace haptic::fuzz
