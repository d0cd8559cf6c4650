#pragma once
// Waiting for what another thread will bring about.

#include <chrono>
#include <thread>

namespace dubsar {

/// Asks for at most ten seconds.
template <class Condition>
bool eventually(const Condition& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < until) {
    if (condition()) return true;
    std::this_thread::yield();
  }
  return condition();
}

}  // namespace dubsar
