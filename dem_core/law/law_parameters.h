#pragma once

// Plain structs of the law between two beads. Real is double, or as many numbers as a register holds
// (Lanes in numbers-inl.h, which only dem_core's own sources include).

namespace pendular::dem_core {

/// A vector in space.
template <typename Real>
struct Triple {
  Real x, y, z;
};

/// What one pair has of its own, SI. A pair without a standing bond has kn = kt = k_bend = k_twist = 0.
template <typename Real>
struct PairData {
  Real rest{};      ///< δ0: initial gap of the pair, m
  Real touch{};     ///< gap at which the glass touches: 0, or the overlap that measured diameters start with
  Real kn{}, kt{};  ///< bond stiffness, N/m
  Real break_limit{};        ///< 2 G l / E_p, m²
  Real k_bend{}, k_twist{};  ///< bond stiffness, N m/rad (zero in the paper)
};
using PairProperties = PairData<double>;

/// The same for all pairs of a specimen, SI.
template <typename Real>
struct LawNumbers {
  Real k_glass, kt_glass;  ///< contact stiffness, N/m
  Real per_overlap;        ///< of glass after Hertz: 1 over its overlap in the law, 1/m
  Real friction;           ///< μ
  Real damping;            ///< ζ, N s/m
  Real dt;                 ///< time step, s
  Real half_dt;            ///< dt/2
  Real half_damping_dt;    ///< ζ dt/2
};

/// What a pair remembers between steps.
template <typename Real>
struct PairMemory {
  Triple<Real> bond_slip;     ///< δt since the start, of the bond (and of the contact, with one spring), m
  Triple<Real> contact_slip;  ///< δt since touch, of the contact, m
  Triple<Real> turn;          ///< rotation of i against j since the start, of the bond, rad
  Real closing;               ///< speed that damping opposed in the last step, m/s
};
using PairHistory = PairMemory<double>;

/// What a pair does in one step.
template <typename Real>
struct PairAction {
  Triple<Real> force;    ///< on bead i; minus this on bead j
  Triple<Real> couple;   ///< n × F^t; the torque on either bead is minus its arm times this
  Triple<Real> moment;   ///< of bending on bead i; minus this on bead j
  Real damped, slipped;  ///< energy lost in the step, J
};

/// A platen as every bead meets it, SI.
template <typename Real>
struct PlatenNumbers {
  Real z, velocity;        ///< of the face, along z
  Real sign;               ///< +1: beads are above it; −1: below
  Real k_glass, kt_glass;  ///< contact stiffness, N/m
  Real per_overlap;        ///< as of LawNumbers, 1/m
  Real friction, damping;  ///< μ of platens; ζ, N s/m
  Real dt, half_damping_dt;
};

/// A bead as a platen meets it.
template <typename Real>
struct PlatenBead {
  Real z, radius, relief;
  Triple<Real> velocity, spin;
};

/// What a platen remembers of a bead.
template <typename Real>
struct PlatenMemory {
  Real slip_x, slip_y;  ///< tangential displacement since touch, m
  Real closing;         ///< speed that damping opposed in the last step, m/s
};

/// What a platen does to a bead in one step.
template <typename Real>
struct PlatenAction {
  Triple<Real> force;       ///< on the bead
  Real torque_x, torque_y;  ///< on the bead
  Real normal;              ///< on the platen
  Real damped, slipped;     ///< energy lost in the step, J
};

/// What the law of a specimen is made of.
struct LawParameters {
  double k_glass = 0.0, kt_glass = 0.0;
  double hertz_overlap = 0.0;  ///< at which glass after Hertz pushes as k_glass does, m; 0: glass is linear
  double friction = 0.0;
  double platen_friction = 0.0;
  double damping = 0.0;
  bool one_spring = false;          ///< one tangential spring whose stiffness changes at touch
  bool bond_friction_limit = true;  ///< Coulomb limit on the bond's tangential force too
  bool bending = false;             ///< some bond has a bending or twisting stiffness
  bool separate_limits = false;     ///< bonds break at a limit of tension or one of shear
};

/// Which parts of the law are at work; the same for all pairs of a specimen.
struct LawParts {
  bool one_spring, bond_friction_limit, bending, hertz, separate_limits;
};

/// The normal force of glass on glass.
template <typename Real>
struct GlassLaw {
  Real k, per_overlap;  ///< as of LawNumbers
  bool hertz;
};

}  // namespace pendular::dem_core
