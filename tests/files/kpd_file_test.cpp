// The KPD writer: the binary and the text form, read back field by field.
#include "files/kpd_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::complaint_of;
using test::TemporaryFolder;

FeatureSet two_features() {
  FeatureSet set;
  Feature feature;
  feature.x_px = 12.25f;
  feature.y_px = 7.5f;
  feature.sigma_px = 1.2f;
  feature.angle_rad = 1.5707964f;
  feature.response = 0.015625f;
  feature.laplacian = -1;
  feature.octave = 1;
  set.features = {feature, Feature{}};
  Descriptor descriptor{};
  for (std::size_t k = 0; k < descriptor.size(); ++k) descriptor[k] = static_cast<float>(k) / 64.f;
  set.descriptors = {descriptor, Descriptor{}};
  return set;
}

TEST(KpdFile, BinaryHoldsEveryField) {
  const TemporaryFolder folder;
  const std::string path = folder.file("features.kpd");
  write_kpd_file(two_features(), 640, 480, path);
  ASSERT_EQ(std::filesystem::file_size(path), 4U * (8 + 2 * (7 + 64)));
  std::ifstream file(path, std::ios::binary);
  std::array<std::int32_t, 8> header;
  std::array<float, 71> record;
  file.read(reinterpret_cast<char*>(header.data()), sizeof header);
  file.read(reinterpret_cast<char*>(record.data()), sizeof record);
  EXPECT_EQ(std::memcmp(header.data(), "KPDB", 4), 0);
  EXPECT_EQ((std::array<std::int32_t, 7>{header[1], header[2], header[3], header[4], header[5], header[6],
                                         header[7]}),
            (std::array<std::int32_t, 7>{1, 2, 64, 640, 480, 640, 480}));
  const std::array<float, 7> expected{12.25f, 7.5f, 9.f, 90.f, 0.015625f, 1.f, -1.f};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(record[i], expected[i], 1e-5f) << i;
  EXPECT_EQ(record[7], 0.f);
  EXPECT_EQ(record[70], 63.f / 64.f);
}

TEST(KpdFile, TextHoldsEveryField) {
  const TemporaryFolder folder;
  const std::string path = folder.file("features.txt");
  write_kpd_file(two_features(), 640, 480, path);
  std::ifstream file(path);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "KPDT 1 2 64 640 480 640 480");
  std::array<double, 71> record;
  for (double& value : record) ASSERT_TRUE(file >> value);
  const std::array<double, 7> expected{12.25, 7.5, 9.0, 90.0, 0.015625, 1.0, -1.0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(record[i], expected[i], 1e-5) << i;
  EXPECT_NEAR(record[70], 63.0 / 64.0, 1e-7);
}

TEST(KpdFile, NamesTheFileItCannotWrite) {
  const std::string complaint =
      complaint_of([] { write_kpd_file(two_features(), 640, 480, "/nowhere/out.kpd"); });
  EXPECT_NE(complaint.find("/nowhere/out.kpd"), std::string::npos) << complaint;
}

}  // namespace
}  // namespace heel
