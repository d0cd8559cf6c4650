#pragma once
// The vector units' part of offset_model.h: inputs are gathered and weighed a row at a time. Integers, so the same on
// every processor.

#include <cstdint>
#include <span>

#include "core/exa/coding/range_coder.h"
#include "core/exa/offsets/offset_model.h"

namespace dubsar {

void begin_offsets(const OffsetNetwork& network, int axis, const OffsetPlace& place, std::span<const std::uint8_t> xs,
                   OffsetRow& row);
OffsetEstimate finish_offset(const OffsetNetwork& network, const OffsetNetwork::Sums& sums, const OffsetNear& near);

/// Offsets of OffsetTable::kBits bits of the edges of a row that was begun; `known` as OffsetWindow::open_row().
void decode_offset_row(const OffsetNetwork& network, int axis, std::span<const std::uint8_t> xs, const OffsetRow& row,
                       RangeDecoder& in, std::uint8_t* known, std::uint16_t* offsets);

}  // namespace dubsar
