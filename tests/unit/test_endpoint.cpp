// Goal: what is no endpoint is refused before a socket makes another one of it. Oracle: the forms
// that base/endpoint.hpp names.

#include <string_view>

#include <gtest/gtest.h>

#include "base/endpoint.hpp"

namespace abut::endpoint_tests {
namespace {

TEST(Endpoint, HasAPathOrAPort) {
  for (const std::string_view right :
       {"ipc:///tmp/hub", "tcp://127.0.0.1:5555", "tcp://localhost:0", "tcp://*:65535",
        "tcp://[::1]:80", "tcp://127.0.0.1:*"})
    EXPECT_EQ(wrong_endpoint(right), "") << right;
}

TEST(Endpoint, IsRefusedInWords) {
  EXPECT_EQ(wrong_endpoint("udp://127.0.0.1:5555"), "begin with tcp:// or ipc://");
  EXPECT_EQ(wrong_endpoint("ipc://"), "name a path");
  EXPECT_EQ(wrong_endpoint("tcp://127.0.0.1"), "end with a port, as in tcp://127.0.0.1:5555");
  for (const std::string_view wrong : {"tcp://127.0.0.1:65536", "tcp://127.0.0.1:99999999999",
                                       "tcp://127.0.0.1:-1", "tcp://127.0.0.1:", "tcp://a:5x"})
    EXPECT_EQ(wrong_endpoint(wrong), "have a port from 0 to 65535") << wrong;
}

}  // namespace
}  // namespace abut::endpoint_tests
