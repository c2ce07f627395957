// Codecs of geometry side by side: on recorded streams (codec_record) and on whole scenes.
#include "bench/codec_rival.h"
#include "bench/gate_profile.h"
#include "bench/meta_recording.h"
#include "bench/row_output.h"
#include "bench/stream_run.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

using namespace atlaswire;
using namespace atlaswire::bench;

namespace {

std::vector<std::unique_ptr<CodecRival>> all_rivals(const MetaRecording& recording) {
  std::vector<std::unique_ptr<CodecRival>> rivals;
  using codec::MetaCodecKind;
  rivals.push_back(make_naive_rival());
  rivals.push_back(make_own_rival(MetaCodecKind::kPaper, recording));
  rivals.push_back(make_draco_rival());
  rivals.push_back(make_meshopt_rival());
  for (const auto kind : {MetaCodecKind::kPlain, MetaCodecKind::kGate})
    rivals.push_back(make_own_rival(kind, recording));
  return rivals;
}

void print_stream(const std::string& name, const MetaRecording& recording) {
  double added = 0;
  double removed = 0;
  double moved = 0;
  int resets = 0;
  for (const codec::MetaUpdate& update : recording.updates) {
    if (&update == &recording.updates.front()) continue;
    added += IncrementMaker::added_triangles(update);
    removed += static_cast<double>(update.removed.size());
    moved += static_cast<double>(update.moved.size());
    resets += update.reset ? 1 : 0;
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(1, recording.updates.size() - 1));
  fmt::print(
      "\n{}: {} frames; {} triangles at first, then a frame {:.0f} triangles added, {:.0f} patches "
      "removed, {:.0f} moved; begun anew {} times\n\n",
      name, recording.updates.size(), IncrementMaker::added_triangles(recording.updates.front()),
      added / frames, removed / frames, moved / frames, resets);
  if (!recording.motion) return;
  double vertices = 0;
  double objects = 0;
  for (const MoverPlaces& places : recording.motion->frames) {
    vertices += static_cast<double>(places.positions.size());
    objects += static_cast<double>(places.transforms.size());
  }
  fmt::print("A frame {:.0f} vertices and {:.0f} objects in sight that may move\n\n", vertices / (frames + 1),
             objects / (frames + 1));
}

void print_topics_head() {
  fmt::print("\n| gate form, bytes |");
  for (const std::string_view topic : kGateTopics) fmt::print(" {} |", topic);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < kGateTopics.size(); ++i) fmt::print("---|");
  fmt::print("\n");
}

void print_topics(const std::string& what, const GateProfile::Bits& bits, double frames) {
  fmt::print("| {} |", what);
  for (const double b : bits) fmt::print(" {:.1f} |", b / 8 / frames);
  fmt::print("\n");
}

void profile(const MetaRecording& recording) {
  GateProfile gate(recording.limits);
  GateProfile::Bits first{};
  GateProfile::Bits later{};
  for (const codec::MetaUpdate& update : recording.updates) {
    const GateProfile::Bits bits = gate.encode(update);
    GateProfile::Bits& sum = &update == &recording.updates.front() ? first : later;
    for (std::size_t i = 0; i < bits.size(); ++i) sum[i] += bits[i];
  }
  print_topics_head();
  print_topics("first", first, 1);
  print_topics("a later frame", later,
               static_cast<double>(std::max<std::size_t>(1, recording.updates.size() - 1)));
}

/// All of a scene in one update: ours against Draco's smallest, blocks aside.
void compare_whole(const std::string& name, const MetaRecording& recording) {
  IncrementMaker maker;
  const Increment increment = maker.next(recording.updates.front());
  GateProfile gate(recording.limits);
  const GateProfile::Bits bits = gate.encode(recording.updates.front());
  const double ours = mesh_octets(bits);
  const auto draco = static_cast<double>(draco_size(increment.positions, increment.indices));
  const auto triangles = static_cast<double>(increment.indices.size()) / 3;
  fmt::print(
      "\n| whole mesh | triangles | grid bits | Draco bytes | bits/triangle | gate bytes | bits/triangle | "
      "ratio |\n|---|---|---|---|---|---|---|---|\n"
      "| {} | {:.0f} | {} | {:.0f} | {:.2f} | {:.0f} | {:.2f} | {:.3f} |\n",
      name, triangles, recording.limits.grid_bits, draco, 8 * draco / triangles, ours, 8 * ours / triangles,
      ours / draco);
}

/// The same stream for a receiver that derives where blocks lie, if it was recorded beside (--requests).
std::optional<MetaRecording> requests_beside(std::filesystem::path file) {
  file.replace_extension(".requests");
  if (!std::filesystem::exists(file)) return std::nullopt;
  return read_recording(file).value();
}

void compare(const std::filesystem::path& file, const std::string& only, bool topics,
             std::vector<Row>& rows) {
  const MetaRecording recording = read_recording(file).value();
  const std::string name = file.stem().string();
  if (recording.updates.size() == 1) return compare_whole(name, recording);
  const bool moves = recording.motion.has_value();
  const auto take = [&](CodecRival& rival, const MetaRecording& updates) {
    if (!only.empty() && rival.name() != only) return;
    rows.push_back(run_stream(rival, name, updates));
    print_row(rows.back(), moves);
  };
  print_stream(name, recording);
  print_head(moves);
  for (const auto& rival : all_rivals(recording)) take(*rival, recording);
  if (const auto requests = requests_beside(file)) {
    take(*make_own_rival(codec::MetaCodecKind::kMirror, *requests), *requests);
  }
  if (topics) profile(recording);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> recordings;
  std::string csv;
  std::string json;
  std::string only;
  bool topics = false;
  CLI::App app(
      "Compares codecs of geometry on recordings of codec_record: octets, bits a triangle, and ms of this "
      "thread's processor time. Decoding is all that a receiver does to know geometry, blocks and motion: in "
      "the mirror form it runs the atlas's memory, too. What is decoded is checked against what was told.");
  app.add_option("recordings", recordings,
                 "X.meta; for the mirror form also X.requests, recorded with --requests. One of a single "
                 "update is compared with Draco as a whole mesh")
      ->required();
  app.add_option("--csv", csv, "File to write figures to, a row each stream and codec");
  app.add_option("--json", json, "File to write the same fields to, an object each");
  app.add_option("--only", only, "Only the codec of this name");
  app.add_flag("--topics", topics, "What the gate form's bits are spent on");
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<Row> rows;
    for (const std::string& file : recordings) compare(file, only, topics, rows);
    if (!csv.empty()) write_csv(rows, csv);
    if (!json.empty()) write_json(rows, json);
  } catch (const std::exception& e) {
    fmt::print(stderr, "codec_bench: {}\n", e.what());
    return 1;
  }
  return 0;
}
