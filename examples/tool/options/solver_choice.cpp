#include "solver_choice.hpp"

#include <gonio/io/text/text.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

namespace cli {

namespace {

/// Lasso whose penalty is a share of the smallest one at which all weights of the channel are 0.
struct relative_lasso {
  double share = 0.0;

  [[nodiscard]] gonio::solution solve(const gonio::least_squares_problem& problem) const {
    return gonio::lasso(share * gonio::largest_lambda(problem.normal(), gonio::sign_rule::any)).solve(problem);
  }
};

gonio::any_solver make_tikhonov(const std::string& eta) {
  if (eta == "gcv") return gonio::automatic_tikhonov(gonio::eta_criterion::generalised_cross_validation);
  if (eta == "loo") return gonio::automatic_tikhonov(gonio::eta_criterion::leave_one_out);
  return gonio::tikhonov(number_of_eta(eta));
}

}  // namespace

double number_of_eta(const std::string& text) {
  double value = 0.0;
  if (gonio::io::read_number(text, value))
    gonio::refuse("--eta needs a positive number, gcv or loo, not '" + text + "'");
  return value;
}

void add_solver_options(command& to, solver_choice& choice) {
  to.add_option("--solver", choice.name,
                "nnls: weights >= 0; qp: nnls as a quadratic program; tikhonov: penalty on squared weights; lasso: "
                "penalty on their magnitudes; tsvd: truncated singular values; ls: least squares (default: tikhonov "
                "for pca, nnls for linear)")
      .check(check::one_of({"nnls", "qp", "tikhonov", "lasso", "tsvd", "ls"}));
  to.add_option(
      "--eta", choice.eta,
      "Penalty of tikhonov: a number (larger for results nearer to the mean material), gcv (generalised "
      "cross-validation) or loo (leave one out). Default: gcv; with --method pca, the value that --noise implies or, "
      "without --noise, gcv among the values that noise of up to 30 % implies; with --method soft-specular, 40");
  to.add_option("--lambda", choice.lambda,
                "Penalty of lasso, as a share of the smallest one at which all weights are 0")
      .capture_default_str();
  to.add_option("--variance", choice.variance, "Share of the variance to keep, for tsvd").capture_default_str();
}

gonio::any_solver make_solver(solver_choice choice, const solver_choice& own) {
  if (choice.name.empty()) choice.name = own.name;
  if (choice.eta.empty()) choice.eta = own.eta;
  if (choice.name == "nnls") return gonio::nnls();
  if (choice.name == "qp") return gonio::quadratic_program();
  if (choice.name == "tikhonov") return make_tikhonov(choice.eta);
  if (choice.name == "tsvd") return gonio::truncated_svd(choice.variance);
  if (choice.name == "ls") return gonio::least_squares();
  if (!(choice.lambda >= 0.0 && choice.lambda <= 1.0))
    gonio::refuse("--lambda needs a share from 0 to 1, not " + std::to_string(choice.lambda));
  return relative_lasso{choice.lambda};
}

}  // namespace cli
