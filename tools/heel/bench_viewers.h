// People who look at heeld's page while it is measured: for heel bench control.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace heel::cli {

class BenchViewers {
 public:
  /// Each gets the live records and pictures of the page on 127.0.0.1:`port`, and asks for the next picture
  /// when it has one, as a browser does. Throws heel::Error when nothing serves it.
  BenchViewers(std::uint16_t port, int count);
  ~BenchViewers();
  BenchViewers(const BenchViewers&) = delete;
  BenchViewers& operator=(const BenchViewers&) = delete;

  /// Pictures that came, to all of them: they show that the load was there.
  std::size_t pictures() const { return pictures_; }

 private:
  void look(std::uint16_t port);

  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> pictures_{0};
  std::vector<std::thread> threads_;
};

}  // namespace heel::cli
