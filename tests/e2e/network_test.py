"""Daemon and client through atlas-netsim: delay and loss never mix a pair, and the picture comes back."""

import json
import subprocess
import time
import unittest

from harness import BIN, SCENE, Client, Daemon, main

PROFILE = """name = "test"
[both]
delay = {{ base_ms = {delay} }}
loss = {{ kind = "bernoulli", probability = {loss} }}
"""


class Network(unittest.TestCase):
    def relay(self, daemon, delay_ms, loss):
        """An atlas-netsim before the daemon; its port."""
        name = f"{delay_ms}-{loss}"
        profile = daemon.folder / f"{name}.toml"
        profile.write_text(PROFILE.format(delay=delay_ms / 2, loss=loss))
        ready = daemon.folder / f"{name}.json"
        process = subprocess.Popen(
            [BIN / "atlas-netsim", "--listen", "0", "--to", f"127.0.0.1:{daemon.port}", "--profile", profile, "--seed", "7",
             "--duration", "60", "--ready-file", ready],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait, 10)
        self.addCleanup(process.terminate)
        end = time.monotonic() + 10
        while not ready.exists():
            self.assertIsNone(process.poll(), "atlas-netsim ended")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        return json.loads(ready.read_text())["port"]

    def stream_through(self, loss):
        """Runs of 0, 20 and 100 ms at one loss rate; prints how long the picture stood still at most."""
        daemon = Daemon(self, "--fps", "6", "--bitrate", "800k")
        for delay_ms in (0, 20, 100):
            port = self.relay(daemon, delay_ms, loss)
            client = Client(self, port, "--reference", SCENE, "--samples", "3", "--at-server-pose", "--wait", "10", duration=6, rate=15)
            code, output = client.finish()
            self.assertEqual(code, 0, output + daemon.log())
            summary = client.summary()
            times = client.pair_times()
            still = max((b - a for a, b in zip(times, times[1:])), default=0)
            print(f"{delay_ms:4} ms, {100 * loss:g} % loss: {summary['frames']['paired']} of {summary['frames']['announced']} "
                  f"frames paired, longest still {1000 * still:.0f} ms, MSSIM {summary['mssim']:.3f}, "
                  f"coverage {100 * summary['coverage']:.2f} %, pose to display {summary['latency_ms']['pose_to_display']['p50']:.0f} ms")
            self.assertGreaterEqual(len(times), 3 if loss < 0.05 else 1, output)
            # A picture and geometry of different frames would show wrong blocks all over.
            self.assertGreater(summary["mssim"], 0.6, summary["samples"])
            self.assertGreater(summary["coverage"], 0.98, summary["samples"])
            if loss == 0:
                self.assertEqual(summary["frames"]["lost"], 0, summary["frames"])
            self.assertGreaterEqual(summary["latency_ms"]["pose_to_display"]["p50"], delay_ms)

    def test_no_loss(self):
        self.stream_through(0)

    def test_one_percent_loss(self):
        self.stream_through(0.01)

    def test_five_percent_loss(self):
        self.stream_through(0.05)


if __name__ == "__main__":
    main()
