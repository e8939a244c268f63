#include "micromechanics/bridge_field.h"

#include <cmath>

namespace pendular::micromechanics {
namespace {

using Eigen::MatrixXd;

double shear_motion(int component, double, double) {
  return component == 1 ? 1.0 : 0.0;
}

double bend_motion(int component, double r, double z) {
  return component == 0 ? 0.0 : component == 1 ? z : -r;
}

}  // namespace

BridgeField stretch_field() {
  BridgeField f{2, 2.0 * M_PI, MatrixXd::Zero(strains, 2 * operators), {true, false}, {false, true}, {}};
  const int w = operators;
  f.strain(e_rr, d_r) = f.strain(e_tt, over_r) = f.strain(g_rz, d_z) = 1.0;
  f.strain(e_zz, w + d_z) = f.strain(g_rz, w + d_r) = 1.0;
  f.motions = {[](int component, double, double) { return component == 1 ? 1.0 : 0.0; }};
  return f;
}

BridgeField twist_field() {
  BridgeField f{1, 2.0 * M_PI, MatrixXd::Zero(strains, operators), {true}, {true}, {}};
  f.strain(g_rt, d_r) = f.strain(g_tz, d_z) = 1.0;
  f.strain(g_rt, over_r) = -1.0;
  f.motions = {[](int, double r, double) { return r; }};
  return f;
}

BridgeField shear_and_bend_field() {
  BridgeField f{3, M_PI, MatrixXd::Zero(strains, 3 * operators), {true, false, true}, {}, {}};
  const int p = 0, q = operators, w = 2 * operators;
  f.strain(e_rr, p + d_r) = f.strain(e_rr, q + d_r) = 1.0;
  f.strain(e_tt, p + over_r) = 2.0;
  f.strain(e_zz, w + d_z) = 1.0;
  f.strain(g_rt, p + d_r) = 1.0;
  f.strain(g_rt, q + d_r) = -1.0;
  f.strain(g_rt, p + over_r) = -2.0;
  f.strain(g_rz, p + d_z) = f.strain(g_rz, q + d_z) = f.strain(g_rz, w + d_r) = 1.0;
  f.strain(g_tz, p + d_z) = 1.0;
  f.strain(g_tz, q + d_z) = f.strain(g_tz, w + over_r) = -1.0;
  f.motions = {shear_motion, bend_motion};
  return f;
}

BridgeField shear_field() {
  BridgeField f = shear_and_bend_field();
  f.motions = {shear_motion};
  f.zero_in_middle = {true, true, false};
  return f;
}

BridgeField bend_field() {
  BridgeField f = shear_and_bend_field();
  f.motions = {bend_motion};
  f.zero_in_middle = {false, false, true};
  return f;
}

MatrixXd elasticity(double nu) {
  const double shear = 0.5 / (1.0 + nu), lame = nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  MatrixXd law = MatrixXd::Zero(strains, strains);
  law.topLeftCorner(3, 3).setConstant(lame);
  law.diagonal() << lame + 2.0 * shear, lame + 2.0 * shear, lame + 2.0 * shear, shear, shear, shear;
  return law;
}

}  // namespace pendular::micromechanics
