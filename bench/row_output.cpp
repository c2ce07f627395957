#include "bench/row_output.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace atlaswire::bench {

namespace {

/// A figure of a row as files have it.
struct Field {
  const char* name;
  double (*of)(const Row&);
  int digits;
};

constexpr std::array kFields{
    Field{"first_mesh_bytes", [](const Row& r) { return static_cast<double>(r.first.mesh); }, 0},
    Field{"first_blocks_bytes", [](const Row& r) { return static_cast<double>(r.first.blocks); }, 0},
    Field{"first_motion_bytes", [](const Row& r) { return r.first_motion; }, 0},
    Field{"first_encode_ms", [](const Row& r) { return r.first_encode; }, 3},
    Field{"first_decode_ms", [](const Row& r) { return r.first_decode; }, 3},
    Field{"mesh_bytes", [](const Row& r) { return r.mesh; }, 1},
    Field{"blocks_bytes", [](const Row& r) { return r.blocks; }, 1},
    Field{"motion_bytes", [](const Row& r) { return r.motion; }, 1},
    Field{"bits_per_triangle", [](const Row& r) { return r.bits_a_triangle; }, 2},
    Field{"encode_ms", [](const Row& r) { return r.encode; }, 4},
    Field{"encode_p95_ms", [](const Row& r) { return r.encode_p95; }, 4},
    Field{"decode_ms", [](const Row& r) { return r.decode; }, 4},
    Field{"decode_p95_ms", [](const Row& r) { return r.decode_p95; }, 4},
    Field{"motion_encode_ms", [](const Row& r) { return r.motion_encode; }, 4},
    Field{"motion_decode_ms", [](const Row& r) { return r.motion_decode; }, 4},
};

void write(const std::string& text, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

void print_head(bool moves) {
  fmt::print(
      "| codec | first frame, bytes | of it blocks | encode/decode ms | additions and removals, bytes/frame "
      "| blocks, bytes/frame | {}all | bits/triangle added | encode ms (p95) | decode ms (p95) |{}\n"
      "|---|---|---|---|---|---|---|---|---|---|{}\n",
      moves ? "motion, bytes/frame | " : "", moves ? " of it motion, encode/decode ms |" : "",
      moves ? "---|---|" : "");
}

void print_row(const Row& r, bool moves) {
  fmt::print("| {} | {:.0f} | {} | {:.1f}/{:.1f} | {:.0f} | {:.0f} |", r.codec, r.first_all(), r.first.blocks,
             r.first_encode, r.first_decode, r.mesh, r.blocks);
  if (moves) fmt::print(" {:.0f} |", r.motion);
  fmt::print(" {:.0f} | {:.1f} | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) |", r.all(), r.bits_a_triangle, r.encode,
             r.encode_p95, r.decode, r.decode_p95);
  if (moves) fmt::print(" {:.3f}/{:.3f} |", r.motion_encode, r.motion_decode);
  fmt::print("\n");
  std::fflush(stdout);
}

void write_csv(const std::vector<Row>& rows, const std::filesystem::path& file) {
  std::string text = "stream,codec";
  for (const Field& field : kFields) text += fmt::format(",{}", field.name);
  text += '\n';
  for (const Row& row : rows) {
    text += row.stream + "," + row.codec;
    for (const Field& field : kFields) text += fmt::format(",{:.{}f}", field.of(row), field.digits);
    text += '\n';
  }
  write(text, file);
}

void write_json(const std::vector<Row>& rows, const std::filesystem::path& file) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json entry{{"stream", row.stream}, {"codec", row.codec}};
    for (const Field& field : kFields) {
      const double unit = std::pow(10.0, field.digits);
      const double rounded = std::round(field.of(row) * unit) / unit;
      if (field.digits == 0) {
        entry[field.name] = std::llround(rounded);
      } else {
        entry[field.name] = rounded;
      }
    }
    all.push_back(std::move(entry));
  }
  write(all.dump(2) + "\n", file);
}

}  // namespace atlaswire::bench
