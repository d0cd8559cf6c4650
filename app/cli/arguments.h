#pragma once
// The door to the command line: what a verb's options are called, where their values go, and which files the verb reads
// and writes. The library that parses stays behind arguments.cpp, so that verbs compile quickly.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/file_uses.h"

namespace dubsar::app {

/// One option, to be narrowed: `arguments.value("--threads", threads, "...").range(0, 1024)`. Good as long as its
/// Arguments.
class Argument {
 public:
  explicit Argument(void* option) : option_(option) {}
  Argument& required();
  Argument& range(int least, int most);
  Argument& range(double least, double most);
  Argument& positive();
  Argument& not_negative();
  Argument& not_empty();  ///< as it is where a shell's variable has no value
  Argument& one_of(std::vector<std::string> words);
  Argument& called(const std::string& type);  ///< what the help calls the value, e.g. "FILE"
  Argument& separated_by(char separator);     ///< a list in one word: "a,b"
  Argument& words(int least, int most);       ///< how many words the option takes
  Argument& one_word_each_time();             ///< may be repeated, each time with one word

 private:
  void* option_;
};

/// The options of the program, of a verb or of one of its subcommands; cheap to copy, all copies are the same thing.
/// Targets must outlive parse(). One thread.
class Arguments {
 public:
  static Arguments program(const std::string& words, const std::string& name, const std::string& version);

  Arguments command(const std::string& name, const std::string& words);
  /// A subcommand that takes its parent's options, too.
  Arguments subcommand(const std::string& name, const std::string& words);
  Arguments group(const std::string& title);
  void needs_command();
  void footer(const std::string& text);

  /// Numbers are finite, and those without a sign take none.
  Argument value(const std::string& name, std::string& target, const std::string& help);
  Argument value(const std::string& name, int& target, const std::string& help);
  Argument value(const std::string& name, std::int64_t& target, const std::string& help);
  Argument value(const std::string& name, std::uint64_t& target, const std::string& help);
  Argument value(const std::string& name, float& target, const std::string& help);
  Argument value(const std::string& name, double& target, const std::string& help);
  Argument value(const std::string& name, std::vector<std::string>& target, const std::string& help);
  Argument value(const std::string& name, std::optional<int>& target, const std::string& help);
  Argument value(const std::string& name, std::optional<std::uint64_t>& target, const std::string& help);
  Argument value(const std::string& name, std::optional<float>& target, const std::string& help);
  Argument value(const std::string& name, std::optional<double>& target, const std::string& help);
  Argument flag(const std::string& name, bool& target, const std::string& help);
  /// One word of a table for one value of an enum.
  template <class T>
  Argument choice(const std::string& name, T& target, const std::vector<std::pair<std::string, T>>& table,
                  const std::string& help) {
    std::vector<std::string> words;
    std::vector<T> values;
    for (const auto& [word, meaning] : table) {
      words.push_back(word);
      values.push_back(meaning);
    }
    return choice_of(
        name, words, [values, &target](std::size_t index) { target = values[index]; }, help);
  }

  /// Files: the same as value(), and known as read or written, so that a verb that would write over what it reads is
  /// refused before it begins (file_uses.h).
  Argument reads(const std::string& name, std::string& target, const std::string& help);
  Argument reads(const std::string& name, std::vector<std::string>& target, const std::string& help);
  Argument writes(const std::string& name, std::string& target, FileFormat format, const std::string& help);

  bool chosen() const;                        ///< this verb or subcommand stands on the command line
  bool given(const std::string& name) const;  ///< this option does
  std::string name() const;
  std::vector<std::string> words() const;  ///< of the command line behind the program and the verb, as they were typed
  std::vector<FileUse> files() const;      ///< of this verb and its subcommands that were chosen; empty paths left out

  /// Nothing when the program shall go on; else its exit code (help and version are printed, and errors).
  std::optional<int> parse(int argc, char** argv);

 private:
  struct State;
  explicit Arguments(std::shared_ptr<State> state, void* app) : state_(std::move(state)), app_(app) {}
  Argument choice_of(const std::string& name, const std::vector<std::string>& words,
                     std::function<void(std::size_t)> chosen, const std::string& help);
  std::shared_ptr<State> state_;
  void* app_;
};

}  // namespace dubsar::app
