#pragma once
// What the program says about its verbs and options, and about command lines that it does not understand: plain
// sentences, laid out for the width of the terminal. Behind arguments.cpp; only these two know the parser's library.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dubsar::app {

/// Columns of the terminal on stdout or stderr, of COLUMNS where neither is one, else 80; 40 to 110.
int help_columns();

/// The page of `--help`: what it does, how it is called, each option with its sentence, examples. The page of the
/// program lists the verbs.
std::string help_text(const CLI::App& app, int columns);

/// The innermost verb that was chosen, the program itself when none was.
const CLI::App& chosen_app(const CLI::App& root);

/// One sentence for a command line that was refused: what was found, what was expected, what may have been meant.
std::string refusal_text(const CLI::App& root, const CLI::ParseError& error, const std::vector<std::string>& words);

}  // namespace dubsar::app
