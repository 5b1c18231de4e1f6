// SURF features of a drawn chessboard, and one packet parsed.
#include <arcos/parser.h>
#include <arcos/sip.h>
#include <heel/features.h>

#include <cstdio>

int main() {
  std::vector<std::uint8_t> grey(320 * 240);
  for (int i = 0; i < 320 * 240; ++i) grey[i] = (i % 320 / 20 + i / 320 / 20) % 2 == 0 ? 40 : 210;
  heel::FeatureSet found;
  heel::FeatureExtractor(320, 240, {}).extract({{0, 0, 320, 240}, grey.data(), 320}, found);
  std::printf("%zu features\n", found.features.size());
  arcos::Parser().feed(arcos::encode_sip({}).bytes(), 0, [](const arcos::Packet& packet) {
    std::printf("packet 0x%02X of %zu bytes\n", packet.id(), packet.body.size());
  });
}
