#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "client/bridge/subject.h"

namespace haptic::bridge {
namespace {

TEST(Subject, MakesAHostOneToken) {
  EXPECT_EQ(subject("lab-3", "objects"), "haptic.lab-3.objects");
  EXPECT_EQ(subject("lab.example.org", "hips"), "haptic.lab_example_org.hips");
  EXPECT_EQ(host_token("a b*c>d\te\xc3\xa4\r\nPUB"), "a_b_c_d_e____PUB");
  EXPECT_EQ(host_token(std::string(1000, 'a')).size(), kHostLimit);
}

TEST(Subject, NamesEachTopicOfTheSchema) {
  const google::protobuf::EnumDescriptor* const topics = v1::Topic_descriptor();
  for (int i = 0; i < topics->value_count(); ++i) {
    std::string name = topics->value(i)->name();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto topic = static_cast<v1::Topic>(topics->value(i)->number());
    EXPECT_EQ(topic_name(topic), topic == v1::TOPIC_UNSPECIFIED ? "" : name);
  }
}

TEST(Subject, TakesWhatIsAUrlOfABroker) {
  for (const char* const url :
       {"nats://127.0.0.1:4222", "tls://broker.example", "broker", "broker:4222", "nats://u:p@broker:1",
        "nats://[::1]:4222", "[::1]", "nats://token@broker:65535"}) {
    EXPECT_EQ(url_problem(url), "") << url;
  }
}

TEST(Subject, TellsWhatIsWrongWithAUrl) {
  EXPECT_EQ(url_problem("http://broker"), "its scheme is neither nats nor tls");
  for (const char* const url : {"", "nats://", "nats://u:p@", ":4222", "[]:1", "::1"}) {
    EXPECT_EQ(url_problem(url), "it has no host") << url;
  }
  for (const char* const url : {"broker:", "broker:0", "broker:65536", "broker:4a", "broker:-1", "[::1]4222",
                                "broker:999999999999999999999"}) {
    EXPECT_EQ(url_problem(url), "its port is no number from 1 to 65535") << url;
  }
  for (const char* const url : {"nats://a b", "a\nb", "a,b", "br\xc3\xb6ker"}) {
    EXPECT_EQ(url_problem(url), "it has a character that no URL has") << url;
  }
  EXPECT_EQ(url_problem("nats://[::1"), "its bracket is not closed");
  EXPECT_EQ(url_problem("nats://broker/path"), "it has more than host and port");
}

TEST(Subject, KeepsUserAndPasswordOutOfLogs) {
  EXPECT_EQ(without_secrets("nats://user:secret@broker:4222"), "nats://broker:4222");
  EXPECT_EQ(without_secrets("user:se@cret@broker"), "broker");
  EXPECT_EQ(without_secrets("nats://broker:4222"), "nats://broker:4222");
}

}  // namespace
}  // namespace haptic::bridge
