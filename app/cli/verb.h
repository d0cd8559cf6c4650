#pragma once
// One file per verb: each adds its subcommand and returns what runs when it is chosen.

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "app/cli/console.h"
#include "core/base/result.h"

namespace dubsar::app {

/// Options of every verb.
struct CommonOptions {
  ConsoleOptions console;
  std::string json_path;  ///< "": none, "-": stdout
  int threads = 0;        ///< 0: all cores
};

struct VerbResult {
  std::string text;     ///< for people, on stdout
  nlohmann::json json;  ///< for programs, where --json says
  ErrorKind failure = ErrorKind::kInternal;
  bool failed = false;  ///< the verb did its work and its finding is bad (exit code `failure`), e.g. doctor
};

struct Verb {
  CLI::App* command = nullptr;
  std::function<Result<VerbResult>(const CommonOptions&, Progress&)> run;
};

Verb add_phantom_verb(CLI::App& program);
Verb add_process_verb(CLI::App& program);
Verb add_info_verb(CLI::App& program);
Verb add_export_verb(CLI::App& program);
Verb add_render_verb(CLI::App& program);
Verb add_view_verb(CLI::App& program);
Verb add_doctor_verb(CLI::App& program);
Verb add_devices_verb(CLI::App& program);
Verb add_displays_verb(CLI::App& program);

/// Fails early, before hours of work, when an output cannot be created: kCannotCreate, kPermission.
Result<void> check_output_path(const std::string& path);

}  // namespace dubsar::app
