#include "loopback/mqtt/mqtt_broker.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <sstream>
#include <stdexcept>

namespace heel::test {
namespace {

void run_or_throw(const std::vector<std::string>& argv) {
  const Outcome outcome = run_program(argv);
  if (outcome.status != 0) throw std::runtime_error(argv.front() + ": " + outcome.out + outcome.err);
}

/// An authority, and a certificate of it for 127.0.0.1.
void make_certificates(const TemporaryFolder& folder) {
  const std::vector<std::string> request = {
      "/usr/bin/openssl",        "req",    "-x509", "-newkey", "ec", "-pkeyopt",
      "ec_paramgen_curve:P-256", "-nodes", "-days", "2"};
  auto authority = request;
  authority.insert(authority.end(), {"-subj", "/CN=authority", "-keyout", folder.file("ca.key"), "-out",
                                     folder.file("ca.pem")});
  run_or_throw(authority);
  auto server = request;
  server.insert(server.end(), {"-subj", "/CN=broker", "-addext", "subjectAltName=IP:127.0.0.1", "-CA",
                               folder.file("ca.pem"), "-CAkey", folder.file("ca.key"), "-addext",
                               "basicConstraints=critical,CA:FALSE", "-keyout", folder.file("server.key"),
                               "-out", folder.file("server.pem")});
  run_or_throw(server);
}

}  // namespace

std::uint16_t free_port() {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  const bool bound = bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(fd);
  if (!bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

MqttBroker::MqttBroker(const Access& access) : access_(access) {
  std::string config = "user root\nlog_dest file " + folder_.file("log") +
                       "\nlog_type all\nconnection_messages true\npersistence false\nlistener " +
                       std::to_string(port_) + " 127.0.0.1\n";
  if (access.user.empty()) {
    config += "allow_anonymous true\n";
  } else {
    run_or_throw(
        {"/usr/bin/mosquitto_passwd", "-b", "-c", folder_.file("passwords"), access.user, access.password});
    config += "allow_anonymous false\npassword_file " + folder_.file("passwords") + "\n";
  }
  if (access.tls) {
    make_certificates(folder_);
    config += "certfile " + folder_.file("server.pem") + "\nkeyfile " + folder_.file("server.key") + "\n";
  }
  write_text(folder_.file("mosquitto.conf"), config);
}

void MqttBroker::start() {
  process_ = std::make_unique<Process>(
      std::vector<std::string>{"/usr/sbin/mosquitto", "-c", folder_.file("mosquitto.conf")},
      folder_.file("output"));
  const bool listens = eventually([this] {
    return run_program(client("mosquitto_pub", {"-t", "x", "-m", ""})).status == 0;
  });
  if (!listens) throw std::runtime_error("mosquitto: " + process_->output() + log());
}

void MqttBroker::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

std::string MqttBroker::address() const {
  return (access_.tls ? "ssl" : "tcp") + std::string("://127.0.0.1:") + std::to_string(port_);
}

std::vector<std::string> MqttBroker::client(const std::string& program,
                                            const std::vector<std::string>& more) const {
  std::vector<std::string> argv = {"/usr/bin/" + program, "-h", "127.0.0.1", "-p", std::to_string(port_)};
  if (!access_.user.empty()) argv.insert(argv.end(), {"-u", access_.user, "-P", access_.password});
  if (access_.tls) argv.insert(argv.end(), {"--cafile", ca_file()});
  argv.insert(argv.end(), more.begin(), more.end());
  return argv;
}

MqttReader::MqttReader(const MqttBroker& broker)
    : process_(broker.client("mosquitto_sub", {"-q", "1", "-t", "#", "-F", "%t\t%p"})) {}

std::vector<std::string> MqttReader::of(const std::string& topic) const {
  std::vector<std::string> found;
  std::istringstream lines(process_.output());
  for (std::string line; std::getline(lines, line);) {
    if (lines.eof()) break;  // not whole yet
    if (line.starts_with(topic + "\t")) found.push_back(line.substr(topic.size() + 1));
  }
  return found;
}

std::string MqttReader::newest(const std::string& topic) const {
  const std::vector<std::string> all = of(topic);
  return all.empty() ? "" : all.back();
}

nlohmann::json MqttReader::newest_json(const std::string& topic) const {
  const std::string text = newest(topic);
  return text.empty() ? nlohmann::json() : nlohmann::json::parse(text);
}

bool MqttReader::hears(const std::string& topic, const std::string& text) const {
  return eventually([&] { return newest(topic) == text; });
}

}  // namespace heel::test
