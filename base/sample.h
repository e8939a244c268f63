#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/files.h"
#include "base/sample_words.h"

namespace pendular {

/// What an experimenter believes about a specimen and its test; one TOML file (docs/sample.md).
/// All values in SI here; the file's keys carry their own units and are listed with ranges and meaning
/// in sample_keys(). Defaults are sample A of Hemmerle et al. 2021, Table 1.
struct Sample {
  struct Beads {
    double diameter = 200.9e-6;    ///< mean, m
    double diameter_sd = 1.9e-6;   ///< true spread of the batch, m
    double realisation_sd = 0.05;  ///< spread of drawn diameters, share of the mean (paper, Sec. 3.2.1)
    double density = 2540.0;       ///< kg/m3
    Diameters diameters = Diameters::automatic;
  } beads;

  struct Bridges {
    double youngs_modulus = 1.5e6;  ///< E_p, Pa
    double poisson_ratio = 0.49;
    double diameter = 73.9e-6;               ///< mean neck diameter d, m
    double diameter_sd = 12.7e-6;            ///< m
    double polymer_content = 0.023;          ///< W for which the diameter holds, see set_polymer_content()
    double gap = 2e-6;                       ///< δ0 for which the stiffness holds, m
    double cutoff = 0.064;                   ///< candidate bridges have gaps below cutoff × D
    double interfacial_energy = 7.0;         ///< G, J/m2
    std::optional<double> relaxation_time;   ///< of the polymer, s; see effects/polymer_viscoelasticity.cpp
    std::optional<double> normal_stiffness;  ///< kn, N/m
    std::optional<double> tangential_stiffness;  ///< kt, N/m
    StiffnessOf stiffness = StiffnessOf::one;
    Breaking breaking = Breaking::griffith;
  } bridges;

  struct Contact {
    double stiffness_ratio = 10.0;    ///< k_glass over k_bond, normal and tangential
    double friction = 0.5;            ///< μ between beads
    double platen_friction = 0.5;     ///< μ between beads and platens
    double damping_fraction = 0.1;    ///< ζ over the critical damping of two mean beads in touch
    double time_step_fraction = 0.2;  ///< time step over √(m_min/k_max)
    Glass glass = Glass::linear;
    TangentialSprings tangential_springs = TangentialSprings::two;
    bool bond_friction_limit = true;  ///< Coulomb limit μ|F^n| also on the bond's tangential force
  } contact;

  struct Specimen {
    double diameter = 4.25e-3;      ///< m
    double height = 4.05e-3;        ///< m
    double volume_fraction = 0.60;  ///< of beads, where a packing is generated
  } specimen;

  struct Compression {
    double speed = 1e-4;             ///< platen speed over D √(k_glass/m)
    std::optional<double> speed_si;  ///< m/s; overrides `speed`
    Control control = Control::speed;
    double relax_increment = 1e-3;      ///< strain of an increment
    double relax_to = 1e-3;             ///< unbalanced force that counts as rest
    std::optional<double> stress_rate;  ///< of that ramp, Pa/s
    std::optional<double> max_stress;   ///< stress at which the run ends, Pa
    double max_strain = 0.10;           ///< engineering strain at which the run ends
    std::vector<double> unload_at;      ///< strains at which the platen returns to zero stress once, rising
    std::vector<double> hold_at;        ///< strains at which the platen rests for a time, rising
    double hold = 1e-3;                 ///< that time: the strain that would be made in it at the speed
    std::optional<double> hold_time;    ///< s; overrides `hold`
    double rows_per_strain = 5000.0;    ///< rows of curve.csv per unit strain
    double frames = 20.0;               ///< frames written, evenly in strain; 0: none
    std::vector<double> frame_at;       ///< strains at which further frames are written, rising
  } compression;

  /// What frames show beside where the beads are; `pendular render` wants all but the stress.
  struct Observe {
    bool local_strain = true, local_stress = true;  ///< of each bead's neighbourhood
    bool coordination = true, damage = true;        ///< bonds and touching neighbours; share of bonds broken
    bool force_chains = true;                       ///< normal force of each pair, and whether it is strong
  } observe;

  struct Phantom {
    double voxel = 5e-6;              ///< m
    double blur_voxels = 1.0;         ///< sd of the Gaussian point spread, voxels
    double noise = 0.1;               ///< sd of the white noise over the air–glass edge
    double correlated_noise = 0.0;    ///< sd of noise correlated over correlation_voxels, over the edge
    double correlation_voxels = 2.0;  ///< sd of the Gaussian kernel that correlates it, voxels
    double polymer_contrast = 0.3;    ///< (polymer − air)/(glass − air)
    double wall_thickness = 100e-6;   ///< container wall, m; 0: none
    double wall_contrast = 0.5;       ///< (wall − air)/(glass − air)
    double piston_contrast = 0.8;     ///< (piston − air)/(glass − air)
    double margin = 150e-6;           ///< air around the container and piston shown above and below, m
    double rings = 0.0;               ///< amplitude of ring artefacts over the edge
    double beam_hardening = 0.0;      ///< relative loss of grey value on the axis against the rim
    double bits = 16.0;               ///< 8 or 16, unsigned
    double air_grey = 0.25;           ///< grey value of air over full scale
    double glass_grey = 0.60;         ///< grey value of glass over full scale
  } phantom;

  /// What the specimen is taken to have that the paper's model has not: the file's [effects], name =
  /// magnitude. Any name is read here; the library of effects checks names and ranges. Magnitude 0 is the
  /// model itself and not kept.
  std::map<std::string, double> effects;
};

/// One key of the sample file.
struct SampleKey {
  std::string name;        ///< dotted, e.g. "bridges.youngs_modulus_pa"
  double lowest, highest;  ///< accepted range, in the unit of the name
  std::string meaning;
};

/// Every numeric key, in the file's order; those of [effects], whose names are not known here, aside.
std::vector<SampleKey> sample_keys();

/// A key's value in the unit of its name: a number, true or false, a word, or strains.
using SampleValue = std::variant<double, bool, std::string, std::vector<double>>;

/// A key by its dotted name, and a value for it.
using SampleSetting = std::pair<std::string, SampleValue>;

/// The names of all these keys, numeric or not.
std::vector<std::string> sample_key_names();

/// Reads and checks a sample file. BadInput names file, line, key, what was found and what was expected;
/// an unknown key names the nearest known one, and a file that leaves out what a sample has to state
/// (docs/sample.md) is told what that is. What only earlier versions leave out is warned of.
Sample read_sample(const fs::path& path);

/// The same from the file's text, changed by settings that count as if the text had them; `name` stands for
/// the file in messages.
Sample whole_sample(std::string_view text, const std::string& name,
                    const std::vector<SampleSetting>& settings = {});

/// Warns where a file's text leaves out what only samples of earlier versions do.
void warn_of_later_keys(std::string_view text, const std::string& name);

/// Of text that need not be whole: what it leaves out is as in sample A.
Sample parse_sample(std::string_view text, const std::string& name,
                    const std::vector<SampleSetting>& settings = {});

/// Every key that the sample has a value for, always in the same order. A sample with these settings equals
/// it exactly if its numbers came from a file or from set_sample_key(), and to 1e-15 otherwise.
std::vector<SampleSetting> sample_settings(const Sample& sample);

/// The same as the text of a sample file.
std::string sample_text(const Sample& sample);

/// Sets one key by its dotted name. BadInput, opening with `where`, for an unknown key, a value of the wrong
/// kind or one out of range. What keys must fulfil together is not checked.
void set_sample_key(Sample& sample, const std::string& name, const SampleValue& value,
                    const std::string& where);

/// Sets or reads one numeric key by its dotted name, in the unit of the name. BadInput for an unknown key
/// or a value out of range.
void set_sample_key(Sample& sample, const std::string& name, double value);
double sample_key(const Sample& sample, const std::string& name);

/// Changes the polymer content W (volume of polymer over that of the specimen) and with it the diameter of
/// the bridges and its spread, W ∝ d² (Hemmerle et al. 2021). BadInput where W or d leave their ranges.
void set_polymer_content(Sample& sample, double content);

}  // namespace pendular
