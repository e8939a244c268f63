#pragma once

// What several kinds share: lists of features, perturbations, checks of columns, and errors of the
// simulation.

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

#include "diagnosis/experiment/observation.h"
#include "diagnosis/kinds/features.h"

namespace pendular::diagnosis {

/// Collects features of one observation; those that are not finite, or no ratio, are left out.
class FeatureList {
 public:
  FeatureList(const Observation& observation, Scale scale) : observation_(observation.name), scale_(scale) {}
  void ratio(const std::string& name, double value, double from = 0.0, double to = 0.0);
  void difference(const std::string& name, double value, double from = 0.0, double to = 0.0);
  std::vector<Feature> take() { return std::move(all_); }

 private:
  std::string observation_;
  Scale scale_;
  std::vector<Feature> all_;
};

double mean_of(const std::vector<double>& values);
std::vector<double> logarithms_of(const std::vector<double>& values);
double largest_of(const std::vector<double>& values);  ///< of the absolute values
double last_strain(const Observation& observation);

/// Numbers with this mean and standard deviation, as many as asked for: what a sample of them comes to.
std::vector<double> spread_about(double mean, double sd, std::size_t count);

/// Values of y at strains, for the first time that x reaches them: by the line through the rows within `half`
/// of it, at least four; NaN beyond the last one.
std::vector<double> read_at(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& strains, double half);

/// Strains of `all` up to `last`, with a thousandth of room.
std::vector<double> strains_up_to(const std::vector<double>& all, double last);

/// Normal noise of a standard deviation per row; `correlation` from row to row of half of its variance.
void add_noise(std::vector<double>& values, const std::vector<double>& sigma, unsigned long seed,
               double correlation = 0.0);
/// Positive values by their own sigma column, where both are there: by factors, so that they stay positive.
void add_stated_noise(Columns& columns, const std::string& value, const std::string& sigma,
                      unsigned long seed);
/// Values of some rows drawn again among them, with replacement; alike for every column of a seed.
void draw_again(std::vector<double>& column, const std::vector<std::size_t>& rows, unsigned long seed);
/// All rows drawn again.
void draw_rows_again(Columns& columns, unsigned long seed);
/// Stated errors, all off by one factor.
void misstate(std::vector<double>& sigma, unsigned long seed);

void check_strain(const Observation& observation, const std::string& column);
/// That rows are in order of rising strain.
void check_rising(const Observation& observation, const std::string& column);
/// That no standard deviation, where the column is there, is beyond what the measured values can be off by.
void check_sigma(const Observation& observation, const std::string& column, double most);
/// That the median of a length is of the order of the beads, µm.
void check_length(const Observation& observation, const std::string& column, double least, double most);
/// That a stiffness is between a tenth and a thousand times the polymer's; the message says which unit would
/// fit.
void check_modulus(const Observation& observation, const std::string& column, double modulus, double polymer);

/// Independent errors by the features' names; later unloadings (…_2, …_3) are as the first one.
Eigen::MatrixXd errors_by_name(const std::vector<Feature>& features,
                               const std::map<std::string, double>& errors);

/// Errors of one size that are correlated over `reach` features.
Eigen::MatrixXd errors_along(const Eigen::VectorXd& size, double reach);

}  // namespace pendular::diagnosis
