#include "lab/sweep.h"

#include "base/time.h"
#include "lab/child_process.h"
#include "lab/point_process.h"

#include <algorithm>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>

namespace atlaswire::lab {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// What every program of the house puts before an error (base/program.h).
constexpr std::string_view kErrorMark = ": error: ";

/// One point under way.
struct Running {
  const PlannedPoint* point;
  std::unique_ptr<ChildProcess> process;
  Time start;
  double progress = 0;
};

/// Takes whole "progress 0.25" lines off a child's output; the newest wins.
void take_progress(std::string& text, double& progress) {
  constexpr std::string_view kWord = "progress ";
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    double v = 0;
    if (text.starts_with(kWord) &&
        std::from_chars(text.data() + kWord.size(), text.data() + end, v).ec == std::errc{}) {
      progress = std::clamp(v, 0.0, 1.0);
    }
    text.erase(0, end + 1);
  }
}

class Sweep {
 public:
  Sweep(const Plan& plan, const Store& store, const SweepSettings& settings,
        const std::function<void(const SweepProgress&)>& report)
      : plan_(plan), store_(store), settings_(settings), report_(report) {
    const std::vector<std::string> finished = store.finished();
    std::set<std::string> known(finished.begin(), finished.end());
    for (const PlannedPoint& point : plan.points) {
      if (std::binary_search(finished.begin(), finished.end(), point.id)) ++outcome_.reused;
      if (known.insert(point.id).second) waiting_.push_back(&point);
    }
    std::reverse(waiting_.begin(), waiting_.end());
    total_ = waiting_.size();
  }

  SweepOutcome run(const std::function<bool()>& should_stop) {
    while (!waiting_.empty() || !running_.empty()) {
      if (should_stop && should_stop()) {
        outcome_.interrupted = true;
        stop_all();
        break;
      }
      while (running_.size() < settings_.jobs && !waiting_.empty()) start_next();
      wait();
      collect();
    }
    return std::move(outcome_);
  }

 private:
  void start_next() {
    const PlannedPoint& point = *waiting_.back();
    waiting_.pop_back();
    const fs::path folder = store_.point_folder(point.id);
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    fs::create_directories(folder, ignored);
    write_whole(folder / "settings.json", settings_json(point));
    std::vector<std::string> command = settings_.command;
    for (const std::string& word :
         {std::string("--settings"), (folder / "settings.json").string(), std::string("--out"),
          folder.string(), std::string("--truth"), store_.truth_folder().string()}) {
      command.push_back(word);
    }
    running_.push_back(
        {&point, std::make_unique<ChildProcess>(command, settings_.environment), steady_now()});
  }

  void wait() {
    std::vector<ChildProcess*> children;
    for (const Running& r : running_) children.push_back(r.process.get());
    wait_for_any(children, 200ms);
  }

  void collect() {
    for (std::size_t i = 0; i < running_.size();) {
      Running& r = running_[i];
      const auto code = r.process->ended();
      take_progress(r.process->out_text(), r.progress);
      if (!code) {
        ++i;
        continue;
      }
      const Running gone = std::move(r);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      finish(gone, *code);
    }
    report_(progress());
  }

  void finish(const Running& gone, int code) {
    SweepProgress p = progress();
    p.finished = label(*gone.point, plan_);
    p.finished_s = to_seconds(steady_now() - gone.start);
    ++p.done;
    if (code == 0 && fs::exists(store_.point_folder(gone.point->id) / "result.json")) {
      ++outcome_.done;
    } else {
      std::string line = last_line(gone.process->error_text());
      if (const auto at = line.find(kErrorMark); at != std::string::npos)
        line.erase(0, at + kErrorMark.size());
      outcome_.failed.push_back({gone.point->id, p.finished, code, line.empty() ? "it said nothing" : line});
      p.failure = &outcome_.failed.back();
    }
    report_(p);
  }

  void stop_all() {
    for (Running& r : running_) r.process->signal(SIGTERM);
    for (Running& r : running_) {
      if (r.process->stop(5s) == 0) continue;
      std::error_code ignored;
      fs::remove_all(store_.point_folder(r.point->id), ignored);
    }
    running_.clear();
  }

  [[nodiscard]] SweepProgress progress() const {
    SweepProgress p{total_, outcome_.done + outcome_.failed.size()};
    double work = static_cast<double>(p.done);
    for (const Running& r : running_) work += r.progress;
    p.fraction = total_ == 0 ? 1 : work / static_cast<double>(total_);
    return p;
  }

  const Plan& plan_;
  const Store& store_;
  const SweepSettings& settings_;
  const std::function<void(const SweepProgress&)>& report_;
  std::vector<const PlannedPoint*> waiting_;  // the next one last
  std::vector<Running> running_;
  std::size_t total_ = 0;
  SweepOutcome outcome_;
};

}  // namespace

SweepOutcome run_sweep(const Plan& plan, const Store& store, const SweepSettings& settings,
                       const std::function<void(const SweepProgress&)>& report,
                       const std::function<bool()>& should_stop) {
  return Sweep(plan, store, settings, report).run(should_stop);
}

}  // namespace atlaswire::lab
