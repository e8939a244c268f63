"""A diagnosis from values, and what is told of one that cannot be made."""

import unittest

import numpy as np

import pendular
from support import RELAXED, InScratchFolder

ALL_BUT = {"bead_friction"}


def curve(run):
    table = np.zeros(len(run.curve), dtype=[("strain", float), ("stress_pa", float)])
    table["strain"], table["stress_pa"] = run.curve["strain"], run.curve["stress_pa"]
    return table


class Diagnosis(InScratchFolder):
    sample_text = RELAXED.replace("1500", "1100")

    def diagnose(self, table, **how):
        left_out = [effect["id"] for effect in pendular.effects() if effect["id"] not in ALL_BUT]
        return pendular.diagnose({"experiment": {"sample": self.sample},
                                  "observation": [{"kind": "compression", "file": table}]},
                                 self.folder / "report", leave_out=left_out, levels=1, runs=0, fresh_runs=False, **how)

    def test_report_and_command_agree(self):
        run = pendular.compress(pendular.generate(self.sample, seed=5), self.sample, self.folder / "run", seed=5)
        found = self.diagnose(curve(run))
        self.assertTrue(found.report.exists())
        self.assertTrue(found.verdict)
        self.assertEqual(found.data["verdict"], found.verdict)
        self.assertAlmostEqual(sum(found.probabilities.values()), 1.0, places=3)
        left_out = [effect["id"] for effect in pendular.effects() if effect["id"] not in ALL_BUT]
        self.program("diagnose", "report/experiment.toml", "-o", "theirs", "--store", "report/store", "--levels", "1",
                     "--runs", "0", "--no-fresh-runs", "--leave-out", ",".join(left_out))
        for table in ("report/gap.csv", "report/explanations.csv"):
            ours, theirs = self.folder / table, self.folder / table.replace("report", "theirs")
            if ours.exists():
                self.assertEqual([l for l in ours.read_text().splitlines() if l[0] != "#"],
                                 [l for l in theirs.read_text().splitlines() if l[0] != "#"])

    def test_what_is_wrong_with_a_table_is_told_before_any_run(self):
        table = np.zeros(3, dtype=[("strain", float), ("stress_mpa", float)])
        with self.assertRaisesRegex(pendular.InputError, "stress_pa"):
            self.diagnose(table)
        self.assertFalse((self.folder / "report" / "store" / "runs").exists())
        with self.assertRaisesRegex(pendular.InputError, "leave_out: found the text"):
            pendular.diagnose("e.toml", self.folder / "out", leave_out="bead_friction")
        with self.assertRaisesRegex(pendular.InputError, "experiment.toml|observation"):
            pendular.diagnose({"experiment": {"sample": self.sample}, "observation": 3}, self.folder / "report")
        with self.assertRaisesRegex(pendular.InputError, "levels: found 9"):
            pendular.diagnose("e.toml", self.folder / "out", levels=9)


if __name__ == "__main__":
    unittest.main()
