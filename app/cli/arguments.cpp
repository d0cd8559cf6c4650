#include "app/cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <system_error>
#include <type_traits>

#include "app/cli/error_json.h"
#include "app/cli/help_text.h"
#include "core/base/result.h"
#include "core/base/text/near_word.h"

namespace dubsar::app {

struct Arguments::State {
  struct File {
    const void* app;
    std::string option;
    std::function<std::vector<std::string>()> paths;
    bool written;
    FileFormat format;
  };
  std::unique_ptr<CLI::App> root;
  std::vector<File> files;
  std::vector<std::string> words;
};

namespace {
CLI::Option& option(void* pointer) { return *static_cast<CLI::Option*>(pointer); }
CLI::App& app(void* pointer) { return *static_cast<CLI::App*>(pointer); }

/// Help adds what is allowed to what the option does.
CLI::Option& says(void* pointer, const std::string& allowed) {
  CLI::Option& it = option(pointer);
  it.description(it.get_description() + " (" + allowed + ")");
  return it;
}

/// Refuses texts for which `good` is not true; "--window: 4 found, expected ...".
CLI::Validator expects(const std::string& words, std::function<bool(const std::string&)> good) {
  CLI::Validator validator(
      [words, good = std::move(good)](std::string& text) {
        return good(text) ? std::string()
                          : fmt::format("{} found, expected {}", text.empty() ? "nothing" : text, words);
      },
      "");
  return validator;
}

template <class T>
std::function<bool(const std::string&)> number_that(std::function<bool(T)> good) {
  return [good = std::move(good)](const std::string& text) {
    T value{};
    return CLI::detail::lexical_cast(text, value) && good(value);
  };
}

CLI::Validator one_word_of(std::vector<std::string> words) {
  return CLI::Validator(
      [words = std::move(words)](std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return fmt::format("{} found, expected one of: {}{}", text.empty() ? "nothing" : text, fmt::join(words, ", "),
                           did_you_mean(text, words));
      },
      "");
}

/// No option means anything by a number that is none, or without end.
bool is_finite_or_text(const std::string& text) {
  double value{};
  return !CLI::detail::lexical_cast(text, value) || std::isfinite(value);
}

/// The library takes -1 for the largest number without a sign, and what is too large for the largest one.
template <class T>
bool is_whole(const std::string& text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

template <class T>
Argument add(void* to, const std::string& name, T& target, const std::string& help) {
  CLI::Option* const made = app(to).add_option(name, target, help);
  if constexpr (std::is_same_v<T, float> || std::is_same_v<T, double> || std::is_same_v<T, std::optional<float>> ||
                std::is_same_v<T, std::optional<double>>)
    made->check(expects("a finite number", is_finite_or_text));
  if constexpr (std::is_same_v<T, std::uint64_t> || std::is_same_v<T, std::optional<std::uint64_t>>)
    made->check(expects("a whole number, 0 to 18446744073709551615", is_whole<std::uint64_t>));
  if constexpr (std::is_same_v<T, std::int64_t>)
    made->check(expects("a whole number of at most 18 digits", is_whole<std::int64_t>));
  return Argument(made);
}
}  // namespace

Argument& Argument::required() { return option(option_).required(), *this; }
Argument& Argument::range(int least, int most) {
  const std::string words = fmt::format("{} to {}", least, most);
  says(option_, words).check(expects(words, number_that<std::int64_t>([=](std::int64_t v) {
                                       return v >= least && v <= most;
                                     })));
  return *this;
}
Argument& Argument::range(double least, double most) {
  const std::string words = fmt::format("{:g} to {:g}", least, most);
  says(option_, words).check(expects(words, number_that<double>([=](double v) { return v >= least && v <= most; })));
  return *this;
}
Argument& Argument::positive() {
  option(option_).check(expects("more than 0", number_that<double>([](double v) { return v > 0.0; })));
  return *this;
}
Argument& Argument::not_negative() {
  option(option_).check(expects("0 or more", number_that<double>([](double v) { return v >= 0.0; })));
  return *this;
}
Argument& Argument::not_empty() {
  option(option_).check(expects("a name", [](const std::string& text) { return !text.empty(); }));
  return *this;
}
Argument& Argument::one_of(std::vector<std::string> words) {
  says(option_, fmt::format("{}", fmt::join(words, ", "))).check(one_word_of(words));
  return *this;
}
Argument& Argument::called(const std::string& type) { return option(option_).type_name(type), *this; }
Argument& Argument::separated_by(char separator) { return option(option_).delimiter(separator), *this; }
Argument& Argument::words(int least, int most) { return option(option_).expected(least, most), *this; }
Argument& Argument::one_word_each_time() { return option(option_).allow_extra_args(false), *this; }

Arguments Arguments::program(const std::string& words, const std::string& name, const std::string& version) {
  auto state = std::make_shared<State>();
  state->root = std::make_unique<CLI::App>(words, name);
  state->root->set_version_flag("--version", version);
  void* const root = state->root.get();
  return Arguments(std::move(state), root);
}

Arguments Arguments::command(const std::string& name, const std::string& words) {
  return Arguments(state_, app(app_).add_subcommand(name, words));
}

Arguments Arguments::subcommand(const std::string& name, const std::string& words) {
  CLI::App* const sub = app(app_).add_subcommand(name, words);
  sub->fallthrough();
  return Arguments(state_, sub);
}

Arguments Arguments::group(const std::string& title) { return Arguments(state_, app(app_).add_option_group(title)); }
void Arguments::needs_command() { app(app_).require_subcommand(1); }
void Arguments::footer(const std::string& text) { app(app_).footer(text); }

Argument Arguments::value(const std::string& name, std::string& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, int& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::int64_t& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::uint64_t& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, float& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, double& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::optional<int>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::optional<std::uint64_t>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::optional<float>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Argument Arguments::value(const std::string& name, std::optional<double>& target, const std::string& help) {
  return add(app_, name, target, help);
}

Argument Arguments::flag(const std::string& name, bool& target, const std::string& help) {
  return Argument(app(app_).add_flag(name, target, help));
}

Argument Arguments::choice_of(const std::string& name, const std::vector<std::string>& words,
                              std::function<void(std::size_t)> chosen, const std::string& help) {
  const auto use = [words, chosen = std::move(chosen)](const std::string& word) {
    chosen(static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin()));
  };
  CLI::Option* const made = app(app_).add_option_function<std::string>(name, use, help);
  says(made, fmt::format("{}", fmt::join(words, ", "))).check(one_word_of(words))->type_name("WORD");
  return Argument(made);
}

Argument Arguments::reads(const std::string& name, std::string& target, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return std::vector{target}; }, false, FileFormat::kOther});
  return value(name, target, help).called("FILE");
}

Argument Arguments::reads(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return target; }, false, FileFormat::kOther});
  return value(name, target, help).called("FILE");
}

Argument Arguments::writes(const std::string& name, std::string& target, FileFormat format, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return std::vector{target}; }, true, format});
  return value(name, target, help).called("FILE").not_empty();
}

bool Arguments::chosen() const { return app(app_).parsed(); }
bool Arguments::given(const std::string& name) const { return app(app_).count(name) > 0; }
std::string Arguments::name() const { return app(app_).get_name(); }

std::vector<FileUse> Arguments::files() const {
  const auto belongs = [this](const void* owner) {  // an option group, a subcommand or this verb itself
    if (owner == app_) return true;
    for (CLI::App* const part : app(app_).get_subcommands([](CLI::App*) { return true; })) {
      if (part == owner) return part->get_name().empty() || part->parsed();
      for (CLI::App* const below : part->get_subcommands([](CLI::App*) { return true; }))
        if (below == owner) return part->parsed();
    }
    return false;
  };
  std::vector<FileUse> uses;
  for (const State::File& file : state_->files) {
    if (!belongs(file.app)) continue;
    for (const std::string& path : file.paths())
      if (!path.empty() && path != "-") uses.push_back({file.option, path, file.written, file.format});
  }
  return uses;
}

std::vector<std::string> Arguments::words() const { return state_->words; }

std::optional<int> Arguments::parse(int argc, char** argv) {
  CLI::App& root = app(app_);
  std::vector<std::string> words(argv + 1, argv + std::max(argc, 1));
  if (words.empty()) {
    std::cerr << help_text(root, help_columns());
    return exit_code(ErrorKind::kUsage);
  }
  if (words[0] == "help") {  // "help process" is "process --help"
    words.erase(words.begin());
    words.push_back("--help");
  }
  state_->words.assign(words.begin() + 1, words.end());
  try {
    std::vector<std::string> backwards(words.rbegin(), words.rend());
    root.parse(backwards);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    std::cout << help_text(chosen_app(root), help_columns());
    return 0;
  } catch (const CLI::Success& e) {
    return root.exit(e);  // --version
  } catch (const CLI::ParseError& e) {
    const std::string message = refusal_text(root, e, words);
    std::cerr << "error: " << message << "\n";
    const auto json = std::find(words.begin(), words.end(), "--json");
    if (std::find(words.begin(), words.end(), "--json=-") != words.end() ||
        (json != words.end() && json + 1 != words.end() && json[1] == "-"))
      std::cout << error_json(Error{ErrorKind::kUsage, message});
    return exit_code(ErrorKind::kUsage);
  }
}

}  // namespace dubsar::app
