#pragma once
// A short file with a name that another program is given, gone with its owner.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dubsar {

class NamedScratch {
 public:
  /// In the folder for temporary files (TMPDIR), as STEM_XXXXXX and `suffix`, a name that nothing has; read and written
  /// by this user alone. Any thread. kCannotCreate, kPermission, kIo.
  static Result<std::shared_ptr<const NamedScratch>> create(std::string_view stem, std::string_view suffix,
                                                            std::string_view text);
  ~NamedScratch();
  NamedScratch(const NamedScratch&) = delete;
  NamedScratch& operator=(const NamedScratch&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  explicit NamedScratch(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace dubsar
