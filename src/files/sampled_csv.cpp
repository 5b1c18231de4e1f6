#include "files/sampled_csv.h"

#include <iterator>
#include <utility>

namespace heel {

void SampledCsv::add_column(const std::string& name, int decimals, std::function<double()> value) {
  columns_.push_back({name, decimals, std::move(value)});
}

void SampledCsv::write_row() {
  std::string text;
  if (!has_header_) {
    for (const Column& column : columns_) text += (text.empty() ? "" : ",") + column.name;
    text += '\n';
    has_header_ = true;
  }
  const char* separator = "";
  for (const Column& column : columns_) {
    fmt::format_to(std::back_inserter(text), "{}{:.{}f}", separator, column.value(), column.decimals);
    separator = ",";
  }
  text += '\n';
  file_.write(text);
}

}  // namespace heel
