"""Two clients at once, pictures, and ffmpeg on the mirrored stream; Vulkan validation on."""

import socket
import subprocess
import unittest

from harness import SCENE, Client, Daemon, main


class Stream(unittest.TestCase):
    def test_two_clients_at_once_under_validation(self):
        daemon = Daemon(self, "--validation", "--fps", "4")
        clients = [
            Client(self, daemon.port, "--validation", "--reference", SCENE, "--samples", "4", "--at-server-pose", duration=8)
            for _ in range(2)
        ]
        for client in clients:
            code, output = client.finish()
            self.assertEqual(code, 0, output + daemon.log())
            self.assertNotIn("validation", output.lower(), output)
            summary = client.summary()
            self.assertGreaterEqual(summary["frames"]["paired"], 6, summary)
            self.assertEqual(summary["frames"]["lost"], 0)
            self.assertGreater(summary["mssim"], 0.75, summary["samples"])
            self.assertGreater(summary["coverage"], 0.99, summary["samples"])
            for stage in ("client_to_server", "server_idle", "server_processing", "server_to_client", "client_decoding",
                          "client_idle", "client_rendering", "display_age"):
                self.assertGreaterEqual(summary["stages_ms"][stage], 0, stage)
            self.assertGreater(summary["stages_ms"]["server_processing"], 0)
            self.assertTrue((client.folder / "side_by_side.png").stat().st_size > 10_000)
        self.assertEqual(daemon.stop(), 0)
        self.assertNotIn("VUID", daemon.log())
        self.assertNotIn("alidation error", daemon.log())

    def test_a_moving_scene_is_shown_where_it_was(self):
        daemon = Daemon(self, "--validation", "--fps", "6", scene="parade")
        client = Client(self, daemon.port, "--validation", "--reference", "parade", "--samples", "4", "--at-server-pose",
                        duration=6)
        code, output = client.finish()
        self.assertEqual(code, 0, output + daemon.log())
        summary = client.summary()
        self.assertGreaterEqual(summary["frames"]["paired"], 6, summary)
        self.assertGreater(summary["mssim"], 0.97, summary["samples"])
        self.assertGreater(summary["coverage"], 0.999, summary["samples"])
        self.assertEqual(daemon.stop(), 0)
        self.assertNotIn("VUID", daemon.log() + output)

    def test_ffmpeg_plays_the_mirrored_stream_from_the_printed_sdp(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1] & ~1
        daemon = Daemon(self, "--fps", "8", "--mirror", f"127.0.0.1:{port}", "--print-sdp", stdout=subprocess.PIPE)
        sdp = daemon.folder / "stream.sdp"
        lines = []
        while not lines or not lines[-1].startswith("a=rtpmap"):
            lines.append(daemon.process.stdout.readline().decode())
            self.assertTrue(lines[-1], "the SDP ended early: " + "".join(lines))
        sdp.write_text("".join(lines) + "a=fmtp:96 packetization-mode=1\n")
        decoder = subprocess.Popen(
            ["ffmpeg", "-v", "error", "-protocol_whitelist", "file,udp,rtp", "-i", sdp, "-frames:v", "8", "-an",
             "-f", "rawvideo", "-pix_fmt", "gray", "-y", daemon.folder / "frames.raw"],
            stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(decoder.kill)
        client = Client(self, daemon.port, duration=20)
        _, errors = decoder.communicate(timeout=90)
        frames = (daemon.folder / "frames.raw").read_bytes()
        self.assertEqual(len(frames), 8 * 512 * 512, errors.decode())
        last = frames[-512 * 512:]
        self.assertGreater(len(set(last)), 64, "the last picture is more than flat grey")
        client.process.terminate()
        code, output = client.finish()
        self.assertEqual(code, 0, output)
        self.assertGreater(client.summary()["frames"]["paired"], 5)
        daemon.process.stdout.close()


if __name__ == "__main__":
    main()
