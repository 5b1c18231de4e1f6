// The module's only export.
#include "operator/mqtt/paho/paho_line.h"

extern "C" [[gnu::visibility("default")]] heel::BrokerLine* heel_make_broker_line(
    const heel::BrokerLogin& login) {
  return new heel::PahoLine(login);
}
