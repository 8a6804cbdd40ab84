#include "check_answer.hpp"

#include "tool/pages/fixed.hpp"
#include "tool/pages/sample_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>

namespace cli {

namespace {

/// Returns the names of the result's channels. The result has one channel if the values of all channels are identical.
std::vector<std::string> channel_names(const checked_part& checked) {
  const gonio::conformity& found = checked.found;
  const measured_surface& part = checked.part;
  if (found.shift.size() == 1) return {part.located.kinds.size() == 1 ? part.located.kinds.name(0) : "value"};
  std::vector<std::string> names;
  for (Eigen::Index c = 0; c < found.shift.size(); ++c) names.push_back(part.located.kinds.name(c));
  return names;
}

/// Returns a number with two significant digits.
std::string probability(double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.2g", value);
  return digits.data();
}

/// Returns "p = 0.42", or "p < 1e-9": no noise is known so well that smaller values have a meaning.
std::string p_value(double value) { return value < 1e-9 ? "p < 1e-9" : "p = " + probability(value); }

/// Returns a difference of mapped values as a relative difference: "+4.1 %".
std::string percent(double mapped) { return (mapped >= 0.0 ? "+" : "") + fixed(100.0 * std::expm1(mapped), 1) + " %"; }

/// Returns theta_i and theta_o in degrees. In the plane of incidence, theta_o is negative on the mirror direction's
/// side; outside it, the difference of the azimuths follows.
std::string angles_of(const gonio::direction_pair& pair) {
  const auto& [wi, wo] = pair;
  constexpr double at_normal = 1e-3;
  const double theta_i = gonio::polar_angle(wi), theta_o = gonio::polar_angle(wo);
  const double turn = theta_i < at_normal ? gonio::azimuth(wo) : gonio::azimuth(wo) - gonio::azimuth(wi);
  const double apart = std::abs(std::remainder(turn, 2.0 * std::numbers::pi));
  const bool is_mirrored = std::numbers::pi - apart < gonio::radians(0.5);
  std::string text = "theta_i " + fixed(gonio::degrees(theta_i), 1) + ", theta_o " +
                     fixed(gonio::degrees(is_mirrored ? -theta_o : theta_o), 1);
  if (!is_mirrored && apart > gonio::radians(0.5) && std::min(theta_i, theta_o) >= at_normal)
    text += ", azimuths " + fixed(gonio::degrees(apart), 1) + " apart";
  return text;
}

/// Describes a direction by the channel that differs most: "theta_i 45.0, theta_o -45.0 (line 12): red 0.210 instead of
/// 0.140 +- 0.020 sr^-1, p = 0.0003".
std::string described(const gonio::compared_direction& each, const checked_part& checked) {
  const measured_surface& part = checked.part;
  Eigen::Index channel = 0;
  (void)(each.difference / each.deviation).abs().maxCoeff(&channel);
  const double off = each.expected[channel] * std::expm1(each.deviation[channel]);
  const auto number = static_cast<std::size_t>(part.numbers[each.number]);
  const std::string location =
      part.lines.empty() ? "sample " + std::to_string(number) : "line " + std::to_string(part.lines[number - 1]);
  return angles_of(part.counting[each.number].pair()) + " (" + location + "): " + channel_names(checked)[channel] +
         ' ' + reflectance(each.value[channel]) + " instead of " + reflectance(each.expected[channel]) + " +- " +
         reflectance(off) + " sr^-1" + (each.measured > 0 ? "" : ", predicted from the reference") +
         (each.delta_e > 0.0 ? ", Delta E " + fixed(each.delta_e, 1) : "") + ", " + p_value(each.adjusted_p_value);
}

/// Returns a sentence for each limitation of the answer.
std::vector<std::string> limits_of(const checked_part& checked) {
  std::vector<std::string> sentences;
  const Eigen::Index predicted = checked.found.predicted(), all = std::ssize(checked.found.directions);
  if (predicted > 0)
    sentences.push_back(std::to_string(predicted) + " of " + std::to_string(all) +
                        " directions are not measured in the reference and are predicted" +
                        (predicted == all ? ": only a shift of all directions and large differences are detectable"
                                          : ": only large differences are detectable there"));
  const auto negative =
      (checked.part.located.values.array() < 0.0).count() + (checked.reference.located.values.array() < 0.0).count();
  if (negative > 0 && checked.options.part.dark == 0.0)
    sentences.push_back(std::to_string(negative) +
                        " values are negative and count as zero: if they are noise, give --dark-noise");
  if (!std::isinf(checked.options.part.degrees_of_freedom))
    sentences.push_back("noise of " + fixed(100.0 * checked.options.part.relative, 2) +
                        " %, estimated from directions that were measured more than once, also with light and receiver "
                        "exchanged (" +
                        fixed(checked.options.part.degrees_of_freedom, 0) + " degrees of freedom)");
  return sentences;
}

/// Returns "red +0.1 %, green +0.3 %, blue -0.2 %"; of more than six channels, only the one with the largest shift.
std::string shifts(const gonio::conformity& found, const std::vector<std::string>& names) {
  constexpr std::size_t most_listed = 6;
  const auto told = [&](Eigen::Index channel) { return names[channel] + ' ' + percent(found.shift[channel]); };
  if (names.size() > most_listed) {
    Eigen::Index most = 0;
    (void)found.shift.abs().maxCoeff(&most);
    return "most at " + told(most);
  }
  std::string all;
  for (Eigen::Index channel = 0; channel < found.shift.size(); ++channel)
    all += (all.empty() ? "" : ", ") + told(channel);
  return all;
}

/// Returns "; tolerance 5 %" or "; tolerance Delta E of 2"; empty if there is none.
std::string tolerances(const gonio::conformity_options& options) {
  std::string text;
  if (options.delta_e > 0.0) text = "Delta E of " + probability(options.delta_e);
  if (std::ranges::max(options.tolerance) > 0.0)
    for (const double each : options.tolerance) text += (text.empty() ? "" : ", ") + probability(100.0 * each) + " %";
  if (options.peak_tolerance)
    text += (text.empty() ? "" : "; ") + probability(100.0 * *options.peak_tolerance) + " % near the mirror direction";
  return text.empty() ? "" : "; tolerance " + text;
}

/// Returns the directions that differ, except the worst.
std::vector<Eigen::Index> others_that_differ(const check_question& question, const gonio::conformity& found) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < std::ssize(found.directions); ++i)
    if (i != found.worst() && found.directions[i].adjusted_p_value < question.false_alarms) others.push_back(i);
  return others;
}

const char* verdict_of(const checked_part& checked) { return checked.conforms ? "GO" : "NO-GO"; }

void print_familiarity(const gonio::familiarity& known) {
  std::cout << "known materials explain the part " << (known.p_value < 0.01 ? "badly" : "well") << " ("
            << p_value(known.p_value) << "; the squared deviation is " << fixed(known.scale, 2)
            << " times the expected one; its shares: components " << fixed(100.0 * known.components, 0)
            << " %, discrepancy " << fixed(100.0 * known.discrepancy, 0) << " %, errors "
            << fixed(100.0 * known.errors, 0) << " %)\n";
}

/// Returns a number for each channel.
json listed(const Eigen::ArrayXd& channels) {
  json all = json::array();
  for (const double value : channels) all.push_back(value);
  return all;
}

json directions_as_json(const checked_part& checked) {
  const measured_surface& part = checked.part;
  json all = json::array();
  for (const gonio::compared_direction& each : checked.found.directions) {
    const Eigen::Index number = part.numbers[each.number];
    json told{{"sample", number}};
    if (!part.lines.empty()) told["line"] = part.lines[static_cast<std::size_t>(number - 1)];
    told.update(angles_as_json(part.counting[each.number]));
    told.update({{"reference_samples", each.measured},
                 {"measured", listed(each.value)},
                 {"reference", listed(each.expected)},
                 {"delta_e", each.delta_e},
                 {"mapped_difference", listed(each.difference)},
                 {"mapped_deviation", listed(each.deviation)},
                 {"p_value", each.p_value},
                 {"adjusted_p_value", each.adjusted_p_value}});
    all.push_back(std::move(told));
  }
  return all;
}

}  // namespace

void print_verdict(const check_question& question, const checked_part& checked) {
  const gonio::conformity& found = checked.found;
  std::cout << verdict_of(checked) << ": " << (checked.conforms ? "no difference found" : "the part differs") << " ("
            << p_value(found.p_value) << "; false alarms " << probability(100.0 * question.false_alarms) << " %"
            << tolerances(checked.options) << ")\n";
  std::cout << "worst: " << described(found.directions[found.worst()], checked) << '\n';
  std::cout << "all directions together: " << shifts(found, channel_names(checked)) << " ("
            << p_value(found.shift_p_value) << ")\n";
  const std::vector<Eigen::Index> others = others_that_differ(question, found);
  if (question.is_verbose) {
    for (const Eigen::Index i : others) std::cout << "differs: " << described(found.directions[i], checked) << '\n';
    for (const std::string& limit : limits_of(checked)) std::cout << limit << '\n';
    print_familiarity(checked.familiarity);
    return;
  }
  if (!others.empty())
    std::cout << counted(std::ssize(others), "other direction") << (others.size() == 1 ? " differs" : " differ")
              << " (--verbose lists " << (others.size() == 1 ? "it" : "them") << ")\n";
  std::string limits;
  for (const std::string& limit : limits_of(checked)) limits += (limits.empty() ? "" : "; ") + limit;
  if (!limits.empty()) std::cout << limits << '\n';
}

void print_table(const check_question& question, const std::vector<checked_part>& parts) {
  std::cout
      << "| part | verdict | as a whole | worst direction | other directions that differ |\n|---|---|---|---|---|\n";
  for (const checked_part& each : parts)
    std::cout << "| " << each.part.name << " | " << verdict_of(each) << " | " << probability(each.found.p_value)
              << " | " << described(each.found.directions[each.found.worst()], each) << " | "
              << others_that_differ(question, each.found).size() << " |\n";
  for (const checked_part& each : parts)
    for (const std::string& limit : limits_of(each)) std::cout << each.part.name << ": " << limit << '\n';
}

json as_json(const check_question& question, const checked_part& checked) {
  const gonio::conformity& found = checked.found;
  const gonio::measurement_noise& noise = checked.options.part;
  json all{{"file", checked.part.name},
           {"verdict", verdict_of(checked)},
           {"conforms", checked.conforms},
           {"p_value", found.p_value},
           {"false_alarms", question.false_alarms},
           {"tolerance", checked.options.tolerance},
           {"delta_e_tolerance", checked.options.delta_e},
           {"noise", noise.relative},
           {"reference_noise", checked.options.reference.relative},
           {"channels", channel_names(checked)},
           {"shift", listed(found.shift.unaryExpr([](double mapped) { return std::expm1(mapped); }))},
           {"shift_p_value", found.shift_p_value},
           {"total_p_value", found.total_p_value},
           {"worst_p_value", found.worst_p_value},
           {"worst_sample", checked.part.numbers[found.directions[found.worst()].number]},
           {"predicted", found.predicted()}};
  all["noise_degrees_of_freedom"] =
      std::isinf(noise.degrees_of_freedom) ? json(nullptr) : json(noise.degrees_of_freedom);
  all["familiarity"] = {{"p_value", checked.familiarity.p_value},
                        {"scale", checked.familiarity.scale},
                        {"components", checked.familiarity.components},
                        {"discrepancy", checked.familiarity.discrepancy},
                        {"errors", checked.familiarity.errors}};
  all["part"] = checked.part.facts;
  all["reference"] = checked.reference.facts;
  all["directions"] = directions_as_json(checked);
  return all;
}

}  // namespace cli
