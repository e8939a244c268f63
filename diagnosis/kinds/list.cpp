#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis {
namespace {

std::vector<const Kind*>& list() {
  static std::vector<const Kind*> all = {&kinds::compression(),    &kinds::lateral_strain(),
                                         &kinds::modulus_series(), &kinds::bridge_stiffness(),
                                         &kinds::coordination(),   &kinds::bridge_diameters(),
                                         &kinds::bridge_gaps(),    &kinds::displacements(),
                                         &kinds::bridges(),        &kinds::broken_bonds()};
  return all;
}

}  // namespace

const std::vector<const Kind*>& all_kinds() {
  return list();
}

AddedKind::AddedKind(const Kind& kind) : kind_(kind) {
  for (const Kind* known : list())
    if (known->name == kind.name) bad_input("kind {}: there is one of that name", kind.name);
  if (kind.name.empty() || kind.required.empty() || !kind.simulate || !kind.landmarks || !kind.perturbed ||
      !kind.model_error)
    bad_input(
        "kind \"{}\": expected a name, columns, and that it is simulated, perturbed and read with errors",
        kind.name);
  if (kind.usual && (!kind.planned || !kind.shown))
    bad_input("kind {}: expected that a usual measurement is planned and shown", kind.name);
  list().push_back(&kind);
}

AddedKind::~AddedKind() {
  std::erase(list(), &kind_);
}

const Kind* find_kind(const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (const Kind* kind : all_kinds()) {
    if (kind->name == name) return kind;
    names.push_back(kind->name);
  }
  bad_input("{}: found \"{}\", the nearest known kind is \"{}\"", where, name, nearest_name(name, names));
}

const Kind* compression_kind() {
  return &kinds::compression();
}

}  // namespace pendular::diagnosis
