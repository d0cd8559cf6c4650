#pragma once
// A transport that misbehaves to order, over any other one: what cables, hubs and firmware do on a bad day.

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "devices/transport/transport.h"

namespace dubsar {

enum class FaultKind {
  kDrop,      ///< the report is thrown away
  kTruncate,  ///< the report is cut to `length` bytes
  kGarbage,   ///< every byte is replaced by a random one
  kStall,     ///< reads time out; nothing is lost
  kUnplug,    ///< lost for good, at once
};

/// Concerns `count` reports, the first of which is number `at` (0: the first one that arrives); for kStall `count` is
/// a number of reads.
struct Fault {
  FaultKind kind = FaultKind::kDrop;
  std::uint64_t at = 0;
  std::uint64_t count = 1;
  std::size_t length = 0;
  bool operator==(const Fault&) const = default;
};

/// "drop@3,truncate@5:7,garbage@9x2,stall@12x40,unplug@20": KIND@AT[xCOUNT][:LENGTH]. kUsage: says which part is wrong.
Result<std::vector<Fault>> parse_faults(std::string_view text);

/// Same faults and seed, same bytes.
std::unique_ptr<Transport> make_fault_transport(std::unique_ptr<Transport> below, std::vector<Fault> faults,
                                                std::uint64_t seed = 1);

}  // namespace dubsar
