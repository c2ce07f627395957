#include "proto/plain_text.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

TEST(PlainText, TakesWellFormedUtf8) {
  for (const char* text : {"", "atlas-client", "Schlo\xC3\x9F", "\xE2\x82\xAC", "\xF0\x9F\x98\x80"}) {
    EXPECT_TRUE(is_plain_text(text)) << text;
    EXPECT_EQ(to_plain_text(text, 100), text);
  }
}

TEST(PlainText, RefusesControlsAndIllFormedOctets) {
  for (const char* text :
       {"a\nb", "\x1B[2J", "\x7F", "\xC2\x85", "\xFF", "\x80", "\xC3", "\xC0\xAF", "\xE0\x80\xAF",
        "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF0\x9F\x98", "\xF5\x80\x80\x80"}) {
    EXPECT_FALSE(is_plain_text(text)) << text;
    EXPECT_TRUE(is_plain_text(to_plain_text(text, 100)));
  }
  EXPECT_FALSE(is_plain_text(std::string("a\0b", 3)));
}

TEST(PlainText, IsMadeByReplacingAndCutting) {
  EXPECT_EQ(to_plain_text("a\r\nb\xFF"
                          "c",
                          100),
            "a  b?c");
  EXPECT_EQ(to_plain_text("ab\xC3\x9F", 4), "ab\xC3\x9F");
  EXPECT_EQ(to_plain_text("ab\xC3\x9F", 3), "ab");
}

}  // namespace
}  // namespace atlaswire::proto
