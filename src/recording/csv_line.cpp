#include "recording/csv_line.h"

#include <charconv>
#include <cmath>

namespace heel {

namespace {

/// The shortest text that reads back as the same number.
class NumberText {
 public:
  template <typename Number>
  explicit NumberText(Number value) {
    end_ = std::to_chars(bytes_.data(), bytes_.data() + bytes_.size(), value).ptr;
  }
  std::string_view view() const { return {bytes_.data(), static_cast<std::size_t>(end_ - bytes_.data())}; }

 private:
  std::array<char, 32> bytes_{};  // the longest, a double, has 24
  char* end_ = nullptr;
};

}  // namespace

void CsvLine::put(char c) {
  // Space for the line end is kept; a line that is too long is cut.
  if (size_ + 1 < kCapacity) bytes_[size_++] = c;
}

void CsvLine::put(std::string_view characters) {
  for (const char c : characters) put(c);
}

void CsvLine::begin_cell() {
  if (size_ > 0) put(',');
}

void CsvLine::number(double value) {
  begin_cell();
  put(std::isnan(value) ? "nan" : NumberText(value).view());
}

void CsvLine::integer(std::int64_t value) {
  begin_cell();
  put(NumberText(value).view());
}

void CsvLine::integer(std::uint64_t value) {
  begin_cell();
  put(NumberText(value).view());
}

void CsvLine::seconds(TimeNs t_ns) {
  begin_cell();
  if (t_ns < 0) put('-');
  const auto magnitude = t_ns < 0 ? -static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  put(NumberText(magnitude / kNsPerS).view());
  put('.');
  std::uint64_t rest = magnitude % kNsPerS;
  for (std::uint64_t unit = kNsPerS / 10; unit > 0; unit /= 10) {
    put(static_cast<char>('0' + rest / unit));
    rest %= unit;
  }
}

void CsvLine::text(std::string_view value) {
  begin_cell();
  for (const char c : value) put(c == ',' || c == '"' || c == '\n' || c == '\r' ? ' ' : c);
}

std::string_view CsvLine::finish() {
  bytes_[size_++] = '\n';
  const std::string_view line(bytes_.data(), size_);
  size_ = 0;
  return line;
}

}  // namespace heel
