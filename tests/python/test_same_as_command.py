"""The module's results are those of the command line, bit by bit."""

import json
import unittest

import numpy as np

import pendular
from support import InScratchFolder


def rows(path):
    """A table without its provenance."""
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


def without(json_data, *keys):
    return {key: value for key, value in json_data.items() if key not in keys}


class SameAsCommand(InScratchFolder):
    def json(self, name):
        return without(json.loads((self.folder / name).read_text()), "provenance")

    def read_both(self, read, ours, theirs):
        return read(self.folder / ours), read(self.folder / theirs)

    def test_chain_from_volume_to_modulus(self):
        self.program("phantom", "sample.toml", "-o", "scan.mha", "--truth", "truth.vtp")
        self.program("segment", "scan.mha", "-o", "beads.csv", "--bridges", "bridges.csv", "--labels", "labels.mha")
        self.program("pack", "beads.csv", "--sample", "sample.toml", "--bridges", "bridges.csv", "-o", "packing.vtp")
        self.program("modulus", "packing.vtp", "--sample", "sample.toml", "-o", "modulus.json")

        volume, truth = pendular.phantom(self.sample)
        scan = pendular.read_volume(self.folder / "scan.mha")
        np.testing.assert_array_equal(volume.grey, scan.grey)
        pendular.write_packing(self.folder / "our_truth.vtp", truth)
        ours, theirs = self.read_both(pendular.read_packing, "our_truth.vtp", "truth.vtp")
        self.assert_same(ours.bridges, theirs.bridges)

        found = pendular.segment(scan, bridges=True)
        pendular.write_beads(self.folder / "our_beads.csv", found.beads)
        pendular.write_bridges(self.folder / "our_bridges.csv", found.beads, found.bridges)
        for name in ("beads.csv", "bridges.csv"):
            self.assertEqual(*self.read_both(rows, "our_" + name, name))
        labels = pendular.read_volume(self.folder / "labels.mha")
        np.testing.assert_array_equal(found.labels(scan).grey, labels.grey)

        beads = pendular.read_beads(self.folder / "beads.csv")
        bridges = pendular.read_bridges(self.folder / "bridges.csv", beads)
        packing, report = pendular.pack_report(beads, self.sample, bridges=bridges)
        pendular.write_packing(self.folder / "our_packing.vtp", packing)
        ours, theirs = self.read_both(pendular.read_packing, "our_packing.vtp", "packing.vtp")
        self.assert_same(ours.beads, theirs.beads)
        self.assert_same(ours.bridges, theirs.bridges)
        self.assertEqual(report, self.json("packing.json"))
        self.assertEqual(without(pendular.modulus(theirs, self.sample), "provenance"), self.json("modulus.json"))

    def test_compression_and_its_folder(self):
        self.program("pack", "--generate", "--sample", "sample.toml", "-o", "packing.vtp")
        self.program("compress", "packing.vtp", "--sample", "sample.toml", "--seed", "3", "-o", "theirs")
        run = pendular.compress(self.folder / "packing.vtp", self.sample, self.folder / "ours", seed=3)
        for name in ("curve.csv", "events.csv", "avalanches.csv"):
            self.assertEqual(*self.read_both(rows, f"ours/{name}", f"theirs/{name}"))
        self.assertTrue(run.frames)
        for frame in run.frames:
            self.assertEqual(frame.read_bytes(), (self.folder / "theirs" / "frames" / frame.name).read_bytes())
        theirs = pendular.read_run(self.folder / "theirs")
        self.assertEqual(without(run.result, "provenance", "performance"),
                         without(theirs.result, "provenance", "performance"))
        self.assertEqual(run.curve.dtype.names, theirs.curve.dtype.names)
        np.testing.assert_allclose(run.curve["stress_pa"], theirs.curve["stress_pa"], rtol=1e-8)  # 9 digits in files
        self.assertEqual(len(run.events), run.result["broken_bonds"])

    def test_generated_packing(self):
        self.program("pack", "--generate", "--sample", "sample.toml", "--seed", "2", "-o", "packing.vtp")
        pendular.write_packing(self.folder / "ours.vtp", pendular.generate(self.sample, seed=2))
        ours, theirs = self.read_both(pendular.read_packing, "ours.vtp", "packing.vtp")
        self.assert_same(ours.beads, theirs.beads)
        self.assert_same(ours.bridges, theirs.bridges)

    def test_bridge_table(self):
        self.program("bridge", "--d-um", "60,80", "--gap-um", "1,2", "-o", "bridges.csv")
        theirs = pendular.read_table(self.folder / "bridges.csv")
        ours = pendular.bridge(d_um=[[60.0, 80.0]], gap_um=[[1.0], [2.0]])
        self.assertEqual(ours.shape, (2, 2))
        for name in ("kn_n_per_m", "kt_n_per_m", "k_bend_n_m_per_rad"):
            self.assertEqual([f"{value:.9g}" for value in ours[name].ravel()], [f"{value:.9g}" for value in theirs[name]])

    def test_sweep_finds_the_runs_of_the_command(self):
        (self.folder / "sweep.toml").write_text(
            '[sweep]\nname = "ends"\nsample = "sample.toml"\n[grid]\n"compression.max_strain" = [0.005, 0.006]\n')
        self.program("sweep", "sweep.toml", "-o", "theirs", "--store", "store")
        runs = self.folder / "store" / "runs"
        made = {path: path.stat().st_mtime_ns for path in runs.iterdir()}
        done = pendular.sweep(self.folder / "sweep.toml", self.folder / "ours", store=self.folder / "store")
        for name in ("results.csv", "summary.csv"):
            self.assertEqual(*self.read_both(rows, f"ours/{name}", f"theirs/{name}"))
        self.assertEqual(done.failed, [])
        self.assertEqual({folder.name for folder in done.folders}, {path.name for path in made})

        told = pendular.sweep({"sweep": {"name": "ends", "sample": self.sample},
                               "grid": {"compression.max_strain": np.array([0.005, 0.006])}},
                              self.folder / "told", store=self.folder / "store")
        self.assert_same(told.summary, done.summary)
        self.assertEqual({path: path.stat().st_mtime_ns for path in runs.iterdir()}, made)

    def test_track(self):
        before = pendular.generate(self.sample).beads
        after = before.copy()
        after["z_m"] *= 0.98
        pendular.write_beads(self.folder / "before.csv", before)
        pendular.write_beads(self.folder / "after.csv", after)
        self.program("track", "before.csv", "after.csv", "-o", "theirs.csv")
        track = pendular.track(self.folder / "before.csv", self.folder / "after.csv")
        track.write(self.folder / "ours.csv")
        self.assertEqual(*self.read_both(rows, "ours.csv", "theirs.csv"))
        self.assertEqual(len(track.beads), len(before))


if __name__ == "__main__":
    unittest.main()
