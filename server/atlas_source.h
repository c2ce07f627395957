#pragma once

#include "server/atlas_stream.h"
#include "server/stream_source.h"

#include <memory>
#include <mutex>
#include <string>

namespace atlaswire::render {
class Device;
}

namespace atlaswire::server {

/// Streams of one scene on one device. The first is made and warmed up at once (pipelines compiled, a frame
/// rendered and encoded), so that failures show before anyone connects and the first client does not wait;
/// one idle stream is kept for whoever comes next.
class AtlasSource final : public StreamSource {
 public:
  /// `device` must outlive this. Throws ProgramError when no stream can be made.
  AtlasSource(const StreamSettings& settings, render::Device& device,
              std::shared_ptr<const render::Scene> scene);

  std::unique_ptr<FrameMaker> make() override;
  void give_back(std::unique_ptr<FrameMaker> maker) override;
  [[nodiscard]] const proto::StreamDescription& description() const override { return description_; }
  [[nodiscard]] ByteBuffer parameter_sets() const override { return parameter_sets_; }
  [[nodiscard]] const std::string& encoder_name() const { return encoder_name_; }

 private:
  [[nodiscard]] std::unique_ptr<AtlasStream> make_stream() const;
  void warm_up(AtlasStream& stream) const;

  StreamSettings settings_;
  render::Device& device_;
  std::shared_ptr<const render::Scene> scene_;
  proto::StreamDescription description_;
  ByteBuffer parameter_sets_;
  std::string encoder_name_;
  std::mutex mutex_;
  std::unique_ptr<FrameMaker> spare_;
};

}  // namespace atlaswire::server
