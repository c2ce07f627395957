#pragma once

#include "client/bounded_queue.h"
#include "render/image/picture.h"

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace atlaswire::client {

/// Encodes PNGs in a thread of its own, so that the display never waits for them. They are opaque: where
/// nothing was drawn, the background shows.
class PictureWriter {
 public:
  PictureWriter();
  /// Finishes what is queued.
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// False when the writer is too far behind: the picture is left out.
  bool write(std::filesystem::path path, render::Picture picture);
  /// Waits for what is queued; the files written and, if any failed, the first failure's text.
  struct Outcome {
    std::vector<std::filesystem::path> written;
    std::size_t left_out = 0;
    std::string failure;
  };
  Outcome finish();

 private:
  void run();

  BoundedQueue<std::pair<std::filesystem::path, render::Picture>> queue_{8};
  std::mutex mutex_;
  Outcome outcome_;
  std::thread thread_;
};

}  // namespace atlaswire::client
