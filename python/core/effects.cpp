#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <map>

#include "binding/effect_failed.h"
#include "core/core.h"
#include "effects/list.h"

namespace pendular::python {
namespace {

using effects::ActualSpecimen;
using effects::Draws;
using effects::Effect;

/// The functions of an effect, and what it is told of bonds in.
struct Hooks {
  std::string id;
  std::shared_ptr<py::object> bonds_class, before, step;
};

using Column = std::vector<double>;

/// What a hook is given, and may change: attributes of a `pendular.effects.Bonds`.
class Bonds {
 public:
  Bonds(const Hooks& hooks, const char* hook, std::size_t rows)
      : hooks_(hooks), hook_(hook), rows_(rows), bonds_((*hooks.bonds_class)()) {}

  void give(const char* name, const Column& values) {
    bonds_.attr(name) = py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  }
  void give(const char* name, const std::vector<int>& values) {
    bonds_.attr(name) = py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data());
  }
  void give_table(const char* name, const Column& values, std::size_t columns) {
    bonds_.attr(name) = py::array_t<double>(
        {static_cast<py::ssize_t>(rows_), static_cast<py::ssize_t>(columns)}, values.data());
  }

  void call(const py::object& function, double theta) { function(bonds_, theta); }

  /// What the hook left; ComputationFailed where it is not as many numbers, of at least `least`.
  Column take(const char* name, double least, std::size_t columns = 1) const {
    const py::object found = bonds_.attr(name);
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(found);
    if (!array) PyErr_Clear();
    if (!array || static_cast<std::size_t>(array.size()) != rows_ * columns)
      throw ComputationFailed(
          fmt::format("effect {}: {}: {}: found {}, expected {} numbers", hooks_.id, hook_, name,
                      array ? fmt::format("{} numbers", array.size()) : "no numbers", rows_ * columns));
    for (py::ssize_t k = 0; k < array.size(); ++k)
      if (const double value = array.data()[k]; !std::isfinite(value) || value < least)
        throw ComputationFailed(
            fmt::format("effect {}: {}: {} of bond {}: found {}, expected a number{}", hooks_.id, hook_, name,
                        static_cast<std::size_t>(k) / columns, value,
                        std::isfinite(least) ? fmt::format(" of at least {}", least) : ""));
    return {array.data(), array.data() + array.size()};
  }

 private:
  const Hooks& hooks_;
  const char* hook_;
  std::size_t rows_;
  py::object bonds_;
};

/// Runs what needs the interpreter; its exceptions become the library's.
template <typename Call>
void in_python(const Hooks& hooks, const char* hook, const Call& call) {
  const py::gil_scoped_acquire held;
  try {
    call();
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt)) throw Interrupted("interrupted");
    const std::string kind = py::str(error.type().attr("__name__")), text = py::str(error.value());
    throw EffectFailed(fmt::format("effect {}: {}: {}: {}", hooks.id, hook, kind, text),
                       shared(error.value()));
  }
}

double dem_core::PairProperties::*const kStiffness[] = {
    &dem_core::PairProperties::kn, &dem_core::PairProperties::kt, &dem_core::PairProperties::k_bend,
    &dem_core::PairProperties::k_twist, &dem_core::PairProperties::break_limit};
constexpr const char* kStiffnessNames[] = {"kn_n_per_m", "kt_n_per_m", "k_bend_n_m_per_rad",
                                           "k_twist_n_m_per_rad", "break_limit_m2"};

template <typename Properties>
void give_stiffness(Bonds& bonds, std::size_t rows, const Properties& of) {
  for (std::size_t n = 0; n < std::size(kStiffness); ++n) {
    Column values(rows);
    for (std::size_t k = 0; k < rows; ++k) values[k] = of(k).*kStiffness[n];
    bonds.give(kStiffnessNames[n], values);
  }
}

/// Taken whole before any is changed.
template <typename Properties>
void take_stiffness(const Bonds& bonds, std::size_t rows, const Properties& of) {
  std::vector<Column> taken;
  for (const char* name : kStiffnessNames) taken.push_back(bonds.take(name, 0.0));
  for (std::size_t n = 0; n < std::size(kStiffness); ++n)
    for (std::size_t k = 0; k < rows; ++k) of(k).*kStiffness[n] = taken[n][k];
}

/// The bonded pairs, in the order of the bonds.
std::vector<dem_core::Pair*> bonded(dem_core::Simulation& simulation) {
  std::vector<dem_core::Pair*> pairs(simulation.bonds.size(), nullptr);
  for (auto& pair : simulation.pairs)
    if (pair.bond >= 0) pairs[static_cast<std::size_t>(pair.bond)] = &pair;
  std::erase(pairs, nullptr);
  return pairs;
}

void give_places(Bonds& bonds, const dem_core::Simulation& simulation,
                 const std::vector<dem_core::Pair*>& pairs) {
  std::vector<int> i, j;
  Column gaps, heights;
  std::map<std::string, Column> places;
  for (const dem_core::Pair* pair : pairs) {
    i.push_back(pair->i), j.push_back(pair->j);
    gaps.push_back(gap(simulation, *pair));
    heights.push_back(simulation.bonds[static_cast<std::size_t>(pair->bond)].height);
    const Vec3 middle = 0.5 * (simulation.beads.position[pair->i] + simulation.beads.position[pair->j]);
    places["x_m"].push_back(middle.x()), places["y_m"].push_back(middle.y()),
        places["z_m"].push_back(middle.z());
  }
  bonds.give("i", i), bonds.give("j", j);
  bonds.give("gap_m", gaps), bonds.give("height_m", heights);
  for (const char* name : {"x_m", "y_m", "z_m"}) bonds.give(name, places[name]);
}

void give_draws(Bonds& bonds, const std::vector<dem_core::Pair*>& pairs, const Draws& draws) {
  Column uniform, normal;
  for (const dem_core::Pair* pair : pairs) {
    uniform.push_back(draws.uniform(effects::of_pair(pair->i, pair->j)));
    normal.push_back(draws.normal(effects::of_pair(pair->i, pair->j)));
  }
  bonds.give("uniform", uniform), bonds.give("normal", normal);
}

auto before_test(const Hooks& hooks) {
  return [hooks](dem_core::Simulation& simulation, const ActualSpecimen& specimen, double theta,
                 const Draws& draws) {
    const auto pairs = bonded(simulation);
    in_python(hooks, "before", [&] {
      Bonds bonds(hooks, "before", pairs.size());
      give_places(bonds, simulation, pairs);
      give_draws(bonds, pairs, draws);
      const auto properties = [&](std::size_t k) -> dem_core::PairProperties& {
        return pairs[k]->properties;
      };
      give_stiffness(bonds, pairs.size(), properties);
      bonds.call(*hooks.before, theta);
      take_stiffness(bonds, pairs.size(), properties);
    });
    for (const dem_core::Pair* pair : pairs)
      simulation.law.bending |= pair->properties.k_bend > 0.0 || pair->properties.k_twist > 0.0;
    simulation.dt = dem_core::time_step(simulation, specimen.sample.contact.time_step_fraction);
  };
}

void give_moments(Bonds& bonds, std::span<const dem_core::BondMoment> moments, std::size_t memory) {
  Column stretch, shear, height, remembered;
  for (const dem_core::BondMoment& moment : moments) {
    stretch.push_back(moment.stretch), shear.push_back(moment.shear), height.push_back(moment.height);
    remembered.insert(remembered.end(), moment.memory, moment.memory + memory);
  }
  bonds.give("stretch_m", stretch), bonds.give("shear_m", shear), bonds.give("height_m", height);
  bonds.give("elapsed_s", Column(moments.size(), moments.empty() ? 0.0 : moments[0].elapsed));
  bonds.give_table("memory", remembered, memory);
}

auto as_it_goes_on(const Hooks& hooks, std::size_t memory) {
  return [hooks, memory](const ActualSpecimen&, double theta) {
    return [hooks, memory, theta](std::span<const dem_core::BondMoment> moments) {
      in_python(hooks, "step", [&] {
        Bonds bonds(hooks, "step", moments.size());
        const auto properties = [&](std::size_t k) -> dem_core::PairProperties& {
          return moments[k].properties;
        };
        give_moments(bonds, moments, memory);
        give_stiffness(bonds, moments.size(), properties);
        bonds.call(*hooks.step, theta);
        const Column remembered = bonds.take("memory", -HUGE_VAL, memory);
        take_stiffness(bonds, moments.size(), properties);
        for (std::size_t k = 0; k < moments.size(); ++k)
          std::copy_n(remembered.begin() + static_cast<std::ptrdiff_t>(k * memory), memory,
                      moments[k].memory);
      });
    };
  };
}

std::map<std::string, std::unique_ptr<effects::AddedEffect>>& added() {
  static std::map<std::string, std::unique_ptr<effects::AddedEffect>> all;
  return all;
}

void add(const py::object& told, const py::object& bonds_class, const std::string& code) {
  const auto text = [&](const char* name) { return told.attr(name).cast<std::string>(); };
  const auto number = [&](const char* name) { return told.attr(name).cast<double>(); };
  const auto [from, to] = told.attr("bank").cast<std::pair<double, double>>();
  Effect effect{.id = text("id"),
                .unit = text("unit"),
                .name = text("name"),
                .sentence = text("sentence"),
                .meaning = text("meaning"),
                .lowest = number("lowest"),
                .highest = number("highest"),
                .bank_from = from,
                .bank_to = to};
  effect.draws = told.attr("draws").cast<bool>();
  effect.memory = told.attr("memory").cast<std::size_t>();
  effect.code = code;
  const Hooks hooks{effect.id, shared(bonds_class), shared(told.attr("before")), shared(told.attr("step"))};
  if (!hooks.before->is_none()) effect.simulation = before_test(hooks);
  if (!hooks.step->is_none()) effect.evolution_of_all = as_it_goes_on(hooks, effect.memory);
  added().erase(effect.id);
  const std::string id = effect.id;
  added().emplace(id, std::make_unique<effects::AddedEffect>(std::move(effect)));
}

py::list all() {
  py::list list;
  for (const Effect& effect : effects::all_effects()) {
    py::dict entry;
    entry["id"] = effect.id, entry["unit"] = effect.unit, entry["name"] = effect.name;
    entry["meaning"] = effect.meaning, entry["lowest"] = effect.lowest, entry["highest"] = effect.highest;
    entry["bank"] = py::make_tuple(effect.bank_from, effect.bank_to);
    entry["in_python"] = added().contains(effect.id);
    list.append(entry);
  }
  return list;
}

}  // namespace

void add_effects(py::module_& module) {
  module.def("add_effect", &add);
  module.def("remove_effect", [](const std::string& id) {
    if (added().erase(id) == 0) bad_input("effect {}: expected one that was added", id);
  });
  module.def("effects", &all);
  // Before the interpreter goes, which the functions belong to.
  py::module_::import("atexit").attr("register")(py::cpp_function([] { added().clear(); }));
}

}  // namespace pendular::python
