#include "client/viewer.h"

#include "client/decode_thread.h"
#include "client/display_loop.h"
#include "client/interrupt.h"
#include "client/motion.h"
#include "client/network_thread.h"
#include "client/output_folder.h"
#include "client/pair_maker.h"
#include "client/pair_renderer.h"
#include "client/picture_writer.h"
#include "client/reference.h"
#include "client/run_facts.h"
#include "render/image/png.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <optional>
#include <random>
#include <utility>

namespace atlaswire::client {
namespace {

/// One run, from the first check to the last line printed.
class Viewer {
 public:
  explicit Viewer(const ClientSettings& settings)
      : settings_(settings), folder_(settings.out), motion_(settings.path) {}

  ExitCode run() {
    watch_interrupts();
    if (!settings_.reference.empty()) truth_ = load_truth(settings_.reference);
    device_ = render::open_device({.select = settings_.device, .validation = settings_.validation});
    connect();
    stream();
    const ExitCode code = outcome();
    fill_report();
    if (truth_ && !facts_.display.samples.empty()) compare();
    write_and_print();
    return code;
  }

 private:
  void connect() {
    network_.emplace(network_settings(), arrivals_);
    answer_ = network_->wait_for_answer(interrupted);
    if (answer_) return;
    const std::optional<SessionEnd> end = network_->end();
    if (!end) throw ProgramError(ExitCode::kInterrupted, "interrupted before the server answered");
    throw ProgramError(exit_code(end->kind), end->text);
  }

  [[nodiscard]] NetworkSettings network_settings() {
    NetworkSettings n{.server = settings_.server,
                      .wait = settings_.wait,
                      .pose_interval = from_seconds(1 / settings_.pose_rate)};
    n.session.emphasis = settings_.emphasis;
    n.session.emphasis_after = settings_.emphasis_after;
    std::random_device entropy;  // an SSRC must differ between clients
    n.session.ssrc = entropy() | 1U;
    proto::ClientHello& hello = n.session.hello;
    hello.client_name = "atlas-client";
    hello.display = settings_.size;
    hello.vertical_fov = settings_.vertical_fov;
    if (settings_.stereo) hello.eye_separation = settings_.ipd;
    hello.max_picture = {16'384, 16'384};
    hello.meta_codecs = readable_meta_codecs();
    hello.shows_motion = true;
    hello.wanted_atlas = settings_.wanted_atlas;
    hello.wanted_bit_rate = settings_.wanted_bit_rate;
    hello.wanted_frame_rate = settings_.wanted_frame_rate;
    n.sample_pose = [this](Time now) { return tracker_.at(now); };
    return n;
  }

  void stream() {
    const proto::StreamDescription& stream = answer_->stream;
    tracker_.set_motion(motion_.choose(stream.scene));
    spdlog::info("session {} streams {}: atlas {}x{}, path {}", value(answer_->session), stream.scene,
                 stream.atlas.width, stream.atlas.height, motion_.name());
    const DisplaySettings display = display_settings(stream);
    PairRenderer renderer(*device_, stream, display.camera,
                          {.ipd = settings_.stereo ? settings_.ipd : 0, .lens = settings_.lens});
    std::optional<PictureWriter> writer;
    if (settings_.png_every != 0) writer.emplace();
    DecodeThread decoder(
        stream, {.threads = settings_.decoder_threads}, arrivals_, pairs_,
        {.decode_failed = [this] { network_->decode_failed(); },
         .peer_broke = [this](std::string why) { network_->fail(std::move(why)); },
         .out_of_step = [this](FrameId frame,
                               std::string why) { network_->request_restart(frame, std::move(why)); }});
    const CloseAtExit close{arrivals_};  // or the decode thread would never end
    const DisplayHooks hooks{.should_stop = [this] { return interrupted() || network_->end().has_value(); },
                             .on_progress = [this](const Progress& p) { on_progress(p); },
                             .on_measuring = [this](Time) { facts_.measured_from = network_->snapshot(); }};
    facts_.display = run_display(display, tracker_, pairs_, renderer, writer ? &*writer : nullptr, hooks);
    facts_.measured_to = network_->snapshot();
    network_->finish();
    arrivals_.close();
    decoder.finish();
    facts_.decoded = decoder.counts();
    if (writer) note_pictures(writer->finish());
  }

  struct CloseAtExit {
    ArrivalQueue& queue;
    ~CloseAtExit() { queue.close(); }
  };

  [[nodiscard]] DisplaySettings display_settings(const proto::StreamDescription& stream) const {
    DisplaySettings d{.rate = settings_.rate,
                      .duration = settings_.duration,
                      .warm_up = settings_.warm_up,
                      .samples = truth_ ? settings_.samples : 0,
                      .at_server_pose = settings_.at_server_pose,
                      .png_every = settings_.png_every,
                      .png_folder = settings_.out};
    d.camera.extent = settings_.size;
    d.camera.vertical_fov = settings_.vertical_fov;
    d.camera.near_plane = stream.near_plane;
    return d;
  }

  void on_progress(const Progress& progress) {
    network_->set_progress(progress);
    const NetworkSnapshot now = network_->snapshot();
    const NetworkSnapshot before = std::exchange(previous_, now);
    const double span = to_seconds(now.taken - before.taken);
    const bool visible = !settings_.quiet && (settings_.verbose || isatty(STDERR_FILENO) == 1);
    if (!visible || before.taken == Time{} || span <= 0) return;
    const auto octets = [](const NetworkSnapshot& s) { return s.traffic.video + s.traffic.meta; };
    fmt::print(stderr, "displayed {:5.1f} fps, server {:5.1f} fps, {:6.2f} Mbps, {} paired, {} lost\n",
               progress.display_rate, static_cast<double>(now.updates - before.updates) / span,
               static_cast<double>(octets(now) - octets(before)) * 8e-6 / span, progress.paired,
               now.frames.lost);
  }

  void note_pictures(const PictureWriter::Outcome& pictures) {
    report_.pictures_left_out = pictures.left_out;
    for (const auto& file : pictures.written) folder_.remember(file);
    if (!pictures.failure.empty()) spdlog::warn("{}", pictures.failure);
  }

  /// Throws when nothing was ever shown.
  [[nodiscard]] ExitCode outcome() {
    const std::optional<SessionEnd> end = network_->end();
    const bool lost = end && exit_code(end->kind) != ExitCode::kOk;
    if (end) report_.end = end->text;
    if (!facts_.display.first) {
      if (interrupted()) throw ProgramError(ExitCode::kInterrupted, "interrupted before the first frame");
      throw ProgramError(lost ? exit_code(end->kind) : ExitCode::kPeerLost,
                         lost ? end->text
                              : "the server sent no frame that could be shown: see its log" +
                                    (report_.end.empty() ? "" : "; " + report_.end));
    }
    if (lost) spdlog::error("{}", end->text);
    return lost ? exit_code(end->kind) : ExitCode::kOk;
  }

  void fill_report() {
    report_.settings = settings_;
    report_.scene = answer_->stream.scene;
    report_.path = motion_.name();
    report_.device = render::device_name(*device_);
    report_.atlas = answer_->stream.atlas;
    client::fill_report(facts_, report_);
  }

  void compare() {
    Reference reference(*device_, truth_);
    const std::vector<Sample>& samples = facts_.display.samples;
    report_.samples = reference.compare(samples, interrupted);
    if (report_.samples.empty()) return;
    report_.quality = summarize(report_.samples);
    if (!folder_.wanted()) return;
    const Notable which = notable(report_.samples);
    const std::array<std::pair<const char*, std::size_t>, 3> files{
        {{"side_by_side.png", which.median}, {"worst.png", which.worst}, {"last.png", which.last}}};
    for (const auto& [name, i] : files) {
      const auto file = folder_.file(name);
      const render::Picture picture = reference.triptych(samples[i], report_.samples[i], report_.atlas);
      if (const Result<void> written = render::write_png(picture, file); !written) {
        throw ProgramError(ExitCode::kCannotWrite, written.error().message());
      }
      folder_.remember(file);
    }
  }

  void write_and_print() {
    if (folder_.wanted()) {
      const auto stages = folder_.file("stages.csv");
      if (const Result<void> written = facts_.display.log.write_csv(stages, *facts_.display.first);
          !written) {
        throw ProgramError(ExitCode::kCannotWrite, written.error().message());
      }
      folder_.remember(stages);
      report_.files = folder_.written();
      report_.files.push_back(folder_.file("summary.json").string());
      folder_.write_text("summary.json", to_json(report_));
    }
    if (settings_.json) {
      fmt::print("{}", to_json(report_));
    } else if (!settings_.quiet) {
      fmt::print("{}", to_table(report_));
    }
    std::fflush(stdout);
  }

  ClientSettings settings_;
  OutputFolder folder_;
  Motion motion_;
  std::shared_ptr<const render::Scene> truth_;  ///< null without --reference
  std::shared_ptr<render::Device> device_;
  Tracker tracker_;
  ArrivalQueue arrivals_{kArrivalPlaces};
  HandOver<Pair> pairs_;
  std::optional<NetworkThread> network_;
  std::optional<proto::ServerHello> answer_;
  NetworkSnapshot previous_;
  RunFacts facts_;
  RunReport report_;
};

}  // namespace

ExitCode run_viewer(const ClientSettings& settings) { return Viewer(settings).run(); }

}  // namespace atlaswire::client
