#pragma once
// One size check for every format: before memory is taken, the announced size is checked against what is there.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

struct Budget {
  std::uint64_t memory_bytes = 0;       ///< most that one object may take; 0: 80 % of MemAvailable
  std::uint64_t max_dimension = 65535;  ///< a scanner has 3072; more is a damaged header
  std::uint64_t max_voxels = std::uint64_t{1} << 36;
  /// Where a scratch file may be made when something must be kept that does not fit; on a disk.
  std::filesystem::path scratch_folder = "/var/tmp";

  /// Most that one object may take: memory_bytes, or 80 % of what is available now.
  std::uint64_t limit_bytes() const;
  /// Most that a stage may keep beside what it makes, such as a layer of chunks: a quarter of the limit.
  std::uint64_t kept_bytes() const { return limit_bytes() / 4; }
};

/// Bytes of memory this process may still take: MemAvailable, or the cgroup limit if smaller, or what the limit set
/// below leaves; what it has freed and kept counts as left. Everything that has a budget asks here, so that this is the
/// one accountant.
std::uint64_t available_memory_bytes();

/// The whole process is to keep below `bytes` from now on; 0: as much as there is. Call before work begins.
void set_memory_limit(std::uint64_t bytes) noexcept;
/// What was set; 0: nothing.
std::uint64_t memory_limit() noexcept;
/// Between steps that take much: where a limit is set, what is free goes back to the system (return_free_memory());
/// else it stays for the next step, for which its pages would have to be cleared again.
void keep_below_limit() noexcept;

/// Checks that `dims` are 1..max_dimension each and their product times `element_bytes` fits the voxel count limit.
/// Returns the number of elements. `what` names the object in the error text.
Result<std::int64_t> check_dims(std::string_view what, std::span<const std::uint64_t> dims, std::uint64_t element_bytes,
                                const Budget& budget = {});

/// Checks that `count` items of `item_bytes` on disk can be there when `bytes_left` bytes are left in the file.
Result<void> check_count(std::string_view what, std::uint64_t count, std::uint64_t item_bytes,
                         std::uint64_t bytes_left);

/// Checks that `bytes` of memory can be taken. kTryAgain with the size needed when not.
Result<void> check_memory(std::string_view what, std::uint64_t bytes, const Budget& budget = {});

}  // namespace dubsar
