#pragma once
/// The benchmark of Noell, Koehler and Stricker 2014, section 3.1: its settings and the printed results of Table 1.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace papers {

/// Measured shares of a material's table: the columns of Table 1.
inline constexpr std::array noell_data_ratios{1.0, 0.7, 0.5, 0.3, 0.1};
/// Shares of outliers among the measurements: the rows of Table 1.
inline constexpr std::array noell_outlier_ratios{0.0, 0.2, 0.4, 0.6, 0.8};

/// Returns the gamma that the paper chose for an outlier ratio.
[[nodiscard]] constexpr double noell_gamma(double outlier_ratio) noexcept {
  return outlier_ratio <= 0.0 ? 0.0 : outlier_ratio <= 0.2 ? 3.0 : 6.0;
}

/// Materials on which the robust estimate and its defaults were tuned, besides Nielsen et al.'s ten test materials.
inline constexpr std::array noell_tuned_materials{
    "black-obsidian",        "black-phenolic",          "chrome-steel",
    "color-changing-paint3", "grease-covered-steel",    "nickel",
    "red-phenolic",          "silicon-nitrade",         "silver-metallic-paint2",
    "specular-red-phenolic", "specular-white-phenolic", "ss440",
    "violet-acrylic",        "white-acrylic",           "white-paint"};

namespace detail {

/// Mean CIELAB differences by outlier ratio and data ratio.
using noell_figures = std::array<std::array<double, 5>, 5>;

inline constexpr noell_figures noell_ours{{{0.28, 0.29, 0.29, 0.29, 0.31},
                                           {0.36, 0.37, 0.44, 0.41, 0.49},
                                           {0.73, 0.72, 0.75, 0.78, 0.92},
                                           {2.06, 2.10, 2.05, 2.23, 2.31},
                                           {4.86, 4.89, 4.83, 4.81, 4.83}}};
inline constexpr noell_figures noell_combination{{{4.88, 4.89, 4.91, 4.96, 5.05},
                                                  {6.32, 6.58, 6.76, 7.57, 7.59},
                                                  {7.97, 8.22, 7.93, 8.32, 9.03},
                                                  {9.64, 9.74, 9.46, 9.59, 9.53},
                                                  {11.33, 11.16, 11.05, 11.05, 10.61}}};
inline constexpr noell_figures noell_radial{{{4.11, 4.11, 4.13, 4.15, 4.17},
                                             {6.85, 6.78, 6.96, 7.12, 7.74},
                                             {9.74, 9.98, 9.79, 10.41, 11.04},
                                             {12.49, 12.63, 12.49, 12.56, 13.45},
                                             {15.18, 15.32, 15.28, 15.16, 15.92}}};
inline constexpr noell_figures noell_pull_push{{{0.00, 0.09, 0.20, 0.46, 2.14},
                                                {17.32, 15.59, 17.28, 14.00, 12.30},
                                                {26.12, 26.38, 24.80, 24.35, 22.90},
                                                {33.32, 34.90, 32.71, 32.13, 28.22},
                                                {39.86, 41.70, 40.75, 38.94, 34.09}}};

}  // namespace detail

/// The methods of Table 1.
enum class noell_method { ours, combination, radial, pull_push };

/// Returns the result that Table 1 prints for a method, a data ratio and an outlier ratio, if it has these ratios.
[[nodiscard]] constexpr std::optional<double> noell_table_1(noell_method method, double data_ratio,
                                                            double outlier_ratio) noexcept {
  constexpr std::array tables{&detail::noell_ours, &detail::noell_combination, &detail::noell_radial,
                              &detail::noell_pull_push};
  for (std::size_t row = 0; row < noell_outlier_ratios.size(); ++row)
    for (std::size_t column = 0; column < noell_data_ratios.size(); ++column)
      if (noell_outlier_ratios[row] == outlier_ratio && noell_data_ratios[column] == data_ratio)
        return (*tables[static_cast<std::size_t>(method)])[row][column];
  return std::nullopt;
}

/// Table 2: full data without outliers, under the metrics lin, root and log, for ours, LC and RBF.
inline constexpr std::array<std::array<double, 3>, 3> noell_table_2{
    {{0.44, 0.31, 0.28}, {13.39, 5.05, 4.88}, {24.14, 3.32, 4.11}}};

}  // namespace papers
