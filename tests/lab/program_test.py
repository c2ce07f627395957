"""atlas-lab as a program, with a stand-in for rendering: sweeps, resuming, interrupts, merging, errors.

Usage: program_test.py FAKE_LAB    the program of fake_lab.cpp"""

import csv
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

LAB = pathlib.Path(sys.argv.pop()).resolve()
FAILING_SEED, WAITING_SEED = 13, 99
EXPERIMENT = """
name = "small"
title = "A small one"
[settings]
seconds = 1
[[variant]]
name = "ours"
method = "sas"
[[variant]]
name = "ATW"
method = "atw"
[sweep]
latency_ms = [0, 50, 100]
[[plot]]
x = "latency_ms"
y = ["mssim"]
[crossover]
x = "latency_ms"
y = "mssim"
reference = "ours"
[difference]
y = "mssim"
reference = "ours"
"""


def lab(*words, **more):
    return subprocess.run([LAB, *map(str, words)], capture_output=True, text=True, timeout=60, **more)


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="atlaswire-lab-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.out = self.root / "out"
        self.file = self.root / "small.toml"
        self.file.write_text(EXPERIMENT)

    def run_small(self, *words, out=None):
        return lab("run", self.file, "--out", out or self.out, "--no-report", *words)

    def results(self, out=None):
        return sorted((out or self.out).glob("points/*/result.json"))

    def test_run_makes_tables(self):
        done = self.run_small("--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.out / "results.csv") as lines:
            rows = list(csv.DictReader(lines))
        self.assertEqual([(r["variant"], r["latency_ms"]) for r in rows],
                         [(v, x) for v in ("ours", "ATW") for x in ("0", "50", "100")])
        self.assertEqual(rows[0]["mssim"], "0.945")
        self.assertEqual(rows[3]["atlas_used"], "")
        self.assertNotIn("wall_s", rows[0])
        self.assertIn("wall_s", (self.out / "timings.csv").read_text())
        self.assertEqual(len((self.out / "frames.csv").read_text().splitlines()), 13)
        results = json.loads((self.out / "results.json").read_text())
        self.assertEqual(results["provenance"]["device"], ["paper and pencil"])
        self.assertAlmostEqual(results["analysis"]["crossovers"][0]["at"][0]["x"], 50)
        self.assertEqual(done.stderr.count("done in"), 6, "a line a point where stderr is no terminal")

    def test_two_runs_give_the_same_tables(self):
        other = self.root / "other"
        self.run_small("--jobs", 2)
        self.run_small("--jobs", 1, out=other)
        for name in ("results.csv", "frames.csv"):
            self.assertEqual((self.out / name).read_bytes(), (other / name).read_bytes())

    def test_a_second_run_keeps_finished_points(self):
        self.run_small()
        stamps = {p: p.stat().st_mtime_ns for p in self.results()}
        gone = self.results()[2]
        gone.unlink()
        self.assertEqual(self.run_small().returncode, 0)
        self.assertEqual(len(self.results()), 6)
        changed = [p for p in self.results() if p.stat().st_mtime_ns != stamps[p]]
        self.assertEqual(changed, [gone])

    def interrupt(self, number):
        """A sweep that hangs in its second variant's point, told to end; its exit code and standard error."""
        waiting = self.root / "waiting.toml"
        waiting.write_text("name = \"waiting\"\n[sweep]\nseed = [1, 2, %d, 4]\n" % WAITING_SEED)
        sweep = subprocess.Popen([LAB, "run", waiting, "--out", self.out, "--jobs", "1", "--no-report"],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(sweep.kill)
        end = time.monotonic() + 30
        while not list(self.out.glob("points/*/waiting")):
            self.assertLess(time.monotonic(), end, "the sweep did not reach the waiting point")
            self.assertIsNone(sweep.poll())
            time.sleep(0.01)
        sweep.send_signal(number)
        _, errors = sweep.communicate(timeout=30)
        return sweep.returncode, errors, waiting

    def test_interrupts_keep_what_is_finished(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                code, errors, waiting = self.interrupt(number)
                self.assertEqual(code, 130, errors)
                self.assertIn("2 finished points are kept", errors)
                self.assertEqual(len(self.results()), 2)
                self.assertEqual(len(list(self.out.glob("points/*"))), 2, "the interrupted point leaves nothing")
                self.assertEqual(len((self.out / "results.csv").read_text().splitlines()), 3)
                again = lab("run", waiting, "--out", self.out, "--set", "seed=1,2,4", "--no-report")
                self.assertEqual(again.returncode, 0)
                self.assertEqual(again.stderr.count("done in"), 1)
                for folder in self.out.glob("points/*"):
                    subprocess.run(["rm", "-r", folder], check=True)

    def test_a_failing_point_does_not_stop_the_others(self):
        done = self.run_small("--set", f"seed=1,{FAILING_SEED},3", "--only", "ATW", "--set", "latency_ms=0")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(self.results()), 2)
        self.assertRegex(done.stderr, rf"failed: ATW, seed {FAILING_SEED} \(point [0-9a-f]{{16}}, exit code 4\): .*no device of this kind")

    def test_points_of_another_commit_are_refused(self):
        self.run_small()
        record = json.loads(self.results()[0].read_text())
        record["provenance"]["commit"] = "0123456789ab"
        self.results()[0].write_text(json.dumps(record))
        refused = self.run_small()
        self.assertEqual(refused.returncode, 2)
        self.assertIn("holds points of commit 0123456789ab", refused.stderr)
        self.assertEqual(len(refused.stderr.splitlines()), 1)
        self.assertEqual(self.run_small("--force").returncode, 0)
        self.assertEqual(self.run_small("--fresh").returncode, 0)
        self.assertNotIn("0123456789ab", (self.out / "results.json").read_text())

    def test_planned_commands_merge_to_the_same_tables(self):
        self.run_small()
        commands = lab("plan", self.file, "--out", self.root / "spread").stdout.splitlines()
        self.assertEqual(len(commands), 6)
        halves = [self.root / "one", self.root / "two"]
        for index, command in enumerate(commands):
            command = command.replace(str(self.root / "spread"), str(halves[index % 2]))
            done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(lab("merge", *halves, "--out", self.root / "both").returncode, 0)
        self.assertEqual((self.root / "both" / "results.csv").read_bytes(), (self.out / "results.csv").read_bytes())

    def test_folders_of_different_plans_do_not_merge(self):
        self.run_small(out=self.root / "one")
        self.run_small("--set", "latency_ms=0", out=self.root / "two")
        refused = lab("merge", self.root / "one", self.root / "two", "--out", self.root / "both")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("different plans", refused.stderr)

    def test_report_makes_a_page_that_needs_nothing_else(self):
        probe = subprocess.run(["/usr/bin/python3", "-c", "import matplotlib"], capture_output=True)
        if probe.returncode != 0:
            self.skipTest("no matplotlib")
        self.run_small()
        done = lab("report", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        text = (self.out / "report.html").read_text()
        self.assertIn("A small one", text)
        self.assertIn("data:image/png;base64,", text)
        self.assertIn("from 50 on ours is better", text)
        self.assertIn("<td>latency_ms 50</td><td>ATW</td><td>0.935</td><td>+0.0000</td>", text)
        self.assertNotRegex(text, r"(src|href)=.?(http|plots/|points/)")
        self.assertEqual(len(list(self.out.glob("plots/*.svg"))), 1)

    def test_errors_are_one_line(self):
        self.file.write_text("name = \"x\"\n[settings]\nlatenzy_ms = 3\n")
        for words, code, said in (
                (("run", self.file), 2, "did you mean latency_ms?"),
                (("run", "no-such"), 2, "atlas-lab list names"),
                (("run", "latency", "--set", "views=99"), 2, "views = 99: must be a whole number 1..16"),
                (("run", "latency", "--scene", "nowhere.glb"), 3, "nowhere.glb"),
                (("run", "latency", "--quick", "--point", "abc", "--out", self.out), 2, "--point abc"),
                (("report", self.root), 2, "holds no plan.json"),
                (("show", "no-such"), 2, "must be a name that atlas-lab list gives"),
                (("compare", "nowhere.png", "nowhere.png"), 2, "nowhere.png"),
                (("run", "latency", "--quick", "--out", "/proc/no"), 9, "cannot make the folder")):
            with self.subTest(words):
                failed = lab(*words)
                self.assertEqual(failed.returncode, code, failed.stderr)
                self.assertEqual(len(failed.stderr.splitlines()), 1, failed.stderr)
                self.assertIn(said, failed.stderr)

    def test_list_show_and_keys(self):
        listed = lab("list").stdout
        for name in ("latency", "upsampling", "bitrate", "amortization", "causes", "endtoend", "latency-bitrate", "network",
                     "tradeoff"):
            self.assertIn(f"\n{name} ", "\n" + listed)
        self.assertIn("[SAS] fig. 13", lab("show", "latency").stdout)
        self.assertIn("latency_ms", lab("keys").stdout)

    def test_json_on_stdout(self):
        done = self.run_small("--json")
        self.assertEqual(len(json.loads(done.stdout)["points"]), 6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
