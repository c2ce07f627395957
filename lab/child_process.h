#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::lab {

/// A program started in a process group of its own, so that a terminal's Ctrl-C reaches it through us alone;
/// its standard output and error are read here, never blocking. Ended (SIGKILL) and reaped with the object.
class ChildProcess {
 public:
  /// `environment`: NAME=VALUE, set in addition unless already there. Throws ProgramError naming the program.
  ChildProcess(const std::vector<std::string>& command, const std::vector<std::string>& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] int out_fd() const { return out_; }
  [[nodiscard]] int error_fd() const { return error_; }

  /// Takes what can be read now from both pipes.
  void read_some();
  /// Everything read so far; the caller may cut from it.
  std::string& out_text() { return out_text_; }
  /// The end of it: 64 KiB at most are kept.
  [[nodiscard]] const std::string& error_text() const { return error_text_; }

  /// The exit code once it has ended (128 + number when a signal killed it), with both pipes read out.
  std::optional<int> ended();
  /// To its whole group.
  void signal(int number);
  /// SIGTERM, and SIGKILL if it has not ended after `patience`; gives the exit code.
  int stop(std::chrono::milliseconds patience);

 private:
  void reap();
  pid_t pid_ = -1;
  int out_ = -1;
  int error_ = -1;
  std::string out_text_;
  std::string error_text_;
  std::optional<int> exit_code_;
};

/// Sleeps until one of them has something to say, `limit` has passed, or a signal came.
void wait_for_any(const std::vector<ChildProcess*>& children, std::chrono::milliseconds limit);

/// The last line of a text that is not blank; "" if there is none.
std::string last_line(const std::string& text);

/// The absolute name of the running program.
std::string own_program();

}  // namespace atlaswire::lab
