#include "codec/av_support.h"

#include <spdlog/spdlog.h>

extern "C" {
#include <libavutil/error.h>
#include <libavutil/log.h>
}

#include <array>
#include <cstdarg>
#include <mutex>

namespace atlaswire::codec {

namespace {

thread_local std::string complaint;

__attribute__((format(printf, 3, 0))) void log_line(void* object, int level, const char* format,
                                                    va_list arguments) {
  if (level > AV_LOG_WARNING) return;
  std::array<char, 512> line{};
  int print_prefix = 1;
  av_log_format_line2(object, level, format, arguments, line.data(), static_cast<int>(line.size()),
                      &print_prefix);
  std::string text(line.data());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  spdlog::debug("libav: {}", text);
  if (level <= AV_LOG_ERROR) {
    const auto prefix = text.find("] ");  // "[h264_nvenc @ 0x55d0c0] reason"
    complaint = prefix == std::string::npos ? std::move(text) : text.substr(prefix + 2);
  }
}

}  // namespace

void route_av_log() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(log_line); });
}

void clear_av_complaint() { complaint.clear(); }

std::string av_complaint() { return complaint; }

std::string av_error_text(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

}  // namespace atlaswire::codec
