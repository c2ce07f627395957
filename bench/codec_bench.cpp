// Codecs of geometry side by side: on recorded streams (codec_record) and on whole scenes.
#include "bench/codec_rival.h"
#include "bench/gate_profile.h"
#include "bench/meta_recording.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>

using namespace atlaswire;
using namespace atlaswire::bench;

namespace {

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Milliseconds of this thread that a call takes, whatever else the machine is busy with.
template <class Call>
double time_of(Call call) {
  const double start = thread_ms();
  call();
  return thread_ms() - start;
}

double mean(const std::vector<double>& all) {
  return all.empty() ? 0 : std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}
double p95(std::vector<double> all) {
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[(all.size() - 1) * 95 / 100];
}

/// What one codec takes for one stream: the first update, and the means of those behind it.
struct Row {
  std::string stream;
  std::string codec;
  UpdateCost first;
  double first_encode = 0;
  double first_decode = 0;
  double mesh = 0;  ///< octets a frame
  double blocks = 0;
  double bits_a_triangle = 0;  ///< of mesh octets, first update included
  double encode = 0;           ///< ms
  double encode_p95 = 0;
  double decode = 0;
  double decode_p95 = 0;
};

Row run(CodecRival& rival, const std::string& stream, const MetaRecording& recording) {
  Row row{.stream = stream, .codec = rival.name()};
  IncrementMaker maker;
  std::vector<double> encodes;
  std::vector<double> decodes;
  double mesh = 0;
  double blocks = 0;
  double all_mesh = 0;
  double triangles = 0;
  for (const codec::MetaUpdate& update : recording.updates) {
    const Increment increment = maker.next(update);
    const double encode = time_of([&] { rival.encode(increment); });
    const double decode = time_of([&] { rival.decode(); });
    const UpdateCost cost = rival.cost();
    all_mesh += static_cast<double>(cost.mesh);
    triangles += IncrementMaker::added_triangles(update);
    if (&update == &recording.updates.front()) {
      row.first = cost;
      row.first_encode = encode;
      row.first_decode = decode;
      continue;
    }
    encodes.push_back(encode);
    decodes.push_back(decode);
    mesh += static_cast<double>(cost.mesh);
    blocks += static_cast<double>(cost.blocks);
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(1, encodes.size()));
  row.mesh = mesh / frames;
  row.blocks = blocks / frames;
  row.bits_a_triangle = 8 * all_mesh / std::max(1.0, triangles);
  row.encode = mean(encodes);
  row.encode_p95 = p95(encodes);
  row.decode = mean(decodes);
  row.decode_p95 = p95(decodes);
  return row;
}

std::vector<std::unique_ptr<CodecRival>> all_rivals(const codec::MetaLimits& limits) {
  std::vector<std::unique_ptr<CodecRival>> rivals;
  rivals.push_back(make_naive_rival());
  rivals.push_back(make_draco_rival());
  rivals.push_back(make_meshopt_rival());
  for (const codec::MetaCodecKind kind : codec::kMetaCodecs) {
    if (!leaves_positions(kind)) rivals.push_back(make_own_rival(kind, limits));
  }
  return rivals;
}

void print_stream(const std::string& name, const MetaRecording& recording) {
  double added = 0;
  double removed = 0;
  double moved = 0;
  for (const codec::MetaUpdate& update : recording.updates) {
    if (&update == &recording.updates.front()) continue;
    added += IncrementMaker::added_triangles(update);
    removed += static_cast<double>(update.removed.size());
    moved += static_cast<double>(update.moved.size());
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(1, recording.updates.size() - 1));
  fmt::print(
      "\n{}: {} frames; {} triangles at first, then a frame {:.0f} triangles added, {:.0f} patches "
      "removed, {:.0f} moved\n\n",
      name, recording.updates.size(), IncrementMaker::added_triangles(recording.updates.front()),
      added / frames, removed / frames, moved / frames);
  fmt::print(
      "| codec | first frame, bytes | of it blocks | encode/decode ms | additions and removals, bytes/frame "
      "| "
      "blocks, bytes/frame | both | bits/triangle added | encode ms (p95) | decode ms (p95) |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
}

void print(const Row& r) {
  fmt::print(
      "| {} | {} | {} | {:.1f}/{:.1f} | {:.0f} | {:.0f} | {:.0f} | {:.1f} | {:.3f} ({:.3f}) | {:.3f} "
      "({:.3f}) |\n",
      r.codec, r.first.mesh + r.first.blocks, r.first.blocks, r.first_encode, r.first_decode, r.mesh,
      r.blocks, r.mesh + r.blocks, r.bits_a_triangle, r.encode, r.encode_p95, r.decode, r.decode_p95);
  std::fflush(stdout);
}

void write_csv(const std::vector<Row>& rows, const std::string& file) {
  std::ofstream out(file);
  out << "stream,codec,first_mesh_bytes,first_blocks_bytes,first_encode_ms,first_decode_ms,mesh_bytes,"
         "blocks_bytes,bits_per_triangle,"
         "encode_ms,encode_p95_ms,decode_ms,decode_p95_ms\n";
  for (const Row& r : rows) {
    out << fmt::format("{},{},{},{},{:.3f},{:.3f},{:.1f},{:.1f},{:.2f},{:.4f},{:.4f},{:.4f},{:.4f}\n",
                       r.stream, r.codec, r.first.mesh, r.first.blocks, r.first_encode, r.first_decode,
                       r.mesh, r.blocks, r.bits_a_triangle, r.encode, r.encode_p95, r.decode, r.decode_p95);
  }
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
  MetaRecording recording = read_recording(file).value();
  for (codec::MetaUpdate& update : recording.updates) update.cue.emplace();
  return recording;
}

void compare(const std::filesystem::path& file, const std::string& only, bool topics,
             std::vector<Row>& rows) {
  const MetaRecording recording = read_recording(file).value();
  const std::string name = file.stem().string();
  if (recording.updates.size() == 1) return compare_whole(name, recording);
  const auto take = [&](CodecRival& rival, const MetaRecording& updates) {
    if (!only.empty() && rival.name() != only) return;
    rows.push_back(run(rival, name, updates));
    print(rows.back());
  };
  print_stream(name, recording);
  for (const auto& rival : all_rivals(recording.limits)) take(*rival, recording);
  if (const auto requests = requests_beside(file)) {
    take(*make_own_rival(codec::MetaCodecKind::kMirror, requests->limits), *requests);
  }
  if (topics) profile(recording);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> recordings;
  std::string csv;
  std::string only;
  bool topics = false;
  CLI::App app("Compares codecs of geometry on recordings of codec_record");
  app.add_option("recordings", recordings,
                 "X.meta; for the mirror form also X.requests, recorded with --requests")
      ->required();
  app.add_option("--csv", csv, "File to write figures to");
  app.add_option("--only", only, "Only the codec of this name");
  app.add_flag("--topics", topics, "What the gate form's bits are spent on");
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<Row> rows;
    for (const std::string& file : recordings) compare(file, only, topics, rows);
    if (!csv.empty()) write_csv(rows, csv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "codec_bench: {}\n", e.what());
    return 1;
  }
  return 0;
}
