#include "input/input_source.h"

#include <array>

#include "input/leapc/leapc_source.h"
#include "input/recording.h"
#include "input/simulated/scripted_source.h"
#include "input/window_events.h"

namespace dubsar {
namespace {

constexpr std::array<InputBackend, 5> kSources{{
    {"mouse", "turn, shift or middle: move, ctrl or wheel: zoom, right: light", true, make_mouse_source},
    {"keyboard", "arrows turn, + and - zoom, home resets, backspace undoes", true, make_keyboard_source},
    {"leapc", "hands from Ultraleap's tracking service: leapc[:library=FILE,mode=desktop,at=X/Y/Z,turn=X/Y/Z]", false,
     make_leapc_source},
    {"scripted", "simulated people: scripted:FILE.json", false, make_scripted_source},
    {"replay", "a recording of any input: replay:FILE.jsonl", false, make_replay_source},
}};

}  // namespace

std::span<const InputBackend> input_sources() { return kSources; }

Result<std::unique_ptr<InputSource>> make_input(std::string_view spec, const InputConfig& base) {
  const auto colon = spec.find(':');
  DUBSAR_ASSIGN(const InputBackend* backend, find_backend(input_sources(), spec.substr(0, colon), "input"));
  InputConfig config = base;
  std::string_view options = colon == std::string_view::npos ? std::string_view() : spec.substr(colon + 1);
  while (!options.empty()) {
    const std::string_view word = options.substr(0, options.find(','));
    const auto equals = word.find('=');
    config.options.emplace_back(word.substr(0, equals), equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1));
    options.remove_prefix(std::min(options.size(), word.size() + 1));
  }
  DUBSAR_ASSIGN(auto source, backend->create(config));
  DUBSAR_TRY(source->start());
  return source;
}

}  // namespace dubsar
