#pragma once
// A grid of floats that is made slice by slice and read again: in memory, or in a scratch file where it would not fit.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/files/scratch_file.h"
#include "core/base/system/budget.h"
#include "core/volume/slab_source.h"

namespace dubsar {

enum class GridPlace { kMemory, kScratch };

/// Where a grid of these dims is to lie: in memory where it takes at most 60 % of the budget, since what is made of it
/// needs room, too; else in a scratch file.
GridPlace place_for(const Dims& dims, const Budget& budget);

/// Slices are written in any order and as often as wanted; those of a scratch file carry sums, and one that comes back
/// from the disk with others is an error (kIo) instead of a wrong surface. A reader in rising order may have slices
/// rewritten behind it. One caller at a time.
class GridStore final : public SlabSource {
 public:
  GridStore() = default;
  /// kTryAgain: memory or disk has no room; those of ScratchFile.
  static Result<GridStore> create(const Dims& dims, GridFrame frame, GridPlace place, const Budget& budget);
  /// Takes a volume over.
  explicit GridStore(Volume<float> volume, GridFrame frame = {});
  /// The volume of a store in memory, which is empty then.
  Volume<float> take_volume() { return std::move(volume_); }

  Dims dims() const noexcept override { return dims_; }
  const GridFrame& frame() const noexcept override { return frame_; }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  /// Where slices [z_begin, z_end) are to be written to, before they are stored: the memory itself, or a page that is
  /// overwritten by the next call.
  std::span<float> page(std::int64_t z_begin, std::int64_t z_end);
  /// Keeps what was written to page(z_begin, z_end).
  Result<void> store(std::int64_t z_begin, std::int64_t z_end);

  bool in_memory() const noexcept { return !scratch_.has_value(); }
  /// Bytes on the disk.
  std::int64_t scratch_bytes() const noexcept;
  /// Gives memory or disk back; dims() and frame() stay.
  void release();

 private:
  Dims dims_;
  GridFrame frame_;
  Volume<float> volume_;
  std::optional<ScratchFile> scratch_;
  std::vector<std::uint64_t> sums_;  ///< of each slice on the disk
  Buffer<float> page_;
};

}  // namespace dubsar
