#include "evaluation/metrics/process_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "heel/error.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr double kMegabytesPerKilobyte = 1024e-6;

/// Empty when it is gone.
std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The number after "Key:" of a file as /proc/PID/status; 0 without one.
std::uint64_t number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key + ":");
  return at == std::string::npos ? 0 : std::strtoull(text.c_str() + at + key.size() + 2, nullptr, 10);
}

/// Fields 10 and 12 of /proc/PID/stat are faults; the name before them may hold spaces.
void read_faults(const std::string& stat, ThreadFigures& thread) {
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return;
  std::istringstream fields(stat.substr(name_end + 1));
  std::string field;
  for (int number = 3; fields >> field; ++number) {
    if (number == 10) thread.minor_faults = std::stoull(field);
    if (number == 12) thread.major_faults = std::stoull(field);
  }
}

void read_scheduling(ThreadFigures& thread) {
  thread.policy = sched_getscheduler(thread.id) & ~SCHED_RESET_ON_FORK;
  sched_param parameters{};
  if (sched_getparam(thread.id, &parameters) == 0) thread.priority = parameters.sched_priority;
  sched_getaffinity(thread.id, sizeof thread.cores, &thread.cores);
}

fs::path folder_of(pid_t process) {
  const fs::path folder = fmt::format("/proc/{}", process);
  if (!fs::exists(folder / "task")) throw Error(fmt::format("process {}: has ended", process));
  return folder;
}

}  // namespace

std::vector<ThreadFigures> threads_of(pid_t process) {
  std::vector<ThreadFigures> threads;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(process) / "task")) {
    ThreadFigures thread;
    thread.id = std::atoi(entry.path().filename().c_str());
    const std::string status = text_of(entry.path() / "status");
    if (status.empty()) continue;
    thread.name = text_of(entry.path() / "comm");
    if (thread.name.ends_with('\n')) thread.name.pop_back();
    thread.cpu_s = 1e-9 * std::strtod(text_of(entry.path() / "schedstat").c_str(), nullptr);
    thread.switches = number_after(status, "voluntary_ctxt_switches");
    thread.forced_switches = number_after(status, "nonvoluntary_ctxt_switches");
    read_faults(text_of(entry.path() / "stat"), thread);
    read_scheduling(thread);
    threads.push_back(thread);
  }
  std::sort(threads.begin(), threads.end(),
            [](const ThreadFigures& a, const ThreadFigures& b) { return a.id < b.id; });
  return threads;
}

MemoryFigures memory_of(pid_t process) {
  const fs::path folder = folder_of(process);
  MemoryFigures memory;
  const std::string status = text_of(folder / "status");
  const auto mb = [&](const char* key) {
    return kMegabytesPerKilobyte * static_cast<double>(number_after(status, key));
  };
  memory.resident_mb = mb("VmRSS");
  memory.peak_mb = mb("VmHWM");
  memory.locked_mb = mb("VmLck");

  std::map<std::string, MappingFigures> by_name;
  std::istringstream lines(text_of(folder / "smaps"));
  MappingFigures* current = nullptr;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::array<std::string, 6> word;
    for (std::string& each : word) words >> each;
    if (!word[0].ends_with(':')) {
      current = &by_name[word[5].empty() ? "anonymous" : fs::path(word[5]).filename().string()];
    } else if (current != nullptr && (word[0] == "Pss:" || word[0] == "Rss:")) {
      (word[0] == "Pss:" ? current->pss_mb : current->resident_mb) +=
          kMegabytesPerKilobyte * std::strtod(word[1].c_str(), nullptr);
    }
  }
  for (auto& [name, mapping] : by_name) {
    mapping.name = name;
    memory.mappings.push_back(mapping);
  }
  std::sort(memory.mappings.begin(), memory.mappings.end(),
            [](const MappingFigures& a, const MappingFigures& b) { return a.pss_mb > b.pss_mb; });
  return memory;
}

}  // namespace heel::evaluation
