// Commands for films: what is seen as keyframes, and showing them.

#include <algorithm>

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"
#include "app/document/mark_file.h"

namespace dubsar::app {
namespace {

constexpr double kUsualStepS = 2.0, kShortestS = 0.05, kLongestS = 3600.0;

bool has_film(const Editor& editor) { return !editor.document().keyframes.empty(); }

/// What is seen becomes a keyframe; one of the same time is replaced.
Command keyframe() {
  Command out{"keyframe", "group.film", {{"k"}}, "arg.seconds"};
  out.optional = true;
  out.values = {"0", "5"};
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
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

Command on_keyframe(std::string name, void (*change)(Document&, std::size_t)) {
  Command out{std::move(name), "group.film", {}, "arg.number"};
  out.enabled = has_film;
  out.run = [change, what = out.name](Editor& editor, const std::string& text) -> Result<void> {
    DUBSAR_ASSIGN(const std::size_t at, place_argument(what, text, editor.document().keyframes.size()));
    Document next = editor.document();
    change(next, at);
    editor.change(std::move(next), what, Transition::kGlide);
    return {};
  };
  return out;
}

Command play() {
  Command out{"play", "group.film", {{"shift+space"}}, "arg.from_keyframe"};
  out.optional = true;
  out.enabled = [](const Editor& editor) { return editor.document().keyframes.size() > 1; };
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    if (text.empty()) return editor.place().play_film(std::nullopt);
    const auto& keys = editor.document().keyframes;
    DUBSAR_ASSIGN(const std::size_t at, place_argument("play", text, keys.size()));
    return editor.place().play_film(keys[at].time_s - keys.front().time_s);
  };
  return out;
}

/// Looks change places, times stay: a move back undoes it.
Command move_keyframe() {
  Command out{"move_keyframe", "group.film", {}, "arg.number_place"};
  out.enabled = has_film;
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto [which, where] = first_word(text);
    Document next = editor.document();
    auto& keys = next.keyframes;
    DUBSAR_ASSIGN(const std::size_t from, place_argument("move_keyframe", which, keys.size()));
    DUBSAR_ASSIGN(const std::size_t to, place_argument("move_keyframe", where, keys.size()));
    std::vector<double> times;
    times.reserve(keys.size());
    for (const Keyframe& key : keys) times.push_back(key.time_s);
    const auto at = [&](std::size_t i) { return keys.begin() + static_cast<std::ptrdiff_t>(i); };
    if (from < to) std::rotate(at(from), at(from + 1), at(to + 1));
    if (to < from) std::rotate(at(to), at(from), at(from + 1));
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i].time_s = times[i];
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

/// The keyframes behind it go on as they did, earlier or later.
Command keyframe_seconds() {
  Command out{"keyframe_seconds", "group.film", {}, "arg.number_seconds"};
  out.enabled = [](const Editor& editor) { return editor.document().keyframes.size() > 1; };
  out.run = [why = out.name](Editor& editor, const std::string& text) -> Result<void> {
    const auto [which, seconds] = first_word(text);
    Document next = editor.document();
    auto& keys = next.keyframes;
    DUBSAR_ASSIGN(const std::size_t at, place_argument("keyframe_seconds", which, keys.size()));
    if (at + 1 == keys.size())
      return fail(ErrorKind::kUsage, "keyframe_seconds: {} is the last keyframe, expected one with another behind it",
                  at + 1);
    DUBSAR_ASSIGN(const double wanted, number_argument("keyframe_seconds", seconds, kShortestS, kLongestS));
    const double later = wanted - (keys[at + 1].time_s - keys[at].time_s);
    for (std::size_t i = at + 1; i < keys.size(); ++i) keys[i].time_s += later;
    editor.change(std::move(next), why);
    return {};
  };
  return out;
}

Command write_film() {
  Command out{"write_film", "group.film", {}, "arg.json"};
  out.enabled = has_film;
  out.run = [](Editor& editor, const std::string& path) -> Result<void> {
    DUBSAR_TRY(write_marks(path, format_film(editor.document().keyframes)));
    editor.place().say(tr("say.written", path));
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> film_commands() {
  std::vector<Command> out;
  out.push_back(keyframe());
  out.push_back(on_keyframe("go_to_keyframe",
                            [](Document& next, std::size_t at) { show_keyframe(next, Keyframe(next.keyframes[at])); }));
  out.back().steers = true;
  out.push_back(on_keyframe("delete_keyframe", [](Document& next, std::size_t at) {
    next.keyframes.erase(next.keyframes.begin() + static_cast<std::ptrdiff_t>(at));
  }));
  out.push_back(on_keyframe("replace_keyframe", [](Document& next, std::size_t at) {
    next.keyframes[at] = keyframe_of(next, next.keyframes[at].time_s);
  }));
  out.push_back(move_keyframe());
  out.push_back(keyframe_seconds());
  out.push_back(play());
  out.push_back(write_film());
  return out;
}

}  // namespace dubsar::app
