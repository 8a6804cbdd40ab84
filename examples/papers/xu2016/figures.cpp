/// gonio-papers figures: the figures of Nielsen et al. 2015 and Xu et al. 2016 that can be simulated.

#include "papers/xu2016/figures.hpp"

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/design/compressed_rows.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace figures {

laboratory open_laboratory(const options& given, const gonio::model::named_networks& learned,
                           const gonio::progress& listener) {
  const auto cells = given.networks.cells();
  const auto others = networks_in(given.networks.read(), gonio::nielsen_test_materials(), given.networks.file);
  return {mapped_errors(learn_all_components(learned, cells, given.threads, listener, given.weighting),
                        gonio::model::tabulate_networks(others, cells, given.threads), given.eta, given.threads)};
}

laboratory open_laboratory(const options& given, const gonio::progress& listener) {
  const auto all = given.networks.read();
  return open_laboratory(given, networks_except(all, gonio::nielsen_test_materials(), given.networks.file), listener);
}

gonio::design::expected_error criterion_of(const laboratory& lab, const options& given) {
  return gonio::design::expected_error(lab.prior(), {.eta = given.eta});
}

double expected_of(const laboratory& lab, const options& given, const std::vector<gonio::half_difference>& directions) {
  return lab.expected(criterion_of(lab, given)(gonio::design::rows_at(lab.prior(), directions).components));
}

namespace {

struct figure {
  const char* name;
  tables (*draw)(const options&, const gonio::progress&);
};

constexpr std::array all_figures{figure{"2015-2", nielsen_2},
                                 figure{"2015-5", nielsen_5},
                                 figure{"2015-6", nielsen_6},
                                 figure{"2015-penalties", nielsen_penalties},
                                 figure{"2015-table-1", nielsen_table_1},
                                 figure{"2015-table-2", nielsen_table_2},
                                 figure{"2015-7", nielsen_7},
                                 figure{"2015-8", nielsen_8},
                                 figure{"2015-9", nielsen_9},
                                 figure{"2015-10", nielsen_10},
                                 figure{"2015-11", nielsen_11},
                                 figure{"2015-12", nielsen_12},
                                 figure{"2016-2", xu_2},
                                 figure{"2016-3", xu_3},
                                 figure{"2016-5", xu_5},
                                 figure{"2016-6", xu_6},
                                 figure{"2016-7", xu_7},
                                 figure{"2016-8", xu_8},
                                 figure{"2016-13", xu_13},
                                 figure{"2016-15", xu_15},
                                 figure{"2016-17", xu_17},
                                 figure{"2016-19", xu_19}};

std::vector<std::string> names_of_figures() {
  std::vector<std::string> names;
  for (const figure& f : all_figures) names.emplace_back(f.name);
  return names;
}

std::string printed_cell(const json& cell, int digits) {
  if (cell.is_null()) return "";
  if (cell.is_string()) return cell.text();
  if (cell.is_number_integer()) return cell.dump();
  const auto value = cell.number();
  return std::isfinite(value) ? fixed(value, digits) : "infinite";
}

void print(const table& shown) {
  std::cout << '\n' << shown.title << "\n\n|";
  for (const table::column& column : shown.columns) std::cout << ' ' << column.title << " |";
  std::cout << "\n|";
  for (std::size_t i = 0; i < shown.columns.size(); ++i) std::cout << "---|";
  std::cout << '\n';
  for (const auto& row : shown.rows) {
    std::cout << '|';
    for (std::size_t i = 0; i < row.size(); ++i)
      std::cout << ' ' << printed_cell(row[i], shown.columns[i].digits) << " |";
    std::cout << '\n';
  }
}

json to_json(const tables& shown) {
  json all = json::array();
  for (const table& one : shown) {
    json rows = json::array();
    for (const auto& cells : one.rows) {
      json row = json::object();
      for (std::size_t i = 0; i < cells.size(); ++i) row[one.columns[i].title] = cells[i];
      rows.push_back(std::move(row));
    }
    all.push_back({{"title", one.title}, {"rows", std::move(rows)}});
  }
  return all;
}

/// Merges two tables of the same figure, one for each cosine weight: columns that differ appear twice. Returns two
/// tables if their rows differ.
tables beside(table product, table larger) {
  bool alike = product.rows.size() == larger.rows.size() && product.columns.size() == larger.columns.size();
  for (std::size_t row = 0; alike && row < product.rows.size(); ++row)
    alike = product.rows[row].front() == larger.rows[row].front();
  if (!alike) {
    product.title += " (product of the cosines)";
    larger.title += " (larger cosine)";
    return {std::move(product), std::move(larger)};
  }
  table both{product.title, {}, std::vector<std::vector<json>>(product.rows.size())};
  for (std::size_t c = 0; c < product.columns.size(); ++c) {
    bool same = true;
    for (std::size_t row = 0; row < both.rows.size(); ++row) {
      both.rows[row].push_back(product.rows[row][c]);
      same = same && product.rows[row][c] == larger.rows[row][c];
    }
    both.columns.push_back(product.columns[c]);
    if (same) continue;
    both.columns.back().title += ", product";
    both.columns.push_back({product.columns[c].title + ", larger", product.columns[c].digits});
    for (std::size_t row = 0; row < both.rows.size(); ++row) both.rows[row].push_back(larger.rows[row][c]);
  }
  return {std::move(both)};
}

/// Draws a figure with each of the cosine weights.
tables drawn(const figure& chosen, options given, const std::vector<std::string>& weights,
             const gonio::progress& listener) {
  std::vector<tables> each;
  for (const std::string& weight : weights) {
    given.weighting = weight == "larger" ? gonio::cosine_weighting::larger : gonio::cosine_weighting::product;
    each.push_back(chosen.draw(given, listener));
  }
  if (each.size() == 1) return std::move(each.front());
  tables all;
  for (std::size_t i = 0; i < each[0].size(); ++i)
    for (table& one : beside(std::move(each[0][i]), std::move(each[1][i]))) all.push_back(std::move(one));
  return all;
}

void run_figure(const options& given, const std::string& name, const std::vector<std::string>& weights,
                bool print_json) {
  if (weights.size() > 2 || (weights.size() == 2 && (weights[0] == weights[1] || weights[0] == "larger")))
    gonio::refuse("--cosine-weight takes product, larger, or product larger");
  progress_bar bar;
  const auto chosen = std::ranges::find(all_figures, name, [](const figure& f) { return std::string(f.name); });
  const tables shown = drawn(*chosen, given, weights, bar.listener());
  bar.wipe();
  if (print_json) {
    std::cout << json{{"figure", name}, {"tables", to_json(shown)}}.dump(2) << '\n';
    return;
  }
  std::cout << "Figure " << name << ", eta = " << given.eta << ", seed " << given.seed;
  if (weights.front() == "larger") std::cout << ", mapped with the larger cosine";
  std::cout << '\n';
  for (const table& one : shown) print(one);
}

}  // namespace

}  // namespace figures

void add_figures(command& app) {
  struct choice {
    figures::options given;
    std::string name;
    std::vector<std::string> cosine_weights{"product"};
    bool print_json = false;
  };
  auto command = app.add_subcommand("figures", "A figure of Nielsen et al. 2015 or Xu et al. 2016 as a table");
  const auto chosen = std::make_shared<choice>();
  figures::options& given = chosen->given;
  add_networks_option(command, given.networks);
  command.add_option("--figure", chosen->name, "Year and number of the figure")
      .required()
      .check(check::one_of(figures::names_of_figures()));
  command.add_option("--most", given.most, "The largest number of measurements (default: the figure's)")
      .check(check::positive_number());
  command.add_option("--repetitions", given.repetitions, "Number of seeds of each random search")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--random-sets", given.random_sets, "Number of random sets whose mean is shown")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--fov", given.fields_of_view, "Near field: angles in degrees that the sample spans from above")
      .capture_default_str();
  command.add_option("--step", given.step, "Near field, and the pairs of 2015-6: degrees between candidates")
      .check(check::positive_number())
      .capture_default_str();
  command
      .add_option("--components", given.components,
                  "2015-5, 2015-6, 2015-penalties, 2015-table-1 and -2: numbers of components k to sweep, in addition "
                  "to all components (default: the figure's)")
      .check(check::positive_number());
  command
      .add_option("--cosine-weight", chosen->cosine_weights,
                  "Weight in the mapping: product (of both cosines, Nielsen 2015), larger (of the cosines, Xu 2016), "
                  "or product larger for both side by side")
      .check(check::one_of({"product", "larger"}))
      .capture_default_str();
  command.add_input_folder("--tables", given.measured_tables, {".binary", ".gz"},
                           "2015-10: folder of measured tables to scan. 2016-17: folder of measured tables that are "
                           "combined into further samples");
  command.add_input("--samples", given.measured_samples,
                    "2015-10, 2015-12: measured samples that are reconstructed in addition (.csv, .brdf)");
  command.add_output("--spheres", given.spheres, {".png"},
                     "2015-2, 2015-12, 2016-2, 2016-15: image to write (.png), one row for each material, with the "
                     "truth at the right");
  command.add_option("--eta", given.eta, "Tikhonov's penalty").check(check::positive_number()).capture_default_str();
  command.add_option("--seed", given.seed, "Seed of all random numbers").capture_default_str();
  command.add_flag("--json", chosen->print_json, "Print as JSON");
  add_threads_option(command, given.threads);
  command.callback(
      [chosen] { figures::run_figure(chosen->given, chosen->name, chosen->cosine_weights, chosen->print_json); });
}

}  // namespace papers
