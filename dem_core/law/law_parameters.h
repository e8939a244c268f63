#pragma once

namespace pendular {

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
  Real friction;           ///< μ
  Real damping;            ///< ζ, N s/m
  Real dt;                 ///< time step, s
  Real half_dt;            ///< dt/2
  Real half_damping_dt;    ///< ζ dt/2
};

/// What the law of a specimen is made of.
struct LawParameters {
  double k_glass = 0.0, kt_glass = 0.0;
  double friction = 0.0;
  double platen_friction = 0.0;
  double damping = 0.0;
  bool one_spring = false;          ///< one tangential spring whose stiffness changes at touch
  bool bond_friction_limit = true;  ///< Coulomb limit on the bond's tangential force too
  bool bending = false;             ///< some bond has a bending or twisting stiffness
};

/// Which parts of the law are at work; the same for all pairs of a specimen.
struct LawParts {
  bool one_spring, bond_friction_limit, bending;
};

}  // namespace pendular
