#include "method_record.hpp"

#include "fixed.hpp"

#include <array>
#include <string_view>

namespace cli {

namespace {

/// A method's errors (Delta E env) from clean samples of 20 measured materials: docs/results/real-methods.md.
struct record {
  std::string_view method;
  Eigen::Index samples;
  double over_pca;  ///< median of the ratio of errors to those of pca
  int beyond_twice_pca, beyond_median_material;
};

constexpr std::array records{record{"pca", 1, 1.0, 0, 3},
                             record{"pca", 3, 1.0, 0, 1},
                             record{"pca", 10, 1.0, 0, 0},
                             record{"linear", 1, 1.12, 0, 11},
                             record{"linear", 5, 0.98, 2, 2},
                             record{"linear", 20, 2.71, 15, 3},
                             record{"linear", 100, 9.68, 19, 5},
                             record{"linear", 500, 20.81, 20, 5},
                             record{"linear", 2000, 33.68, 20, 5},
                             record{"correction", 1, 1.33, 5, 12},
                             record{"correction", 5, 1.34, 3, 5},
                             record{"correction", 20, 1.93, 10, 2},
                             record{"correction", 100, 3.01, 17, 0},
                             record{"correction", 500, 4.66, 19, 0},
                             record{"correction", 2000, 7.6, 20, 0},
                             record{"rbf", 1, 1.55, 6, 13},
                             record{"rbf", 5, 3.49, 15, 11},
                             record{"rbf", 20, 6.72, 19, 5},
                             record{"rbf", 100, 8.2, 20, 2},
                             record{"rbf", 500, 17.63, 20, 3},
                             record{"rbf", 2000, 8.59, 20, 1},
                             record{"pull-push", 1, 1.55, 6, 13},
                             record{"pull-push", 5, 3.88, 17, 13},
                             record{"pull-push", 20, 15.65, 20, 12},
                             record{"pull-push", 100, 27.11, 20, 10},
                             record{"pull-push", 500, 49.68, 20, 10},
                             record{"pull-push", 2000, 34.81, 20, 7},
                             record{"scattered", 1, 1.55, 6, 13},
                             record{"scattered", 5, 0.94, 0, 1},
                             record{"scattered", 20, 2.1, 12, 0},
                             record{"scattered", 100, 2.51, 19, 0},
                             record{"scattered", 500, 2.93, 18, 0},
                             record{"scattered", 2000, 2.06, 12, 0}};

}  // namespace

std::string warning_of(const std::string& method, Eigen::Index samples) {
  const record* nearest = nullptr;  // a method's records are ordered by their number of samples
  for (const record& each : records)
    if (each.method == method && each.samples <= samples) nearest = &each;
  if (nearest == nullptr || (nearest->beyond_twice_pca == 0 && nearest->beyond_median_material == 0)) return "";
  std::string text = "--method " + method + " with " + counted(samples, "sample");
  if (nearest->beyond_twice_pca > 0)
    text += " usually has " + fixed(nearest->over_pca, 1) + " times the error of --method pca, more than twice for " +
            std::to_string(nearest->beyond_twice_pca) + " of 20 measured materials";
  else
    text += " has a larger error than the median material for " + std::to_string(nearest->beyond_median_material) +
            " of 20 measured materials";
  return text + " (docs/results/real-methods.md)";
}

}  // namespace cli
