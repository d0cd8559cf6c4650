#pragma once
// What a verb reads and what it writes, checked before any work: nothing that is read, and nothing that somebody may
// not be able to make again, is written over.

#include <span>
#include <string>

#include "app/cli/own_files.h"
#include "core/base/result.h"

namespace dubsar::app {

struct FileUse {
  std::string option;  ///< as it stands on the command line, e.g. "--json"
  std::string path;    ///< never empty
  bool written = false;
  FileFormat format = FileFormat::kOther;  ///< of what is written
};

/// For every file that would be written: its folder exists and can be written in; it is no folder, pipe, socket or
/// device; it is not the same file (also by another name or link) as one that is read or written besides, nor one of
/// the files of a folder that is read; its suffix is that of its format, where there is one; and what is there already
/// is a file of this kind that dubsar wrote (own_files.h). kCannotCreate, kPermission, kUsage (suffix, the same file
/// twice).
Result<void> check_file_uses(std::span<const FileUse> files);

/// The same of a file whose name follows from one of `option`, of which nobody may think. kCannotCreate, kPermission.
Result<void> check_made(const std::string& option, const std::string& path, FileFormat format);

/// `out` is none of the files that a verb will make besides, which nobody named. kUsage.
Result<void> check_apart(const FileUse& out, std::span<const std::string> made);

/// Everything that is read exists. kNoInput, with the name beside it that may have been meant.
Result<void> check_inputs(std::span<const FileUse> files);

}  // namespace dubsar::app
