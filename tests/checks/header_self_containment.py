#!/usr/bin/env python3
"""Every header compiles alone: it includes what it uses.

A header that some source of the build includes first (its own x.cpp does, and its test) is proved by that source's
compilation. For the others, the one line '#include "room/x.h"' is compiled with the flags of a source beside it.
Precompiled vk.h would hide what a header forgot, so it proves only headers that reach vk.h through their own includes.

Usage: header_self_containment.py ROOT BUILD [JOBS]    BUILD holds compile_commands.json and has been built
"""
import concurrent.futures
import json
import pathlib
import re
import shlex
import subprocess
import sys

ROOMS = ["base", "shaders", "codec", "proto", "netsim", "render", "server", "client", "lab"]
INPUT_OUTPUT = {"-o", "-c", "-MT", "-MF"}  # options of the source's own command that go, value and all
DROPPED = {"-MD", "-Winvalid-pch"}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
ANY_INCLUDE = re.compile(r"^\s*#\s*include", re.MULTILINE)


def without_precompiled(flags):
    """The flags, less every '-include FILE'."""
    words = iter(flags)
    return [word for word in words if word != "-include" or not next(words)]


def compile_flags(root, build):
    """How each source below `root` is compiled, without its input and output."""
    flags_of = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["file"])
        if not source.is_relative_to(root):
            continue
        words = iter(shlex.split(entry["command"]))
        flags = []
        for word in words:
            if word in INPUT_OUTPUT:
                next(words)
            elif word not in DROPPED:
                flags.append(word)
        flags_of[source.relative_to(root)] = flags
    return flags_of


def reaches(root, header, target, seen):
    """Does `header` include `target`, through our own headers?"""
    if header == target:
        return True
    seen.add(header)
    path = root / header
    if not path.exists():
        return False
    names = INCLUDE.findall(path.read_text(encoding="utf-8"))
    return any(name not in seen and reaches(root, name, target, seen) for name in names)


def reaches_vulkan(root, header):
    return reaches(root, header.as_posix(), "render/gpu/vk.h", set())


def proved_headers(root, flags_of):
    """Headers that the build compiles as the first include of some source."""
    proved = set()
    for source, flags in flags_of.items():
        first = source.suffix == ".cpp" and INCLUDE.search((root / source).read_text(encoding="utf-8"))
        if first and not ANY_INCLUDE.search((root / source).read_text(encoding="utf-8")[: first.start()]):
            header = pathlib.Path(first.group(1))
            if "-include" not in flags or reaches_vulkan(root, header):
                proved.add(header)
    return proved


def flags_for(root, header, flags_of):
    """Flags of a source in the nearest folder at or above the header's, or else of any source of its room."""
    room = [source for source in sorted(flags_of) if source.parts[0] == header.parts[0]]
    for folder in header.parents:
        beside = [source for source in room if source.parent == folder]
        room = beside or room
        if beside:
            break
    if not room:
        return None
    flags = flags_of[room[0]]
    return flags if reaches_vulkan(root, header) else without_precompiled(flags)


def complaint(header, flags, scratch):
    """What the compiler says about the header alone; empty when it is content."""
    source = scratch / (header.as_posix().replace("/", "__") + ".cpp")
    source.write_text(f'#include "{header.as_posix()}"\n')
    done = subprocess.run(flags + ["-fsyntax-only", str(source)], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else f"{header}:\n{done.stderr}"


def main():
    root, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    jobs = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    scratch = build / "header_check"
    scratch.mkdir(exist_ok=True)
    flags_of = compile_flags(root, build)
    proved = proved_headers(root, flags_of)
    work = []
    for room in ROOMS:
        for path in sorted((root / room).rglob("*.h")):
            header = path.relative_to(root)
            flags = flags_for(root, header, flags_of)
            if flags and header not in proved:
                work.append((header, flags, scratch))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        complaints = [text for text in pool.map(lambda one: complaint(*one), work) if text]
    print("\n".join(complaints))
    print(f"{len(proved)} headers proved by sources, {len(work)} compiled alone, {len(complaints)} not self-contained")
    return 1 if complaints or not work else 0


if __name__ == "__main__":
    sys.exit(main())
