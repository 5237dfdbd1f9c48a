#!/usr/bin/env bash
# No room calls a room that it does not stand on (CMakeLists.txt). Prints the circles of calls between files, which do not fail.
exec python3 - "$(dirname "$1")" "$2" <<'P'
import subprocess, sys
from pathlib import Path

build = Path(sys.argv[1])
files = {}  # room -> its sources
stands_on = {}  # room -> rooms, those that it stands on by others too
for line in (build / "rooms.txt").read_text().splitlines():
    room, on, calls, files[line.split()[0]] = (part.split() for part in line.split("|"))
    assert stands_on.keys() >= {*on, *calls}, f"{room[0]} stands on a room below it"
    stands_on[room[0]] = {*on, *calls}.union(*(stands_on[other] for other in on))

room_of, defines, needs = {}, {}, {}
for room in stands_on:
    for source in files[room]:
        name = str(Path(source).relative_to(sys.argv[2]))
        file = build / f"CMakeFiles/room_{room}.dir" / (name + ".o")
        room_of[name], needs[name] = room, set()
        for line in subprocess.run(["nm", "-P", file], check=True, capture_output=True, text=True).stdout.splitlines():
            symbol, kind = line.split()[:2]
            if not symbol.startswith("Lam"):
                continue
            if kind == "U":
                needs[name].add(symbol)
            elif kind.isupper():
                defines[symbol] = name
assert len(defines) > 500, f"{len(defines)} functions found in {build}"

failed = False
calls = {file: {defines[s] for s in symbols if s in defines} for file, symbols in needs.items()}
for file, symbols in needs.items():
    for symbol in sorted(s for s in symbols if s in defines):
        room, other = room_of[file], room_of[defines[symbol]]
        if other != room and other not in stands_on[room]:
            print(f"FAILED: {file} uses {symbol} of {defines[symbol]}, but {room} does not stand on {other}")
            failed = True


def reached(file):
    seen, todo = set(), [file]
    while todo:
        todo += (more := calls[todo.pop()] - seen)
        seen |= more
    return seen


reach = {file: reached(file) for file in calls}
circles = {frozenset(f for f in reach[file] if file in reach[f]) for file in calls if file in reach[file]}
for circle in sorted(circles, key=len, reverse=True):
    print(f"circle of {len(circle)}:", *sorted(circle))
sys.exit(failed)
P
