#!/usr/bin/env python3
"""Includes point downward only: docs/ARCHITECTURE.md has the picture, ALLOWED the rule.

Usage: include_direction.py ROOT    prints each offending line; exit status 1 if there is one
"""
import pathlib
import re
import sys

# What each room may include, besides itself.
ALLOWED = {
    "base": set(),
    "shaders": {"base"},
    "codec": {"base"},
    "proto": {"base"},
    "netsim": {"base"},
    "render": {"base", "shaders"},
    "server": {"base", "proto", "codec", "render", "shaders"},
    "client": {"base", "proto", "codec", "render", "shaders"},
    "lab": {"base", "proto", "codec", "netsim", "render", "shaders", "server", "client"},
}

# Libraries that only some paths may touch: sockets in the shells, video codecs and Vulkan in their rooms.
LIBRARIES = [
    (re.compile(r"boost/(asio|beast)"), re.compile(r"(server|client)/|netsim/(relay|main)"), "Asio"),
    (re.compile(r"(sys/socket|netinet/|arpa/inet|netdb)"), re.compile(r"(server|client)/|netsim/(relay|main)"), "sockets"),
    (re.compile(r"(libav(codec|util|format)/|libsw|turbojpeg)"), re.compile(r"codec/"), "a video codec"),
    (re.compile(r"vulkan/"), re.compile(r"render/"), "Vulkan"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SUFFIXES = {".h", ".hpp", ".cpp", ".in"}


def fault(path, quote, target):
    """Why the file at `path` (relative to the root) may not include `target`, or None."""
    room = path.split("/")[0]
    if quote == '"':
        owner = target.split("/")[0]
        if owner not in ALLOWED:
            return "a quoted include must name a room from the repository's root"
        if owner != room and owner not in ALLOWED[room]:
            return f"{room}/ must not know {owner}/"
    for library, homes, name in LIBRARIES:
        if library.match(target) and not homes.match(path):
            return f"{path} must not touch {name}"
    return None


def offending_lines(root):
    """(path, line number, line, reason) of every bad include below `root`."""
    for room in ALLOWED:
        for path in sorted((root / room).rglob("*")):
            if path.suffix not in SUFFIXES or not path.is_file():
                continue
            name = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                found = INCLUDE.match(line)
                reason = found and fault(name, *found.groups())
                if reason:
                    yield name, number, line.strip(), reason


def main():
    root = pathlib.Path(sys.argv[1])
    faults = list(offending_lines(root))
    for name, number, line, reason in faults:
        print(f"{name}:{number}: {line}: {reason}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
