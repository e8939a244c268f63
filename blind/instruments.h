#pragma once

#include <nlohmann/json_fwd.hpp>

#include <map>

#include "blind/truth.h"

namespace pendular::blind {

/// What a case publishes of one kind of observation.
struct Table {
  std::vector<std::string> names;  ///< of the columns, with their units
  std::vector<std::vector<double>> rows;
};

/// The text of a table's file.
std::string csv_text(const Table& table);

/// Tables by the name of their file, without ".csv".
using Tables = std::map<std::string, Table>;

/// What a case observes: A's test, B's where there is one, and the kinds that its plan lists, all with noise
/// that is not quite the stated one: forces with a gain within half a per cent and noise correlated in time,
/// stated sigmas off by up to 30 %. `noise` tells what was done, for the sealed file.
Tables observe(const CasePlan& plan, const Split& split, const TrueTest& a, const TrueTest* b,
               nlohmann::ordered_json& noise);

}  // namespace pendular::blind
