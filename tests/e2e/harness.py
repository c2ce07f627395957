"""Runs the built programs as a user would: daemons and clients as processes over loopback."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

BIN = pathlib.Path(os.environ["ATLASWIRE_BIN"])
SCENE = "atrium:0.05"


def exit_line(process):
    """What a failed program said: (exit code, stderr lines)."""
    return process.returncode, process.stderr.strip().splitlines()


def run(program, *arguments, timeout=60, **more):
    """One program to its end."""
    return subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **more)


class Daemon:
    """An atlasd on a free port of loopback, ready when constructed; ends with the test."""

    def __init__(self, test, *arguments, scene=SCENE, stdout=None):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="atlaswire-e2e-"))
        test.addCleanup(lambda: subprocess.run(["rm", "-rf", self.folder], check=False))
        ready = self.folder / "ready.json"
        self.log_path = self.folder / "atlasd.log"
        self.log_file = open(self.log_path, "w")
        self.process = subprocess.Popen(
            [BIN / "atlasd", "--scene", scene, "--port", "0", "--ready-file", ready, "--atlas", "512x512",
             "--stats-interval", "1", "--max-runtime", "240", *map(str, arguments)],
            stdout=stdout or self.log_file, stderr=self.log_file)
        test.addCleanup(self.stop)
        end = time.monotonic() + 90
        while not ready.exists():
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError("atlasd did not start:\n" + self.log())
            time.sleep(0.05)
        self.port = json.loads(ready.read_text())["port"]

    def stop(self):
        """SIGTERM, and the exit code of the drain."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        finally:
            self.log_file.close()
        return code

    def log(self):
        return self.log_path.read_text()


class Client:
    """An atlas-client of a daemon, running in the background."""

    def __init__(self, test, port, *arguments, duration=6, rate=20):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="atlaswire-e2e-"))
        test.addCleanup(lambda: subprocess.run(["rm", "-rf", self.folder], check=False))
        self.process = subprocess.Popen(
            [BIN / "atlas-client", "--connect", f"127.0.0.1:{port}", "--path", "atrium", "--size", "320x180", "--rate", str(rate),
             "--duration", str(duration), "--out", self.folder, *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        test.addCleanup(self.process.kill)

    def finish(self, timeout=120):
        """Waits for the end; (exit code, stderr)."""
        out, err = self.process.communicate(timeout=timeout)
        return self.process.returncode, out + err

    def summary(self):
        return json.loads((self.folder / "summary.json").read_text())

    def pair_times(self):
        """Seconds at which each new pair was first shown, since the first picture."""
        rows = [line.split(",") for line in (self.folder / "stages.csv").read_text().splitlines()]
        names = rows[0]
        at, first = names.index("display_start_ms"), names.index("first")
        return [float(row[at]) / 1000 for row in rows[1:] if row[first] == "1"]


def main():
    unittest.main(verbosity=2)
