#include "app/cli/program.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <span>

#include "app/cli/console_progress.h"
#include "app/cli/error_json.h"
#include "app/cli/file_uses.h"
#include "app/cli/fit_columns.h"
#include "core/base/files/atomic_file.h"
#include "core/base/system/parallel.h"
#include "core/base/text/json_text.h"
#include "core/base/text/plain_text.h"

namespace dubsar::app {
namespace {

void add_common_options(Arguments command, CommonOptions& common) {
  Arguments group = command.group("Common");
  group.writes("--json", common.json_path, FileFormat::kJson, "write the result as JSON to FILE (- for stdout)")
      .called("FILE");
  group.choice<ProgressStyle>("--progress", common.console.progress,
                              {{"auto", ProgressStyle::kAuto},
                               {"bar", ProgressStyle::kBar},
                               {"json", ProgressStyle::kJson},
                               {"none", ProgressStyle::kNone}},
                              "how progress is shown on stderr");
  group.value("--threads", common.threads, "number of threads (0: all cores)").range(0, 1024).called("N");
  group.flag("-q,--quiet", common.console.quiet, "errors only");
  group.flag("-v,--verbose", common.console.verbose, "more messages");
}

Result<void> print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
  return fail_errno(errno, "cannot write the result to stdout");
}

/// On stderr, and as an object on stdout for programs that asked for one there.
int report_error(const Error& error, const CommonOptions& common) {
  log(LogLevel::kError, error.message);
  if (common.json_path == "-") {
    if (!print(error_json(error))) log(LogLevel::kError, "cannot write the error to stdout");
  }
  return exit_code(error.kind);
}

Result<VerbResult> run_verb(const Verb& verb, const CommonOptions& common, Progress& progress) {
  try {
    return verb.run(common, progress);
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kTryAgain, "out of memory; close other programs, or work on a part of the data");
  } catch (const std::exception& e) {
    return fail(ErrorKind::kInternal, "internal error, please report: {}", e.what());
  }
}

Result<void> deliver(const VerbResult& result, const CommonOptions& common) {
  if (common.json_path == "-") return print(dump_json_lines(result.json) + "\n");
  if (!common.console.quiet) {
    const std::string text = plain_text(result.text, true);
    const std::optional<int> columns = stdout_columns();
    DUBSAR_TRY(print(columns ? fit_columns(text, *columns) : text));
  }
  if (common.json_path.empty()) return {};
  const FileUse report{"--json", common.json_path, true, FileFormat::kJson};
  DUBSAR_TRY(check_file_uses(std::span(&report, 1)));  // once more: the verb may have written just there
  nlohmann::json signed_result = result.json;
  if (signed_result.is_object())
    signed_result["made_by"] = "dubsar " DUBSAR_VERSION;  // by which it may be written over
  return write_file_atomically(common.json_path, dump_json_lines(signed_result) + "\n");
}

int run(const Verb& verb, const CommonOptions& common) {
  install_log(common.console);
  set_thread_count(common.threads);
  if (verb.settle) verb.settle();
  if (const auto ok = check_file_uses(verb.command.files()); !ok) return report_error(ok.error(), common);
  ConsoleProgress progress(common.console, verb.plan ? verb.plan() : std::vector<PlannedStage>());
  cancel_on_signals(progress);
  const Result<VerbResult> result = run_verb(verb, common, progress);
  progress.close();
  if (!result && result.error().kind != ErrorKind::kUsage)  // whatever went wrong: a file that is not there comes first
    if (const auto there = check_inputs(verb.command.files()); !there) return report_error(there.error(), common);
  if (!result) return report_error(result.error(), common);
  if (const auto ok = deliver(*result, common); !ok) {
    log(LogLevel::kError, ok.error().message);
    return exit_code(ok.error().kind);
  }
  if (!result->failure) return 0;
  log(LogLevel::kError, result->failure->message);
  return exit_code(result->failure->kind);
}

}  // namespace

Arguments begin_program() {
  Arguments program =
      Arguments::program("dubsar: from a CT scan of an enclosed cuneiform tablet to surfaces that can be read",
                         "dubsar", "dubsar " DUBSAR_VERSION);
  program.needs_command();
  return program;
}

int run_program(Arguments program, const std::vector<Verb>& verbs, int argc, char** argv) {
  CommonOptions common;
  for (const Verb& verb : verbs) add_common_options(verb.command, common);
  if (const std::optional<int> over = program.parse(argc, argv)) return *over;
  for (const Verb& verb : verbs)
    if (verb.command.chosen()) return run(verb, common);
  return exit_code(ErrorKind::kUsage);
}

}  // namespace dubsar::app
