#include "files/kpd_file.h"

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <numbers>

#include "heel/error.h"

namespace heel {
namespace {

static_assert(std::endian::native == std::endian::little, "KPD is written in the machine's own order");

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

void write_text(const FeatureSet& features, int width_px, int height_px, std::FILE* file) {
  std::fprintf(file, "KPDT %d %zu %d %d %d %d %d\n", kVersion, features.features.size(), kDescriptorSize,
               width_px, height_px, width_px, height_px);
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    for (const float value : record_of(features.features[i]))
      std::fprintf(file, "%.9g ", static_cast<double>(value));
    for (std::size_t k = 0; k < kDescriptorSize; ++k)
      std::fprintf(file, "%s%.9g", k == 0 ? "" : " ", static_cast<double>(features.descriptors[i][k]));
    std::fputc('\n', file);
  }
}

void write_binary(const FeatureSet& features, int width_px, int height_px, std::FILE* file) {
  const std::array<std::int32_t, 8> header{
      kKpdMagic,       kVersion, static_cast<std::int32_t>(features.features.size()),
      kDescriptorSize, width_px, height_px,
      width_px,        height_px};
  std::fwrite(header.data(), sizeof header[0], header.size(), file);
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    const Record record = record_of(features.features[i]);
    std::fwrite(record.data(), sizeof record[0], record.size(), file);
    std::fwrite(features.descriptors[i].data(), sizeof(float), kDescriptorSize, file);
  }
}

}  // namespace

void write_kpd_file(const FeatureSet& features, int width_px, int height_px, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) throw Error(path + ": cannot write: " + std::strerror(errno));
  if (path.ends_with(".txt")) {
    write_text(features, width_px, height_px, file);
  } else {
    write_binary(features, width_px, height_px, file);
  }
  const bool failed = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || failed) throw Error(path + ": cannot write: " + std::strerror(errno));
}

}  // namespace heel
