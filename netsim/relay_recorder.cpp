#include "netsim/relay_recorder.h"

#include "base/program.h"
#include "netsim/decision_log.h"
#include "netsim/pcapng.h"

namespace atlaswire::netsim {

namespace {

std::ofstream open_for_writing(const std::string& name) {
  if (name.empty()) return {};
  std::ofstream file(name, std::ios::binary | std::ios::trunc);
  if (!file) throw ProgramError(ExitCode::kCannotWrite, "cannot write '" + name + "'");
  return file;
}

void write_bytes(std::ofstream& file, const ByteBuffer& bytes) {
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

RelayRecorder::RelayRecorder(const std::string& log_file, const std::string& pcapng_file, Time start,
                             Duration start_unix)
    : log_name_(log_file),
      pcapng_name_(pcapng_file),
      log_(open_for_writing(log_file)),
      pcapng_(open_for_writing(pcapng_file)),
      start_(start),
      start_unix_(start_unix) {
  if (log_.is_open()) log_ << decision_log_header() << '\n';
  if (pcapng_.is_open()) write_bytes(pcapng_, pcapng_opening());
}

void RelayRecorder::attach(Emulator& emulator) {
  if (!pcapng_.is_open()) return;
  for (std::uint32_t i = 0; i < emulator.paths(); ++i) {
    for (const Direction d : {Direction::kUp, Direction::kDown}) {
      taps_.push_back(std::make_unique<LaneTap>(*this, PathId{i}, d));
      emulator.set_tap(PathId{i}, d, taps_.back().get());
    }
  }
}

void RelayRecorder::log(const DirectedDecision& d) {
  if (log_.is_open()) log_ << format_decision(d, start_) << '\n';
}

void RelayRecorder::record(const DirectedDecision& d, ByteView payload) {
  const auto stamp = static_cast<std::uint64_t>((start_unix_ + (d.decision.arrived - start_)).count());
  write_bytes(pcapng_, pcapng_packet(d, payload, streams_.contains(d.decision.flow), stamp));
}

void RelayRecorder::close() {
  const auto finish = [](std::ofstream& file, const std::string& name) {
    if (!file.is_open()) return;
    file.close();
    if (!file) throw ProgramError(ExitCode::kCannotWrite, "cannot write all of '" + name + "'");
  };
  finish(log_, log_name_);
  finish(pcapng_, pcapng_name_);
}

}  // namespace atlaswire::netsim
