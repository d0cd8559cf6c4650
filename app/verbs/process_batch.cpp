#include "app/verbs/process_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "app/cli/default_output.h"
#include "app/cli/error_json.h"
#include "app/cli/file_uses.h"
#include "app/document/file_kinds.h"
#include "core/base/files/atomic_file.h"
#include "core/base/files/file_fingerprint.h"
#include "core/base/files/input_file.h"
#include "core/base/system/child_process.h"
#include "core/base/text/json_text.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

std::vector<std::string> scans_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->is_regular_file(error) && names_a_scan(it->path())) out.push_back(it->path().string());
  std::sort(out.begin(), out.end());
  return out;
}

std::string record_of(const std::string& out) { return output_beside(out, ".run.json"); }

/// What a surface depends on, and the surface.
Result<json> state_of(const ScanBatch& batch, const ScanBatch::Item& item) {
  DUBSAR_ASSIGN(const std::string scan, file_fingerprint(item.scan));
  DUBSAR_ASSIGN(const std::string surface, file_fingerprint(item.out));
  return json{{"program", DUBSAR_VERSION}, {"scan", scan}, {"options", batch.options}, {"surface", surface}};
}

/// The record of a surface that need not be made again.
std::optional<json> kept(const ScanBatch& batch, const ScanBatch::Item& item) {
  const auto text = read_file_bytes(record_of(item.out));
  if (!text) return std::nullopt;
  json record = json::parse(*text, nullptr, false);
  const auto state = state_of(batch, item);
  if (!state || !record.is_object() || record.value("state", json()) != *state) return std::nullopt;
  return record;
}

/// What a run said on its way: the last line of its progress, in percent.
std::optional<double> percent_told(const std::string& text) {
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos) return std::nullopt;
  const std::size_t begin = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const json line = json::parse(text.substr(begin == std::string::npos ? 0 : begin + 1, end), nullptr, false);
  if (!line.is_object() || !line.contains("overall_percent")) return std::nullopt;
  return line.value("overall_percent", 0.0);
}

Error told(const std::string& out, const std::string& err, int code) {
  static constexpr ErrorKind kKinds[] = {ErrorKind::kUsage,       ErrorKind::kBadData,  ErrorKind::kNoInput,
                                         ErrorKind::kUnavailable, ErrorKind::kInternal, ErrorKind::kCannotCreate,
                                         ErrorKind::kIo,          ErrorKind::kTryAgain, ErrorKind::kPermission,
                                         ErrorKind::kConfig,      ErrorKind::kCancelled};
  const auto* const kind =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](ErrorKind k) { return exit_code(k) == code; });
  const json answer = json::parse(out, nullptr, false);
  const std::string message = answer.is_object() && answer.contains("error")
                                  ? answer["error"].value("message", "")
                                  : fmt::format("the run ended with code {}: {}", code, err.substr(0, err.find('\n')));
  return {kind == std::end(kKinds) ? ErrorKind::kInternal : *kind, message};
}

/// The report of one scan.
Result<json> process_one(const ScanBatch& batch, const ScanBatch::Item& item, Progress& progress) {
  std::vector<std::string> words{"/proc/self/exe", "process", item.scan, "-o", item.out};
  words.insert(words.end(), batch.options.begin(), batch.options.end());
  words.insert(words.end(), {"--json", "-", "--progress", "json"});
  std::error_code ignored;
  words[0] = fs::read_symlink(words[0], ignored).string();
  DUBSAR_ASSIGN(ChildProcess child, ChildProcess::start(std::move(words)));
  std::array<std::string, 2> said;
  double done = 0.0;
  while (child.read(said)) {
    if (progress.cancelled()) return cancelled_error();
    if (const auto percent = percent_told(said[1]); percent && *percent > done) {
      const double now = std::min(std::floor(*percent), 100.0);
      progress.advance(static_cast<std::int64_t>(now - done));
      done = now;
    }
    if (said[1].size() > 1 << 16) said[1].erase(0, said[1].size() - (1 << 14));
  }
  const int code = child.wait();
  if (progress.cancelled() || code == exit_code(ErrorKind::kCancelled)) return cancelled_error();
  progress.advance(static_cast<std::int64_t>(100.0 - done));
  if (code != 0) return tl::unexpected(told(said[0], said[1], code));
  json report = json::parse(said[0], nullptr, false);
  if (!report.is_object()) return fail(ErrorKind::kInternal, "{}: the run gave no report", item.scan);
  DUBSAR_ASSIGN(json state, state_of(batch, item));
  const json record{{"made_by", "dubsar " DUBSAR_VERSION}, {"state", std::move(state)}, {"report", report}};
  DUBSAR_TRY(check_made("-o", record_of(item.out), FileFormat::kJson));
  DUBSAR_TRY(write_file_atomically(record_of(item.out), dump_json_lines(record) + "\n"));
  return report;
}

std::string parts_in_words(const json& report) {
  std::string out;
  for (const json& part : report.value("/facts/parts"_json_pointer, json::array()))
    out += (out.empty() ? "" : ", ") + part.value("name", std::string("?"));
  return out;
}

}  // namespace

bool is_scan_folder(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return false;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error))
    if (names_a_slice(it->path())) return false;
  return !scans_in(path).empty();
}

Result<std::vector<ScanBatch::Item>> batch_items(const std::vector<std::string>& inputs, const std::string& folder) {
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error)) {
    if (fs::exists(folder, error))
      return fail(ErrorKind::kCannotCreate, "-o: {} is a file; expected a folder for the surfaces of several scans",
                  folder);
    if (!fs::create_directory(folder, error))
      return fail(ErrorKind::kCannotCreate, "-o: cannot make the folder {} ({})", folder, error.message());
  }
  std::vector<ScanBatch::Item> out;
  std::map<std::string, std::string> made_of;
  const auto add = [&](const std::string& scan) -> Result<void> {
    std::string product = output_beside(scan, ".exa");
    if (!folder.empty()) product = (fs::path(folder) / fs::path(product).filename()).string();
    if (const auto [at, fresh] = made_of.emplace(product, scan); !fresh)
      return fail(ErrorKind::kUsage, "{} and {} would both be written to {}: rename one, or process them apart",
                  at->second, scan, product);
    out.push_back({scan, product});
    return {};
  };
  for (const std::string& input : inputs) {
    if (!is_scan_folder(input)) {
      DUBSAR_TRY(add(input));
      continue;
    }
    for (const std::string& scan : scans_in(input)) DUBSAR_TRY(add(scan));
  }
  if (out.empty()) return fail(ErrorKind::kNoInput, "no scans were found (HDF5, NRRD)");
  return out;
}

std::vector<std::string> options_for_each(const std::vector<std::string>& words,
                                          const std::vector<std::string>& inputs) {
  constexpr std::array<std::string_view, 4> kWithValue{"-o", "--output", "--json", "--progress"};
  constexpr std::array<std::string_view, 5> kFlags{"--resume", "-q", "--quiet", "-v", "--verbose"};
  std::vector<std::string> left = inputs, out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    if (std::find(kFlags.begin(), kFlags.end(), words[i]) != kFlags.end()) continue;
    if (std::find(kWithValue.begin(), kWithValue.end(), name) != kWithValue.end()) {
      i += name == words[i];
      continue;
    }
    if (const auto at = std::find(left.begin(), left.end(), words[i]); at != left.end()) {
      left.erase(at);
      continue;
    }
    out.push_back(words[i]);
  }
  return out;
}

Result<void> check_report(const ScanBatch& batch, const std::string& json_path) {
  std::vector<std::string> made;
  for (const ScanBatch::Item& item : batch.items) made.insert(made.end(), {item.out, record_of(item.out)});
  return check_apart({"--json", json_path, true, FileFormat::kJson}, made);
}

Result<VerbResult> process_batch(const ScanBatch& batch, Progress& progress) {
  progress.begin("scans", static_cast<std::int64_t>(batch.items.size()) * 100, "percent of a scan");
  VerbResult out;
  out.json = {{"scans", json::array()}};
  std::size_t made = 0, same = 0;
  for (const ScanBatch::Item& item : batch.items) {
    json row{{"scan", item.scan}, {"output", item.out}};
    std::string line;
    if (auto record = batch.resume ? kept(batch, item) : std::nullopt) {
      ++same;
      row["kept"] = true;
      row["report"] = (*record)["report"];
      line = "kept, as nothing has changed: " + parts_in_words(row["report"]);
      progress.advance(100);
    } else if (auto report = process_one(batch, item, progress)) {
      ++made;
      row["report"] = std::move(*report);
      line = parts_in_words(row["report"]);
    } else if (report.error().kind == ErrorKind::kCancelled) {
      return fail(ErrorKind::kTryAgain,
                  "stopped after {} of {} scans; the same command with --resume goes on with the rest", made + same,
                  batch.items.size());
    } else {
      if (!out.failure) out.failure = report.error();
      row["error"] = error_object(report.error());
      line = "failed: " + report.error().message;
    }
    out.text += fmt::format("{}: {}\n", row.contains("error") ? item.scan : item.out, line);
    out.json["scans"].push_back(std::move(row));
  }
  progress.end();
  const std::size_t failed = batch.items.size() - made - same;
  out.json["made"] = made;
  out.json["kept"] = same;
  out.json["failed"] = failed;
  out.text += fmt::format("\n{} made, {} kept, {} failed\n", made, same, failed);
  if (out.failure)
    out.failure->message =
        fmt::format("{} of {} scans failed, the first of them: {}", failed, batch.items.size(), out.failure->message);
  return out;
}

}  // namespace dubsar::app
