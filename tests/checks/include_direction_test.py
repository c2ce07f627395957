#!/usr/bin/env python3
"""The include check catches what it is there to catch."""
import pathlib
import tempfile
import unittest

import include_direction


def faults_of(files):
    """Reasons found in a temporary tree of {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return [(name, number) for name, number, _, _ in include_direction.offending_lines(root)]


class IncludeDirection(unittest.TestCase):
    def test_accepts_downward_includes(self):
        self.assertEqual(faults_of({
            "base/a.h": "#include <vector>\n",
            "codec/a.cpp": '#include "base/a.h"\n#include "codec/a.h"\nextern "C" {\n#include <libavcodec/avcodec.h>\n}\n',
            "server/a.cpp": '#include "render/a.h"\n#include <boost/asio/post.hpp>\n',
            "netsim/relay.cpp": "#include <boost/asio.hpp>\n",
            "lab/a.cpp": '#include "server/a.h"\n#include "netsim/a.h"\n',
        }), [])

    def test_catches_every_forbidden_arrow(self):
        for path, include in [
            ("base/a.h", '"codec/video.h"'), ("codec/a.cpp", '"proto/rtp.h"'), ("proto/a.h", '"codec/video.h"'),
            ("netsim/a.cpp", '"proto/rtp.h"'), ("render/a.cpp", '"codec/video.h"'), ("render/a.cpp", '"server/a.h"'),
            ("server/a.cpp", '"client/a.h"'), ("client/a.cpp", '"server/a.h"'), ("server/a.cpp", '"netsim/link.h"'),
            ("client/a.h", '"lab/a.h"'), ("render/gpu/a.h", '"proto/rtp.h"'),
        ]:
            with self.subTest(path=path, include=include):
                self.assertEqual(faults_of({path: f"// first line\n  #  include {include}\n"}), [(path, 2)])

    def test_catches_libraries_out_of_place(self):
        for path, include in [
            ("proto/a.cpp", "<boost/asio/buffer.hpp>"), ("netsim/link.cpp", "<boost/asio.hpp>"),
            ("render/a.cpp", "<sys/socket.h>"), ("render/a.cpp", "<libavcodec/avcodec.h>"),
            ("server/a.cpp", "<vulkan/vulkan_raii.hpp>"), ("lab/a.cpp", "<boost/beast.hpp>"),
        ]:
            with self.subTest(path=path, include=include):
                self.assertEqual(faults_of({path: f"#include {include}\n"}), [(path, 1)])

    def test_catches_paths_not_from_the_root(self):
        self.assertEqual(faults_of({"codec/a.cpp": '#include "video.h"\n'}), [("codec/a.cpp", 1)])


if __name__ == "__main__":
    unittest.main()
