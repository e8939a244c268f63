#include "pipette/calibration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/nearest.h"
#include "base/toml_place.h"

namespace pendular::pipette {
namespace {

constexpr int kLargestImage = 65536;  // pixels along a side

const std::vector<std::string> kKeys = {"camera.um_per_pixel",
                                        "camera.um_per_pixel_sigma",
                                        "camera.frame_rate_hz",
                                        "pipette.stiffness_n_per_m",
                                        "pipette.stiffness_sigma_n_per_m",
                                        "pipette.sigma_reliability",
                                        "stage.speed_um_s",
                                        "test.direction",
                                        "test.pull_direction_px",
                                        "regions.beads",
                                        "regions.bead_fixed_px",
                                        "regions.bead_free_px",
                                        "regions.pipette_px",
                                        "regions.reference_px",
                                        "regions.expected_diameter_um",
                                        "tracking.search_px",
                                        "tracking.least_score"};

/// The keys of a file by their dotted names; every one is known, and each is asked for by its type.
class Keys {
 public:
  Keys(const toml::table& root, std::string file) : file_(std::move(file)) {
    for (const auto& [section, node] : root) {
      const auto* table = node.as_table();
      if (!table)
        bad_input("{}:{}: {}: unknown key, expected a section such as [camera]", file_,
                  node.source().begin.line, std::string(section.str()));
      for (const auto& [key, value] : *table)
        add(std::string(section.str()) + "." + std::string(key.str()), value);
    }
  }

  bool has(const std::string& name) const { return nodes_.count(name) != 0; }

  double number(const std::string& name, double lowest, double highest) const {
    const toml::node& node = at(name);
    if (!node.is_number())
      bad_input("{}: found no number, expected one from {} to {}", where(name), lowest, highest);
    const double value = nearest_double(node);
    if (!(value >= lowest && value <= highest))
      bad_input("{}: found {}, expected a number from {} to {}", where(name), value, lowest, highest);
    return value;
  }
  double number(const std::string& name, double lowest, double highest, double otherwise) const {
    return has(name) ? number(name, lowest, highest) : otherwise;
  }

  std::string word(const std::string& name, const std::vector<std::string>& allowed) const {
    const auto value = at(name).value<std::string>();
    if (!at(name).is_string() || std::find(allowed.begin(), allowed.end(), *value) == allowed.end())
      bad_input("{}: found {}, expected \"{}\"", where(name), value ? '"' + *value + '"' : "no string",
                fmt::join(allowed, "\" or \""));
    return *value;
  }

  std::vector<double> numbers(const std::string& name, std::size_t size, const char* expected) const {
    const auto* array = at(name).as_array();
    std::vector<double> values;
    if (array)
      for (const auto& item : *array)
        if (item.is_number() && std::isfinite(nearest_double(item))) values.push_back(nearest_double(item));
    if (!array || values.size() != size || array->size() != size)
      bad_input("{}: expected {}", where(name), expected);
    return values;
  }

  Region region(const std::string& name) const {
    const auto v = numbers(name, 4, "[x, y, width, height] in pixels from the upper left");
    for (std::size_t k = 0; k < 4; ++k)
      if (v[k] != std::floor(v[k]) || v[k] < (k < 2 ? 0.0 : 8.0) || v[k] > kLargestImage)
        bad_input("{}: found {}, expected whole pixels within the image, at least 8 wide and high",
                  where(name), v[k]);
    return {static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]), static_cast<int>(v[3])};
  }

  std::string where(const std::string& name) const {
    return fmt::format("{}:{}: {}", file_, at(name).source().begin.line, name);
  }
  const std::string& file() const { return file_; }

 private:
  void add(const std::string& name, const toml::node& node) {
    if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end())
      bad_input("{}:{}: {}: unknown key, the nearest known one is \"{}\"", file_, node.source().begin.line,
                name, nearest_name(name, kKeys));
    nodes_[name] = &node;
  }

  const toml::node& at(const std::string& name) const {
    const auto found = nodes_.find(name);
    if (found == nodes_.end()) bad_input("{}: {} is missing", file_, name);
    return *found->second;
  }

  std::string file_;
  std::map<std::string, const toml::node*> nodes_;
};

/// A value and its standard deviation, which every calibrated value must have.
void read_measured(const Keys& keys, const std::string& name, const std::string& sigma_name, double unit,
                   double& value, double& sigma) {
  value = unit * keys.number(name, 1e-9, 1e9);
  if (!keys.has(sigma_name))
    bad_input("{}: {} is missing, expected the standard deviation of {}", keys.file(), sigma_name, name);
  sigma = unit * keys.number(sigma_name, 1e-12, 1e9);
  if (sigma > 0.5 * value)
    bad_input("{}: found {}, expected at most half of {}", keys.where(sigma_name), sigma / unit, name);
}

void read_regions(const Keys& keys, Calibration& c) {
  const bool found_by_program = keys.has("regions.beads");
  if (found_by_program) keys.word("regions.beads", {"auto"});
  const bool given = keys.has("regions.bead_fixed_px") || keys.has("regions.bead_free_px");
  if (given == found_by_program)
    bad_input("{}: regions: expected either beads = \"auto\" or bead_fixed_px and bead_free_px", keys.file());
  if (given) {
    c.bead_fixed = keys.region("regions.bead_fixed_px");
    c.bead_free = keys.region("regions.bead_free_px");
  }
  if (keys.has("regions.pipette_px")) c.pipette = keys.region("regions.pipette_px");
  c.reference = keys.region("regions.reference_px");
}

Calibration read_keys(const Keys& keys) {
  Calibration c;
  read_measured(keys, "camera.um_per_pixel", "camera.um_per_pixel_sigma", 1e-6, c.metres_per_pixel,
                c.metres_per_pixel_sigma);
  read_measured(keys, "pipette.stiffness_n_per_m", "pipette.stiffness_sigma_n_per_m", 1.0,
                c.pipette_stiffness, c.pipette_stiffness_sigma);
  c.sigma_reliability = keys.number("pipette.sigma_reliability", 0.0, 0.5, c.sigma_reliability);
  c.frame_rate = keys.number("camera.frame_rate_hz", 1e-6, 1e7);
  c.stage_speed = 1e-6 * keys.number("stage.speed_um_s", 1e-6, 1e6);
  c.direction = keys.word("test.direction", {"normal", "tangential"}) == "normal" ? Direction::normal
                                                                                  : Direction::tangential;
  const auto pull = keys.numbers("test.pull_direction_px", 2, "[x, y]: right and down in the image");
  c.pull = {pull[0], pull[1]};
  if (!(c.pull.norm() > 1e-9) || !std::isfinite(c.pull.norm()))
    bad_input("{}: found [{}, {}], expected a direction", keys.where("test.pull_direction_px"), pull[0],
              pull[1]);
  c.pull.normalize();
  read_regions(keys, c);
  c.expected_diameter =
      1e-6 * keys.number("regions.expected_diameter_um", 0.1, 1e5, 1e6 * c.expected_diameter);
  c.search_reach = static_cast<int>(keys.number("tracking.search_px", 2, 200, c.search_reach));
  c.least_score = keys.number("tracking.least_score", 0.1, 0.999, c.least_score);
  return c;
}

std::string region_text(const char* name, const Region& r) {
  return fmt::format("{} = [{}, {}, {}, {}]\n", name, r.x, r.y, r.width, r.height);
}

}  // namespace

Calibration parse_calibration(std::string_view text, const std::string& name) {
  try {
    const toml::table root = toml::parse(text, name);
    return read_keys(Keys(root, name));
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    // The library quotes the character it stumbled over.
    std::replace_if(
        what.begin(), what.end(), [](unsigned char ch) { return ch < ' '; }, ' ');
    bad_input("{}:{}: {}", name, error.source().begin.line, what);
  }
}

Calibration read_calibration(const fs::path& path) {
  return parse_calibration(read_text(path), path.string());
}

std::string to_toml(const Calibration& c) {
  std::string text = fmt::format(
      "[camera]\num_per_pixel = {}\num_per_pixel_sigma = {}\nframe_rate_hz = {}\n\n[pipette]\n"
      "stiffness_n_per_m = {}\nstiffness_sigma_n_per_m = {}\nsigma_reliability = {}\n\n[stage]\nspeed_um_s = "
      "{}\n\n"
      "[test]\ndirection = \"{}\"\npull_direction_px = [{}, {}]\n\n[regions]\n",
      1e6 * c.metres_per_pixel, 1e6 * c.metres_per_pixel_sigma, c.frame_rate, c.pipette_stiffness,
      c.pipette_stiffness_sigma, c.sigma_reliability, 1e6 * c.stage_speed,
      c.direction == Direction::normal ? "normal" : "tangential", c.pull.x(), c.pull.y());
  if (c.bead_fixed && c.bead_free)
    text += region_text("bead_fixed_px", *c.bead_fixed) + region_text("bead_free_px", *c.bead_free);
  else
    text += "beads = \"auto\"\n";
  if (c.pipette) text += region_text("pipette_px", *c.pipette);
  text += region_text("reference_px", c.reference);
  text += fmt::format("expected_diameter_um = {}\n\n[tracking]\nsearch_px = {}\nleast_score = {}\n",
                      1e6 * c.expected_diameter, c.search_reach, c.least_score);
  return text;
}

}  // namespace pendular::pipette
