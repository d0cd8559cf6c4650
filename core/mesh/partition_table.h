#pragma once
// Partitions: the labelled pieces of a surface, and the bodies that they bound.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

using PartitionId = std::uint8_t;

/// What a partition is. kOther: named by a foreign file.
enum class PartitionKind : std::uint8_t {
  kObject,
  kTablet,
  kEnvelopeOutside,
  kEnvelopeInside,
  kFragment,
  kPores,
  kOther
};

/// "tablet", "envelope outside", ...; fragments are numbered, so that theirs only starts with "fragment".
std::string_view partition_kind_name(PartitionKind kind) noexcept;
/// The kind that a partition of this name has.
PartitionKind partition_kind_of(std::string_view name) noexcept;

/// One labelled piece of surface. Partitions that bound the same body share its name: "envelope outside" and "envelope
/// inside" are two partitions of the body "envelope". Figures are those of the partition's own surface with its fill
/// patches, so a cavity wall such as "envelope inside" has a negative volume and the partitions of a body add up.
struct Partition {
  PartitionId id = 0;  ///< below PartitionTable::kMost
  std::string name{};  ///< "tablet", "envelope outside", "object", "fragment 1", "pores and crumbs", ...
  std::string body{};  ///< "tablet", "envelope", ...; empty: the partition bounds a body of its own
  double area_mm2 = 0.0;
  double volume_mm3 = 0.0;  ///< signed volume enclosed; where it ends at another of its body, by cones
  bool watertight = false;
  PartitionKind kind = PartitionKind::kOther;  ///< a table finds out by the name where this is kOther
  /// Of pores and crumbs whose place was looked at (pores_by_body.h): the body that they go with. No file has it.
  std::string within{};

  /// The body's name, also where the partition has one of its own.
  const std::string& body_name() const noexcept { return body.empty() ? name : body; }
};

/// The partitions of a surface in rising order of their ids, at most kMost. A model has all ids from 0 on; a mesh with
/// some of its parts keeps their ids.
class PartitionTable {
 public:
  static constexpr std::size_t kMost = 8;  ///< three bits in files and shaders
  static constexpr PartitionId kHighest = kMost - 1;
  static constexpr PartitionId kNone = 255;  ///< no partition

  PartitionTable() = default;
  /// For tables that the program itself makes: an id that is too high or used twice is our own mistake.
  PartitionTable(std::initializer_list<Partition> partitions);

  /// kBadData: the id is too high or taken.
  Result<void> insert(Partition partition);
  /// Takes over the partitions of `other` whose ids are free.
  void merge(const PartitionTable& other);
  /// A partition with the next id; the table must not be full. Its name is that of the kind unless given, its body
  /// bears the same name unless given.
  PartitionId add(PartitionKind kind, std::string_view body = {}, std::string name = {});
  /// Stores what was measured.
  void measured(PartitionId id, double area_mm2, double volume_mm3, bool watertight);
  /// Stores which body a partition goes with.
  void lies_within(PartitionId id, std::string_view body);
  void clear() noexcept { rows_.clear(); }

  std::size_t size() const noexcept { return rows_.size(); }
  bool empty() const noexcept { return rows_.empty(); }
  bool full() const noexcept { return rows_.size() == kMost; }
  auto begin() const noexcept { return rows_.begin(); }
  auto end() const noexcept { return rows_.end(); }
  /// Row by place, which in a model is the id.
  const Partition& operator[](std::size_t row) const { return rows_[row]; }

  const Partition* find(PartitionId id) const noexcept;
  const Partition* find(PartitionKind kind) const noexcept;  ///< the first of its kind
  const Partition* find(std::string_view name) const noexcept;
  /// The first partition that bounds the same body: what tells bodies apart. An id without a row stands for itself.
  PartitionId body_of(PartitionId id) const noexcept;
  /// Names of the bodies, each once, in the order of their first partitions.
  std::vector<std::string> body_names() const;
  /// "tablet (0), envelope outside (1)", for messages.
  std::string listed() const;

  /// The table of a model and the labels of its faces fit each other: ids from 0 on without gaps, every label has a
  /// row; without a table all labels are 0. kBadData; `what` starts the sentence, `of` names a labelled face.
  Result<void> check_complete(std::span<const PartitionId> labels, std::string_view what, std::string_view of) const;

 private:
  std::vector<Partition> rows_;
};

/// {"id":0,"name":"tablet","part":"tablet","area_mm2":..,"volume_mm3":..,"watertight":true}: a row of the table, the
/// same in EXA files, mesh files and reports. The body stands under "part".
nlohmann::ordered_json partition_json(const Partition& partition);
nlohmann::ordered_json partitions_json(const PartitionTable& table);
/// The inverse. kBadData: id or name missing, an id that is too high; figures that are missing count as 0.
Result<Partition> parse_partition(const nlohmann::json& json);

}  // namespace dubsar
