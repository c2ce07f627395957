#include "bench/netsim_mahimahi.h"
#include "netsim/emulator.h"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

/// Packets per second in virtual time through one direction, on one core: 10 s of 1200-octet packets, 20
/// Mbps. "mahimahi" is its approach re-written from the paper: see netsim_mahimahi.h.

namespace atlaswire::bench {

namespace {

constexpr std::size_t kOctets = 1200;
constexpr Duration kGap = std::chrono::microseconds(480);
constexpr int kPackets = 20'833;
constexpr Duration kDrain = std::chrono::seconds(2);

/// About 24 Mbps: two opportunities every millisecond.
std::vector<std::uint64_t> trace_ms() {
  std::vector<std::uint64_t> trace;
  for (std::uint64_t ms = 1; ms <= 1000; ++ms) trace.insert(trace.end(), 2, ms);
  return trace;
}

netsim::LinkProfile ours(const char* name) {
  const std::string what = name;
  netsim::LinkProfile link;
  link.steps.assign(1, {});
  auto& p = link.steps[0].parameters;
  p.overhead = Bytes{0};
  if (what == "delay" || what == "trace") p.delay.base = std::chrono::milliseconds(20);
  if (what == "trace") {
    for (const std::uint64_t ms : trace_ms()) p.rate.trace.emplace_back(std::chrono::milliseconds(ms));
    p.rate.trace_period = p.rate.trace.back();
  }
  if (what == "wifi5") return netsim::load_profile("wifi5")->down;
  if (what == "codel") {
    p.rate.rate = BitRate{18'000'000};  // less than the load: it has drops to decide
    p.queue.policy = netsim::QueueModel::Policy::kCodel;
  }
  return link;
}

void count(benchmark::State& state, std::size_t delivered) {
  state.SetItemsProcessed(state.iterations() * kPackets);
  state.counters["delivered_share"] = static_cast<double>(delivered) / kPackets;
}

void link_virtual(benchmark::State& state, const char* name) {
  const netsim::LinkProfile profile = ours(name);
  std::size_t delivered = 0;
  for (auto _ : state) {
    netsim::Link link(profile, 1, Time{});
    delivered = 0;
    Time now{};
    for (int i = 0; i < kPackets; ++i, now += kGap) {
      link.send(ByteBuffer(kOctets), now);
      for (const auto& d : link.deliver(now)) delivered += d.payload.size() == kOctets ? 1 : 0;
      benchmark::DoNotOptimize(link.take_decisions());
    }
    delivered += link.deliver(now + kDrain).size();
  }
  count(state, delivered);
}

/// As the relay and the virtual driver do it: from event to event, both directions present.
void emulator_virtual(benchmark::State& state, const char* name) {
  netsim::Profile profile;
  profile.up = profile.down = ours(name);
  std::size_t delivered = 0;
  for (auto _ : state) {
    netsim::Emulator emulator(profile, 1, Time{});
    delivered = 0;
    Time now{};
    for (int i = 0; i < kPackets; ++i, now += kGap) {
      emulator.datagram(netsim::FlowId{1}, netsim::Direction::kDown, ByteBuffer(kOctets), now);
      for (auto next = emulator.next_event(); next && *next < now + kGap; next = emulator.next_event()) {
        delivered += emulator.deliver(*next).size();
      }
      benchmark::DoNotOptimize(emulator.take_decisions());
    }
    delivered += emulator.deliver(now + kDrain).size();
  }
  count(state, delivered);
}

void mahimahi_virtual(benchmark::State& state, bool with_trace) {
  std::size_t delivered = 0;
  for (auto _ : state) {
    MahimahiDelay delay(20);
    MahimahiLink link(trace_ms());
    std::vector<std::string> out;
    std::vector<std::string> passed;
    delivered = 0;
    Time next{};
    int sent = 0;
    const std::uint64_t end_ms = 12'000;
    for (std::uint64_t ms = 0; ms < end_ms; ++ms) {
      for (; sent < kPackets && next < Time{std::chrono::milliseconds(ms + 1)}; ++sent, next += kGap) {
        delay.enter(std::string(kOctets, 'x'), ms);
      }
      delay.release(ms, passed);
      if (with_trace) {
        for (std::string& packet : passed) link.enter(std::move(packet));
        link.release(ms, out);
      } else {
        std::swap(passed, out);
      }
      delivered += out.size();
      passed.clear();
      out.clear();
    }
  }
  count(state, delivered);
}

}  // namespace

BENCHMARK_CAPTURE(link_virtual, ours_delay, "delay");
BENCHMARK_CAPTURE(link_virtual, ours_trace, "trace");
BENCHMARK_CAPTURE(link_virtual, ours_wifi5, "wifi5");
BENCHMARK_CAPTURE(link_virtual, ours_codel, "codel");
BENCHMARK_CAPTURE(emulator_virtual, ours_delay, "delay");
BENCHMARK_CAPTURE(emulator_virtual, ours_trace, "trace");
BENCHMARK_CAPTURE(mahimahi_virtual, mahimahi_delay, false);
BENCHMARK_CAPTURE(mahimahi_virtual, mahimahi_trace, true);

}  // namespace atlaswire::bench
