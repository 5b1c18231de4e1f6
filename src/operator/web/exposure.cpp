#include "operator/web/exposure.h"

#include <fmt/format.h>

#include "operator/web/token.h"

namespace heel {

std::string page_exposure(const ViewConfig& config) {
  if (config.address.empty()) return "";
  const bool token = Token::read(config.token_file).set();
  const bool this_computer_alone = config.address.starts_with("127.") || config.address.starts_with("[::1]");
  const char* const change = token ? "who knows the token can change settings and start the robot"
                                   : "there is no token (view.token_file), so nothing can be changed there";
  if (this_computer_alone)
    return fmt::format("view.address: {}: the page is for this computer alone; {}", config.address, change);
  return fmt::format(
      "view.address: {}: the page is open to the network, without encryption: everybody there can look and "
      "stop the robot; {} (docs/page.md)",
      config.address, change);
}

}  // namespace heel
