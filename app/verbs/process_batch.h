#pragma once
// `process` for many scans: one program a scan, so that one that is damaged or too large costs the others nothing, and
// a record beside each surface, so that the same command goes on where it was ended.

#include <string>
#include <vector>

#include "app/cli/verb.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace dubsar::app {

struct ScanBatch {
  struct Item {
    std::string scan, out;
  };
  std::vector<Item> items;
  std::vector<std::string> options;  ///< of `process`, as typed, without names of scans and outputs
  bool resume = false;               ///< surfaces whose records say that nothing has changed are kept
};

/// A folder with scans (HDF5, NRRD) that is no TIFF stack.
bool is_scan_folder(const std::string& path);

/// The scans named, those of folders in the order of their names, and where their surfaces go: into `folder`, or beside
/// them where it is empty. kUsage: two surfaces of one name; kNoInput: nothing to do; kCannotCreate: `folder` is a file
/// or cannot be made.
Result<std::vector<ScanBatch::Item>> batch_items(const std::vector<std::string>& inputs, const std::string& folder);

/// What was typed behind the verb without `inputs` and without the options that a batch gives each scan itself.
std::vector<std::string> options_for_each(const std::vector<std::string>& words,
                                          const std::vector<std::string>& inputs);

/// The report of the batch is no surface that it makes, and no record beside one. kUsage.
Result<void> check_report(const ScanBatch& batch, const std::string& json_path);

/// Runs them one after another; failures are told at the end and the others go on (the exit code is that of the first).
/// kTryAgain when cancelled, with what is done kept. Progress in percent of a scan.
Result<VerbResult> process_batch(const ScanBatch& batch, Progress& progress);

}  // namespace dubsar::app
