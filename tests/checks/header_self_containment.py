#!/usr/bin/env python3
"""Every header compiles alone: it includes what it uses.

Compiles one line, '#include "room/x.h"', for each header of the rooms that this build configured, with the flags
of a source beside it. Behind ccache only changed headers cost anything.

Usage: header_self_containment.py ROOT BUILD [JOBS]    BUILD holds compile_commands.json
"""
import concurrent.futures
import json
import pathlib
import shlex
import subprocess
import sys

ROOMS = ["base", "shaders", "codec", "proto", "netsim", "render", "server", "client", "lab"]
WITH_VALUE = {"-o", "-c", "-MT", "-MF", "-include"}  # options of the source's own command that go, value and all
DROPPED = {"-MD", "-Winvalid-pch", "-fpch-preprocess"}


def flags_by_folder(root, build):
    """For each folder with sources, how one of them is compiled, without input, output and precompiled header."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["file"])
        if not source.is_relative_to(root):
            continue
        words = iter(shlex.split(entry["command"]))
        flags = []
        for word in words:
            if word in WITH_VALUE:
                next(words)
            elif word not in DROPPED:
                flags.append(word)
        commands.setdefault(source.parent.relative_to(root), flags)
    return commands


def flags_for(header, commands):
    """Flags of the nearest folder at or above the header's that has sources, or of any folder of its room."""
    for folder in header.parents:
        if folder in commands:
            return commands[folder]
    below = [folder for folder in commands if folder.parts and folder.parts[0] == header.parts[0]]
    return commands[min(below)] if below else None


def complaint(header, flags, scratch):
    """What the compiler says about the header alone; empty when it is content."""
    source = scratch / (header.as_posix().replace("/", "__") + ".cpp")
    line = f'#include "{header.as_posix()}"\n'
    if not source.exists() or source.read_text() != line:
        source.write_text(line)
    done = subprocess.run(flags + ["-g0", "-O0", "-c", str(source), "-o", str(source.with_suffix(".o"))],
                          capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else f"{header}:\n{done.stderr}"


def main():
    root, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    jobs = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    scratch = build / "header_check"
    scratch.mkdir(exist_ok=True)
    commands = flags_by_folder(root, build)
    work = []
    for room in ROOMS:
        for path in sorted((root / room).rglob("*.h")):
            header = path.relative_to(root)
            flags = flags_for(header, commands)
            if flags:
                work.append((header, flags, scratch))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        complaints = [text for text in pool.map(lambda one: complaint(*one), work) if text]
    print("\n".join(complaints))
    print(f"{len(work)} headers, {len(complaints)} not self-contained")
    return 1 if complaints or not work else 0


if __name__ == "__main__":
    sys.exit(main())
