#include "core/volume/grid_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "core/base/numbers/units.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// Of a slice: eight sums side by side, so that it costs less than reading the slice. Never 0, which is a slice that
/// was not written.
std::uint64_t sum_of(std::span<const float> values) {
  constexpr std::size_t kLanes = 8;
  constexpr std::uint64_t kPrime = 0x9E3779B185EBCA87ULL;
  std::array<std::uint64_t, kLanes> lanes{1, 2, 3, 4, 5, 6, 7, 8};
  const auto bytes = std::as_bytes(values);
  std::size_t at = 0;
  for (; at + sizeof lanes <= bytes.size(); at += sizeof lanes) {
    std::array<std::uint64_t, kLanes> words;
    std::memcpy(words.data(), bytes.data() + at, sizeof words);
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = (std::rotl(lanes[i], 23) ^ words[i]) * kPrime;
  }
  std::uint64_t sum = bytes.size();
  for (; at < bytes.size(); ++at) sum = (sum ^ std::to_integer<std::uint64_t>(bytes[at])) * kPrime;
  for (const std::uint64_t lane : lanes) sum = (std::rotl(sum, 23) ^ lane) * kPrime;
  return sum | 1;
}

std::int64_t bytes_of(const Dims& dims) { return dims.count() * static_cast<std::int64_t>(sizeof(float)); }

}  // namespace

GridPlace place_for(const Dims& dims, const Budget& budget) {
  constexpr double kShare = 0.6;
  const bool fits = static_cast<double>(bytes_of(dims)) <= kShare * static_cast<double>(budget.limit_bytes());
  return fits ? GridPlace::kMemory : GridPlace::kScratch;
}

GridStore::GridStore(Volume<float> volume, GridFrame frame)
    : dims_(volume.dims), frame_(std::move(frame)), volume_(std::move(volume)) {}

Result<GridStore> GridStore::create(const Dims& dims, GridFrame frame, GridPlace place, const Budget& budget) {
  GridStore grid;
  grid.dims_ = dims;
  grid.frame_ = std::move(frame);
  if (place == GridPlace::kMemory) {
    DUBSAR_TRY(check_memory("volume", static_cast<std::uint64_t>(bytes_of(dims)), budget));
    grid.volume_ = Volume<float>(dims);
    return grid;
  }
  std::error_code error;
  const std::filesystem::space_info disk = std::filesystem::space(budget.scratch_folder, error);
  if (!error && disk.available < static_cast<std::uintmax_t>(bytes_of(dims)))
    return fail(ErrorKind::kTryAgain,
                "volume: {:.1f} GiB do not fit into memory, and {} has {:.1f} GiB left; name a folder on another disk",
                gib_of(bytes_of(dims)), budget.scratch_folder.string(), gib_of(disk.available));
  DUBSAR_ASSIGN(grid.scratch_, ScratchFile::create(budget.scratch_folder));
  grid.sums_.assign(static_cast<std::size_t>(dims.z), 0);
  return grid;
}

Result<void> GridStore::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  if (!scratch_) return VolumeSource(volume_).read(z_begin, z_end, out);
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims_.z);
  const auto slice = static_cast<std::size_t>(dims_.slice());
  const auto count = static_cast<std::size_t>(z_end - z_begin);
  DUBSAR_CHECK(out.size() >= count * slice);
  DUBSAR_TRY(
      scratch_->read_at(z_begin * bytes_of({dims_.x, dims_.y, 1}), std::as_writable_bytes(out.first(count * slice))));
  std::vector<std::uint8_t> good(count, 0);
  parallel_for(z_end - z_begin, 1, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    good[at] = sum_of(out.subspan(at * slice, slice)) == sums_[static_cast<std::size_t>(z_begin) + at] ? 1 : 0;
  });
  for (std::size_t i = 0; i < count; ++i)
    if (good[i] == 0)
      return fail(ErrorKind::kIo,
                  "scratch file: slice {} came back from the disk with other bits than were written; look after the "
                  "disk, or name a folder on another one",
                  static_cast<std::size_t>(z_begin) + i);
  return {};
}

std::span<float> GridStore::page(std::int64_t z_begin, std::int64_t z_end) {
  DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims_.z);
  const std::int64_t count = (z_end - z_begin) * dims_.slice();
  if (!scratch_) return {volume_.row(0, z_begin), static_cast<std::size_t>(count)};
  if (page_.size() < count) page_ = Buffer<float>(count);
  return page_.span().first(static_cast<std::size_t>(count));
}

Result<void> GridStore::store(std::int64_t z_begin, std::int64_t z_end) {
  if (!scratch_) return {};
  const std::span<const float> written = page(z_begin, z_end);
  const auto slice = static_cast<std::size_t>(dims_.slice());
  parallel_for(z_end - z_begin, 1, [&](std::int64_t i) {
    sums_[static_cast<std::size_t>(z_begin + i)] = sum_of(written.subspan(static_cast<std::size_t>(i) * slice, slice));
  });
  return scratch_->write_at(z_begin * bytes_of({dims_.x, dims_.y, 1}), std::as_bytes(written));
}

std::int64_t GridStore::scratch_bytes() const noexcept { return scratch_ ? bytes_of(dims_) : 0; }

void GridStore::release() {
  volume_ = {};
  scratch_.reset();
  sums_ = {};
  page_ = {};
}

}  // namespace dubsar
