// Commands for films: what is seen as keyframes, and showing them.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/mark_file.h"

namespace dubsar::app {
namespace {

constexpr double kUsualStepS = 2.0, kLongestS = 3600.0;

bool has_film(const Editor& editor) { return !editor.document().keyframes.empty(); }

/// What is seen becomes a keyframe; one of the same time is replaced.
Command keyframe() {
  Command out{"keyframe", "Film", "what is seen becomes a keyframe", {{"k"}}, "its time in seconds"};
  out.optional = true;
  out.values = {"0", "5"};
  out.run = [why = out.words](Editor& editor, const std::string& text) -> Result<void> {
    Document next = editor.document();
    auto& keys = next.keyframes;
    double time = keys.empty() ? 0.0 : keys.back().time_s + kUsualStepS;
    if (!text.empty()) {
      DUBSAR_ASSIGN(time, number_argument("keyframe", text, 0.0, kLongestS));
    }
    const Keyframe frame = keyframe_of(next, time);
    const auto at =
        std::lower_bound(keys.begin(), keys.end(), time, [](const Keyframe& key, double t) { return key.time_s < t; });
    if (at != keys.end() && at->time_s == time)
      *at = frame;
    else
      keys.insert(at, frame);
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command on_keyframe(std::string name, std::string words, void (*change)(Document&, std::size_t)) {
  Command out{std::move(name), "Film", std::move(words), {}, "its number"};
  out.enabled = has_film;
  out.run = [change, what = out.name, why = out.words](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const std::size_t at, place_argument(what, text, editor.document().keyframes.size()));
    Document next = editor.document();
    change(next, at);
    editor.change(std::move(next), why, Way::kGlide);
    return {};
  };
  return out;
}

Command play() {
  Command out{"play", "Film", "show the film, or stop it", {{"shift+space"}}};
  out.enabled = [](const Editor& editor) { return editor.document().keyframes.size() > 1; };
  out.run = [](Editor& editor, const std::string&) { return editor.place().play_film(); };
  return out;
}

Command write_film() {
  Command out{"write_film", "Film", "write the film into a file, for dubsar animate", {}, "FILE.json"};
  out.enabled = has_film;
  out.run = [](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_TRY(write_marks(path, format_film(editor.document().keyframes)));
    editor.place().say("written: " + path);
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> film_commands() {
  std::vector<Command> out;
  out.push_back(keyframe());
  out.push_back(on_keyframe("go_to_keyframe", "look as a keyframe does",
                            [](Document& next, std::size_t at) { show_keyframe(next, Keyframe(next.keyframes[at])); }));
  out.back().steers = true;
  out.push_back(on_keyframe("delete_keyframe", "take a keyframe away", [](Document& next, std::size_t at) {
    next.keyframes.erase(next.keyframes.begin() + static_cast<std::ptrdiff_t>(at));
  }));
  out.push_back(play());
  out.push_back(write_film());
  return out;
}

}  // namespace dubsar::app
