#include "meshing/run_apart.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

bool write_all(int file, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

constexpr int kPatience = 100;  // [ms] between checkpoints

std::string read_all(int file, const std::function<void()>& checkpoint) {
  std::string bytes;
  std::array<char, 65536> buffer;
  while (true) {
    checkpoint();
    pollfd ready{file, POLLIN, 0};
    if (poll(&ready, 1, kPatience) <= 0) continue;
    const ssize_t count = read(file, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return bytes;
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

[[noreturn]] void be_child(int result, const std::function<std::string()>& work, unsigned seconds) {
  for (const int number : {SIGALRM, SIGSEGV, SIGABRT, SIGPIPE}) signal(number, SIG_DFL);
  for (const int number : {SIGINT, SIGTERM}) signal(number, SIG_IGN);  // the parent decides what to do
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  alarm(seconds);
  const int null = open("/dev/null", O_WRONLY);
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
  int status = 1;
  try {
    if (write_all(result, work())) status = 0;
  } catch (...) {
  }
  _exit(status);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

}  // namespace

std::optional<std::string> run_apart(const std::function<std::string()>& work, unsigned seconds,
                                     const std::function<void()>& checkpoint) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw NumericalError("no pipe to a child process");
  const pid_t child = fork();
  if (child == 0) be_child(ends[1], work, seconds);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw NumericalError("no child process");
  }
  std::string bytes;
  try {
    bytes = read_all(ends[0], checkpoint);
  } catch (...) {
    kill(child, SIGKILL);
    close(ends[0]);
    wait_for(child);
    throw;
  }
  close(ends[0]);
  const int status = wait_for(child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return bytes;
}

}  // namespace tissue_stiffness
