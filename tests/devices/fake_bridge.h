#pragma once
// Looking Glass Bridge as far as dubsar asks it: a server on a free loopback port with answers to its
// endpoints.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dubsar::test {

struct BridgeManners {
  bool chunked = false;      ///< the body in chunks of 100 bytes instead of with a length
  bool until_close = false;  ///< neither: it ends with the connection
  bool silent = false;       ///< accepts and never answers
  bool cut_short = false;    ///< closes in the middle of the body
};

/// A display as the service lists it.
struct FakeBridgeDevice {
  std::string id, hardware, calibration;
};

class FakeBridge {
 public:
  explicit FakeBridge(const std::vector<FakeBridgeDevice>& devices, BridgeManners manners = {});
  ~FakeBridge();
  std::uint16_t port() const noexcept { return port_; }
  /// Endpoints asked so far, in order.
  std::vector<std::string> asked() const;

 private:
  void serve();
  void answer(int connection);

  std::map<std::string, std::string> bodies_;  ///< by endpoint
  BridgeManners manners_;
  int listener_ = -1, stop_[2] = {-1, -1};
  std::uint16_t port_ = 0;
  mutable std::mutex mutex_;
  std::vector<std::string> asked_;
  std::thread thread_;
};

}  // namespace dubsar::test
