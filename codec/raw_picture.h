#pragma once

#include "codec/av_support.h"
#include "codec/video.h"

namespace atlaswire::codec {

/// Pictures that are not coded at all, so that what coding costs can be measured: width and height as
/// u32, then the Y, U and V planes without padding.
void write_raw_picture(const I420View& picture, ByteBuffer& out);

/// Reads such bytes; kTooLarge beyond `max_extent`, kWrongFormat for odd or empty sides, kCorrupt for a
/// length that is not theirs.
Result<AvFrame> read_raw_picture(ByteView bytes, Extent2D max_extent);

}  // namespace atlaswire::codec
