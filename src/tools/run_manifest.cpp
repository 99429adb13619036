#include "tools/run_manifest.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <list>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

#include "tissue_stiffness/types/error.hpp"
#include "tools/exit_code.hpp"
#include "tools/read_text.hpp"
#include "types/pending_file.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause{5};
constexpr const char* kAside = ".part-";  // begins the names of folders whose rows are not over

/// A row that is estimated by a process.
struct Running {
  const ManifestRow* row;
  fs::path aside, folder;
  pid_t process;
};

std::string host() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

// A folder on a disk that many machines share is that of a process on one of them.
std::string aside_prefix(pid_t process) {
  return kAside + host() + "-" + std::to_string(process) + "-";
}

// Removes what processes of this machine left that were killed outright.
void clear_leftovers(const fs::path& output) {
  const std::string begin = kAside + host() + "-";
  for (const auto& entry : fs::directory_iterator(output)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(begin, 0) != 0) continue;
    const long process = std::strtol(name.c_str() + begin.size(), nullptr, 10);
    if (process > 0 && kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) fs::remove_all(entry.path());
  }
}

// Ends with its parent, however that ends.
pid_t start(const std::vector<std::string>& arguments, const std::string& log) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw InputError("--threads", "no process can be started", "fewer at once");
  if (child > 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int out = open("/dev/null", O_WRONLY), error = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (getppid() != parent || dup2(out, STDOUT_FILENO) < 0 || dup2(error, STDERR_FILENO) < 0) _exit(1);
  execv("/proc/self/exe", argv.data());
  _exit(1);
}

Running begin(const ManifestRow& row, const fs::path& folder, const ManifestTask& task, std::size_t number) {
  Running out{&row, fs::path(task.output) / (aside_prefix(getpid()) + std::to_string(number)), folder, 0};
  fs::create_directories(out.aside);
  std::vector<std::string> arguments{"estimate", row.model_file,     row.recording_file,
                                     "--output", out.aside.string(), "--quiet"};
  arguments.insert(arguments.end(), task.arguments.begin(), task.arguments.end());
  out.process = start(arguments, (out.aside / "log.txt").string());
  return out;
}

std::string last_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

bool is_answer(int code) {
  return code == static_cast<int>(ExitCode::answered) || code == static_cast<int>(ExitCode::wrong_input) ||
         code == static_cast<int>(ExitCode::not_to_be_used);
}

// A status is written last, so a folder that has one is whole.
bool is_answered(const fs::path& folder) {
  const nlohmann::json status = read_json(folder / "status.json");
  return status.is_object() && is_answer(status.value("exit_code", 1));
}

void put_in_place(const Running& done, int code, const std::string& message) {
  const nlohmann::json status{
      {"model", done.row->model_file}, {"recording", done.row->recording_file}, {"exit_code", code}, {"message", message}};
  write_file((done.aside / "status.json").string(), [&](std::ostream& out) {
    out << status.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  });
  fs::remove_all(done.folder);
  std::error_code taken;
  fs::rename(done.aside, done.folder, taken);
  if (taken) fs::remove_all(done.aside);  // another process was as fast with the same row
}

// Takes what an ended process left.
void finish(const Running& done, int status, ManifestOutcome& outcome) {
  const bool killed = WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (killed || code == static_cast<int>(ExitCode::interrupted)) {
    ++outcome.interrupted;
    fs::remove_all(done.aside);
    return;
  }
  ++(is_answer(code) ? outcome.answered : outcome.failed);
  std::string message;
  if (WIFSIGNALED(status)) message = "ended by signal " + std::to_string(WTERMSIG(status));
  if (code == static_cast<int>(ExitCode::wrong_input) || code == static_cast<int>(ExitCode::failed)) {
    message = last_line(done.aside / "log.txt");
  }
  put_in_place(done, code, message);
}

}  // namespace

void read_shard(const std::string& text, ManifestTask& task) {
  char* end = nullptr;
  const unsigned long shard = std::strtoul(text.c_str(), &end, 10);
  const unsigned long shards = *end == '/' ? std::strtoul(end + 1, &end, 10) : 0;
  if (*end != '\0' || shard < 1 || shard > shards) {
    throw InputError("--shard", text, "I/N, such as 2/3, with 1 <= I <= N");
  }
  task.shard = shard;
  task.shards = shards;
}

ManifestOutcome run_manifest(const Manifest& manifest, const ManifestTask& task,
                             const std::function<void(std::size_t, std::size_t)>& tell, const StopRequest& stop) {
  ManifestOutcome out;
  clear_leftovers(task.output);
  const std::size_t total = (manifest.rows.size() + task.shards - task.shard) / task.shards;
  std::size_t over = 0, next = task.shard - 1;
  std::set<fs::path> begun;
  std::list<Running> running;
  bool told_to_end = false;
  while (!running.empty() || (next < manifest.rows.size() && !stop.stopped())) {
    while (next < manifest.rows.size() && running.size() < task.processes && !stop.stopped()) {
      const ManifestRow& row = manifest.rows[next];
      const fs::path folder = fs::path(task.output) / result_folder(row, task.arguments);
      const bool known = !begun.insert(folder).second || (task.resume && is_answered(folder));
      if (known) {
        ++out.kept;
        tell(++over, total);
      } else {
        running.push_back(begin(row, folder, task, next));
      }
      next += task.shards;
    }
    if (stop.stopped() && !std::exchange(told_to_end, true)) {
      for (const Running& row : running) kill(row.process, SIGTERM);
    }
    for (auto row = running.begin(); row != running.end();) {
      int status = 0;
      if (waitpid(row->process, &status, WNOHANG) != row->process) {
        ++row;
        continue;
      }
      finish(*row, status, out);
      row = running.erase(row);
      tell(++over, total);
    }
    if (!running.empty()) std::this_thread::sleep_for(kPause);
  }
  for (; next < manifest.rows.size(); next += task.shards) ++out.interrupted;
  return out;
}

}  // namespace tissue_stiffness
