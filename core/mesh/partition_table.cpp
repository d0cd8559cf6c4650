#include "core/mesh/partition_table.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace dubsar {
namespace {

using nlohmann::ordered_json;

/// In the order of PartitionKind.
constexpr std::array<std::string_view, 7> kKindNames{
    "object", "tablet", "envelope outside", "envelope inside", "fragment", "pores and crumbs", "other"};
static_assert(kKindNames.size() == static_cast<std::size_t>(PartitionKind::kOther) + 1);

bool is_fragment(std::string_view name) {
  constexpr std::string_view kStart = "fragment ";
  return name.starts_with(kStart) && name.size() > kStart.size() &&
         name.find_first_not_of("0123456789", kStart.size()) == std::string_view::npos;
}

}  // namespace

std::string_view partition_kind_name(PartitionKind kind) noexcept { return kKindNames[static_cast<std::size_t>(kind)]; }

PartitionKind partition_kind_of(std::string_view name) noexcept {
  if (is_fragment(name)) return PartitionKind::kFragment;
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  return found == kKindNames.end() ? PartitionKind::kOther : static_cast<PartitionKind>(found - kKindNames.begin());
}

PartitionTable::PartitionTable(std::initializer_list<Partition> partitions) {
  for (const Partition& partition : partitions) {
    const Result<void> inserted = insert(partition);
    DUBSAR_CHECK(inserted.has_value());
  }
}

Result<void> PartitionTable::insert(Partition partition) {
  if (partition.id > kHighest)
    return fail(ErrorKind::kBadData, "partition table: id {} found, expected 0..{}", partition.id, kHighest);
  const auto place = std::lower_bound(rows_.begin(), rows_.end(), partition.id,
                                      [](const Partition& row, PartitionId id) { return row.id < id; });
  if (place != rows_.end() && place->id == partition.id)
    return fail(ErrorKind::kBadData, "partition table: id {} found twice, expected each once", partition.id);
  if (partition.kind == PartitionKind::kOther) partition.kind = partition_kind_of(partition.name);
  rows_.insert(place, std::move(partition));
  return {};
}

void PartitionTable::merge(const PartitionTable& other) {
  for (const Partition& partition : other)
    if (find(partition.id) == nullptr) static_cast<void>(insert(partition));
}

PartitionId PartitionTable::add(PartitionKind kind, std::string_view body, std::string name) {
  Partition partition;
  partition.id = rows_.empty() ? PartitionId{0} : static_cast<PartitionId>(rows_.back().id + 1);
  partition.name = name.empty() ? std::string(partition_kind_name(kind)) : std::move(name);
  partition.body = body.empty() ? partition.name : std::string(body);
  partition.kind = kind;
  const Result<void> inserted = insert(std::move(partition));
  DUBSAR_CHECK(inserted.has_value());
  return rows_.back().id;
}

void PartitionTable::measured(PartitionId id, double area_mm2, double volume_mm3, bool watertight) {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Partition& p) { return p.id == id; });
  DUBSAR_CHECK(row != rows_.end());
  row->area_mm2 = area_mm2;
  row->volume_mm3 = volume_mm3;
  row->watertight = watertight;
}

void PartitionTable::lies_within(PartitionId id, std::string_view body) {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Partition& p) { return p.id == id; });
  DUBSAR_CHECK(row != rows_.end());
  row->within = body;
}

const Partition* PartitionTable::find(PartitionId id) const noexcept {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Partition& p) { return p.id == id; });
  return row == rows_.end() ? nullptr : &*row;
}

const Partition* PartitionTable::find(PartitionKind kind) const noexcept {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Partition& p) { return p.kind == kind; });
  return row == rows_.end() ? nullptr : &*row;
}

const Partition* PartitionTable::find(std::string_view name) const noexcept {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Partition& p) { return p.name == name; });
  return row == rows_.end() ? nullptr : &*row;
}

PartitionId PartitionTable::body_of(PartitionId id) const noexcept {
  const Partition* const partition = find(id);
  if (partition == nullptr) return id;
  const auto first = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Partition& p) { return p.body_name() == partition->body_name(); });
  return first->id;
}

std::vector<std::string> PartitionTable::body_names() const {
  std::vector<std::string> names;
  for (const Partition& p : rows_)
    if (body_of(p.id) == p.id) names.push_back(p.body_name());
  return names;
}

std::string PartitionTable::listed() const {
  std::string text;
  for (const Partition& p : rows_) text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", p.name, p.id);
  return text;
}

Result<void> PartitionTable::check_complete(std::span<const PartitionId> labels, std::string_view what,
                                            std::string_view of) const {
  for (std::size_t row = 0; row < rows_.size(); ++row)
    if (rows_[row].id != row)
      return fail(ErrorKind::kBadData, "{}: partition {} found at place {} of the table, expected ids from 0 on", what,
                  rows_[row].id, row);
  const std::size_t ids = std::max<std::size_t>(rows_.size(), 1);
  for (const PartitionId label : labels)
    if (label >= ids)
      return fail(ErrorKind::kBadData, "{}: {} has partition {}, expected less than {}", what, of, label, ids);
  return {};
}

ordered_json partition_json(const Partition& partition) {
  return {{"id", partition.id},
          {"name", partition.name},
          {"part", partition.body},
          {"area_mm2", partition.area_mm2},
          {"volume_mm3", partition.volume_mm3},
          {"watertight", partition.watertight}};
}

ordered_json partitions_json(const PartitionTable& table) {
  ordered_json rows = ordered_json::array();
  for (const Partition& partition : table) rows.push_back(partition_json(partition));
  return rows;
}

Result<Partition> parse_partition(const nlohmann::json& json) {
  const auto member = [&](const char* key) -> const nlohmann::json* {
    if (!json.is_object()) return nullptr;
    const auto found = json.find(key);
    return found == json.end() ? nullptr : &*found;
  };
  const auto number = [&](const char* key) {
    const nlohmann::json* const value = member(key);
    return value != nullptr && value->is_number() ? value->get<double>() : 0.0;
  };
  const nlohmann::json *const id = member("id"), *const name = member("name"), *const body = member("part"),
                              *const watertight = member("watertight");
  if (id == nullptr || !id->is_number_integer() || name == nullptr || !name->is_string())
    return fail(ErrorKind::kBadData, "partition table: a row without id or name, expected both in every row");
  const auto number_of = id->get<std::int64_t>();
  if (number_of < 0 || number_of > PartitionTable::kHighest)
    return fail(ErrorKind::kBadData, "partition table: id {} found, expected 0..{}", number_of,
                PartitionTable::kHighest);
  Partition partition;
  partition.id = static_cast<PartitionId>(number_of);
  partition.name = name->get<std::string>();
  if (body != nullptr && body->is_string()) partition.body = body->get<std::string>();
  partition.area_mm2 = number("area_mm2");
  partition.volume_mm3 = number("volume_mm3");
  partition.watertight = watertight != nullptr && watertight->is_boolean() && watertight->get<bool>();
  partition.kind = partition_kind_of(partition.name);
  return partition;
}

}  // namespace dubsar
