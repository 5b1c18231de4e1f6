#include "telemetry/black_box.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "heel/error.h"
#include "recording/flow_json.h"

namespace heel {
namespace {

constexpr std::array<char, 8> kMagic{'H', 'E', 'E', 'L', 'B', 'O', 'X', '1'};

/// A regular file that is empty or a black box, also one of another version of heel: it may be overwritten.
bool may_become_black_box(int fd) {
  struct stat facts {};
  if (::fstat(fd, &facts) != 0 || !S_ISREG(facts.st_mode)) return false;
  if (facts.st_size == 0) return true;
  constexpr std::size_t kWithoutVersion = kMagic.size() - 1;
  std::array<char, kWithoutVersion> begin{};
  return ::pread(fd, begin.data(), begin.size(), 0) == static_cast<ssize_t>(begin.size()) &&
         std::equal(begin.begin(), begin.end(), kMagic.begin());
}

/// The newest `N` - 1 records. The position only counts up: it is raised after the record is whole, so that
/// what a crash leaves are whole records, but for the one that the next record was about to replace.
template <typename Record, std::size_t N>
struct Ring {
  std::atomic<std::uint64_t> count{0};
  std::array<Record, N> records;

  void add(const Record& record) {
    const std::uint64_t n = count.load(std::memory_order_relaxed);
    records[n % N] = record;
    count.store(n + 1, std::memory_order_release);
  }
  template <typename Take>
  void for_each(const Take& take) const {
    const std::uint64_t n = count.load(std::memory_order_acquire);
    for (std::uint64_t i = n >= N ? n - N + 1 : 0; i < n; ++i) take(records[i % N]);
  }
};

/// A file with other structs must not be read as these: a sum over their fields' names and types, and sizes.
std::uint64_t layout_sum() {
  std::uint64_t sum = 0xcbf29ce484222325;  // FNV-1a
  const auto add = [&](std::string_view text) {
    for (const char c : text) sum = (sum ^ static_cast<std::uint8_t>(c)) * 0x100000001b3;
  };
  add(flow_json_schema<TickRecord>(""));
  add(flow_json_schema<PoseEstimate>(""));
  add(flow_json_schema<Event>(""));
  add(flow_json_schema<WireBytes>(""));
  add(fmt::format("{} {} {} {}", sizeof(TickRecord), sizeof(PoseEstimate), sizeof(Event), sizeof(WireBytes)));
  return sum;
}

}  // namespace

struct BlackBox::Contents {
  std::array<char, 8> magic;
  std::uint64_t layout;
  std::atomic<std::uint32_t> ended;  // 1: the run has ended by itself
  RecordingClock clock;
  std::uint64_t configuration_number;
  TimeNs t_configuration_ns;
  std::atomic<std::uint32_t> configuration_bytes;
  std::array<char, 1 << 16> configuration;
  Ring<TickRecord, 1536> ticks;  // 30 s at 50 a second
  Ring<PoseEstimate, 1024> poses;
  Ring<Event, 256> events;
  Ring<WireBytes, 4096> wire;

  bool holds_a_run() const {
    return magic == kMagic && ended.load(std::memory_order_acquire) == 0 && ticks.count.load() > 0;
  }
  void save(const std::string& recording) const;
  void write(Recorder& recorder) const;
};

/// In place of a recording of that name. Throws heel::Error; then there is none.
void BlackBox::Contents::save(const std::string& recording) const {
  std::error_code none;
  std::filesystem::remove(recording, none);
  bool whole = false;
  {
    Recorder recorder(recording, clock);
    write(recorder);
    whole = recorder.finish();
  }
  if (whole) return;
  std::filesystem::remove(recording, none);
  throw Error(recording + ": the black box could not be written there (disk full?)");
}

/// In the order of time, as far as each topic has it.
void BlackBox::Contents::write(Recorder& recorder) const {
  const std::size_t bytes = std::min<std::size_t>(configuration_bytes.load(), configuration.size());
  recorder.record(
      ConfigurationText{t_configuration_ns, configuration_number, std::string(configuration.data(), bytes)});
  ticks.for_each([&](const TickRecord& tick) { recorder.record(tick); });
  poses.for_each([&](const PoseEstimate& pose) { recorder.record(pose); });
  events.for_each([&](const Event& event) { recorder.record(event); });
  wire.for_each([&](const WireBytes& piece) { recorder.record(piece); });
}

BlackBox::BlackBox(const std::string& path, RecordingClock clock) : path_(path) {
  const auto fail = [&](const char* what, int error) {
    if (fd_ >= 0) ::close(fd_);
    throw Error(fmt::format("telemetry.black_box {}: {}: {}", path, what, std::strerror(error)));
  };
  fd_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640);
  if (fd_ < 0 && errno == ENOENT)
    throw Error(fmt::format("telemetry.black_box {}: its folder is missing", path));
  if (fd_ < 0) fail("cannot create", errno);
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) fail("another heeld uses it", errno);
  if (!may_become_black_box(fd_)) {
    ::close(fd_);
    throw Error(
        fmt::format("telemetry.black_box {}: another file has this name (expected none, an empty one or a "
                    "black box of heel)",
                    path));
  }
  if (::ftruncate(fd_, 0) != 0) fail("cannot be emptied", errno);
  // It returns its error and leaves errno alone.
  if (const int error = ::posix_fallocate(fd_, 0, sizeof(Contents)); error != 0)
    fail("cannot be made", error);
  void* const memory = ::mmap(nullptr, sizeof(Contents), PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  if (memory == MAP_FAILED) fail("cannot be mapped", errno);
  contents_ = static_cast<Contents*>(memory);  // zeros, which are empty rings
  contents_->layout = layout_sum();
  contents_->clock = clock;
  contents_->magic = kMagic;
}

BlackBox::~BlackBox() {
  ::munmap(contents_, sizeof(Contents));
  ::close(fd_);
}

void BlackBox::add(const TickRecord& tick) {
  contents_->ticks.add(tick);
}

void BlackBox::add(const PoseEstimate& pose) {
  contents_->poses.add(pose);
}

void BlackBox::add(const Event& event) {
  contents_->events.add(event);
}

void BlackBox::add(const WireBytes& bytes) {
  contents_->wire.add(bytes);
}

void BlackBox::add(const ConfigurationText& configuration) {
  if (configuration.text.size() > contents_->configuration.size()) return;
  contents_->configuration_bytes.store(0);
  configuration.text.copy(contents_->configuration.data(), configuration.text.size());
  contents_->configuration_number = configuration.number;
  contents_->t_configuration_ns = configuration.t_ns;
  contents_->configuration_bytes.store(static_cast<std::uint32_t>(configuration.text.size()));
}

void BlackBox::save(const std::string& recording) const {
  contents_->save(recording);
}

void BlackBox::end() {
  contents_->ended.store(1, std::memory_order_release);
}

bool recover_black_box(const std::string& path, const std::string& recording) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return false;
  struct stat facts {};
  // One that a running heeld has is not left.
  const bool left = ::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &facts) == 0 &&
                    facts.st_size == static_cast<off_t>(sizeof(BlackBox::Contents));
  void* const memory =
      left ? ::mmap(nullptr, sizeof(BlackBox::Contents), PROT_READ, MAP_SHARED, fd, 0) : MAP_FAILED;
  ::close(fd);
  if (memory == MAP_FAILED) return false;
  const auto* const contents = static_cast<const BlackBox::Contents*>(memory);
  bool recovered = false;
  std::string why_not;
  try {
    if (contents->holds_a_run()) {
      if (contents->layout != layout_sum())
        throw Error(path + ": the black box of another build of heel (expected one of this build)");
      contents->save(recording);
      recovered = true;
    }
  } catch (const Error& error) {
    why_not = error.what();
  }
  ::munmap(memory, sizeof(BlackBox::Contents));
  if (!why_not.empty()) throw Error(why_not);
  return recovered;
}

}  // namespace heel
