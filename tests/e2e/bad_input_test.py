"""Bad flags, files, peers and devices: one clear line, a distinct exit code."""

import os
import signal
import socket
import struct
import tempfile
import time
import unittest

from harness import SCENE, Client, Daemon, exit_line, main, run


class BadInput(unittest.TestCase):
    def expect(self, process, code, *words):
        got, lines = exit_line(process)
        self.assertEqual(got, code, lines)
        errors = [line for line in lines if "error" in line]
        self.assertEqual(len(errors), 1, lines)
        for word in words:
            self.assertIn(word, errors[0])

    def test_scenes(self):
        self.expect(run("atlasd", "--scene", "missing.glb"), 3, "missing.glb")
        with tempfile.NamedTemporaryFile(suffix=".glb") as broken:
            broken.write(b"glTF\x02\0\0\0 this is no scene")
            broken.flush()
            self.expect(run("atlasd", "--scene", broken.name), 3, broken.name)
        self.expect(run("atlasd", "--scene", "atrium:17"), 3, "17")

    def test_options_and_config_files(self):
        self.expect(run("atlasd", "--colour", "red"), 2, "--colour")
        self.expect(run("atlasd", "--atlas", "12x"), 2, "12x")
        self.expect(run("atlasd", "--port", "70000"), 2, "port")
        self.expect(run("atlas-client", "--connect", "nowhere"), 2, "nowhere")
        self.expect(run("atlas-client", "--connect", "127.0.0.1:1", "--speed", "3"), 2, "--speed")
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as config:
            config.write('atlas = "1000000x2"\n')
            config.flush()
            self.expect(run("atlasd", "--config", config.name), 2, "1000000x2")

    def test_no_vulkan_device(self):
        nothing = dict(os.environ, VK_DRIVER_FILES="/nonexistent.json", VK_ICD_FILENAMES="/nonexistent.json")
        self.expect(run("atlasd", "--scene", SCENE, env=nothing), 4, "mesa-vulkan-drivers")
        self.expect(run("atlasd", "--scene", SCENE, "--device", "voodoo"), 4, "voodoo")

    def test_port_in_use(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            self.expect(run("atlasd", "--scene", SCENE, "--atlas", "512x512", "--port", port), 5, str(port))

    def test_nobody_listens(self):
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
            self.expect(run("atlas-client", "--connect", f"127.0.0.1:{port}", "--wait", "0.5"), 6, str(port))

    def test_a_bad_path_file_and_an_unwritable_folder(self):
        daemon = Daemon(self)
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as path:
            path.write("0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1\n")
            path.flush()
            client = run("atlas-client", "--connect", f"127.0.0.1:{daemon.port}", "--path", path.name)
            self.expect(client, 3, "line 2")
        client = run("atlas-client", "--connect", f"127.0.0.1:{daemon.port}", "--out", "/proc/no-such-folder")
        self.expect(client, 9, "/proc/no-such-folder")

    def test_a_server_that_speaks_another_protocol(self):
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            listener.listen()
            port = listener.getsockname()[1]
            client = Client(self, port, duration=3)
            peer, _ = listener.accept()
            with peer:
                peer.recv(4096)
                peer.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
                code, output = client.finish()
        self.assertIn(code, (6, 8), output)
        self.assertEqual(sum("error" in line for line in output.splitlines()), 1, output)

    def test_a_version_from_the_future_is_refused(self):
        daemon = Daemon(self)
        # Envelope { client_hello = 1 { version_min: 900, version_max: 901, display: 640x360, vertical_fov: 1,
        # max_atlas: 2048x2048, meta_codecs: [1] } }, see docs/PROTOCOL.md.
        hello = (b"\x08\x84\x07\x10\x85\x07" b"\x22\x06\x08\x80\x05\x10\xe8\x02" + b"\x29" + struct.pack("<d", 1.0) +
                 b"\x32\x06\x08\x80\x10\x10\x80\x10" b"\x3a\x01\x01")
        envelope = b"\x0a" + bytes([len(hello)]) + hello
        with socket.create_connection(("127.0.0.1", daemon.port)) as connection:
            connection.sendall(struct.pack(">I", len(envelope)) + envelope)
            connection.settimeout(10)
            answer = b""
            while chunk := connection.recv(4096):
                answer += chunk
        self.assertGreater(len(answer), 4, daemon.log())
        self.assertIn(b"version", answer.lower())

    def test_a_server_killed_in_mid_frame(self):
        daemon = Daemon(self, "--fps", "6")
        client = Client(self, daemon.port, duration=60)
        time.sleep(5)
        daemon.process.send_signal(signal.SIGKILL)
        daemon.process.wait(10)
        code, output = client.finish()
        self.assertEqual(code, 8, output)
        self.assertTrue((client.folder / "summary.json").exists(), "what it had is written")

    def test_a_drained_daemon_lets_its_client_end_well(self):
        daemon = Daemon(self, "--fps", "6")
        client = Client(self, daemon.port, duration=60)
        time.sleep(5)
        self.assertEqual(daemon.stop(), 0)
        code, output = client.finish()
        self.assertIn(code, (0, 8), output)
        self.assertGreater(client.summary()["frames"]["paired"], 0)

    def test_interrupting_the_client_keeps_its_summary(self):
        daemon = Daemon(self)
        client = Client(self, daemon.port, duration=60)
        time.sleep(5)
        client.process.send_signal(signal.SIGINT)
        code, output = client.finish()
        self.assertEqual(code, 0, output)
        self.assertGreater(client.summary()["frames"]["paired"], 0)


if __name__ == "__main__":
    main()
