#!/usr/bin/python3
"""By how much engines differ: compare.py FOLDER, with the files of engine_runs named PACKING_ENGINE_MEMBER.*

Prints one table per observable: each engine against "own" on the same beads, and members of "own" against its member 0.
"""

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

STRAINS = np.arange(0.005, 0.0351, 0.0025)


def table(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def loading(curve):
    """Rows that reach a strain never reached before."""
    reached = np.maximum.accumulate(curve["strain"])
    return curve[np.r_[True, curve["strain"][1:] > reached[:-1]]]


def slope(curve, low, high):
    part = curve[(curve["strain"] >= low) & (curve["strain"] <= high)]
    return np.polyfit(part["strain"], part["stress_pa"], 1)[0]


def unloading_modulus(curve):
    """Over the first third of the way down in stress."""
    strain, stress = curve["strain"], curve["stress_pa"]
    turn = np.flatnonzero(np.diff(strain) < 0)
    if not len(turn):
        return np.nan
    first = turn[0]
    below = (stress > 2 / 3 * stress[first]) & (strain < strain[first])
    down = np.flatnonzero((np.arange(len(strain)) > first + 1) & below)
    last = np.flatnonzero(np.diff(strain[first + 1:]) > 0)
    if len(last):
        down = down[down < first + 1 + last[0]]
    return np.polyfit(strain[down], stress[down], 1)[0]


def features(curve):
    up = loading(curve)
    at = lambda strain, what: np.interp(strain, up["strain"], up[what])
    return {"stress": at(STRAINS, "stress_pa"), "modulus": slope(up, 0.005, 0.015),
            "lateral": at(0.015, "lateral_strain"), "unloading": unloading_modulus(curve),
            "breaks": at(STRAINS[-1], "broken_bonds"), "peak": up["stress_pa"].max()}


def without_rigid_motion(at, u):
    """Displacements less the best rigid motion, by Kabsch."""
    now = at + u
    a, b = at - at.mean(axis=0), now - now.mean(axis=0)
    left, _, right = np.linalg.svd(a.T @ b)
    turn = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
    return b @ turn.T - a


def rms(u):
    return np.sqrt((u**2).sum(axis=1).mean())


def non_affine(at, u):
    fit = np.c_[at, np.ones(len(at))]
    return u - fit @ np.linalg.lstsq(fit, u, rcond=None)[0]


def field_difference(a, b):
    """rms of the difference per bead, um, after rigid motion; and over the non-affine part of a's field."""
    at = np.stack([a[k] for k in ("x_um", "y_um", "z_um")], axis=1)
    ua, ub = (np.stack([f[k] for k in ("ux_um", "uy_um", "uz_um")], axis=1) for f in (a, b))
    off = rms(without_rigid_motion(at + ua, ub - ua))
    na, nb = non_affine(at, ua), non_affine(at, ub)
    return off, rms(na), off / rms(na), (na * nb).sum() / np.sqrt((na**2).sum() * (nb**2).sum())


def main(folder):
    runs = {tuple(p.stem.split(".")[0].rsplit("_", 1)): p for p in sorted(Path(folder).glob("*_[0-9].csv"))}
    differences = defaultdict(list)
    print("packing engine member | stress %% at %s | E %% | unloading %% | lateral | breaks | peak %% | field um, over non-affine, cosine"
          % " ".join("%.2f" % (100 * s) for s in STRAINS[1::3]))
    for (name, member), path in runs.items():
        packing, engine = name.split("_", 1)
        own = runs.get((packing + "_own", "0"))
        if own is None or path == own:
            continue
        mine, base = features(table(path)), features(table(own))
        stress = np.log(mine["stress"] / base["stress"])
        field = field_difference(table(own.with_suffix(".field.csv")), table(path.with_suffix(".field.csv")))
        differences["members" if engine == "own" else engine].append(stress)
        percent = lambda what: 100 * np.log(mine[what] / base[what])
        print("%s %s %s | %s | %+.1f | %+.1f | %.4f vs %.4f | %d vs %d | %+.1f | %.2f of %.2f: %.2f, %.3f" % (
            packing, engine, member, " ".join("%+.1f" % (100 * d) for d in stress[1::3]), percent("modulus"),
            percent("unloading"), mine["lateral"], base["lateral"], mine["breaks"], base["breaks"], percent("peak"), *field))
    report(differences)


def report(differences):
    print("\nstress, rms over runs in %, and correlation of neighbouring and of farthest strains from 1 % on (about zero)")
    groups = dict(differences, **{"all engines": sum((v for k, v in differences.items() if k != "members"), [])})
    for engine, found in groups.items():
        d = np.array(found)
        moments = d.T @ d / len(d)
        scale = np.sqrt(np.diag(moments))
        if len(d) > 2:
            rho = moments / np.outer(scale, scale)
            tail = rho[2:, 2:]
            told = "%.2f %.2f" % (np.diag(tail, 1).mean(), tail[0, -1])
        else:
            told = "- -"
        print(engine, len(d), "|", " ".join("%.1f" % (100 * s) for s in scale), "|", told)


main(sys.argv[1])
