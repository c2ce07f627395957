#include "lab/child_process.h"

#include "base/program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

extern char** environ;

namespace atlaswire::lab {
namespace {

constexpr std::size_t kMostErrorText = 64 * 1024;

/// Both ends closed on exec, the reading one not blocking.
struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw ProgramError(ExitCode::kInternal, std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    read_end = ends[0];
    write_end = ends[1];
    fcntl(read_end, F_SETFL, O_NONBLOCK);
  }
};

/// Ours and `more`, where it does not overrule ours.
std::vector<std::string> full_environment(const std::vector<std::string>& more) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
  for (const std::string& entry : more) {
    const std::string name = entry.substr(0, entry.find('=') + 1);
    const auto same = [&](const std::string& other) { return other.starts_with(name); };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(entry);
  }
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

/// Signals as a fresh program expects them, in a group of its own.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGINT);
    sigaddset(&defaults, SIGTERM);
    posix_spawnattr_setsigdefault(&attributes_, &defaults);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

void read_available(int fd, std::string& text) {
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(fd, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::vector<std::string>& environment) {
  const Pipe out;
  const Pipe error;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, error.write_end, STDERR_FILENO);
  std::vector<std::string> words = command;
  std::vector<std::string> settings = full_environment(environment);
  const SpawnAttributes attributes;
  const int failure = posix_spawnp(&pid_, command.front().c_str(), &actions, attributes.get(),
                                   pointers(words).data(), pointers(settings).data());
  posix_spawn_file_actions_destroy(&actions);
  close(out.write_end);
  close(error.write_end);
  out_ = out.read_end;
  error_ = error.read_end;
  if (failure == 0) return;
  close(out_);
  close(error_);
  throw ProgramError(ExitCode::kInternal, "cannot start " + command.front() + ": " + std::strerror(failure));
}

ChildProcess::~ChildProcess() {
  if (!exit_code_) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(out_);
  close(error_);
}

void ChildProcess::read_some() {
  read_available(out_, out_text_);
  read_available(error_, error_text_);
  if (error_text_.size() > kMostErrorText) error_text_.erase(0, error_text_.size() - kMostErrorText);
}

void ChildProcess::reap() {
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::optional<int> ChildProcess::ended() {
  if (!exit_code_) reap();
  read_some();
  return exit_code_;
}

void ChildProcess::signal(int number) {
  if (!exit_code_) kill(-pid_, number);
}

int ChildProcess::stop(std::chrono::milliseconds patience) {
  signal(SIGTERM);
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!ended() && std::chrono::steady_clock::now() < end)
    wait_for_any({this}, std::chrono::milliseconds(20));
  if (!ended()) signal(SIGKILL);
  while (!ended()) wait_for_any({this}, std::chrono::milliseconds(20));
  return *ended();
}

void wait_for_any(const std::vector<ChildProcess*>& children, std::chrono::milliseconds limit) {
  std::vector<pollfd> waits;
  for (const ChildProcess* child : children) {
    waits.push_back({child->out_fd(), POLLIN, 0});
    waits.push_back({child->error_fd(), POLLIN, 0});
  }
  const int ready = poll(waits.data(), waits.size(), static_cast<int>(limit.count()));
  const auto hung_up = [](const pollfd& p) { return (p.revents & POLLIN) == 0; };
  // A pipe that its program closed stays ready for ever; give the program a moment to end.
  if (ready > 0 && std::all_of(waits.begin(), waits.end(), hung_up)) poll(nullptr, 0, 1);
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \r\n\t");
  if (end == std::string::npos) return {};
  const auto start = text.rfind('\n', end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     end - (start == std::string::npos ? 0 : start + 1) + 1);
}

std::string own_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

}  // namespace atlaswire::lab
