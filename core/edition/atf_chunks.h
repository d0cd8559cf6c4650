#pragma once
// A text of ATF cut where object, side or column changes. Part of this room.

#include <string>
#include <vector>

#include "core/edition/atf.h"
#include "core/edition/text_passages.h"

namespace dubsar {

struct AtfChunk {
  std::string object = "tablet", surface{};  ///< surface: empty until one is named
  int column = 0;
  bool tail = false;  ///< a block of translation at the end
  std::vector<AtfLine> lines{};
  /// Lines without a side are on the obverse.
  std::string side() const { return surface.empty() ? "obverse" : surface; }
};

std::vector<AtfChunk> chunks_of(const AtfFile& text);

/// Whether a line says more of the numbered line above it.
bool belongs_to_line(AtfKind kind);

/// Places of objects and sides in the order of reading, from 0.
int rank_of_object(std::string_view object);
int rank_of_surface(std::string_view surface);

}  // namespace dubsar
