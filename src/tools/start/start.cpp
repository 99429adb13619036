// Starts the tool beside it, NAME.tool, with SIGINT and SIGTERM held back until that listens (stop_on_signals.hpp). Loading
// a tool's libraries takes tenths of a second, in which a signal would otherwise end it before it has written anything. For
// the same reason nothing here needs a library.
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int main(int, char** argv) {
  sigset_t held;
  sigemptyset(&held);
  sigaddset(&held, SIGINT);
  sigaddset(&held, SIGTERM);
  sigprocmask(SIG_BLOCK, &held, nullptr);
  char tool[PATH_MAX + sizeof ".tool"] = "";
  if (readlink("/proc/self/exe", tool, PATH_MAX) > 0) strcat(tool, ".tool");
  execv(tool, argv);
  perror(tool);
  return 1;
}
