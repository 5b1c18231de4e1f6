#include "logging/journal_sink.h"

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/uio.h>
#include <systemd/sd-journal.h>

#include <array>
#include <mutex>

namespace heel {

namespace {

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    std::vector<std::string> fields = journal_fields(message);
    std::vector<iovec> parts;
    parts.reserve(fields.size());
    for (std::string& field : fields) parts.push_back({field.data(), field.size()});
    // Without a journal the message is lost; nothing waits for it.
    sd_journal_sendv(parts.data(), static_cast<int>(parts.size()));
  }
  void flush_() override {}
};

}  // namespace

void log_event(const LogTopic& topic, spdlog::level::level_enum level, const std::string& text) {
  // spdlog carries the place in the source beside a message's text. heel does not log it and uses its members
  // for the fields.
  spdlog::log(spdlog::source_loc{topic.part, 1, topic.event}, level, "{}", text);
}

std::vector<std::string> journal_fields(const spdlog::details::log_msg& message) {
  // syslog(3):                                trace debug info warn  error critical off
  static constexpr std::array<char, 7> kPriority{'7', '7', '6', '4', '3', '2', '7'};
  std::vector<std::string> fields;
  fields.emplace_back("MESSAGE=").append(message.payload.data(), message.payload.size());
  fields.emplace_back("PRIORITY=").push_back(kPriority[static_cast<std::size_t>(message.level)]);
  fields.emplace_back("SYSLOG_IDENTIFIER=heeld");
  if (!message.source.empty()) {
    fields.push_back(fmt::format("HEEL_PART={}", message.source.filename));
    fields.push_back(fmt::format("HEEL_EVENT={}", message.source.funcname));
  }
  return fields;
}

spdlog::sink_ptr make_journal_sink() {
  return std::make_shared<JournalSink>();
}

}  // namespace heel
