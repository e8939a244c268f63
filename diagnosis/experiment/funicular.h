#pragma once

namespace pendular::diagnosis {

/// W*: polymer content at which bridges begin to merge (paper: 2.7 %).
constexpr double kFunicularContent = 0.027;

}  // namespace pendular::diagnosis
