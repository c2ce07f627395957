#pragma once

#include "base/bytes.h"
#include "base/error_enum.h"
#include "base/result.h"
#include "base/units.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace atlaswire::codec {

/// Borrowed planes of a YCbCr 4:2:0 picture, BT.709 full range; chroma planes are half size, both sides even.
struct I420View {
  Extent2D extent;
  const std::uint8_t* y = nullptr;
  const std::uint8_t* u = nullptr;
  const std::uint8_t* v = nullptr;
  std::uint32_t y_stride = 0;   ///< octets
  std::uint32_t uv_stride = 0;  ///< octets, of both chroma planes
};

/// Settings of an H.264 encoder ([SAS] 3.4, 5.8). CAVLC, one reference, no B-frames, no look-ahead always.
struct VideoEncoderSettings {
  Extent2D extent;                    ///< both sides even
  double frame_rate = 15;             ///< nominal, for rate control
  BitRate bit_rate{10'000'000};       ///< 0: constant quantizer `qp`
  int qp = 20;                        ///< 0..51, used when bit_rate is 0
  std::uint32_t intra_interval = 30;  ///< frames from IDR to IDR; 0: only when asked; [SAS] 5.8 has 5
  std::string preset = "ultrafast";   ///< of x264
  std::string encoder = "auto";  ///< "auto", "h264_nvenc", "h264_vaapi", "libx264"; "raw": see VideoCoding
  std::uint32_t threads = 2;     ///< slices encoded side by side; adds no delay
  std::uint32_t max_slice_bytes = 0;  ///< 0: one slice a thread
};

/// One encoded picture in Annex B form (start codes), parameter sets in band before each IDR.
struct EncodedPicture {
  ByteBuffer bytes;
  bool idr = false;
  std::int64_t index = 0;  ///< the number given to `encode`
};

/// H.264 through libavcodec, no delay: every picture given comes back at once. Encoder "raw" makes
/// VideoCoding::kRaw. One thread at a time.
class VideoEncoder {
 public:
  /// Tries the named encoder, or each of the hardware ones and then libx264 for "auto"; an encoder that
  /// cannot open is logged with its reason and the next one tried. Throws ProgramError when none opens.
  explicit VideoEncoder(const VideoEncoderSettings& settings);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Is the next picture an IDR by the interval's rule? Lets the renderer clear and rearrange the atlas.
  [[nodiscard]] bool next_is_intra() const;
  /// Encodes one picture; `force_intra` makes it an IDR and restarts the interval.
  Result<EncodedPicture> encode(const I420View& picture, bool force_intra);
  /// Applies to following pictures.
  void set_bit_rate(BitRate rate);
  /// The encoder that opened, "libx264" for instance.
  [[nodiscard]] const std::string& name() const;
  /// SPS and PPS, Annex B, for SDP's sprop-parameter-sets; empty before the first picture.
  [[nodiscard]] const ByteBuffer& parameter_sets() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a stream's pictures are: H.264, or bare planes that show what coding costs (never on a network).
enum class VideoCoding : std::uint8_t { kH264, kRaw };

/// A decoded picture; owns its planes until destroyed.
class DecodedPicture {
 public:
  DecodedPicture();
  ~DecodedPicture();
  DecodedPicture(DecodedPicture&&) noexcept;
  DecodedPicture& operator=(DecodedPicture&&) noexcept;
  [[nodiscard]] I420View view() const;

 private:
  friend class VideoDecoder;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decoder, no delay. Hostile bytes give an Error, never a crash; the caller then waits for an IDR.
class VideoDecoder {
 public:
  /// `max_extent`: larger pictures are refused. `threads`: slice threads.
  explicit VideoDecoder(Extent2D max_extent, std::uint32_t threads = 1,
                        VideoCoding coding = VideoCoding::kH264);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  /// One whole access unit in Annex B form to its picture.
  Result<DecodedPicture> decode(ByteView access_unit);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What encoding and decoding can say.
enum class VideoError { kEncoderFailed = 1, kCorrupt, kNoPicture, kTooLarge, kWrongFormat, kWrongExtent };
const char* error_text(VideoError e);

}  // namespace atlaswire::codec
ATLASWIRE_ERROR_ENUM(codec, VideoError);
