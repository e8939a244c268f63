#include "segmentation/fit/bead_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/batches.h"
#include "base/quantile.h"
#include "segmentation/fit/level_field.h"
#include "segmentation/thresholds.h"

namespace pendular::segmentation {
namespace {

constexpr double cone_share = 0.53;  // of the typical radius, as long as the blur is not known: 32°

/// Radius of a cone on its bead: the widest neck and its blur.
double cone_for(double radius, double blur) {
  constexpr double widest = 0.485, blurs = 1.15, most = 0.57;  // of the typical radius
  return std::min(widest * radius + blurs * blur, most * radius);
}

/// One round: every ball fitted with the others where they were before, with cones towards those nearer than
/// `cone_gap`.
std::vector<BallFit> fit_round(const Volume& volume, const std::vector<GreyBall>& balls,
                               const std::optional<Container>& container, const FitSetting& setting,
                               double cone_gap, const std::string& name) {
  Neighbours neighbours(balls.size());
  for (const auto& [i, j] : near_balls(balls, std::max(cone_gap, 2.0 * setting.half_width))) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const double gap = (balls[a].centre - balls[b].centre).norm() - balls[a].radius - balls[b].radius;
    neighbours[a].push_back({j, gap < cone_gap});
    neighbours[b].push_back({i, gap < cone_gap});
  }
  return fit_all(volume, balls, neighbours, container, setting, name);
}

bool outside(const Volume& volume, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < -0.5 || p[axis] > static_cast<double>(volume.size[static_cast<std::size_t>(axis)]) - 0.5)
      return true;
  return false;
}

/// Drops fits that are no bead; of two that overlap, the one that fits worse.
void reject(std::vector<BallFit>& fits, const Volume& volume, const BeadSearch& search) {
  const double needed =
      kThresholds.least_contrast * (search.levels.bright - search.levels.dark) * (search.bright ? 1.0 : -1.0);
  std::erase_if(fits, [&](const BallFit& fit) {
    return !fit.converged || fit.explained_share < kThresholds.least_explained ||
           fit.ball.contrast / needed < 1.0 || fit.ball.radius < search.least_radius ||
           outside(volume, fit.ball.centre) ||
           (search.container && !within(*search.container, fit.ball.centre));
  });
  std::vector<bool> dropped(fits.size(), false);
  for (const auto& [a, b] : near_balls(balls_of(fits), 0.0)) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const double separation = (fits[i].ball.centre - fits[j].ball.centre).norm();
    if (dropped[i] || dropped[j] ||
        separation > kThresholds.least_separation * (fits[i].ball.radius + fits[j].ball.radius))
      continue;
    dropped[fits[i].residual < fits[j].residual ? j : i] = true;
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < fits.size(); ++n)
    if (!dropped[n]) fits[kept++] = fits[n];
  fits.resize(kept);
}

/// Drops the few among balls that fit far worse, as broken ones do; grains that are all irregular stay.
void drop_outliers(std::vector<BallFit>& fits, double noise) {
  const auto is_outlier = [noise](const BallFit& fit) {
    return fit.residual > std::hypot(noise, kThresholds.outlier_misfit * fit.ball.contrast);
  };
  if (2 * std::count_if(fits.begin(), fits.end(), is_outlier) < std::ssize(fits))
    std::erase_if(fits, is_outlier);
}

std::vector<GreyBall> balls_at(const std::vector<Seed>& seeds, const BeadSearch& search) {
  const double edge = search.levels.bright - search.levels.dark;
  std::vector<GreyBall> balls;
  for (const Seed& seed : seeds)
    balls.push_back({seed.centre, seed.radius, search.bright ? edge : -edge,
                     search.bright ? search.levels.dark : search.levels.bright});
  return balls;
}

/// Of a shell's voxels every so many: some thousands are enough for a fit that another one follows.
std::size_t stride_for(double radius, double half_width) {
  constexpr double enough = 6000.0;
  return static_cast<std::size_t>(std::max(1.0, 8.0 * M_PI * radius * radius * half_width / enough));
}

/// First fits to seeds, which may be off by some voxels: a wide shell, some of its voxels; then with the blur
/// free.
std::vector<BallFit> coarse_fits(const Volume& volume, const std::vector<GreyBall>& balls,
                                 const BeadSearch& search, double cutoff) {
  std::vector<double> radii;
  for (const GreyBall& ball : balls) radii.push_back(ball.radius);
  const double radius = median(radii);
  FitSetting setting;
  setting.half_width = std::max(std::min(3.0, 0.4 * radius), 0.3 * radius);
  const double cone_gap = 2.0 * cutoff * radius + 2.0;
  setting.cone = cone_share * radius;
  setting.stride = stride_for(radius, setting.half_width);
  setting.tolerance = 0.05;
  const auto first = fit_round(volume, balls, search.container, setting, cone_gap, "first fits");
  setting.half_width = std::max(std::min(3.0, 0.4 * radius), 0.2 * radius);
  setting.stride = stride_for(radius, setting.half_width);
  setting.fit_blur = true;
  auto fits =
      fit_round(volume, balls_of(first), search.container, setting, cone_gap, "first fits, with blur");
  reject(fits, volume, search);
  return fits;
}

std::vector<Seed> seeds_at(const std::vector<BallFit>& fits) {
  std::vector<Seed> seeds;
  for (const BallFit& fit : fits) seeds.push_back({fit.ball.centre, fit.ball.radius});
  return seeds;
}

}  // namespace

std::vector<GreyBall> balls_of(const std::vector<BallFit>& fits) {
  std::vector<GreyBall> balls;
  for (const BallFit& fit : fits) balls.push_back(fit.ball);
  return balls;
}

double median_radius(const std::vector<BallFit>& fits) {
  std::vector<double> radii;
  for (const BallFit& fit : fits) radii.push_back(fit.ball.radius);
  return median(radii);
}

FitSetting fine_setting(const std::vector<BallFit>& fits, double blur) {
  const double radius = median_radius(fits);
  FitSetting setting;
  setting.blur = blur;
  setting.half_width = std::min(std::max(2.0, 3.0 * blur), 0.4 * radius);
  setting.cone = cone_for(radius, blur);
  setting.drop_foreign = true;
  return setting;
}

std::vector<BallFit> fit_all(const Volume& volume, const std::vector<GreyBall>& balls,
                             const Neighbours& neighbours, const std::optional<Container>& container,
                             const FitSetting& setting, const std::string& name,
                             const std::function<KnownGrey(std::size_t)>& known) {
  std::vector<BallFit> fits(balls.size());
  for_batches(name, balls.size(), 64, [&](std::size_t n) {
    fits[n] = fit_ball(volume, balls, n, neighbours[n], container, setting, known ? known(n) : KnownGrey());
  });
  return fits;
}

std::vector<IndexPair> near_balls(const std::vector<GreyBall>& balls, double max_gap) {
  std::vector<Vec3> centres;
  std::vector<double> diameters;
  for (const GreyBall& ball : balls) {
    centres.push_back(ball.centre);
    diameters.push_back(2.0 * ball.radius);
  }
  return pairs_within(centres, diameters, max_gap);
}

double ball_share(const Volume& volume, const BeadSearch& search, double cutoff) {
  constexpr std::size_t most = 150;
  const std::size_t step = search.seeds.size() / most + 1;
  std::vector<Seed> sample;
  for (std::size_t n = 0; n < search.seeds.size(); n += step) sample.push_back(search.seeds[n]);
  if (sample.empty()) return 0.0;
  const auto fits = coarse_fits(volume, balls_at(sample, search), search, cutoff);
  double sum = 0.0;
  for (const BallFit& fit : fits) sum += 1.0 / (1.0 + std::pow(fit.residual / (0.15 * fit.ball.contrast), 2));
  return sum / static_cast<double>(sample.size());
}

FittedBeads fit_beads(const Volume& volume, const BeadSearch& search, double cutoff) {
  FittedBeads result;
  std::vector<BallFit> fits = coarse_fits(volume, balls_at(search.seeds, search), search, cutoff);
  std::size_t tried = search.seeds.size();
  // A pore keeps the ball that fits into a bead far smaller than the bead, so what is missed again is taken
  // to be of the usual size.
  for (const bool usual_size : {false, true}) {
    const double usual = median_radius(fits);
    auto missed = search_missed(search.mask, seeds_at(fits), std::max(search.least_radius, 0.5 * usual));
    if (missed.empty()) break;
    if (usual_size)
      for (Seed& seed : missed) seed.radius = usual;
    else
      tried += missed.size();
    auto balls = balls_of(fits);
    const auto more = balls_at(missed, search);
    balls.insert(balls.end(), more.begin(), more.end());
    fits = coarse_fits(volume, balls, search, cutoff);
  }
  if (fits.empty()) return result;

  std::vector<double> blurs;
  for (const BallFit& fit : fits) blurs.push_back(fit.blur);
  result.blur = median(blurs);
  FitSetting last = fine_setting(fits, result.blur), rough = last;
  rough.tolerance = 1e-3;
  rough.stride = stride_for(median_radius(fits), rough.half_width);
  const double cone_gap = 2.0 * cutoff * median_radius(fits) + 0.5;
  const auto levelled = [&] {
    auto balls = balls_of(fits);
    set_level_slopes(balls);
    return balls;
  };
  const auto fit_again = [&](const FitSetting& setting, const char* name) {
    fits = fit_round(volume, levelled(), search.container, setting, cone_gap, name);
    reject(fits, volume, search);
  };
  fit_again(rough, "second fits");
  result.rings = find_rings(volume, levelled(), 4.0 * result.blur);
  last.rings = rough.rings = result.rings.get();
  // Levels that rings have shifted are not those of the specimen.
  if (result.rings) fit_again(rough, "second fits without rings");
  fit_again(last, "last fits");
  result.noise = measure_noise(volume, balls_of(fits), last.half_width, last.rings);
  drop_outliers(fits, result.noise.sd);
  result.grains = search_missed(search.mask, seeds_at(fits), search.least_radius);
  result.fits = std::move(fits);
  result.rejected = tried - result.fits.size();
  return result;
}

}  // namespace pendular::segmentation
