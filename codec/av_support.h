#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/buffer.h>
#include <libavutil/frame.h>
}

#include <memory>
#include <string>

namespace atlaswire::codec {

/// Frees libav objects through their own pointer-to-pointer functions.
struct AvFree {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVBufferRef* p) const { av_buffer_unref(&p); }
};
using AvContext = std::unique_ptr<AVCodecContext, AvFree>;
using AvFrame = std::unique_ptr<AVFrame, AvFree>;
using AvPacket = std::unique_ptr<AVPacket, AvFree>;
using AvBuffer = std::unique_ptr<AVBufferRef, AvFree>;

/// Sends libav's own log to spdlog, at debug; its chatter at info and below is dropped. Idempotent.
void route_av_log();

/// Forgets and tells the last error line that libav logged on this thread: often the only place where the
/// reason stands ("Cannot load libcuda.so.1"). Empty when there is none.
void clear_av_complaint();
std::string av_complaint();

/// libav's text for one of its error codes.
std::string av_error_text(int code);

}  // namespace atlaswire::codec
