// Commands for the window and what it is connected to. They change no document and are not undone.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/drawers.h"
#include "app/commands/number_argument.h"
#include "app/words/language.h"

namespace dubsar::app {
namespace {

Command plain(std::string name, std::vector<DefaultKey> keys, std::function<Result<void>(Editor&)> run) {
  Command out{std::move(name), kWindowGroup, std::move(keys)};
  out.run = [run = std::move(run)](Editor& editor, const std::string&) { return run(editor); };
  return out;
}

/// While the help lists the devices, numbers switch them.
Command toggle_source() {
  Command out{"toggle_source", kWindowGroup, {}};
  out.argument = "arg.number";
  for (char number = '1'; number <= '9'; ++number) {
    out.values.emplace_back(1, number);
    out.keys.push_back({std::string(1, number), std::string(1, number)});
  }
  out.closed = true;
  out.enabled = [](const Editor& editor) { return editor.ui().help; };
  out.run = [](Editor& editor, const std::string& number) -> Result<void> {
    if (editor.place().toggle_source(static_cast<std::size_t>(number[0] - '1'))) return {};
    return fail(ErrorKind::kUsage, "toggle_source: there is no device {}", number);
  };
  return out;
}

/// One at a time; the one that is open is closed.
Command drawer() {
  Command out{"drawer", kWindowGroup, {}};
  out.argument = "arg.panel";
  for (const DrawerRow& row : kDrawers) {
    out.values.emplace_back(row.name);
    out.keys.push_back({std::string(row.key), std::string(row.name)});
  }
  out.closed = true;
  out.run = [](Editor& editor, const std::string& name) -> Result<void> {
    UiState& ui = editor.ui();
    ui.drawer = ui.drawer == name && ui.panels ? std::string() : name;
    ui.panels = true;
    return {};
  };
  return out;
}

Command picture() {
  Command out{"picture", kWindowGroup, {{"f12"}}};
  out.argument = "arg.picture";
  out.optional = true;
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t space = text.rfind(' ');
    std::string path = text;
    int factor = 1;
    if (space != std::string::npos) {  // a name with spaces is one as long as no number stands behind it
      const auto number = number_argument("picture", text.substr(space + 1), 1.0, 16.0);
      if (number) {
        factor = static_cast<int>(*number);
        path = text.substr(0, space);
      }
    }
    return editor.place().picture(path, factor);
  };
  return out;
}

constexpr double kLeastScale = 0.5, kMostScale = 4.0;

Command ui_scale() {
  Command out{"ui_scale", kWindowGroup, {}, "arg.ui_scale"};
  out.values = {"100", "150", "200", "auto"};
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    if (text == "auto") {
      editor.ui().ui_scale = 0.0;
      return {};
    }
    DUBSAR_ASSIGN(const double percent, number_argument("ui_scale", text, 100 * kLeastScale, 100 * kMostScale));
    editor.ui().ui_scale = 0.01 * percent;
    return {};
  };
  return out;
}

/// For people who read other words; commands keep their names.
Command ui_language() {
  Command out{"ui_language", kWindowGroup, {{"ctrl+l"}}, "arg.language_code"};
  out.values = language_codes();
  out.optional = true;
  out.run = [](Editor& editor, const std::string& code) -> Result<void> {
    const auto& all = language_codes();
    const auto at = std::find(all.begin(), all.end(), language().code());
    const std::size_t next = at == all.end() ? 0 : static_cast<std::size_t>(at - all.begin() + 1) % all.size();
    DUBSAR_TRY(use_language(code.empty() ? all[next] : code));
    editor.place().say(tr("say.language"));
    return {};
  };
  return out;
}

Command scale_by(std::string name, double factor, std::vector<DefaultKey> keys) {
  Command out = plain(std::move(name), std::move(keys), [factor](Editor& editor) -> Result<void> {
    double& scale = editor.ui().ui_scale;
    scale = std::clamp((scale > 0 ? scale : 1.0) * factor, kLeastScale, kMostScale);
    return {};
  });
  out.repeats = true;
  return out;
}

Command magnify() {
  Command out{"magnify", kWindowGroup, {{"g"}}};
  out.argument = "arg.magnify";
  out.values = {"2", "4", "8"};
  out.optional = true;
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    double factor = editor.ui().pointing.magnify > 0 ? 0.0 : 3.0;
    if (!text.empty()) {
      DUBSAR_ASSIGN(factor, number_argument("magnify", text, 2.0, 8.0));
    }
    editor.ui().pointing.magnify = factor;
    return {};
  };
  return out;
}

/// The state of now stays on the left while one goes on on the right.
Command beside() {
  Command out{"beside", kWindowGroup, {{"y"}}};
  out.argument = "arg.beside";
  out.values = {"linked", "apart", "none"};
  out.closed = out.optional = true;
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    UiState& ui = editor.ui();
    if (text == "none" || (text.empty() && ui.compared)) {
      ui.compared.reset();
      return {};
    }
    if (!ui.compared) ui.compared = editor.document();
    ui.linked = text != "apart";
    return {};
  };
  return out;
}

/// For scripts, which have no mouse.
Command pointer() {
  Command out{"pointer", kWindowGroup, {}};
  out.argument = "arg.pointer";
  out.values = {"0,0", "-0.2,0.1"};
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    const std::size_t comma = std::min(text.find(','), text.size());
    glm::dvec2 at(0.0);
    DUBSAR_ASSIGN(at.x, number_argument("pointer", text.substr(0, comma), -4.0, 4.0));
    DUBSAR_ASSIGN(at.y, number_argument("pointer", text.substr(std::min(comma + 1, text.size())), -4.0, 4.0));
    editor.ui().pointing.at = at;
    return {};
  };
  return out;
}

/// What was opened last goes first; a session with work in it asks.
Result<void> close(Editor& editor) {
  UiState& ui = editor.ui();
  if (ui.help) {
    ui.help = false;
  } else if (ui.palette) {
    ui.palette = false;
  } else if (editor.place().stop_opening()) {
    // a file that was being read
  } else if (ui.choosing.open) {
    ui.choosing.open = false;
  } else if (ui.pointing.cut_box) {
    ui.pointing.cut_box = false;
  } else if (ui.tool != "turn") {
    ui.tool = "turn";
    ui.pending.clear();
  } else if (ui.panels && !ui.drawer.empty()) {
    ui.drawer.clear();
  } else if (editor.has_work() && !ui.leaving) {
    ui.leaving = true;
    editor.place().say(tr("say.end"));
  } else {
    editor.place().end();
  }
  return {};
}

}  // namespace

std::vector<Command> window_commands() {
  std::vector<Command> out;
  out.push_back(plain("help", {{"f1"}, {"?"}}, [](Editor& editor) -> Result<void> {
    editor.ui().help = !editor.ui().help;
    return {};
  }));
  out.push_back(toggle_source());
  out.push_back(plain("next_display", {{"f2"}}, [](Editor& editor) { return editor.place().switch_display(1); }));
  out.push_back(plain("previous_display", {{"f3"}}, [](Editor& editor) { return editor.place().switch_display(-1); }));
  out.push_back(plain("swap_eyes", {{"x"}}, [](Editor& editor) { return editor.place().swap_eyes(); }));
  out.push_back(plain("panels", {{"tab"}}, [](Editor& editor) -> Result<void> {
    editor.ui().panels = !editor.ui().panels;
    return {};
  }));
  out.push_back(drawer());
  out.push_back(plain("retry_sources", {{"f5"}}, [](Editor& editor) -> Result<void> {
    editor.place().retry_sources();
    return {};
  }));
  out.push_back(plain("recentre", {{"f6"}}, [](Editor& editor) -> Result<void> {
    editor.place().recentre_heads();
    editor.place().say(tr("command.recentre"));
    return {};
  }));
  out.push_back(plain("fullscreen", {{"f11"}}, [](Editor& editor) { return editor.place().toggle_fullscreen(); }));
  out.push_back(plain("palette", {{"ctrl+k"}}, [](Editor& editor) -> Result<void> {
    editor.ui().palette = !editor.ui().palette;
    return {};
  }));
  out.push_back(ui_scale());
  out.push_back(ui_language());
  out.push_back(scale_by("letters_larger", 1.1, {{"ctrl++"}, {"ctrl+="}}));
  out.push_back(scale_by("letters_smaller", 1.0 / 1.1, {{"ctrl+-"}}));
  out.push_back(magnify());
  out.push_back(plain("cursor", {{"z"}}, [](Editor& editor) -> Result<void> {
    editor.ui().pointing.cursor = !editor.ui().pointing.cursor;
    return {};
  }));
  out.push_back(pointer());
  out.push_back(beside());
  out.push_back(picture());
  out.push_back(plain("close", {{"escape"}}, close));
  return out;
}

}  // namespace dubsar::app
