#include "proto/sdp.h"

#include "proto/h264_payload.h"
#include "proto/rtp.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace atlaswire::proto {

namespace {

/// RFC 4648 section 4, with padding.
std::string base64(ByteView bytes) {
  constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8U) | (k < count ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kAlphabet[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return out;
}

/// A text that cannot end its line.
std::string one_line(const std::string& text) {
  std::string out = text;
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return out.empty() ? "-" : out;
}

/// RFC 6184 section 8.1: profile-level-id from the SPS's first octets, and the sets themselves.
std::string parameter_sets(ByteView annex_b) {
  std::vector<ByteView> nals;
  split_annex_b(annex_b, nals);
  std::string level;
  std::string sets;
  for (const ByteView nal : nals) {
    if (nal_type(nal) != NalType::kSps && nal_type(nal) != NalType::kPps) continue;
    if (nal_type(nal) == NalType::kSps && nal.size() >= 4 && level.empty()) {
      level = fmt::format(";profile-level-id={:02X}{:02X}{:02X}", std::to_integer<unsigned>(nal[1]),
                          std::to_integer<unsigned>(nal[2]), std::to_integer<unsigned>(nal[3]));
    }
    sets += (sets.empty() ? ";sprop-parameter-sets=" : ",") + base64(nal);
  }
  return level + sets;
}

struct ExtensionName {
  RtpExtensionId id;
  const char* uri;
};

constexpr ExtensionName kExtensions[] = {
    {RtpExtensionId::kFrame, "urn:x-atlaswire:rtp-hdrext:frame-id"},
    {RtpExtensionId::kPose, "urn:x-atlaswire:rtp-hdrext:pose-id"},
    {RtpExtensionId::kCaptureTime, "urn:x-atlaswire:rtp-hdrext:capture-time"},
    {RtpExtensionId::kTransportSequence,
     "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01"}};

}  // namespace

std::string make_sdp(const SdpSettings& settings) {
  const unsigned type = settings.payload_type;
  const std::string address = one_line(settings.address);
  const std::string net = (address.find(':') == std::string::npos ? "IN IP4 " : "IN IP6 ") + address;
  std::string out;
  const auto line = [&out](const std::string& text) { out += text + "\r\n"; };
  line("v=0");
  line(fmt::format("o=- {} 1 {}", settings.ssrc, net));
  line("s=" + one_line(settings.session_name));
  line("c=" + net);
  line("t=0 0");
  line(fmt::format("m=video {} RTP/AVP {}", settings.port, type));
  line(fmt::format("a=rtpmap:{} H264/90000", type));
  line(fmt::format("a=fmtp:{} packetization-mode=1{}", type, parameter_sets(settings.parameter_sets)));
  for (const auto& extension : kExtensions) {
    line(fmt::format("a=extmap:{} {}", static_cast<unsigned>(extension.id), extension.uri));
  }
  line("a=rtcp-mux");
  line(settings.sending ? "a=sendonly" : "a=recvonly");
  if (settings.ssrc != 0) line(fmt::format("a=ssrc:{} cname:{}", settings.ssrc, one_line(settings.cname)));
  return out;
}

}  // namespace atlaswire::proto
