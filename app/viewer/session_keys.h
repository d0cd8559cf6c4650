#pragma once
// Keys that the session itself understands, in one table: the window obeys it and the help prints it.

#include <array>
#include <optional>
#include <string_view>

namespace dubsar::app {

enum class SessionCommand { kHelp, kNextDisplay, kPreviousDisplay, kRetrySources, kFullscreen, kEnd };

struct SessionKey {
  std::string_view key;
  SessionCommand command;
  std::string_view words;
};

inline constexpr std::array<SessionKey, 7> kSessionKeys{{
    {"f1", SessionCommand::kHelp, "this help"},
    {"?", SessionCommand::kHelp, "this help"},
    {"f2", SessionCommand::kNextDisplay, "next display"},
    {"f3", SessionCommand::kPreviousDisplay, "display before"},
    {"f5", SessionCommand::kRetrySources, "look for missing sources now"},
    {"f11", SessionCommand::kFullscreen, "whole monitor, and back"},
    {"escape", SessionCommand::kEnd, "close this help, or end"},
}};

inline std::optional<SessionCommand> session_command(std::string_view key) noexcept {
  for (const SessionKey& row : kSessionKeys)
    if (row.key == key) return row.command;
  return std::nullopt;
}

}  // namespace dubsar::app
