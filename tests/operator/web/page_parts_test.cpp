// What the page's server is made of, without a network: tokens, hosts and origins, limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "operator/web/address_limits.h"
#include "operator/web/lateness_counts.h"
#include "operator/web/origin.h"
#include "operator/web/token.h"
#include "support/complaint.h"
#include "support/environment.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string token_file(const test::TemporaryFolder& folder, const std::string& text,
                       fs::perms mode = fs::perms::owner_read) {
  const std::string file = folder.file("view-token");
  fs::remove(file);
  test::write_text(file, text);
  fs::permissions(file, mode);
  return file;
}

TEST(PageToken, IsTheFilesTextWithoutItsEnd) {
  const test::TemporaryFolder folder;
  const Token token = Token::read(token_file(folder, "0123456789abcdef\n"));
  EXPECT_TRUE(token.equals("0123456789abcdef"));
  for (const char* other : {"", "0123456789abcde", "0123456789abcdeF", "0123456789abcdef0",
                            "0123456789abcdef\n", "0123456789abcdef0123456789abcdef"})
    EXPECT_FALSE(token.equals(other)) << other;
  EXPECT_FALSE(Token().equals("")) << "without a token nothing equals it";
}

TEST(PageToken, ComesFromTheServicesCredentialWithoutAFile) {
  const test::TemporaryFolder folder;
  const test::ScopedEnvironment credentials("CREDENTIALS_DIRECTORY", folder.path().string());
  EXPECT_FALSE(Token::read("").set()) << "the service has other credentials only";
  token_file(folder, "0123456789abcdef");
  EXPECT_TRUE(Token::read("").equals("0123456789abcdef"));
}

TEST(PageToken, AFileThatCannotBeUsedIsNamed) {
  const test::TemporaryFolder folder;
  const auto complaint = [](const std::string& file) {
    return test::complaint_of([&] { Token::read(file); });
  };
  EXPECT_THAT(complaint(folder.file("none")), HasSubstr("none: cannot be read: No such file"));
  EXPECT_THAT(complaint(token_file(folder, "short\n")), HasSubstr("5 bytes (expected 16 to 512"));
  EXPECT_THAT(complaint(token_file(folder, std::string(600, 'a'))), HasSubstr("(expected 16 to 512"));
  EXPECT_THAT(
      complaint(token_file(folder, "0123456789abcdef", fs::perms::owner_read | fs::perms::others_read)),
      HasSubstr("other users can read it"));
}

TEST(PageOrigin, HostsAreAddressesLocalhostAndNames) {
  const std::vector<std::string> names = {"robot.local"};
  for (const char* ours : {"127.0.0.1", "192.168.1.7:8080", "[::1]:8080", "[fe80::1]", "localhost:80",
                           "LOCALHOST", "robot.local", "Robot.Local:8080"})
    EXPECT_TRUE(host_is_ours(ours, names)) << ours;
  for (const char* other : {"", ":80", "evil.example", "robot.local.evil.example", "127.0.0.1.nip.io", "[::1",
                            "1.2.3", "local", "localhost.evil.example:80"})
    EXPECT_FALSE(host_is_ours(other, names)) << other;
}

TEST(PageOrigin, OriginsAreOfTheHostThatIsAsked) {
  EXPECT_TRUE(origin_is_ours("", "robot:80")) << "no browser";
  EXPECT_TRUE(origin_is_ours("http://robot:80", "robot:80"));
  EXPECT_TRUE(origin_is_ours("https://Robot", "robot")) << "behind a proxy with TLS";
  for (const char* other :
       {"null", "http://robot", "http://robot:81", "http://evil", "ftp://robot:80", "robot:80"})
    EXPECT_FALSE(origin_is_ours(other, "robot:80")) << other;
}

TEST(PageOrigin, ViewersOfOtherSitesAreNamed) {
  const std::vector<std::string> names = {"viewer.example"};
  EXPECT_TRUE(origin_is_named("https://viewer.example", names));
  EXPECT_TRUE(origin_is_named("http://viewer.example:3000", names));
  for (const char* other : {"", "null", "https://evil.example", "https://127.0.0.1", "viewer.example",
                            "https://viewer.example.evil.example"})
    EXPECT_FALSE(origin_is_named(other, names)) << other;
}

TEST(PageLimits, AnAllowanceComesBackWithTime) {
  Allowance allowance(2.0, 3.0);
  TimeNs now_ns = kNsPerS;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(allowance.take(now_ns));
  EXPECT_FALSE(allowance.take(now_ns));
  now_ns += kNsPerS / 2;
  EXPECT_TRUE(allowance.take(now_ns));
  EXPECT_FALSE(allowance.take(now_ns));
  allowance.give_back(now_ns);
  EXPECT_TRUE(allowance.take(now_ns));
  EXPECT_FALSE(allowance.full(now_ns));
  EXPECT_TRUE(allowance.full(now_ns + 2 * kNsPerS));
}

TEST(PageLimits, AnIpv6NetworkCountsAsOneAddress) {
  EXPECT_EQ(counted_address("2001:db8:1:2:aaaa::1"), counted_address("2001:db8:1:2:bbbb::9"));
  EXPECT_NE(counted_address("2001:db8:1:2::1"), counted_address("2001:db8:1:3::1"));
  EXPECT_EQ(counted_address("::ffff:192.168.1.7"), "192.168.1.7");
  EXPECT_EQ(counted_address("192.168.1.7"), "192.168.1.7");
}

TEST(PageLimits, ManyAddressesTakeBoundedTriesAndTheQuietAreForgotten) {
  AddressLimits limits;
  TimeNs now_ns = kNsPerS;
  int allowed = 0;
  for (int i = 0; i < 3000; ++i)
    allowed += limits.may_try_token("10.0." + std::to_string(i / 250) + "." + std::to_string(i % 250), now_ns)
                   ? 1
                   : 0;
  EXPECT_EQ(allowed, 60) << "of all addresses together";
  now_ns += 120 * kNsPerS;
  EXPECT_TRUE(limits.may_try_token("10.9.9.9", now_ns));
}

TEST(PageMetrics, LatenessIsCountedInItsStep) {
  LatenessCounts counts;
  for (const TimeNs lateness_ns : {TimeNs{0}, TimeNs{20'000}, TimeNs{20'001}, 3 * kNsPerMs, kNsPerS})
    counts.add(lateness_ns);
  const LatenessCounts::Values values = counts.values();
  EXPECT_EQ(values.counts[0], 2u);
  EXPECT_EQ(values.counts[1], 1u);
  EXPECT_EQ(values.counts[7], 1u);
  EXPECT_EQ(values.counts.back(), 1u);
  EXPECT_EQ(values.sum_ns, 40'001 + 3 * kNsPerMs + kNsPerS);
}

}  // namespace
}  // namespace heel
