#include "core/exa/patches/patch_evidence.h"

#include <algorithm>
#include <array>

#include "core/exa/coding/symbol_coder.h"

namespace dubsar {
namespace {

template <class Coder>
void code(Coder& coder, std::vector<FillPatch>& patches) {
  AdaptiveBit present;
  std::array<BitTree<2>, 16> models;  // by the two vertices before
  for (FillPatch& patch : patches) {
    const bool known = coder.bit(present, !patch.evidence.empty());
    patch.evidence.resize(known ? patch.extra_positions.size() : 0);
    std::size_t before = 0;
    for (std::uint8_t& evidence : patch.evidence) {
      evidence = static_cast<std::uint8_t>(models[before].code(coder, evidence));
      before = (before << 2 | evidence) & 15;
    }
  }
}

}  // namespace

bool has_patch_evidence(const std::vector<FillPatch>& patches) {
  return std::any_of(patches.begin(), patches.end(), [](const FillPatch& p) { return !p.evidence.empty(); });
}

std::vector<std::string> encode_patch_evidence(const std::vector<FillPatch>& patches) {
  std::vector<FillPatch> copy = patches;
  RangeEncoder out;
  BitSink sink{out};
  code(sink, copy);
  return {out.take()};
}

Result<void> decode_patch_evidence(std::span<const std::string_view> chunks, std::vector<FillPatch>& patches) {
  if (chunks.size() != 1)
    return fail(ErrorKind::kBadData, "exa: {} chunks of the patches' evidence found, 1 expected", chunks.size());
  RangeDecoder in(chunks[0]);
  BitSource source{in};
  code(source, patches);
  return {};
}

}  // namespace dubsar
