#pragma once

#include "netsim/emulator.h"

#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace atlaswire::netsim {

/// Writes what a relay decides: a decision log for replay, a pcapng file for Wireshark, either or none.
class RelayRecorder {
 public:
  /// Empty names record nothing. `start`: the run's zero; `start_unix`: the same instant, since 1970. Throws
  /// ProgramError (cannot write).
  RelayRecorder(const std::string& log_file, const std::string& pcapng_file, Time start, Duration start_unix);
  /// Listens to `emulator`, which must not outlive this, where packets are recorded.
  void attach(Emulator& emulator);
  void mark_stream(FlowId flow) { streams_.insert(flow); }
  void log(const DirectedDecision& d);
  /// Flushes; throws ProgramError when something could not be written.
  void close();

 private:
  class LaneTap final : public Tap {
   public:
    LaneTap(RelayRecorder& recorder, PathId path, Direction direction)
        : recorder_(recorder), path_(path), direction_(direction) {}
    void decided(const Decision& decision, ByteView payload) override {
      recorder_.record(DirectedDecision{direction_, decision, path_}, payload);
    }

   private:
    RelayRecorder& recorder_;
    PathId path_;
    Direction direction_;
  };
  void record(const DirectedDecision& d, ByteView payload);

  std::string log_name_;
  std::string pcapng_name_;
  std::ofstream log_;
  std::ofstream pcapng_;
  Time start_;
  Duration start_unix_;
  std::set<FlowId> streams_;
  std::vector<std::unique_ptr<LaneTap>> taps_;  ///< the emulator borrows them
};

}  // namespace atlaswire::netsim
