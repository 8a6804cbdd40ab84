/// The tool's options as Python's arguments.

#include "words.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace python {

namespace {

/// Options whose argument has another name, or that stand for one value of an argument.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> renamed{{{"lambda", "lambda_share="},
                                                                                {"misplaced", "misplaced_degrees="},
                                                                                {"no-reject", "reject=False"},
                                                                                {"uncertainty", "uncertainty=True"},
                                                                                {"as-printed", "as_printed=True"},
                                                                                {"in-sample", "in_sample=True"},
                                                                                {"fresnel", "fresnel=True"}}};

/// Options whose argument has the same name, except for hyphens.
constexpr std::array<std::string_view, 27> same{
    "prior",  "networks",     "merl",      "exclude",    "metric",   "root",     "solver",     "eta",  "variance",
    "noise",  "discrepancy",  "gamma",     "method",     "geometry", "search",   "iterations", "seed", "start",
    "starts", "common-shift", "criterion", "neighbours", "rgl",      "quantity", "columns",    "side", "band"};

/// Options of `same` whose value is a word.
constexpr std::array<std::string_view, 6> chosen_by_word{"method",   "metric",    "solver",
                                                         "geometry", "criterion", "search"};

/// Words of a sentence that are never the value of an option.
constexpr std::array<std::string_view, 9> plain_words{"and", "or", "not", "need", "needs", "goes", "was", "to", "of"};

template <class Words>
bool contains(const Words& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_lower_case(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the lower-case word, which may contain hyphens, at the beginning of a text.
std::string_view word_at(std::string_view text) {
  const auto end = std::ranges::find_if_not(text, [](char c) { return is_lower_case(c) || is_digit(c) || c == '-'; });
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

/// Returns "eta=" for "eta"; nothing if the option is not an argument.
std::string argument_of(std::string_view option) {
  for (const auto& [name, argument] : renamed)
    if (name == option) return std::string(argument);
  if (!contains(same, option)) return {};
  std::string argument(option);
  std::ranges::replace(argument, '-', '_');
  return argument + '=';
}

/// Finds an option's value at the beginning of the text after the option. Returns the value's length with the leading
/// space, and the value in Python.
std::pair<std::size_t, std::string> value_behind(std::string_view option, std::string_view text) {
  if (text.size() < 2 || text.front() != ' ') return {0, ""};
  const std::string_view word = word_at(text.substr(1));
  if (is_digit(text[1])) return {1, ""};  // the number follows unchanged
  if (!contains(chosen_by_word, option) || word.empty() || !is_lower_case(word.front()) || contains(plain_words, word))
    return {0, ""};
  return {1 + word.size(), '\'' + std::string(word) + '\''};
}

}  // namespace

std::string in_python(std::string_view sentence) {
  std::string told;
  while (!sentence.empty()) {
    const bool begins =
        sentence.starts_with("--") && (told.empty() || !(is_lower_case(told.back()) || told.back() == '-'));
    const std::string_view option = begins ? word_at(sentence.substr(2)) : std::string_view();
    const std::string argument = argument_of(option);
    if (argument.empty()) {
      told += sentence.front();
      sentence.remove_prefix(1);
      continue;
    }
    sentence.remove_prefix(2 + option.size());
    told += argument;
    if (!argument.ends_with('=')) continue;
    const auto [length, value] = value_behind(option, sentence);
    told += value;
    sentence.remove_prefix(length);
  }
  return told;
}

}  // namespace python
