#include "base/error.h"
#include "base/nearest.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis {

const std::vector<const Kind*>& all_kinds() {
  static const std::vector<const Kind*> all = {&kinds::compression(),      &kinds::lateral_strain(),
                                               &kinds::modulus_series(),   &kinds::bridge_stiffness(),
                                               &kinds::bridge_diameters(), &kinds::bridge_gaps(),
                                               &kinds::coordination(),     &kinds::displacements(),
                                               &kinds::bridges(),          &kinds::broken_bonds()};
  return all;
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
