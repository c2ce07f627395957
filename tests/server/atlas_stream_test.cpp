#include "server/atlas_stream.h"

#include "client/layout_mirror.h"
#include "codec/video.h"
#include "render/gpu/open_device.h"
#include "render/scene/load.h"
#include "server/atlas_source.h"
#include "tests/server/daemon_fixture.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <map>
#include <memory>
#include <set>

namespace atlaswire::server {
namespace {

using namespace std::chrono_literals;

/// A small scene on the device that is there, with the validation layer watching.
class AtlasStreamTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    device = render::open_device({"auto", true});
    scene = std::make_shared<const render::Scene>(render::load_scene("atrium:0.05").value());
  }
  static void TearDownTestSuite() {
    scene.reset();
    device.reset();
  }

  AtlasStreamTest() {
    settings.render.atlas = settings.render.allocator.atlas = {256, 256};
    settings.video.threads = 1;
    settings.video.intra_interval = 5;
    request.camera.extent = {160, 90};
    request.camera.pose = scene->start;
  }
  void TearDown() override { EXPECT_TRUE(render::validation_messages(*device).empty()); }

  std::unique_ptr<AtlasStream> make_stream() {
    return std::make_unique<AtlasStream>(
        settings, scene, render::make_method(settings.method, *device, scene, settings.render));
  }

  static std::shared_ptr<render::Device> device;
  static std::shared_ptr<const render::Scene> scene;
  StreamSettings settings;
  ViewRequest request;
};

std::shared_ptr<render::Device> AtlasStreamTest::device;
std::shared_ptr<const render::Scene> AtlasStreamTest::scene;

/// What a client knows: applies updates strictly.
struct Replica {
  std::set<std::uint32_t> vertices;
  std::map<std::uint32_t, Block> patches;

  void apply(const codec::MetaUpdate& update) {
    if (update.reset) *this = {};
    for (const PatchId id : update.removed) EXPECT_EQ(patches.erase(value(id)), 1U);
    for (const auto& vertex : update.vertices) EXPECT_TRUE(vertices.insert(value(vertex.id)).second);
    for (const auto& added : update.added) {
      EXPECT_TRUE(patches.emplace(value(added.id), added.block).second);
      for (std::uint32_t corner = 0; corner < corner_count(added.triangles); ++corner) {
        EXPECT_TRUE(vertices.contains(value(added.corners[corner])));
      }
    }
    for (const auto& moved : update.moved) patches.at(value(moved.id)) = moved.block;
  }
};

TEST_F(AtlasStreamTest, AClientCanFollowEveryFrame) {
  const auto stream = make_stream();
  codec::VideoDecoder video(stream->picture_extent());
  const ReplicaTracker limits(scene, settings.grid_bits);
  const auto meta = codec::make_meta_decoder(settings.meta_codec, limits.limits(settings.render.atlas));
  Replica replica;
  for (std::uint32_t n = 0; n < 8; ++n) {
    request.camera.pose.position.x += 0.2;
    request.pose = PoseId{n + 1};
    const auto frame = stream->encode(stream->render(request)).value();
    EXPECT_EQ(value(frame.frame), n);
    EXPECT_EQ(frame.pose, PoseId{n + 1});
    EXPECT_EQ(frame.idr, n % 5 == 0);
    const auto update = meta->decode(frame.meta).value();
    EXPECT_EQ(update.frame, frame.frame);
    EXPECT_EQ(update.reset, n == 0);
    replica.apply(update);
    const auto picture = video.decode(frame.video);
    ASSERT_TRUE(picture.has_value()) << picture.error().message();
    EXPECT_EQ(picture->view().extent, stream->picture_extent());
    EXPECT_GT(frame.report.visible_patches, 0U);
  }
  EXPECT_GT(replica.patches.size(), 100U);
}

TEST_F(AtlasStreamTest, AMovingSceneTellsWhereThingsAreIfAsked) {
  const auto parade = std::make_shared<const render::Scene>(render::load_scene("parade").value());
  AtlasStream stream(settings, parade,
                     render::make_method(settings.method, *device, parade, settings.render));
  ASSERT_TRUE(stream.motion());
  EXPECT_EQ(describe(*parade, stream, settings).motion, stream.motion());
  request.camera.pose = parade->start;
  EXPECT_TRUE(stream.encode(stream.render(request)).value().motion.empty()) << "at rest";
  request.restart = true;
  std::size_t octets = 0;
  for (int n = 0; n < 4; ++n) {
    request.scene_time = 100ms * n;
    const auto frame = stream.encode(stream.render(request)).value();
    EXPECT_EQ(frame.scene_time, *request.scene_time);
    ASSERT_FALSE(frame.motion.empty());
    EXPECT_EQ(frame.motion[0], request.restart ? std::byte{0xB3} : std::byte{0xB2});
    octets = frame.motion.size();
    request.restart = false;
  }
  EXPECT_GT(octets, 500U) << "a figure of thousands of points walks";
}

TEST_F(AtlasStreamTest, ASceneThatRestsIsStreamedAlikeWhateverTheTime) {
  const auto resting = make_stream();
  const auto timed = make_stream();
  EXPECT_FALSE(timed->motion());
  for (int n = 0; n < 3; ++n) {
    request.camera.pose.position.x += 0.1;
    request.scene_time.reset();
    const auto wanted = resting->encode(resting->render(request)).value();
    request.scene_time = 100ms * n;
    const auto got = timed->encode(timed->render(request)).value();
    EXPECT_EQ(got.meta, wanted.meta);
    EXPECT_EQ(got.video, wanted.video);
    EXPECT_TRUE(got.motion.empty());
  }
}

TEST_F(AtlasStreamTest, AFirstFrameThatIsAskedToTellAllDoesSoOnce) {
  const auto stream = make_stream();
  request.restart = true;
  EXPECT_TRUE(stream->render(request).update.reset);
  request.restart = false;
  EXPECT_FALSE(stream->render(request).update.reset);
}

TEST_F(AtlasStreamTest, RestartTellsANewcomerAll) {
  const auto stream = make_stream();
  const ReplicaTracker limits(scene, settings.grid_bits);
  const auto meta = codec::make_meta_decoder(settings.meta_codec, limits.limits(settings.render.atlas));
  Replica old_client;
  for (int n = 0; n < 3; ++n) {
    request.camera.pose.position.z += 0.3;
    old_client.apply(meta->decode(stream->encode(stream->render(request)).value().meta).value());
  }
  request.restart = true;
  const auto frame = stream->encode(stream->render(request)).value();
  EXPECT_TRUE(frame.idr);
  Replica newcomer;
  const auto update = meta->decode(frame.meta).value();
  EXPECT_TRUE(update.reset);
  newcomer.apply(update);
  old_client.apply(update);
  EXPECT_EQ(newcomer.patches, old_client.patches);
  EXPECT_EQ(newcomer.vertices, old_client.vertices);
}

TEST_F(AtlasStreamTest, RestartMayChooseAnotherMetaCodec) {
  const auto stream = make_stream();
  const codec::MetaLimits limits = ReplicaTracker(scene, settings.grid_bits).limits(settings.render.atlas);
  for (const codec::MetaCodecKind kind :
       {codec::MetaCodecKind::kPlain, codec::MetaCodecKind::kGate, codec::MetaCodecKind::kPlain}) {
    const auto meta = codec::make_meta_decoder(kind, limits);
    request.meta_codec = kind;
    for (const bool restart : {true, false}) {
      request.restart = restart;
      request.camera.pose.position.x += 0.1;
      EXPECT_TRUE(meta->decode(stream->encode(stream->render(request)).value().meta));
    }
  }
}

TEST_F(AtlasStreamTest, AMirrorShowsWhatItIsNotTold) {
  for (const auto kind : {render::AllocatorKind::kSequential, render::AllocatorKind::kDevice}) {
    settings.render.allocator_kind = kind;
    settings.render.most_new_patches = 200;
    auto method = render::make_method(settings.method, *device, scene, settings.render);
    const render::Method& truth = *method;
    AtlasStream stream(settings, scene, std::move(method));
    const auto memory = stream.memory();
    ASSERT_TRUE(memory);
    const codec::MetaLimits limits = ReplicaTracker(scene, settings.grid_bits).limits(settings.render.atlas);
    const auto meta = codec::make_meta_decoder(codec::MetaCodecKind::kMirror, limits);
    client::LayoutMirror mirror({memory->superblock_log2, memory->min_block_log2, memory->high_water},
                                settings.render.atlas, limits.max_patches);
    Replica derived;
    for (int n = 0; n < 16; ++n) {
      request.restart = n == 4;
      request.camera.pose.position.z += 0.1;
      const auto frame = stream.encode(stream.render(request)).value();
      if (n < 4) continue;  // the client joins late
      auto placed = mirror.place(meta->decode(frame.meta).value());
      ASSERT_TRUE(placed) << n << ": " << placed.error().message();
      EXPECT_LE(frame.report.added_patches, n == 4 ? 200U : ~0U);
      EXPECT_TRUE(n != 4 || frame.report.waiting_patches != 0);
      derived.apply(*placed);
      std::map<std::uint32_t, Block> blocks;
      for (const render::PlacedPatch& p : truth.blocks()) blocks[value(p.patch)] = p.block;
      ASSERT_EQ(derived.patches, blocks) << n;
    }
    EXPECT_GT(derived.patches.size(), 400U);
  }
}

TEST_F(AtlasStreamTest, AnEmphasisCountsFromItsFrameOnUntilTheNext) {
  const auto stream = make_stream();
  const auto allocated = [&] {
    const auto frame = stream->encode(stream->render(request)).value();
    request.emphasis.reset();
    return frame.report.usage.allocated;
  };
  const auto before = allocated();
  Emphasis& emphasis = request.emphasis.emplace();
  for (const auto& material : scene->materials) emphasis.priorities.push_back({material.name, -8});
  EXPECT_LT(allocated(), before / 2);
  EXPECT_LT(allocated(), before / 2);
  request.emphasis.emplace();
  for (int frame = 0; frame < 30; ++frame) allocated();  // the bias falls slowly
  EXPECT_GT(allocated(), before / 2);
}

TEST_F(AtlasStreamTest, DrawsItsLayoutWhenAskedIfItFollowsIt) {
  request.layout = true;
  const auto blind = make_stream();
  PreparedFrame without = blind->render(request);
  EXPECT_FALSE(without.layout);
  ASSERT_TRUE(blind->encode(std::move(without)));
  settings.layout_colours = render::LayoutColours::kLevel;
  const auto stream = make_stream();
  PreparedFrame with = stream->render(request);
  ASSERT_TRUE(with.layout);
  EXPECT_EQ(with.layout->extent, settings.render.atlas);
  ASSERT_TRUE(stream->encode(std::move(with)));
  request.layout = false;
  PreparedFrame unasked = stream->render(request);
  EXPECT_FALSE(unasked.layout);
  ASSERT_TRUE(stream->encode(std::move(unasked)));
}

TEST_F(AtlasStreamTest, RefreshBringsAnEarlyIntraFrame) {
  const auto stream = make_stream();
  std::string kinds;
  for (int n = 0; n < 6; ++n) {
    request.refresh = n == 3;
    kinds += stream->encode(stream->render(request)).value().idr ? 'I' : 'P';
  }
  EXPECT_EQ(kinds, "IPPIPP");
}

TEST_F(AtlasStreamTest, TheDescriptionIsFitForTheWire) {
  AtlasSource source(settings, *device, scene);
  EXPECT_FALSE(source.parameter_sets().empty());
  ByteBuffer bytes;
  proto::ServerHello hello;
  hello.session = SessionId{1};
  hello.stream = source.description();
  proto::append_message(hello, bytes);
  const auto parsed = proto::parse_message(ByteView(bytes).subspan(4));
  ASSERT_TRUE(parsed.has_value()) << parsed.error().message();
}

TEST_F(AtlasStreamTest, AWarmStreamIsHandedOutAgain) {
  AtlasSource source(settings, *device, scene);
  auto first = source.make();
  const FrameMaker* address = first.get();
  source.give_back(std::move(first));
  EXPECT_EQ(source.make().get(), address);
}

TEST_F(AtlasStreamTest, TheDaemonServesThroughGarbageAndSilence) {
  AtlasSource source(settings, *device, scene);
  DaemonSettings daemon_settings;
  daemon_settings.stream = settings;
  RunningDaemon daemon(daemon_settings, source);
  proto::ClientHello hello;
  hello.display = {160, 90};
  RawClient client(daemon.port(), hello);
  ASSERT_TRUE(client.run_until_frames(5, 60s));
  const RawSocket silent(SOCK_STREAM, daemon.port());
  RawSocket garbage(SOCK_STREAM, daemon.port());
  garbage.send(ByteBuffer(3000, std::byte{0xAB}));
  RawSocket flood(SOCK_DGRAM, daemon.port());
  const auto goal = client.paired() + 10;
  unsigned sent = 0;
  EXPECT_TRUE(client.run_until(
      [&] {
        for (int i = 0; i < 100; ++i, ++sent) {
          flood.send(ByteBuffer(100 + sent % 900, static_cast<std::byte>(sent)));
        }
        return client.paired() >= goal;
      },
      60s));
  // A second client joins and leaves without a word; the first goes on.
  {
    RawClient doomed(daemon.port(), hello);
    EXPECT_TRUE(doomed.run_until_frames(2, 60s));
  }
  EXPECT_TRUE(client.run_until_frames(client.paired() + 5, 60s));
  EXPECT_FALSE(client.goodbye());
}

}  // namespace
}  // namespace atlaswire::server
