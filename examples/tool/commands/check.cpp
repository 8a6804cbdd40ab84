/// gonio check: does a part reflect like a reference?

#include "commands.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/negative_answer.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/report_page.hpp"
#include "tool/pages/sample_facts.hpp"
#include <gonio/conformity/conformity.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

namespace cli {

namespace {

struct check_options {
  std::filesystem::path part, reference, prior;
  page_option report;
  measurement_options reading;
  std::optional<double> noise, reference_noise;
  double dark_noise = 0.0, tolerance = 0.0, false_alarms = 0.01, same_within = 0.01;
  bool print_json = false;
  gonio::thread_count threads;
};

/// The samples of a file that count: where each is in the file, and where it is on the prior's cells; and what the file
/// says of them.
struct measured_surface {
  std::vector<gonio::sample_directions> counting;
  std::vector<Eigen::Index> numbers;  ///< from 1
  gonio::located_samples located;
  json facts;

  measured_surface(gonio::io::sample_file file, const check_options& given, const gonio::log_relative_pca& prior)
      : located(gonio::locate_samples(prior.cells(), file.samples, given.threads)), facts(facts_of(file)) {
    for (const Eigen::Index i : gonio::counting_positions(file.samples)) {
      counting.push_back(file.samples.directions(i));
      numbers.push_back(i + 1);
    }
  }
};

/// Part and reference in the channels that both have, else by their colours.
std::pair<measured_surface, measured_surface> read_both(const check_options& given,
                                                        const gonio::log_relative_pca& prior) {
  gonio::io::sample_file part = read_measurement_file(given.part, given.reading),
                         reference = read_measurement_file(given.reference, given.reading);
  const gonio::channels &of_part = part.samples.channels(), &of_reference = reference.samples.channels();
  if (!(of_part == of_reference) && !(of_part.size() == 1 && of_reference.size() == 1)) {
    if (of_part.are_wavelengths() && of_reference.are_wavelengths())
      gonio::refuse({given.part.native(), ": its wavelengths are not those of ", given.reference.native(),
                     ", which check compares one by one"});
    part.samples = as_colours(given.part, part.samples).colours();
    reference.samples = as_colours(given.reference, reference.samples).colours();
  }
  return {{std::move(part), given, prior}, {std::move(reference), given, prior}};
}

/// What the channels of an answer are called. Channels that all have the same values are one.
std::vector<std::string> channel_names(const gonio::conformity& found, const measured_surface& part) {
  if (found.shift.size() == 1) return {part.located.kinds.size() == 1 ? part.located.kinds.name(0) : "value"};
  std::vector<std::string> names;
  for (Eigen::Index c = 0; c < found.shift.size(); ++c) names.push_back(part.located.kinds.name(c));
  return names;
}

/// What was asked, what came out of it, and all that is told of it.
struct check_result {
  gonio::conformity_options options;
  gonio::conformity conformity;
  gonio::familiarity familiarity;
  bool conforms = true;
};

/// The noise as it is stated, or as repeated measurements tell.
gonio::conformity_options options_of(const check_options& given, const gonio::log_relative& metric,
                                     const measured_surface& part, const measured_surface& reference) {
  gonio::conformity_options options{
      .part = {}, .reference = {}, .tolerance = given.tolerance, .same_direction = gonio::radians(given.same_within)};
  if (given.noise) {
    options.part.relative = *given.noise;
    options.reference.relative = given.reference_noise.value_or(*given.noise);
  } else {
    if (given.reference_noise) gonio::refuse("--reference-noise needs --noise");
    options.part = options.reference = gonio::pooled_noise(gonio::noise_of_repeats(metric, part.located, options),
                                                           gonio::noise_of_repeats(metric, reference.located, options));
    if (options.part.degrees_of_freedom == 0.0)
      gonio::refuse(
          "check needs --noise, the relative deviation of the measurements (0.02 is 2 %), or directions that " +
          std::string("are measured more than once, from which it is estimated"));
  }
  options.part.dark = options.reference.dark = given.dark_noise;
  return options;
}

check_result check_part(const check_options& given, const measured_surface& part, const measured_surface& reference,
                        const gonio::log_relative_pca& prior) {
  check_result result{options_of(given, prior.metric(), part, reference), {}, {}};
  const gonio::reconstruction estimator{prior, {.noise = result.options.part.relative}, given.threads};
  result.conformity = gonio::check_conformity(estimator, part.located, reference.located, result.options);
  result.familiarity = estimator.process_of(part.located).familiarity();
  result.conforms = result.conformity.conforms(given.false_alarms);
  return result;
}

/// A probability, in as many digits as matter.
std::string probability(double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.2g", value);
  return digits.data();
}

/// Of a difference of mapped values, relative: "+4.1 %".
std::string percent(double mapped) { return (mapped >= 0.0 ? "+" : "") + fixed(100.0 * std::expm1(mapped), 1) + " %"; }

/// "sample 6 (theta_i 30.0, theta_o 41.2 degrees): measured 0.210, the reference says 0.140 +- 0.020 (red, p =
/// 0.0003)", of the channel that differs most.
std::string told(const gonio::compared_direction& each, const measured_surface& part,
                 const std::vector<std::string>& names) {
  Eigen::Index channel = 0;
  (void)(each.difference / each.deviation).abs().maxCoeff(&channel);
  const auto [wi, wo] = part.counting[each.number].pair();
  const double off = each.expected[channel] * std::expm1(each.deviation[channel]);
  return "sample " + std::to_string(part.numbers[each.number]) + " (theta_i " +
         fixed(gonio::degrees(std::acos(std::min(wi.z(), 1.0))), 1) + ", theta_o " +
         fixed(gonio::degrees(std::acos(std::min(wo.z(), 1.0))), 1) + " degrees): measured " +
         reflectance(each.value[channel]) + ", the reference " + (each.measured > 0 ? "says " : "predicts ") +
         reflectance(each.expected[channel]) + " +- " + reflectance(off) + " (" + names[channel] +
         ", p = " + probability(each.adjusted_p_value) + ")";
}

/// What limits the answer.
void print_limits(const check_result& result, const measured_surface& part, const measured_surface& reference) {
  const Eigen::Index predicted = result.conformity.predicted(), all = std::ssize(result.conformity.directions);
  if (predicted > 0)
    std::cout << predicted << " of " << all << " directions are not in the reference, which predicts them"
              << (predicted == all ? ": only a shift of all directions, and gross differences, can be seen\n"
                                   : ": there only gross differences can be seen\n");
  const auto negative = (part.located.values.array() < 0.0).count() + (reference.located.values.array() < 0.0).count();
  if (negative > 0 && result.options.part.dark == 0.0)
    std::cout << negative << " values are negative and count as zero: if that is noise, state --dark-noise\n";
  if (!std::isinf(result.options.part.degrees_of_freedom))
    std::cout << "noise of " << fixed(100.0 * result.options.part.relative, 2) << " %, estimated from repeats with "
              << fixed(result.options.part.degrees_of_freedom, 0) << " degrees of freedom\n";
}

/// "red +0.1 %, green +0.3 %, blue -0.2 %"; of many wavelengths the one that is shifted most.
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

void print(const check_options& given, const check_result& result, const measured_surface& part,
           const measured_surface& reference) {
  const gonio::conformity& found = result.conformity;
  std::cout << (result.conforms ? "no difference found" : "differs") << " (p = " << probability(found.p_value)
            << "; false alarms " << probability(100.0 * given.false_alarms) << " %";
  if (given.tolerance > 0.0) std::cout << ", tolerance " << probability(100.0 * given.tolerance) << " %";
  const std::vector<std::string> names = channel_names(found, part);
  std::cout << ")\nin all directions: " << shifts(found, names) << " (p = " << probability(found.shift_p_value)
            << ")\n";
  std::cout << (result.conforms ? "most " : "differs most ") << "at "
            << told(found.directions[found.worst()], part, names) << '\n';
  for (Eigen::Index i = 0; i < std::ssize(found.directions); ++i)
    if (i != found.worst() && found.directions[i].adjusted_p_value < given.false_alarms)
      std::cout << "differs at " << told(found.directions[i], part, names) << '\n';
  print_limits(result, part, reference);
  const gonio::familiarity& known = result.familiarity;
  std::cout << "known materials explain the part " << (known.p_value < 0.01 ? "badly" : "well")
            << " (p = " << probability(known.p_value) << "; " << fixed(known.scale, 2)
            << " times what is expected: components " << fixed(100.0 * known.components, 0) << " %, discrepancy "
            << fixed(100.0 * known.discrepancy, 0) << " %, errors " << fixed(100.0 * known.errors, 0) << " %)\n";
}

/// A number for each channel.
json listed(const Eigen::ArrayXd& channels) {
  json all = json::array();
  for (const double value : channels) all.push_back(value);
  return all;
}

json directions_as_json(const gonio::conformity& found, const measured_surface& part) {
  json all = json::array();
  for (const gonio::compared_direction& each : found.directions) {
    json told{{"sample", part.numbers[each.number]}};
    told.update(angles_as_json(part.counting[each.number]));
    told.update({{"reference_samples", each.measured},
                 {"measured", listed(each.value)},
                 {"reference", listed(each.expected)},
                 {"mapped_difference", listed(each.difference)},
                 {"mapped_deviation", listed(each.deviation)},
                 {"p_value", each.p_value},
                 {"adjusted_p_value", each.adjusted_p_value}});
    all.push_back(std::move(told));
  }
  return all;
}

json as_json(const check_options& given, const check_result& result, const measured_surface& part,
             const measured_surface& reference) {
  const gonio::conformity& found = result.conformity;
  const gonio::measurement_noise& noise = result.options.part;
  json all{{"conforms", result.conforms},
           {"p_value", found.p_value},
           {"false_alarms", given.false_alarms},
           {"tolerance", given.tolerance},
           {"noise", noise.relative},
           {"reference_noise", result.options.reference.relative},
           {"channels", channel_names(found, part)},
           {"shift", listed(found.shift.unaryExpr([](double mapped) { return std::expm1(mapped); }))},
           {"shift_p_value", found.shift_p_value},
           {"total_p_value", found.total_p_value},
           {"worst_p_value", found.worst_p_value},
           {"worst_sample", part.numbers[found.directions[found.worst()].number]},
           {"predicted", found.predicted()}};
  all["noise_degrees_of_freedom"] =
      std::isinf(noise.degrees_of_freedom) ? json(nullptr) : json(noise.degrees_of_freedom);
  all["familiarity"] = {{"p_value", result.familiarity.p_value},
                        {"scale", result.familiarity.scale},
                        {"components", result.familiarity.components},
                        {"discrepancy", result.familiarity.discrepancy},
                        {"errors", result.familiarity.errors}};
  all["part"] = part.facts;
  all["reference"] = reference.facts;
  all["directions"] = directions_as_json(found, part);
  return all;
}

/// The page for people: the same, and what was done.
void write_report(const check_options& given, const json& check) {
  const auto described = [](const std::filesystem::path& path, const json& facts) {
    std::string text = path.string();
    for (const char* fact : {"quantity", "instrument", "date", "conditions"})
      if (facts.contains(fact)) text.append("; ").append(fact).append(": ").append(facts[fact].text());
    return text;
  };
  const json record =
      record_of({{"Part", described(given.part, check["part"])},
                 {"Reference", described(given.reference, check["reference"])},
                 {"Prior", given.prior.string()},
                 {"Noise", fixed(100.0 * check["noise"].number(), 2) + " %" +
                               (given.noise ? " (stated)" : " (of directions that were measured repeatedly)")}});
  write_report_page(given.report, {{"kind", "check"},
                                   {"name", given.part.stem().string() + " beside " + given.reference.stem().string()},
                                   {"check", check},
                                   {"record", record}});
}

/// Says whether the part conforms.
bool check_files(const check_options& given) {
  const gonio::log_relative_pca prior = read_prior(given.prior);
  const auto [part, reference] = read_both(given, prior);
  const check_result result = check_part(given, part, reference, prior);
  const json told = as_json(given, result, part, reference);
  if (given.report.is_given()) write_report(given, told);
  if (given.print_json)
    std::cout << told.dump(2) << '\n';
  else
    print(given, result, part, reference);
  return result.conforms;
}

/// The same; what fails is bad input, so that exit code 1 means that the part differs.
bool check_or_refuse(const check_options& given) {
  try {
    return check_files(given);
  } catch (const gonio::error&) {
    throw;
  } catch (const std::exception& failure) {
    gonio::refuse(std::string("the part could not be checked: ") + failure.what());
  }
}

void add_noise_options(command& to, check_options& options) {
  to.add_option("--noise", options.noise,
                "Relative deviation of the measured values (0.02 is 2 %), independent in each channel of each sample; "
                "without it directions that are measured more than once tell it")
      .check(check::range(1e-6, 0.3));
  to.add_option("--reference-noise", options.reference_noise, "The same of the reference, if it is another")
      .check(check::range(0.0, 0.3));
  to.add_option("--dark-noise", options.dark_noise, "Deviation of values near zero, sr^-1")
      .check(check::range(0.0, 1e6))
      .capture_default_str();
}

}  // namespace

void add_check(command& app, const std::vector<std::string>& words) {
  auto command = app.add_subcommand(
      "check", "Tell whether a part reflects like a reference: exit code 0 if no difference is found, 1 if it differs");
  const auto options = std::make_shared<check_options>();
  command.add_input("part", options->part, "Measurements of the part (.csv, or .brdf in Cornell's text format)")
      .required();
  command
      .add_input("--reference", options->reference,
                 "Measurements of the reference, in the same directions or in others; what is measured in both is "
                 "compared with the certainty of the noise")
      .required();
  add_measurement_options(command, options->reading);
  add_noise_options(command, *options);
  command
      .add_option("--tolerance", options->tolerance,
                  "A part differs if values are off by more than this, relative to them (0.05 is 5 %)")
      .check(check::range(0.0, 10.0))
      .capture_default_str();
  command
      .add_option("--false-alarms", options->false_alarms, "Share of parts like the reference that are said to differ")
      .check(check::range(1e-9, 0.5))
      .capture_default_str();
  command
      .add_option("--same-within", options->same_within,
                  "Half and difference angles that differ by no more degrees are the same direction")
      .check(check::range(0.0, 5.0))
      .capture_default_str();
  add_prior_option(command, options->prior);
  add_report_option(command, options->report, words);
  command.add_flag("--json", options->print_json, "Print the answer and all directions as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] {
    if (!check_or_refuse(*options)) throw negative_answer{};
  });
}

}  // namespace cli
