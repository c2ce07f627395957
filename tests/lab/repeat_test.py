"""A small experiment in virtual time, run twice with real pictures: whole tables must be equal byte for byte.

Usage: repeat_test.py ATLAS_LAB"""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

LAB = pathlib.Path(sys.argv.pop()).resolve()
EXPERIMENT = """
name = "repeat"
title = "Every method, coded, direct and over a network that loses packets"
[settings]
scene = "atrium:0.05"
seconds = 0.5
display = "160x96"
atlas = "512x512"
server_hz = 10
client_hz = 20
measure_every = 3
bitrate_mbps = 4
depth = "coded"
[[variant]]
name = "SAS"
method = "sas"
[[variant]]
name = "SAS through lenses"
method = "sas"
stereo = true
lens = "generic"
[[variant]]
name = "ATW"
method = "atw"
[[variant]]
name = "mesh warp"
method = "mesh"
[[variant]]
name = "iterative warp"
method = "iterative"
[sweep]
profile = ["", "lossy-wifi"]
"""
METHODS, MEASURED = 5, 3


class TwoRuns(unittest.TestCase):
    def tables(self, root, name, jobs):
        """The two tables of a run of its own, the ground truth drawn anew."""
        out = root / name
        done = subprocess.run([LAB, "run", root / "repeat.toml", "--out", out, "--jobs", str(jobs), "--no-report"],
                              capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [(out / table).read_bytes() for table in ("results.csv", "frames.csv")]

    def test_give_the_same_tables(self):
        with tempfile.TemporaryDirectory(prefix="atlaswire-repeat-") as folder:
            root = pathlib.Path(folder)
            (root / "repeat.toml").write_text(EXPERIMENT)
            results, frames = self.tables(root, "two-at-once", 2)
            again = self.tables(root, "one-at-once", 1)
        rows = list(csv.DictReader(results.decode().splitlines()))
        self.assertEqual(len(rows), 2 * METHODS)
        self.assertEqual(len({row["mssim"] for row in rows}), 2 * METHODS, "each point is measured by itself")
        self.assertEqual(len(frames.decode().splitlines()), 1 + 2 * METHODS * MEASURED)
        self.assertEqual(results, again[0])
        self.assertEqual(frames, again[1])


if __name__ == "__main__":
    unittest.main(verbosity=2)
