#include "client/picture_writer.h"

#include "render/image/png.h"

namespace atlaswire::client {

PictureWriter::PictureWriter() : thread_([this] { run(); }) {}

PictureWriter::~PictureWriter() { finish(); }

bool PictureWriter::write(std::filesystem::path path, render::Picture picture) {
  if (queue_.try_push({std::move(path), std::move(picture)})) return true;
  const std::lock_guard lock(mutex_);
  ++outcome_.left_out;
  return false;
}

PictureWriter::Outcome PictureWriter::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  return outcome_;
}

void PictureWriter::run() {
  while (auto job = queue_.pop()) {
    for (std::size_t i = 3; i < job->second.rgba.size(); i += 4) job->second.rgba[i] = 255;
    const Result<void> written = render::write_png(job->second, job->first);
    const std::lock_guard lock(mutex_);
    if (written) {
      outcome_.written.push_back(job->first);
    } else if (outcome_.failure.empty()) {
      outcome_.failure = written.error().message();
    }
  }
}

}  // namespace atlaswire::client
