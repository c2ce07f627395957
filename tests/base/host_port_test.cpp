#include "base/host_port.h"

#include <gtest/gtest.h>

namespace atlaswire {
namespace {

TEST(HostPort, ReadsNamesAndAddresses) {
  const auto name = parse_host_port("example:80");
  ASSERT_TRUE(name.has_value());
  EXPECT_EQ(name->host, "example");
  EXPECT_EQ(name->port, 80);
  const auto six = parse_host_port("[::1]:7400");
  ASSERT_TRUE(six.has_value());
  EXPECT_EQ(six->host, "::1");
  EXPECT_EQ(to_string(*six), "[::1]:7400");
  EXPECT_EQ(to_string(*name), "example:80");
  EXPECT_EQ(parse_host_port("a:0")->port, 0);
  EXPECT_EQ(parse_host_port("a:65535")->port, 65535);
}

TEST(HostPort, RefusesAllElse) {
  for (const char* text : {"", ":", "a", "a:", ":80", "a:65536", "a:-1", "a:8o", "a: 80", "a:80 ", "80"}) {
    EXPECT_FALSE(parse_host_port(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace atlaswire
