"""Whatever one peer does, the others' frame rate stays."""

import os
import random
import signal
import socket
import threading
import time
import unittest

from harness import Client, Daemon, main

FPS = 4
SECONDS = 9


class Neighbours(unittest.TestCase):
    def watch(self, misbehave):
        """Frame rates of an honest client before and while `misbehave(daemon)` runs."""
        daemon = Daemon(self, "--fps", str(FPS))
        honest = Client(self, daemon.port, rate=10, duration=2 * SECONDS + 4)
        start = time.monotonic()
        time.sleep(SECONDS + 2)
        misbehave(daemon)
        elapsed = time.monotonic() - start
        code, output = honest.finish()
        self.assertEqual(code, 0, output + daemon.log())
        times = honest.pair_times()
        middle = elapsed - (SECONDS - 1)
        before = sum(1 for t in times if middle - SECONDS < t <= middle) / min(SECONDS, middle)
        after = sum(1 for t in times if middle < t <= middle + SECONDS - 2) / (SECONDS - 2)
        self.assertGreater(before, 0.6 * FPS, f"no sound rate to compare with: {times}")
        self.assertGreater(after, 0.75 * before, f"{before:.2f} fps before, {after:.2f} fps while a neighbour misbehaved\n" + daemon.log())
        self.assertEqual(honest.summary()["frames"]["lost"], 0)
        self.assertEqual(daemon.stop(), 0)
        return daemon

    def test_a_client_killed_in_mid_frame(self):
        def misbehave(daemon):
            victim = Client(self, daemon.port, rate=5, duration=60)
            time.sleep(2.5)
            victim.process.send_signal(signal.SIGKILL)
            time.sleep(SECONDS - 3.5)

        daemon = self.watch(misbehave)
        self.assertIn("session 2", daemon.log())

    def test_a_flood_of_garbage_datagrams(self):
        def misbehave(daemon):
            rng = random.Random(7)
            packets = [rng.randbytes(rng.randint(1, 1400)) for _ in range(64)]
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as flood:
                end = time.monotonic() + SECONDS - 1
                sent = 0
                while time.monotonic() < end:  # about 4000 packets a second
                    for packet in packets[:8]:
                        flood.sendto(packet, ("127.0.0.1", daemon.port))
                    rng.shuffle(packets)
                    sent += 8
                    time.sleep(0.002)
            self.assertGreater(sent, 5000)

        self.watch(misbehave)

    def test_silent_and_babbling_tcp_connections(self):
        def misbehave(daemon):
            silent = [socket.create_connection(("127.0.0.1", daemon.port)) for _ in range(6)]
            babbling = [socket.create_connection(("127.0.0.1", daemon.port)) for _ in range(4)]
            for n, connection in enumerate(babbling):
                connection.sendall(b"\xff\xff\xff\xff" if n % 2 else os.urandom(400))
            time.sleep(SECONDS - 1)
            for connection in silent + babbling:
                connection.settimeout(1)
                try:  # a refusal may precede the end
                    while connection.recv(4096):
                        pass
                    closed = True
                except ConnectionError:
                    closed = True
                except socket.timeout:
                    closed = False
                self.assertTrue(closed, "a connection without a hello is closed after 5 s")
                connection.close()

        self.watch(misbehave)


if __name__ == "__main__":
    main()
