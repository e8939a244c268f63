#include "segmentation/bridges/polymer_fit.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"
#include "segmentation/bridges/bridge_search.h"
#include "segmentation/bridges/crevice.h"
#include "segmentation/fit/ball_profile.h"
#include "segmentation/fit/level_field.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

/// A neck that shows in the volume.
struct NeckShown {
  CreviceAxes axes;
  const NeckTemplate* shape;
  double share = 0.0, sigma_share = 0.0;  ///< radius, over the pair's
  double grey = 0.0;

  double at(const Vec3& p) const { return of_share(share, p); }
  /// By one standard error of the radius.
  double error_at(const Vec3& p) const {
    return 0.5 * (of_share(share + sigma_share, p) - of_share(share - sigma_share, p));
  }

 private:
  double of_share(double radius, const Vec3& p) const {
    const auto place = axes.place(p);
    return grey * shape->at(radius, axes.height(place).from_middle, std::sqrt(std::max(0.0, place.across2)));
  }
};

/// The blurred image of a ball in the volume, without its background.
struct BallShown {
  const BallFit* fit;
  double blur = 0.0;

  double at(const Vec3& p) const { return fit->ball.contrast * profile(p).value; }
  /// By one standard error of where its surface is.
  double error_at(const Vec3& p) const {
    return std::hypot(fit->sigma_centre, fit->sigma_radius) * fit->ball.contrast * profile(p).by_radius;
  }

 private:
  BallProfile profile(const Vec3& p) const {
    const double reach = fit->ball.radius + 4.0 * blur, square = (p - fit->ball.centre).squaredNorm();
    return square > reach * reach ? BallProfile() : ball_profile(std::sqrt(square), fit->ball.radius, blur);
  }
};

/// What is about each ball.
struct Surroundings {
  explicit Surroundings(std::size_t count) : neighbours(count), balls(count), necks(count) {}

  Neighbours neighbours;
  std::vector<std::vector<BallShown>> balls;
  std::vector<std::vector<NeckShown>> necks;

  KnownGrey of(std::size_t own) const {
    KnownGrey known;
    known.grey = [&near = balls[own], &joined = necks[own]](const Vec3& p) {
      double grey = 0.0;
      for (const BallShown& ball : near) grey += ball.at(p);
      for (const NeckShown& neck : joined) grey += neck.at(p);
      return grey;
    };
    for (const BallShown& ball : balls[own])
      known.errors.push_back([&ball](const Vec3& p) { return ball.error_at(p); });
    constexpr double misshapen = 0.03;  // necks are not quite cylinders of one contrast
    for (const NeckShown& neck : necks[own]) {
      known.errors.push_back([&neck](const Vec3& p) { return neck.error_at(p); });
      known.errors.push_back([&neck](const Vec3& p) { return misshapen * neck.at(p); });
    }
    return known;
  }
};

std::vector<Bridge> near_pairs(const std::vector<GreyBall>& balls, double most_gap) {
  std::vector<Bridge> pairs;
  for (const auto& [i, j] : near_balls(balls, most_gap)) {
    Bridge pair;
    pair.i = i, pair.j = j;
    pairs.push_back(pair);
  }
  return pairs;
}

double typical_error(const FittedBeads& fitted) {
  std::vector<double> errors, radii;
  for (const BallFit& fit : fitted.fits) errors.push_back(fit.sigma_centre), radii.push_back(fit.ball.radius);
  return median(errors) * std::sqrt(variance_inflation(fitted.noise, median(radii), fitted.blur).centre);
}

/// Polymer as in the pictures of the pairs, as probable as it is.
void show_necks(const std::vector<GreyBall>& balls, const std::vector<Bridge>& pairs,
                const NeckTemplates& templates, double contrast, double spacing, Surroundings& about) {
  constexpr double least = 0.01;
  for (const Bridge& bridge : pairs) {
    if (bridge.diameter == 0.0 || bridge.probability < least) continue;
    const BallPair pair = ball_pair(balls, bridge.i, bridge.j);
    const auto i = static_cast<std::size_t>(bridge.i), j = static_cast<std::size_t>(bridge.j);
    const double grey = bridge.probability * contrast * 0.5 * (balls[i].contrast + balls[j].contrast);
    const double per_share = 2.0 * spacing * pair.radius;
    const NeckShown neck{CreviceAxes(balls[i], balls[j]), &templates.of(pair), bridge.diameter / per_share,
                         bridge.sigma_diameter / per_share, grey};
    about.necks[i].push_back(neck), about.necks[j].push_back(neck);
  }
}

/// `open`: pairs, sorted, between which there may be polymer or not.
void show_balls(const FittedBeads& fitted, const std::vector<IndexPair>& open, double reach,
                Surroundings& about) {
  for (const auto& [i, j] : near_balls(balls_of(fitted.fits), reach)) {
    const bool polymer = std::binary_search(open.begin(), open.end(), IndexPair{i, j});
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    about.neighbours[a].push_back({j, polymer}), about.neighbours[b].push_back({i, polymer});
    about.balls[a].push_back({&fitted.fits[b], fitted.blur}),
        about.balls[b].push_back({&fitted.fits[a], fitted.blur});
  }
}

}  // namespace

void fit_with_polymer(const Volume& volume, const std::optional<Container>& container, double cutoff,
                      FittedBeads& fitted) {
  if (typical_error(fitted) < kThresholds.polymer_error) return;
  auto balls = balls_of(fitted.fits);
  set_level_slopes(balls);
  FitSetting setting = fine_setting(fitted.fits, fitted.blur);
  setting.rings = fitted.rings.get();
  auto pairs = near_pairs(balls, 2.0 * cutoff * median_radius(fitted.fits) + 0.5);
  const BridgeSummary polymer = measure_bridges(volume, fitted, container, {}, pairs);
  const bool none = polymer.contrast + 2.0 * polymer.sigma_contrast < kThresholds.polymer_contrast;
  if (!none && !polymer.polymer_seen) return;

  std::vector<BallPair> shown;
  std::vector<IndexPair> open;
  for (const Bridge& pair : pairs) {
    shown.push_back(ball_pair(balls, pair.i, pair.j));
    if (!none && pair.state == BridgeState::undetermined) open.push_back({pair.i, pair.j});
  }
  const NeckTemplates templates(shown, fitted.blur);
  Surroundings about(balls.size());
  if (!none) show_necks(balls, pairs, templates, polymer.contrast, volume.spacing, about);
  show_balls(fitted, open, 2.0 * setting.half_width, about);
  const auto again = fit_all(volume, balls, about.neighbours, container, setting, "fits with polymer known",
                             [&](std::size_t own) { return about.of(own); });
  for (std::size_t n = 0; n < again.size(); ++n)
    if (again[n].converged) fitted.fits[n] = again[n];
}

}  // namespace pendular::segmentation
