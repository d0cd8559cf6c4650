#pragma once
// The data of a binary glTF file behind its accessors: plain, quantised, sparse, and packed by meshoptimizer.

#include <cstdint>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

tl::unexpected<Error> broken_glb(std::string_view what);

/// Null where the object has no such member.
const nlohmann::json* glb_member(const nlohmann::json& object, const char* key);
/// The number under `key`; `otherwise` when it is absent; nothing when it is not an integer 0..2^40.
std::optional<std::uint64_t> glb_number(const nlohmann::json& object, const char* key,
                                        std::optional<std::uint64_t> otherwise);
/// Element number `index` of the array under `key`; null where there is none.
const nlohmann::json* glb_element(const nlohmann::json& root, const char* key, std::optional<std::uint64_t> index);
/// An extension of an object; null where it has none of that name.
const nlohmann::json* glb_extension(const nlohmann::json& object, const char* name);

/// Items of one to four numbers. Borrows bytes of its GlbData.
struct GlbAccessor {
  std::string_view bytes;
  std::uint64_t count = 0, stride = 0, parts = 0;
  int component = 0;        ///< 5120 and on, as glTF names number types
  bool normalized = false;  ///< integers stand for 0..1 or -1..1

  bool floats() const noexcept { return component == 5126; }
  /// The number as the file has it; an index for integers.
  double raw(std::uint64_t item, std::uint64_t part) const;
  /// What it stands for.
  double at(std::uint64_t item, std::uint64_t part) const { return raw(item, part) * (normalized ? scale() : 1.0); }
  /// Of colours and texture coordinates, which are shares whether the file says so or not.
  double share(std::uint64_t item, std::uint64_t part) const { return raw(item, part) * scale(); }

 private:
  double scale() const noexcept;
};

class GlbData {
 public:
  /// `bin` outlives it.
  GlbData(nlohmann::json root, std::string_view bin) : root_(std::move(root)), bin_(bin) {}
  const nlohmann::json& root() const noexcept { return root_; }
  /// kBadData: no such accessor, or one that lies outside of the data; kTryAgain: memory for what has to be unpacked.
  Result<GlbAccessor> accessor(const nlohmann::json* index);
  /// Whether an accessor of this number exists and names numbers: of Draco they do not.
  bool has_bytes(const nlohmann::json* index) const;
  /// All bytes of a buffer view.
  Result<std::string_view> view(std::optional<std::uint64_t> index);

 private:
  Result<std::string_view> unpacked(std::uint64_t index, const nlohmann::json& packed);
  Result<std::string_view> raw_bytes(const nlohmann::json& holder);
  Result<void> fill_sparse(GlbAccessor& accessor, std::uint64_t item_bytes, const nlohmann::json& sparse);

  nlohmann::json root_;
  std::string_view bin_;
  std::map<std::uint64_t, std::string> unpacked_;  ///< by the number of the view
  std::deque<std::string> filled_;                 ///< sparse accessors
};

}  // namespace dubsar
