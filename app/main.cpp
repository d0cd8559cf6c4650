// dubsar: verbs, exit codes, and what is common to all of them.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include "app/cli/verb.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"

namespace {
using namespace dubsar;
using namespace dubsar::app;

void add_common_options(CLI::App& command, CommonOptions& common) {
  const std::map<std::string, ProgressStyle> styles{{"auto", ProgressStyle::kAuto},
                                                    {"bar", ProgressStyle::kBar},
                                                    {"json", ProgressStyle::kJson},
                                                    {"none", ProgressStyle::kNone}};
  auto* const group = command.add_option_group("Common");
  group->add_option("--json", common.json_path, "write the result as JSON to FILE (- for stdout)")->type_name("FILE");
  group->add_option("--progress", common.console.progress, "how progress is shown on stderr")
      ->transform(CLI::CheckedTransformer(styles, CLI::ignore_case))
      ->option_text("auto|bar|json|none");
  group->add_option("--threads", common.threads, "number of threads (0: all cores)")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  group->add_flag("-q,--quiet", common.console.quiet, "errors only");
  group->add_flag("-v,--verbose", common.console.verbose, "more messages");
}

int report_error(const Error& error) {
  log(LogLevel::kError, error.message);
  return exit_code(error.kind);
}

int run_verb(const Verb& verb, const CommonOptions& common) {
  install_log(common.console);
  set_thread_count(common.threads);
  ConsoleProgress progress(common.console);
  cancel_on_signals(progress);
  if (!common.json_path.empty() && common.json_path != "-")
    if (auto ok = check_output_path(common.json_path); !ok) return report_error(ok.error());
  const auto result = verb.run(common, progress);
  progress.end();
  if (!result) return report_error(result.error());
  if (common.json_path == "-") {
    fmt::print("{}\n", result->json.dump(2));
  } else {
    fmt::print("{}", result->text);
    if (!common.json_path.empty())
      if (auto ok = write_file_atomically(common.json_path, result->json.dump(2) + "\n"); !ok)
        return report_error(ok.error());
  }
  if (std::fflush(stdout) != 0) return report_error({ErrorKind::kIo, "cannot write the result to stdout"});
  return result->failed ? exit_code(result->failure) : 0;
}

int guarded_run(const Verb& verb, const CommonOptions& common) {
  try {
    return run_verb(verb, common);
  } catch (const std::bad_alloc&) {
    return report_error({ErrorKind::kTryAgain, "out of memory; use --crop or --stride, or close other programs"});
  } catch (const std::exception& e) {
    return report_error({ErrorKind::kInternal, fmt::format("internal error, please report: {}", e.what())});
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("dubsar: from a CT scan of an enclosed cuneiform tablet to surfaces that can be read", "dubsar");
  program.set_version_flag("--version", "dubsar " DUBSAR_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  dubsar phantom scan.h5 --preset demo\n"
      "  dubsar process scan.h5 -o tablet.exa\n"
      "  dubsar render tablet.exa -o tablet.png\n"
      "  dubsar export tablet.exa tablet.stl --partition tablet\n\n"
      "Exit codes: 0 done, 64 usage, 65 bad data, 66 no input, 69 device missing, 70 internal, 73 cannot create,\n"
      "74 I/O or disk full, 75 try again, 77 permission, 130 cancelled.");
  CommonOptions common;
  std::vector<Verb> verbs{add_phantom_verb(program), add_process_verb(program),  add_info_verb(program),
                          add_export_verb(program),  add_render_verb(program),   add_view_verb(program),
                          add_doctor_verb(program),  add_displays_verb(program), add_devices_verb(program)};
  for (Verb& verb : verbs) add_common_options(*verb.command, common);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return program.exit(e);  // --help, --version
  } catch (const CLI::ParseError& e) {
    program.exit(e, std::cout, std::cerr);
    return exit_code(ErrorKind::kUsage);
  }
  for (const Verb& verb : verbs)
    if (verb.command->parsed()) return guarded_run(verb, common);
  return exit_code(ErrorKind::kUsage);
}
