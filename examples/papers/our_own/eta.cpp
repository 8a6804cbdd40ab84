/// gonio-papers eta: compares the chosen penalty with the best in hindsight.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/basis/project.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Eigenvalues>

#include <iostream>
#include <memory>

namespace papers {

namespace {

struct eta_options {
  studied_networks networks;
  std::vector<std::string> sets{"expected-error", "published"};
  std::vector<Eigen::Index> counts{5, 10, 20};
  std::vector<double> noises{0.0, 0.02, 0.1, 0.3};
  int repetitions = 5;
  std::uint64_t seed = 0;
  bool print_json = false;
  gonio::thread_count threads;
};

/// Ten materials x in a prior's domain. A reconstruction Q w has the squared error |x|^2 - 2 w'Q'x + w'Sigma^2 w.
struct mapped_truths {
  std::vector<gonio::brdf_table> tables;
  Eigen::MatrixXd products;  ///< Q'x, k x 3 for each table
  Eigen::VectorXd energies;  ///< |x|^2
};

mapped_truths map_truths(const gonio::log_relative_pca& prior, const gonio::material_set& materials,
                         gonio::thread_count threads) {
  mapped_truths truths;
  const Eigen::Index count = 3 * materials.names.size();
  truths.products.resize(prior.size(), count);
  truths.energies.setZero(count);
  for (std::size_t m = 0; m < materials.names.size(); ++m) {
    const gonio::brdf_table& table = truths.tables.emplace_back(materials.table(m));
    const Eigen::Index first = 3 * m;
    truths.products.middleCols(first, 3) =
        prior.singular_values().array().square().matrix().asDiagonal() * gonio::project(prior, table, threads);
    for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
      for (Eigen::Index c = 0; c < 3; ++c)
        truths.energies[first + c] += std::pow(prior.metric().forward(table.at(cell)[c], cell) - prior.offset(cell), 2);
  }
  return truths;
}

/// Errors of reconstructions from measurements y at some rows A of the prior. With the eigenvectors U and eigenvalues l
/// of A A', the weights are A'U g with g = U'y / (l + eta).
class reconstruction_error {
 public:
  reconstruction_error(const gonio::log_relative_pca& prior, const mapped_truths& truths, const Eigen::MatrixXd& rows)
      : truths_(truths), cells_(static_cast<double>(prior.cells().size())) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rows * rows.transpose());
    values_ = eigen.eigenvalues().cwiseMax(0.0);
    vectors_ = eigen.eigenvectors();
    const Eigen::MatrixXd turned = vectors_.transpose() * rows;
    norm_ = turned * prior.singular_values().array().square().matrix().asDiagonal() * turned.transpose();
    products_ = turned * truths.products;
  }

  /// Returns the root mean square error over all cells in the mapped domain, averaged over the channels, for a
  /// reconstruction from the mapped values `measured`.
  [[nodiscard]] double operator()(std::size_t material, const Eigen::MatrixXd& measured, double eta) const {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::Index column = (3 * material) + c;
      const Eigen::VectorXd g =
          (vectors_.transpose() * measured.col(c)).cwiseQuotient((values_.array() + eta).matrix());
      const double squared = truths_.energies[column] - 2.0 * g.dot(products_.col(column)) + g.dot(norm_ * g);
      sum += std::sqrt(std::max(squared, 0.0) / cells_);
    }
    return sum / 3.0;
  }

 private:
  const mapped_truths& truths_;
  double cells_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_, norm_, products_;
};

/// The mean result of one rule that chooses eta.
struct eta_outcome {
  double rms = 0.0, log_eta = 0.0;

  void add(double error, double eta, std::size_t all) {
    rms += error / static_cast<double>(all);
    log_eta += std::log(eta) / static_cast<double>(all);
  }
};

json outcome_row(const eta_outcome& choice, double best) {
  return {{"eta", std::exp(choice.log_eta)}, {"rms", choice.rms}, {"ratio", choice.rms / best}};
}

/// Tries all rules that choose eta, for measurements at some cells with some noise.
json judge_choices(const gonio::log_relative_pca& prior, const mapped_truths& truths,
                   std::span<const Eigen::Index> cells, double noise, const eta_options& options) {
  const auto equations_of = [&](const gonio::sample_set& samples) {
    return gonio::basis_equations(prior, gonio::locate_samples(prior.cells(), samples)).problem();
  };
  const auto gcv = gonio::eta_criterion::generalised_cross_validation;
  // Compute the penalties that depend only on the locations.
  const gonio::sample_set at_cells = gonio::sample_table(truths.tables[0], cells);
  const double stated = gonio::eta_of_noise(prior, at_cells, noise, options.threads);
  const gonio::eta_range plausible = gonio::plausible_etas(prior, at_cells, 0.3, options.threads);
  const reconstruction_error error(prior, truths, equations_of(at_cells).rows());

  // Reconstruct each material with every penalty and with the choice of each rule.
  const Eigen::VectorXd etas = gonio::geometric_sequence(1e-3, 1e5, 97);
  Eigen::VectorXd shared = Eigen::VectorXd::Zero(etas.size());
  eta_outcome each, forty, of_noise, unknown, free;
  const std::size_t repetitions = noise > 0.0 ? options.repetitions : 1;
  const std::size_t all = repetitions * truths.tables.size();
  for (std::size_t repetition = 0; repetition < repetitions; ++repetition)
    for (std::size_t m = 0; m < truths.tables.size(); ++m) {
      const auto samples =
          gonio::sample_table(truths.tables[m], cells, {.noise = noise}, options.seed + 1000 * repetition + m);
      const auto problem = equations_of(samples);
      const auto rms = [&](double eta) { return error(m, problem.right_hand_side(), eta); };
      const Eigen::VectorXd errors = etas.unaryExpr(rms);
      shared += errors / static_cast<double>(all);
      Eigen::Index best = 0;
      each.add(errors.minCoeff(&best), etas[best], all);
      const auto add = [&](eta_outcome& to, double eta) { to.add(rms(eta), eta, all); };
      add(forty, 40.0);
      add(of_noise, stated);
      add(unknown, gonio::choose_eta(problem, gcv, plausible));
      add(free, gonio::choose_eta(problem, gcv));
    }
  // Find the best common penalty for all materials.
  Eigen::Index at = 0;
  const double best = shared.minCoeff(&at);
  return {{"best", {{"eta", etas[at]}, {"rms", best}}},
          {"best_of_each", outcome_row(each, best)},
          {"forty", outcome_row(forty, best)},
          {"stated_noise", outcome_row(of_noise, best)},
          {"unknown_noise", outcome_row(unknown, best)},
          {"unbounded_gcv", outcome_row(free, best)},
          {"plausible", {plausible.lowest, plausible.highest}}};
}

/// Returns a number with two significant digits.
std::string brief(const json& eta) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", eta.number());
  return text.data();
}

void print_eta_row(const json& row) {
  const auto eta = [&](const char* way) { return " | " + brief(row[way]["eta"]); };
  const auto rms = [&](const char* way) { return " | " + fixed(row[way]["rms"], 4); };
  const auto ratio = [&](const char* way) { return " | " + fixed(row[way]["ratio"], 3); };
  const auto all = [&](const char* way) { return eta(way) + rms(way) + ratio(way); };
  std::cout << "| " << row["set"].text() << " | " << row["n"] << " | " << 100.0 * row["noise"].number() << " %"
            << eta("best") << rms("best") << ratio("best_of_each") << rms("forty") << ratio("forty")
            << all("stated_noise") << all("unknown_noise") << ratio("unbounded_gcv") << " |\n";
}

void compare_etas(const eta_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  const nielsen_split split = nielsen_split::learn(options.networks, options.threads, listener);
  const gonio::log_relative_pca& prior = split.prior;
  const mapped_truths truths = map_truths(prior, split.truths, options.threads);

  json rows = json::array();
  for (const std::string& set : options.sets)
    for (const Eigen::Index count : options.counts) {
      const auto at = gonio::cells_at(prior.cells(), required_points(shipped_directions(), set, count));
      for (const double noise : options.noises) {
        gonio::report(listener, "choosing for " + std::to_string(count) + " of " + set, 0.0);
        json row{{"set", set}, {"n", count}, {"noise", noise}};
        row.update(judge_choices(prior, truths, at, noise, options));
        rows.push_back(std::move(row));
      }
    }
  bar.wipe();
  if (options.print_json) {
    std::cout << rows.dump(2) << '\n';
    return;
  }
  std::cout
      << split.truths.names.size() << " test materials, " << prior.names().size() << " learned, " << options.repetitions
      << " times the noise.\n\n"
      << "| directions | n | noise | best eta | rms | each its best | eta 40: rms | ratio | noise stated: eta | rms "
         "| ratio | not stated: eta | rms | ratio | GCV by itself: ratio |\n"
      << "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const json& row : rows.elements()) print_eta_row(row);
}

}  // namespace

void add_eta(command& app) {
  auto command = app.add_subcommand(
      "eta", "Compare chosen penalties of Tikhonov with the best one in hindsight, on ten materials");
  const auto options = std::make_shared<eta_options>();
  add_networks_option(command, options->networks);
  command
      .add_option("--sets", options->sets,
                  "Sets of directions: published (1, 2, 5, 10 or 20 directions), or sets that ship as files")
      .check(check::one_of({"published", "expected-error", "perceived"}))
      .capture_default_str();
  add_counts_option(command, options->counts);
  command.add_option("--noise", options->noises, "Relative deviations of the measurements").capture_default_str();
  command.add_option("--repetitions", options->repetitions, "How often each material is measured with noise")
      .check(check::range(1, 10'000))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the noise").capture_default_str();
  command.add_flag("--json", options->print_json, "Print everything as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { compare_etas(*options); });
}

}  // namespace papers
