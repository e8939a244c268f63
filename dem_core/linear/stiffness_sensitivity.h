#pragma once

#include <vector>

#include "dem_core/linear/spring_network.h"

namespace pendular::dem_core {

/// How a network between held platens moves where its springs become stiffer. x solves K x = pushes; a spring
/// whose stiffness changes by the factor exp θ has its force, push included, changed by the same factor.

/// Derivative of x with respect to θ where the θ of spring b is `weights`[b] times one number; one linear
/// solve. m.
NodeVector stiffness_sensitivity(const SpringNetwork& network, const NodeVector& x,
                                 const std::vector<double>& weights, double tolerance);

/// Derivative with respect to the θ of every spring of a function of x whose gradient is `gradient`; one
/// adjoint solve: K λ = gradient on the free nodes, dJ/dθ_b = −λ · (forces of spring b).
std::vector<double> stiffness_gradient(const SpringNetwork& network, const NodeVector& x,
                                       const NodeVector& gradient, double tolerance);

}  // namespace pendular::dem_core
