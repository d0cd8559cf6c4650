#include "app/viewer/exporter.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/document/document_file.h"
#include "app/words/text.h"
#include "core/base/files/named_scratch.h"
#include "core/base/system/child_process.h"
#include "core/base/system/log.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostSaid = std::size_t{1} << 16;
constexpr std::int64_t kHundred = 100;

/// The last whole line of progress, in per cent.
std::optional<double> percent_in(const std::string& said) {
  const std::size_t end = said.rfind('\n');
  if (end == std::string::npos) return std::nullopt;
  const std::size_t begin = end == 0 ? std::string::npos : said.rfind('\n', end - 1);
  const json line = json::parse(said.substr(begin == std::string::npos ? 0 : begin + 1, end - begin), nullptr, false);
  if (!line.is_object()) return std::nullopt;
  if (line.contains("overall_percent")) return line.value("overall_percent", 0.0);
  return line.contains("percent") ? std::optional(line.value("percent", 0.0)) : std::nullopt;
}

std::string sentence_of(const std::string& out, const std::string& err, int code) {
  constexpr std::string_view kOption = "-o,--output ";  // nobody typed it
  const json answer = json::parse(out, nullptr, false);
  if (answer.is_object() && answer.contains("error") && answer["error"].is_object()) {
    const std::string message = answer["error"].value("message", "");
    return message.starts_with(kOption) ? message.substr(kOption.size()) : message;
  }
  return fmt::format("it ended with code {}: {}", code, err.substr(0, err.find('\n')));
}

Result<void> run_child(std::vector<std::string> words, Progress& progress) {
  words.insert(words.end(), {"--json", "-", "--progress", "json"});
  DUBSAR_ASSIGN(ChildProcess child, ChildProcess::start(std::move(words)));
  progress.begin("export", kHundred, "percent");
  std::array<std::string, 2> said;
  std::int64_t done = 0;
  while (child.read(said)) {
    if (progress.cancelled()) return cancelled_error();  // the child is asked to end, and waited for
    if (const auto percent = percent_in(said[1])) {
      const auto now = static_cast<std::int64_t>(std::clamp(*percent, 0.0, 100.0));
      if (now > done) progress.advance(now - done);
      done = std::max(done, now);
    }
    if (said[1].size() > kMostSaid) said[1].erase(0, said[1].size() - kMostSaid / 4);
  }
  const int code = child.wait();
  if (progress.cancelled()) return cancelled_error();
  if (code != 0) return fail(ErrorKind::kIo, "{}", sentence_of(said[0], said[1], code));
  return {};
}

}  // namespace

Result<void> Exporter::begin(const Order& order, const ExportChoice& choice, const Document& document) {
  if (order.surface.empty()) return fail(ErrorKind::kUsage, "{}", tr("export.no_file"));
  std::error_code ignored;
  const std::string program =
      order.program.empty() ? fs::read_symlink("/proc/self/exe", ignored).string() : order.program;
  if (order.program.empty() && fs::path(program).filename() != "dubsar")
    return fail(ErrorKind::kUnavailable, "export: this program is {}, expected dubsar", program);
  const auto kind = std::find_if(kExportKinds.begin(), kExportKinds.end(),
                                 [&](const ExportKind& each) { return each.name == order.kind; });
  if (kind == kExportKinds.end()) return fail(ErrorKind::kUsage, "export: there is no {} to write", order.kind);
  const fs::path surface(order.surface);
  out_ = order.out.empty() ? (surface.parent_path() / surface.stem()).string() + std::string(kind->ending) : order.out;
  // One of its own for each export: a child that was stopped may live until the next one reads its session.
  DUBSAR_ASSIGN(const std::shared_ptr<const NamedScratch> session,
                NamedScratch::create("dubsar_export", ".json", format_document(document)));
  std::vector<std::string> words =
      export_words(order.kind, {order.surface, session->path().string(), out_}, choice, document, order.side);
  words.insert(words.begin(), program);
  job_.begin(tr_name("export_kind", order.kind),
             [words, session](Progress& progress) { return run_child(words, progress); }, {{"export", 1.0}});
  return {};
}

std::optional<std::string> Exporter::ended() {
  const auto done = job_.take();
  if (!done) return std::nullopt;
  if (*done) return tr("say.written", out_);
  log_warning("export: {}", done->error().message);
  return done->error().message;
}

}  // namespace dubsar::app
