#pragma once
// What EXA is meant to reach, beside what was found in this run.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

class ExaGoals {
 public:
  /// `digits` behind the point; the goal holds when found <= limit.
  void at_most(const std::string& what, double found, double limit, int digits = 3) {
    lines_.push_back(
        {what, fmt::format("{:.{}f}", found, digits), fmt::format("<= {:.{}f}", limit, digits), found <= limit});
  }
  void at_least(const std::string& what, double found, double limit, int digits = 2) {
    lines_.push_back(
        {what, fmt::format("{:.{}f}", found, digits), fmt::format(">= {:.{}f}", limit, digits), found >= limit});
  }
  void near_to(const std::string& what, double found, double wanted, double apart, int digits = 3) {
    lines_.push_back({what, fmt::format("{:.{}f}", found, digits), fmt::format("{:.{}f} +- {:.2f}", wanted, 2, apart),
                      found >= wanted - apart && found <= wanted + apart});
  }
  void holds(const std::string& what, bool yes) { lines_.push_back({what, yes ? "yes" : "no", "yes", yes}); }

  bool all_met() const {
    return std::all_of(lines_.begin(), lines_.end(), [](const Line& line) { return line.met; });
  }
  std::string text() const {
    std::string text = fmt::format("\n{:<78}{:>10}{:>14}\n", "goals", "found", "goal");
    for (const Line& line : lines_)
      text += fmt::format("{:<78}{:>10}{:>14}  {}\n", line.what, line.found, line.goal, line.met ? "met" : "MISSED");
    return text;
  }

 private:
  struct Line {
    std::string what, found, goal;
    bool met = false;
  };
  std::vector<Line> lines_;
};
