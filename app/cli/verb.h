#pragma once
// One file per verb: each adds its subcommand and returns what runs when it is chosen.

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/cli/arguments.h"
#include "app/cli/console.h"
#include "app/cli/overall_progress.h"
#include "core/base/result.h"

namespace dubsar {
struct TriMesh;
}

namespace dubsar::app {

struct Document;

/// Options of every verb.
struct CommonOptions {
  ConsoleOptions console;
  std::string json_path;  ///< "": none, "-": stdout
  int threads = 0;        ///< 0: all cores
};

struct VerbResult {
  std::string text;              ///< for people, on stdout
  nlohmann::json json;           ///< for programs, where --json says
  std::optional<Error> failure;  ///< the verb did its work and its finding is bad, e.g. doctor: said, and the exit code
};

struct Verb {
  Arguments command;
  std::function<Result<VerbResult>(const CommonOptions&, Progress&)> run;
  std::function<void()> settle =
      nullptr;  ///< fills in names that follow from others, before files are checked; may be empty
  std::function<std::vector<PlannedStage>()> plan = nullptr;  ///< of runs that take minutes; may be empty
};

/// What people made of a surface, as it was kept when they looked at the file; empty where nobody did. A program
/// without windows has none.
using KeptDocument = std::function<Result<Document>(const std::string& file, const TriMesh& mesh)>;

Verb add_animate_verb(Arguments program);
Verb add_phantom_verb(Arguments program);
Verb add_process_verb(Arguments program);
Verb add_info_verb(Arguments program);
Verb add_compare_verb(Arguments program);
Verb add_kiosk_verb(Arguments program);
Verb add_wedges_verb(Arguments program, KeptDocument kept = {});
Verb add_handcopy_verb(Arguments program, KeptDocument kept = {});
Verb add_seal_verb(Arguments program);
Verb add_exa_verb(Arguments program);
Verb add_export_verb(Arguments program);
Verb add_fatcross_verb(Arguments program);
Verb add_render_verb(Arguments program);
Verb add_report_verb(Arguments program);
Verb add_show_verb(Arguments program);
Verb add_view_verb(Arguments program);
Verb add_doctor_verb(Arguments program);
Verb add_devices_verb(Arguments program);
Verb add_displays_verb(Arguments program);

}  // namespace dubsar::app
