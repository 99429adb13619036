#include "tools/stop_on_signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "tools/exit_code.hpp"

namespace tissue_stiffness {
namespace {

StopRequest stop_request;
std::atomic<bool> signalled{false};

void on_signal(int) {
  if (signalled.exchange(true)) _exit(static_cast<int>(ExitCode::interrupted));
  stop_request.stop();
}

}  // namespace

StopRequest& stop_on_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigset_t held;
  sigemptyset(&held);
  for (const int number : {SIGINT, SIGTERM}) {
    sigaction(number, &action, nullptr);
    sigaddset(&held, number);
  }
  sigprocmask(SIG_UNBLOCK, &held, nullptr);  // since the start (start/start.cpp)
  return stop_request;
}

}  // namespace tissue_stiffness
