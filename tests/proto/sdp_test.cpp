#include "proto/sdp.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

TEST(Sdp, GoldenText) {
  SdpSettings settings;
  settings.port = 5004;
  settings.ssrc = 1234;
  settings.parameter_sets = test::from_hex("00000001 6742c01e d9 00000001 68ce3c80");
  EXPECT_EQ(
      make_sdp(settings),
      "v=0\r\n"
      "o=- 1234 1 IN IP4 127.0.0.1\r\n"
      "s=atlaswire\r\n"
      "c=IN IP4 127.0.0.1\r\n"
      "t=0 0\r\n"
      "m=video 5004 RTP/AVP 96\r\n"
      "a=rtpmap:96 H264/90000\r\n"
      "a=fmtp:96 packetization-mode=1;profile-level-id=42C01E;sprop-parameter-sets=Z0LAHtk=,aM48gA==\r\n"
      "a=extmap:1 urn:x-atlaswire:rtp-hdrext:frame-id\r\n"
      "a=extmap:2 urn:x-atlaswire:rtp-hdrext:pose-id\r\n"
      "a=extmap:3 urn:x-atlaswire:rtp-hdrext:capture-time\r\n"
      "a=extmap:4 http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01\r\n"
      "a=rtcp-mux\r\n"
      "a=recvonly\r\n"
      "a=ssrc:1234 cname:atlaswire\r\n");
}

TEST(Sdp, WithoutParameterSetsOnlyTheModeIsSaid) {
  const std::string text = make_sdp({});
  EXPECT_NE(text.find("a=fmtp:96 packetization-mode=1\r\n"), std::string::npos);
  EXPECT_EQ(text.find("a=ssrc"), std::string::npos);
}

TEST(Sdp, SaysIp6AndSendonlyWhereTheyHold) {
  SdpSettings settings;
  settings.address = "fe80::1";
  settings.sending = true;
  const std::string text = make_sdp(settings);
  EXPECT_NE(text.find("c=IN IP6 fe80::1\r\n"), std::string::npos);
  EXPECT_NE(text.find("a=sendonly\r\n"), std::string::npos);
}

TEST(Sdp, ANameCannotAddLines) {
  SdpSettings settings;
  settings.session_name = "x\r\na=evil";
  EXPECT_NE(make_sdp(settings).find("s=x  a=evil\r\n"), std::string::npos);
  settings.session_name.clear();
  EXPECT_NE(make_sdp(settings).find("s=-\r\n"), std::string::npos);
}

}  // namespace
}  // namespace atlaswire::proto
