#include "app/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "core/base/result.h"

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
};

namespace {
CLI::Option& option(void* pointer) { return *static_cast<CLI::Option*>(pointer); }
CLI::App& app(void* pointer) { return *static_cast<CLI::App*>(pointer); }

/// Single letters to insert, leave out or change until the words are equal.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t changed = corner + (a[i] == b[k] ? 0 : 1);
      corner = row[k + 1];
      row[k + 1] = std::min({changed, row[k] + 1, corner + 1});
    }
  }
  return row.back();
}

/// The verb or option of `from` that `word` may have been meant as; empty when none is near.
std::string meant(const CLI::App& from, const std::string& word) {
  std::string best;
  std::size_t least = word.size() < 5 ? 2 : 3;  // nearer than this
  const auto consider = [&](const std::string& name) {
    const std::size_t distance = edit_distance(word, name);
    if (distance < least) least = distance, best = name;
  };
  for (const CLI::App* const part : from.get_subcommands([](const CLI::App*) { return true; })) {
    if (!part->get_name().empty() && !word.starts_with("-")) consider(part->get_name());
    if (part->get_name().empty())  // a group of options
      for (const CLI::Option* const option : part->get_options())
        for (const std::string& name : option->get_lnames()) consider("--" + name);
  }
  for (const CLI::Option* const option : from.get_options())
    for (const std::string& name : option->get_lnames()) consider("--" + name);
  return best;
}

/// The innermost verb that was chosen, the program itself when none was.
const CLI::App& chosen_app(const CLI::App& root) {
  for (const CLI::App* const part : root.get_subcommands([](const CLI::App*) { return true; }))
    if (!part->get_name().empty() && part->parsed()) return chosen_app(*part);
  return root;
}

template <class T>
Option add(void* to, const std::string& name, T& target, const std::string& help) {
  return Option(app(to).add_option(name, target, help));
}
}  // namespace

Option& Option::required() { return option(option_).required(), *this; }
Option& Option::range(int least, int most) { return option(option_).check(CLI::Range(least, most)), *this; }
Option& Option::range(double least, double most) { return option(option_).check(CLI::Range(least, most)), *this; }
Option& Option::positive() { return option(option_).check(CLI::PositiveNumber), *this; }
Option& Option::not_negative() { return option(option_).check(CLI::NonNegativeNumber), *this; }
Option& Option::one_of(std::vector<std::string> words) { return option(option_).check(CLI::IsMember(words)), *this; }
Option& Option::called(const std::string& type) { return option(option_).type_name(type), *this; }
Option& Option::separated_by(char separator) { return option(option_).delimiter(separator), *this; }
Option& Option::words(int least, int most) { return option(option_).expected(least, most), *this; }
Option& Option::one_word_each_time() { return option(option_).allow_extra_args(false), *this; }

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

Option Arguments::value(const std::string& name, std::string& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, int& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::int64_t& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::uint64_t& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, float& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, double& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::optional<int>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::optional<std::uint64_t>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::optional<float>& target, const std::string& help) {
  return add(app_, name, target, help);
}
Option Arguments::value(const std::string& name, std::optional<double>& target, const std::string& help) {
  return add(app_, name, target, help);
}

Option Arguments::flag(const std::string& name, bool& target, const std::string& help) {
  return Option(app(app_).add_flag(name, target, help));
}

Option Arguments::choice_of(const std::string& name, const std::vector<std::string>& words,
                            std::function<void(std::size_t)> chosen, const std::string& help) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : "|") + word;
  const auto use = [words, chosen = std::move(chosen)](const std::string& word) {
    chosen(static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin()));
  };
  return Option(
      app(app_).add_option_function<std::string>(name, use, help)->check(CLI::IsMember(words))->option_text(all));
}

Option Arguments::reads(const std::string& name, std::string& target, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return std::vector{target}; }, false, FileFormat::kOther});
  return value(name, target, help);
}

Option Arguments::reads(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return target; }, false, FileFormat::kOther});
  return value(name, target, help);
}

Option Arguments::writes(const std::string& name, std::string& target, FileFormat format, const std::string& help) {
  state_->files.push_back({app_, name, [&target] { return std::vector{target}; }, true, format});
  return value(name, target, help);
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

std::optional<int> Arguments::parse(int argc, char** argv) {
  CLI::App& root = app(app_);
  if (argc < 2) {
    std::cerr << root.help();
    return exit_code(ErrorKind::kUsage);
  }
  try {
    root.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& e) {
    return root.exit(e);  // --help, --version
  } catch (const CLI::ParseError& e) {
    root.exit(e, std::cout, std::cerr);
    const CLI::App& at = chosen_app(root);
    std::vector<std::string> unknown = at.remaining(true);
    for (const std::string& word : &at == &root ? unknown : root.remaining(false)) unknown.push_back(word);
    for (const std::string& word : unknown)
      if (const std::string better = meant(at, word.substr(0, word.find('='))); !better.empty()) {
        std::cerr << "Did you mean " << better << "?\n";
        break;
      }
    return exit_code(ErrorKind::kUsage);
  }
}

}  // namespace dubsar::app
