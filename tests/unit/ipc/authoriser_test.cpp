#include "ipc/authoriser.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace haptic::ipc {
namespace {

constexpr uid_t kOwner = 1000;
constexpr uid_t kStranger = 1001;
constexpr gid_t kViewers = 70;
constexpr gid_t kDrivers = 71;

const Authoriser& example() {
  static const Authoriser kAuthoriser(kOwner, {{kViewers, v1::OBSERVE}, {kDrivers, v1::DRIVE}});
  return kAuthoriser;
}

TEST(Authoriser, MakesRootAndTheOwnerAdmin) {
  EXPECT_EQ(example().role_of({.user = 0}, {}), v1::ADMIN);
  EXPECT_EQ(example().role_of({.user = kOwner}, {}), v1::ADMIN);
}

TEST(Authoriser, GivesTheHighestRoleOfThePeersGroups) {
  EXPECT_EQ(example().role_of({.user = kStranger}, {5, kViewers}), v1::OBSERVE);
  EXPECT_EQ(example().role_of({.user = kStranger}, {kViewers, kDrivers}), v1::DRIVE);
  EXPECT_EQ(example().role_of({.user = kStranger}, {kDrivers, kViewers}), v1::DRIVE);
}

TEST(Authoriser, RefusesWhoIsInNoGroup) {
  EXPECT_EQ(example().role_of({.user = kStranger}, {5, 6}), std::nullopt);
  EXPECT_EQ(example().role_of({.user = kStranger}, {}), std::nullopt);
}

TEST(Authoriser, RefusesAGroupThatIsNotThere) {
  v1::Listen::Unix config;
  config.add_allow()->set_group("no-such-group");
  config.mutable_allow(0)->set_role(v1::OBSERVE);
  try {
    Authoriser::from_config(config);
    FAIL() << "accepted an unknown group";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "listen.unix.allow: there is no group \"no-such-group\"");
  }
}

TEST(Authoriser, RefusesAGroupWithoutARole) {
  v1::Listen::Unix config;
  config.add_allow()->set_group("root");
  EXPECT_THROW(Authoriser::from_config(config), std::runtime_error);
}

TEST(Authoriser, FindsTheGroupsOfTheConfig) {
  v1::Listen::Unix config;
  config.add_allow()->set_group("root");
  config.mutable_allow(0)->set_role(v1::SCRIPT);
  const Authoriser authoriser = Authoriser::from_config(config);
  ASSERT_EQ(authoriser.entries().size(), 1U);
  EXPECT_EQ(authoriser.entries()[0].group, 0U);
}

TEST(PeerCredentials, AreThoseOfTheProcessAtTheOtherEnd) {
  int pair[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  const auto peer = peer_credentials(pair[0]);
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->user, ::geteuid());
  EXPECT_EQ(peer->process, ::getpid());
  ::close(pair[0]);
  ::close(pair[1]);
}

TEST(GroupsOf, HoldTheGroupThatThePeerRunsUnder) {
  const std::vector<gid_t> groups = groups_of({.user = 4'000'000'000, .group = 77});
  EXPECT_EQ(groups, (std::vector<gid_t>{77}));
  // "daemon" (uid 1) is in the group of its name on every Debian system
  const std::vector<gid_t> of_daemon = groups_of({.user = 1, .group = 1});
  EXPECT_NE(std::find(of_daemon.begin(), of_daemon.end(), 1U), of_daemon.end());
}

}  // namespace
}  // namespace haptic::ipc
