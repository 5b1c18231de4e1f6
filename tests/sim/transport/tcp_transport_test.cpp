// Who is served on the robot's TCP port: one client, until it goes or falls silent.
#include "sim/transport/tcp_transport.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <string>

#include "support/process.h"

namespace heel::sim {
namespace {

FileDescriptor client_of(const TcpTransport& transport) {
  FileDescriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(transport.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return client;
}

/// All that the transport says until it closes the connection.
std::string until_closed(const FileDescriptor& client) {
  std::string all;
  std::array<char, 256> buffer{};
  for (ssize_t size; (size = ::recv(client.get(), buffer.data(), buffer.size(), 0)) > 0;)
    all.append(buffer.data(), static_cast<std::size_t>(size));
  return all;
}

bool becomes_present(TcpTransport& transport) {
  return test::eventually([&] { return transport.client_present(); });
}

void say(const FileDescriptor& client) {
  ASSERT_EQ(::send(client.get(), "x", 1, MSG_NOSIGNAL), 1);
}

/// True when a byte comes through.
bool hears(TcpTransport& transport) {
  std::array<std::uint8_t, 8> into{};
  return test::eventually([&] { return transport.read(into) > 0; });
}

TEST(TcpTransport, AClientThatSpeaksKeepsItsPlaceAndAnotherIsTold) {
  TcpTransport transport("127.0.0.1", 0, std::chrono::minutes(10));
  const FileDescriptor first = client_of(transport);
  ASSERT_TRUE(becomes_present(transport));
  const FileDescriptor second = client_of(transport);
  std::string news;
  ASSERT_TRUE(test::eventually([&] {
    EXPECT_TRUE(transport.client_present()) << "the first stays";
    news = transport.take_news();
    return !news.empty();
  }));
  EXPECT_EQ(news, "another client refused: one is connected");
  EXPECT_EQ(until_closed(second), "heel-sim: in use by another client\r\n");
  say(first);
  EXPECT_TRUE(hears(transport));
}

TEST(TcpTransport, AClientThatComesAtOnceAfterAnotherHasClosedIsServed) {
  TcpTransport transport("127.0.0.1", 0, std::chrono::minutes(10));
  FileDescriptor first = client_of(transport);
  ASSERT_TRUE(becomes_present(transport));
  say(first);
  first.close();
  const FileDescriptor next = client_of(transport);
  EXPECT_TRUE(transport.client_present()) << "its last byte is not read yet";
  EXPECT_TRUE(hears(transport));
  std::array<std::uint8_t, 8> into{};
  ASSERT_TRUE(test::eventually([&] {
    transport.read(into);
    return !transport.client_present();
  })) << "the caller sees that it has gone";
  ASSERT_TRUE(becomes_present(transport));
  EXPECT_EQ(transport.take_news(), "") << "nobody was refused";
  say(next);
  EXPECT_TRUE(hears(transport));
}

TEST(TcpTransport, AClientThatHasFallenSilentGivesWay) {
  TcpTransport transport("127.0.0.1", 0, std::chrono::milliseconds(0));
  const FileDescriptor half_dead = client_of(transport);
  ASSERT_TRUE(becomes_present(transport));
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(transport.client_present()) << "nobody else wants the robot";
  const FileDescriptor next = client_of(transport);
  ASSERT_TRUE(test::eventually([&] { return !transport.client_present(); }))
      << "the caller sees that it has gone";
  EXPECT_EQ(transport.take_news(), "client let go: it has sent nothing for 0 s, and another one has come");
  ASSERT_TRUE(transport.client_present());
  say(next);
  EXPECT_TRUE(hears(transport));
  EXPECT_EQ(until_closed(half_dead), "");
}

TEST(TcpTransport, AClientThatHasGoneMakesRoom) {
  TcpTransport transport("127.0.0.1", 0);
  {
    const FileDescriptor first = client_of(transport);
    ASSERT_TRUE(becomes_present(transport));
  }
  std::array<std::uint8_t, 8> into{};
  EXPECT_TRUE(test::eventually([&] {
    transport.read(into);
    return !transport.client_present();
  }));
  const FileDescriptor second = client_of(transport);
  ASSERT_TRUE(becomes_present(transport));
  say(second);
  EXPECT_TRUE(hears(transport));
  EXPECT_EQ(transport.take_news(), "");
}

}  // namespace
}  // namespace heel::sim
