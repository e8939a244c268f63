"""Phantoms of sample A, smaller, and how near a table of beads comes to the truth."""

import csv
import re
import subprocess
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parent.parent.parent
LEAST = 0.4  # of the true diameter: smaller bodies do not count


def sample(phantom, size_um=None, volume_fraction=None, diameter_sd_um=None):
    """Sample A's file with this [phantom] table; all of A, or a cylinder as wide as it is high."""
    text = (ROOT / "samples/hemmerle2021_a.toml").read_text().split("[phantom]")[0]
    if size_um:
        text = re.sub(r"(?m)^(diameter|height)_um = 4\d+", rf"\1_um = {size_um}", text)
    if volume_fraction:
        text = re.sub(r"(?m)^volume_fraction = .*", f"volume_fraction = {volume_fraction}", text)
    if diameter_sd_um:
        text = re.sub(r"(?m)^diameter_sd_um = 1.9", f"diameter_sd_um = {diameter_sd_um}", text)
    return text + "\n[phantom]\n" + "".join(f"{key} = {value}\n" for key, value in phantom.items())


def make(pendular, text, work):
    """The phantom work/v.mha of a sample file's text; returns its true beads."""
    (work / "s.toml").write_text(text)
    for command in (["phantom", work / "s.toml", "-o", work / "v.mha", "--truth", work / "t.vtp"],
                    ["convert", work / "t.vtp", work / "t.csv"]):
        subprocess.run([pendular, *command, "--quiet"], check=True)
    return beads_of(work / "t.csv")


def beads_of(path):
    """Columns x, y, z, diameter and, where the table has them, both standard errors; um."""
    with open(path) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    keys = ["x_um", "y_um", "z_um", "diameter_um"] + [
        key for key in ("sigma_centre_um", "sigma_diameter_um") if rows and key in rows[0]]
    return np.array([[float(row[key]) for key in keys] for row in rows])


def compare(truth, found, voxel_um):
    """Share found, number invented, centre rms, bias and sd of diameters in voxels, rms errors over stated ones."""
    found = found[found[:, 3] > LEAST * np.median(truth[:, 3])]
    distance, nearest = cKDTree(found[:, :3]).query(truth[:, :3])
    right = distance < 0.25 * truth[:, 3]
    match = found[nearest[right]]
    off, wider = match[:, :3] - truth[right, :3], match[:, 3] - truth[right, 3]
    pulls = (np.nan, np.nan)
    if found.shape[1] > 5:
        pulls = (np.sqrt(((off / match[:, 4:5]) ** 2).mean()), np.sqrt(((wider / match[:, 5]) ** 2).mean()))
    return (right.mean(), len(found) - len(set(nearest[right])), np.sqrt((off**2).mean()) / voxel_um,
            wider.mean() / voxel_um, wider.std() / voxel_um, *pulls)
