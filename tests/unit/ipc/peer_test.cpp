#include "ipc/peer.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

std::vector<v1::Listen::AllowName> allow() {
  std::vector<v1::Listen::AllowName> entries;
  const auto add = [&](const char* name, v1::Role role) {
    v1::Listen::AllowName& entry = entries.emplace_back();
    entry.set_name(name);
    entry.set_role(role);
  };
  add("alice", v1::DRIVE);
  add("bob", v1::OBSERVE);
  add("lab.example", v1::SCRIPT);
  return entries;
}

TEST(CertifiedPeer, HasTheRoleOfItsExactName) {
  EXPECT_EQ(certified_peer({"alice"}, allow()).role, v1::DRIVE);
  EXPECT_EQ(certified_peer({"bob"}, allow()).role, v1::OBSERVE);
  for (const char* name : {"Alice", "alice ", " alice", "alic", "alicee", "alice.lab.example", "*", ""}) {
    EXPECT_FALSE(certified_peer({name}, allow()).role) << name;
  }
}

TEST(CertifiedPeer, HasTheHighestRoleOfItsNames) {
  const Peer peer = certified_peer({"bob", "lab.example"}, allow());
  EXPECT_EQ(peer.role, v1::SCRIPT);
  EXPECT_EQ(peer.name, "lab.example");
}

TEST(CertifiedPeer, IsToldWhyItIsRefused) {
  EXPECT_EQ(
      certified_peer({"mallory"}, allow()).refusal,
      "the certificate of \"mallory\" may not use this daemon; its config allows names in listen.tcp.allow");
  EXPECT_FALSE(certified_peer({}, allow()).role);
}

TEST(UnknownPeer, OnlyObserves) { EXPECT_EQ(unknown_peer().role, v1::OBSERVE); }

}  // namespace
}  // namespace haptic::ipc
