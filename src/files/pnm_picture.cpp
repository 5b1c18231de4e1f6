#include "files/pnm_picture.h"

#include <cctype>
#include <cstddef>

namespace heel {
namespace {

constexpr int kMostValue = 65535;

/// The next whole number of the header, past white space and comments; -1 when there is none.
int next_number(ByteView file, std::size_t& at) {
  for (; at < file.size() && (std::isspace(file[at]) != 0 || file[at] == '#'); ++at) {
    if (file[at] != '#') continue;
    while (at < file.size() && file[at] != '\n') ++at;
  }
  int value = -1;
  for (; at < file.size() && std::isdigit(file[at]) != 0; ++at) {
    value = (value < 0 ? 0 : value) * 10 + (file[at] - '0');
    if (value > kMostValue) return -1;
  }
  return value;
}

}  // namespace

int largest_value_of_pnm(ByteView file) {
  if (file.size() < 3 || file[0] != 'P') return 0;
  if (file[1] != '2' && file[1] != '3' && file[1] != '5' && file[1] != '6') return 0;
  std::size_t at = 2;
  const int width_px = next_number(file, at), height_px = next_number(file, at);
  const int largest = next_number(file, at);
  return width_px > 0 && height_px > 0 && largest > 0 ? largest : 0;
}

}  // namespace heel
