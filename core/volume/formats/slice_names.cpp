#include "core/volume/formats/slice_names.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/files/file_suffix.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// How numbers in names are read.
struct Reading {
  bool decimals = true;      ///< "0.05" is one number
  bool every_minus = false;  ///< "-" before a digit is a sign unless a digit stands before it
};

/// A name with its numbers taken out: "z_*.tif" and {0.05}.
struct SliceName {
  fs::path file;
  std::string text;
  std::vector<double> numbers;
};

std::size_t digits_from(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

/// Where the number ends that begins at `at` with a digit.
std::size_t number_end(std::string_view text, std::size_t at, const Reading& reading) {
  std::size_t end = digits_from(text, at);
  if (!reading.decimals) return end;
  if (end + 1 < text.size() && (text[end] == '.' || text[end] == ',') && is_digit(text[end + 1]))
    end = digits_from(text, end + 1);
  if (end + 2 < text.size() && (text[end] == 'e' || text[end] == 'E') &&
      (text[end + 1] == '-' || text[end + 1] == '+') && is_digit(text[end + 2]))
    end = digits_from(text, end + 2);
  return end;
}

SliceName take_apart(const fs::path& file, const Reading& reading) {
  SliceName name{file, {}, {}};
  const std::string stem = file.stem().string();
  for (std::size_t at = 0; at < stem.size();) {
    const char before = at > 0 ? stem[at - 1] : '_';
    const bool sign = stem[at] == '-' && at + 1 < stem.size() && is_digit(stem[at + 1]) &&
                      (before == '_' || before == '=' || before == '(' || (reading.every_minus && !is_digit(before)));
    if (!sign && !is_digit(stem[at])) {
      name.text += stem[at++];
      continue;
    }
    const std::size_t begin = at, end = number_end(stem, at + (sign ? 1 : 0), reading);
    std::string number = stem.substr(begin, end - begin);
    std::replace(number.begin(), number.end(), ',', '.');
    double value = 0.0;
    std::from_chars(number.data(), number.data() + number.size(), value);
    name.numbers.push_back(value);
    name.text += '*';
    at = end;
  }
  // Both suffixes, in either case, are one kind of file.
  name.text += lower_suffix(file) == ".tiff" ? ".tif" : lower_suffix(file);
  return name;
}

/// The first number that is another in each name.
std::optional<std::size_t> counting_number(const std::vector<SliceName>& names) {
  for (std::size_t i = 0; i < names.front().numbers.size(); ++i) {
    std::vector<double> values;
    for (const SliceName& name : names) values.push_back(name.numbers[i]);
    std::sort(values.begin(), values.end());
    if (std::adjacent_find(values.begin(), values.end()) == values.end()) return i;
  }
  return std::nullopt;
}

bool same_text(const std::vector<SliceName>& names) {
  return std::all_of(names.begin(), names.end(), [&](const SliceName& n) { return n.text == names.front().text; });
}

/// The name of the slice that would have this number, written as that of its neighbour.
std::string name_with(const SliceName& neighbour, std::size_t which, double number) {
  const std::string stem = neighbour.file.stem().string();
  std::size_t at = 0;
  for (std::size_t i = 0; at < stem.size(); ++i) {
    while (at < stem.size() && !is_digit(stem[at])) ++at;
    const std::size_t end = digits_from(stem, at);
    if (i == which) return fmt::format("{}{:0{}.0f}{}", stem.substr(0, at), number, end - at, stem.substr(end));
    at = end;
  }
  return stem;
}

void tell_gaps(const std::vector<SliceName>& names, std::size_t which, std::vector<std::string>& warnings) {
  std::vector<double> steps;
  bool whole = true;
  for (std::size_t k = 0; k + 1 < names.size(); ++k)
    steps.push_back(names[k + 1].numbers[which] - names[k].numbers[which]);
  for (const SliceName& name : names) whole = whole && name.numbers[which] == std::floor(name.numbers[which]);
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2), sorted.end());
  const double step = sorted[(sorted.size() - 1) / 2];
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> missing;
  double count = 0;
  std::size_t uneven = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (std::abs(steps[k] - step) <= 0.02 * step) continue;
    const double gone = std::round(steps[k] / step) - 1.0;
    if (gone < 1.0 || std::abs((gone + 1.0) * step - steps[k]) > 0.05 * step) {
      ++uneven;
      continue;
    }
    count += gone;
    for (double i = 1; i <= gone && missing.size() < kMostNamed; ++i) {
      const double number = names[k].numbers[which] + i * step;
      missing.push_back(whole && number >= 0.0 ? name_with(names[k], which, number) : fmt::format("{:g}", number));
    }
  }
  if (count > 0)
    warnings.push_back(
        fmt::format("{:.0f} slice{} missing among the names of the files ({}{}): what lies beyond is nearer "
                    "than it was",
                    count, count == 1 ? " is" : "s are", fmt::join(missing, ", "),
                    count > static_cast<double>(missing.size()) ? ", ..." : ""));
  if (uneven > 0)
    warnings.push_back(
        fmt::format("the numbers in the names of the slices have uneven steps ({} of {} differ from {:g}): the slices "
                    "are taken as equally far apart",
                    uneven, steps.size(), step));
}

std::string several_series(const std::vector<SliceName>& names) {
  std::map<std::string, int> groups;
  for (const SliceName& name : names) ++groups[name.text];
  std::vector<std::string> said;
  for (const auto& [text, count] : groups) {
    if (said.size() == 4) {
      said.push_back(fmt::format("{} more", groups.size() - 4));
      break;
    }
    said.push_back(fmt::format("{} ({} file{})", text, count, count == 1 ? "" : "s"));
  }
  return fmt::format("{}", fmt::join(said, " and "));
}

}  // namespace

Result<SliceSeries> order_slices(std::vector<fs::path> files, const std::string& where) {
  SliceSeries series;
  if (files.size() < 2) {
    series.files = std::move(files);
    return series;
  }
  constexpr std::array<Reading, 4> kReadings{{{true, false}, {true, true}, {false, false}, {false, true}}};
  std::vector<SliceName> first;
  std::optional<SliceSeries> uneven;  // by the first reading that makes one series, though it has gaps
  for (const Reading& reading : kReadings) {
    std::vector<SliceName> names;
    for (const fs::path& file : files) names.push_back(take_apart(file, reading));
    if (const auto which = same_text(names) ? counting_number(names) : std::nullopt) {
      std::sort(names.begin(), names.end(),
                [&](const SliceName& a, const SliceName& b) { return a.numbers[*which] < b.numbers[*which]; });
      SliceSeries found;
      if (names.size() > 2) tell_gaps(names, *which, found.warnings);
      for (const SliceName& name : names) found.files.push_back(name.file);
      if (found.warnings.empty()) return found;
      if (!uneven) uneven = std::move(found);
    }
    if (first.empty()) first = std::move(names);
  }
  if (uneven) return *std::move(uneven);
  if (std::all_of(first.begin(), first.end(), [](const SliceName& name) { return name.numbers.empty(); })) {
    std::sort(files.begin(), files.end());
    series.files = std::move(files);
    return series;
  }
  if (same_text(first)) {
    std::sort(first.begin(), first.end(), [](const SliceName& a, const SliceName& b) {
      return std::lexicographical_compare(a.numbers.rbegin(), a.numbers.rend(), b.numbers.rbegin(), b.numbers.rend());
    });
    return fail(
        ErrorKind::kBadData,
        "import_tiff: {} holds more than one slice of a number, such as {} and {}; expected one series, name it "
        "with a pattern such as scan1_*.tif",
        where, first[0].file.filename().string(), first[1].file.filename().string());
  }
  return fail(ErrorKind::kBadData,
              "import_tiff: {} holds several series of names: {}; expected one, name it with a pattern such as {}",
              where, several_series(first), first.front().text);
}

}  // namespace dubsar
