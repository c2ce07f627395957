#!/usr/bin/env python3
"""No tracked file exceeds 200 KB, and no source 500 lines.

Usage: tree_limits.py ROOT    prints each offender; exit status 1 if there is one
"""
import pathlib
import subprocess
import sys

MAX_BYTES = 200 * 1024
MAX_LINES = 500
SOURCES = {".h", ".cpp", ".py", ".sh", ".js", ".glsl", ".vert", ".frag", ".comp", ".tesc", ".tese", ".geom", ".cmake"}
NOT_OURS = {".git", "build", "out", "shared"}


def tracked(root):
    """Git's files, or in an exported tree all files outside build and output folders."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        return [root / name for name in listed.stdout.decode().split("\0") if name]
    return [path for path in root.rglob("*") if path.relative_to(root).parts[0] not in NOT_OURS]


def main():
    root = pathlib.Path(sys.argv[1])
    faults = []
    for path in tracked(root):
        if not path.is_file():
            continue
        name = path.relative_to(root)
        size = path.stat().st_size
        if size > MAX_BYTES:
            faults.append(f"{name}: {size} octets, limit {MAX_BYTES}")
        if path.suffix in SOURCES or path.name == "CMakeLists.txt":
            lines = path.read_bytes().count(b"\n")
            if lines > MAX_LINES:
                faults.append(f"{name}: {lines} lines, limit {MAX_LINES}")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
