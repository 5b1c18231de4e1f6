#include "files/kpd_file.h"

#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "files/output_file.h"

namespace heel {
namespace {

static_assert(std::endian::native == std::endian::little,
              "KPD files are little endian, and values are written as they lie in memory");

constexpr std::int32_t kKpdMagic = 0x4244504B;  // "KPDB"
constexpr std::int32_t kVersion = 1;
constexpr float kSizePerSigma = 7.5f;

using Record = std::array<float, 7>;

Record record_of(const Feature& feature) {
  return {feature.x_px,
          feature.y_px,
          kSizePerSigma * feature.sigma_px,
          feature.angle_rad * (180.f / std::numbers::pi_v<float>),
          feature.response,
          static_cast<float>(feature.octave),
          static_cast<float>(feature.laplacian)};
}

void write_text(const FeatureSet& features, int width_px, int height_px, OutputFile& file) {
  file.print("KPDT {} {} {} {} {} {} {}\n", kVersion, features.features.size(), kDescriptorSize, width_px,
             height_px, width_px, height_px);
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    for (const float value : record_of(features.features[i])) file.print("{:.9g} ", value);
    file.print("{:.9g}\n", fmt::join(features.descriptors[i], " "));
  }
}

template <typename Values>
std::string_view bytes_of(const Values& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]};
}

void write_binary(const FeatureSet& features, int width_px, int height_px, OutputFile& file) {
  const std::array<std::int32_t, 8> header{
      kKpdMagic,       kVersion, static_cast<std::int32_t>(features.features.size()),
      kDescriptorSize, width_px, height_px,
      width_px,        height_px};
  file.write(bytes_of(header));
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    file.write(bytes_of(record_of(features.features[i])));
    file.write(bytes_of(features.descriptors[i]));
  }
}

}  // namespace

void write_kpd_file(const FeatureSet& features, int width_px, int height_px, const std::string& path) {
  OutputFile file(path);
  if (path.ends_with(".txt")) {
    write_text(features, width_px, height_px, file);
  } else {
    write_binary(features, width_px, height_px, file);
  }
  file.flush();
}

}  // namespace heel
