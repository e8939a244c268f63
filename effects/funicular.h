#pragma once

namespace pendular::effects {

/// W*: polymer content at which bridges begin to merge (Hemmerle et al. 2021: 2.7 %).
inline constexpr double kFunicularContent = 0.027;

}  // namespace pendular::effects
