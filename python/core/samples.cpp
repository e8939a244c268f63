#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "base/nearest.h"
#include "base/sample.h"
#include "binding/inputs.h"
#include "binding/work.h"
#include "core/core.h"
#include "effects/list.h"

namespace pendular::python {
namespace {

NamedSample checked(NamedSample named) {
  effects::check_effects(named.sample, named.name);
  return named;
}

// They may warn of keys that only earlier versions leave out.

NamedSample read(const fs::path& path) {
  return work({}, [&] { return checked({read_sample(path), path.string(), true}); });
}

NamedSample from_text(const std::string& text) {
  return work({}, [&] { return checked({whole_sample(text, "sample")}); });
}

SampleValue value_at(const NamedSample& named, const std::string& key) {
  std::vector<std::string> names;
  for (auto& [name, value] : sample_settings(named.sample)) {
    if (name == key) return value;
    names.push_back(name);
  }
  throw py::key_error(fmt::format("{}: has no value for \"{}\"; the nearest key is \"{}\"", named.name, key,
                                  nearest_name(key, names)));
}

/// With some keys changed; "W" is the polymer content, which changes the bridges' diameter with it.
NamedSample with(const NamedSample& named, const std::vector<SampleSetting>& settings) {
  NamedSample changed = named;
  changed.name = "sample", changed.of_file = false;
  for (const auto& [key, value] : settings) {
    const auto* number = std::get_if<double>(&value);
    if (key == "W" && number)
      set_polymer_content(changed.sample, *number);
    else
      set_sample_key(changed.sample, key, value, "sample: " + key);
  }
  changed.sample = whole_sample(sample_text(changed.sample), "sample");
  return checked(std::move(changed));
}

SampleValue to_value(const std::string& key, const py::object& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  try {
    if (PyNumber_Check(value.ptr()) != 0 && !py::hasattr(value, "__len__")) return value.cast<double>();
    return value.cast<std::vector<double>>();
  } catch (const py::cast_error&) {
    bad_input("sample: {}: found {}, expected a number, true or false, a word, or a list of numbers", key,
              std::string(py::repr(value)));
  }
}

}  // namespace

void add_samples(py::module_& module) {
  py::class_<NamedSample>(module, "Sample")
      .def_static("read", &read)
      .def_static("from_text", &from_text)
      .def_readonly("name", &NamedSample::name)
      .def("value", &value_at)
      .def("keys",
           [](const NamedSample& named) {
             std::vector<std::string> keys;
             for (const auto& setting : sample_settings(named.sample)) keys.push_back(setting.first);
             return keys;
           })
      .def("changed",
           [](const NamedSample& named, const py::dict& settings) {
             std::vector<SampleSetting> list;
             for (const auto& [key, value] : settings) {
               const auto name = py::str(key).cast<std::string>();
               list.emplace_back(name, to_value(name, py::reinterpret_borrow<py::object>(value)));
             }
             return with(named, list);
           })
      .def("text", [](const NamedSample& named) { return sample_text(named.sample); })
      .def("input", [](const NamedSample& named) { return input_of(named); });
}

}  // namespace pendular::python
