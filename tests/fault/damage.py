"""
Database files that are cut, or in which bits flip: they open with what they held, or the damage is told with the file's
name and status 2; nothing crashes or hangs; `merge --salvage` refuses a file by name or takes records of it that are those
of an undisturbed build: of one that is damaged in its records alone all that are sound; `build --resume` completes it.
    damage.py LAMELLA SHIM CASES SEED
"""
import os
import random
import subprocess
import sys

import h5py

from harness import SCENES, Fault, Wrong, content

DAMAGED, SALVAGED = "case.h5", "case.h5.salvaged"
LIMIT = 20  # s, for any one command


def places(path):
    """Key -> where the bytes of its record are in the file, and what they are."""
    with open(path, "rb") as f:
        raw = f.read()
    with h5py.File(path, "r") as f:
        records = f["records"][: f["records"].attrs["committed"]]
    return {int(r["key"]): (raw.index(r.tobytes()), r.tobytes()) for r in records}


def cut(raw):
    del raw[random.randrange(len(raw)) :]
    return f"cut to {len(raw)} bytes"


def flip(raw, end):
    bits = [random.randrange(8 * end) for _ in range(random.choice([1, 1, 1, 2, 8, 64]))]
    for bit in bits:
        raw[bit // 8] ^= 1 << bit % 8
    return f"bits {bits} flipped"


def wipe(raw):
    first = random.randrange(len(raw)) // 4096 * 4096
    raw[first : first + 4096] = bytes(len(raw[first : first + 4096]))
    return f"page at {first} wiped"


KINDS = {
    "cut": cut,
    "bits flipped": lambda raw: flip(raw, len(raw)),
    "bits flipped, first 20 kB": lambda raw: flip(raw, 20000),
    "page wiped": wipe,
}


def command(fault, *arguments):
    """Status and all that was told; within the time limit and without a signal."""
    try:
        r = subprocess.run([fault.lamella, *arguments], capture_output=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise Wrong(f"no end after {LIMIT} s: {arguments[0]}")
    told = (r.stdout + r.stderr).decode(errors="replace")
    if r.returncode not in (0, 2) or "Sanitizer" in told or "runtime error" in told:
        raise Wrong(f"{arguments[0]} ends with {r.returncode}: {told}")
    return r.returncode, told


def content_apart(path):
    """The content as another program reads it, which damage may crash."""
    program = "import sys, pickle, harness; sys.stdout.buffer.write(pickle.dumps(harness.content(sys.argv[1])))"
    here = os.path.dirname(os.path.abspath(__file__))
    r = subprocess.run([sys.executable, "-c", program, path], capture_output=True, timeout=LIMIT, env={**os.environ, "PYTHONPATH": here})
    if r.returncode:
        raise Wrong(f"opens, but others cannot read it: {r.stderr.decode()[-200:]}")
    import pickle

    return pickle.loads(r.stdout)


def check_salvage(fault, scene, sound, in_records):
    """What is taken is right, all that is sound where no other part is damaged, and the build goes on with it."""
    wanted, _ = fault.wanted(scene)
    status, told = command(fault, "merge", SALVAGED, DAMAGED, "--salvage")
    if status and DAMAGED not in told:
        raise Wrong(f"the file is not named: {told}")
    if status and in_records and sound:
        raise Wrong(f"merge --salvage: {told}")
    if status:
        return
    found, _ = content(SALVAGED)
    lost = [key for key in sound if key not in found]
    if lost and in_records:
        raise Wrong(f"{len(lost)} of {len(sound)} sound records are lost")
    if any(wanted.get(key) != record for key, record in found.items()):
        raise Wrong("a record is not that of an undisturbed build")
    fault.check_completes(scene, SALVAGED)


def damage_case(fault, scene, kind, where):
    with open(f"undisturbed-{scene}.h5", "rb") as f:
        original = f.read()
    raw = bytearray(original)
    what = KINDS[kind](raw)
    sound = [key for key, (at, record) in where.items() if raw[at : at + len(record)] == record]
    rest = bytearray(raw)
    for at, record in where.values():
        rest[at : at + len(record)] = record

    def run():
        with open(DAMAGED, "wb") as f:
            f.write(raw)
        status, told = command(fault, "info", DAMAGED, "--check")
        if status == 0 and content_apart(DAMAGED) != fault.wanted(scene):
            raise Wrong("opens with other content")
        if status == 2 and DAMAGED not in told:
            raise Wrong(f"the file is not named: {told}")
        opens, told = command(fault, "info", DAMAGED)
        if status == 0 and opens:
            raise Wrong(f"passes the check but does not open: {told}")
        check_salvage(fault, scene, sound, rest == original)

    fault.case(kind, f"{scene}, {what}", run)


def main():
    lamella, shim, cases, seed = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:5])
    random.seed(seed)
    fault = Fault(lamella, shim)
    scenes = list(SCENES) if cases > 20 else ["bonded"]
    for scene in scenes:
        fault.wanted(scene)
    where = {scene: places(f"undisturbed-{scene}.h5") for scene in scenes}
    for k in range(cases):
        scene = random.choice(scenes)
        fault.clean(SALVAGED)
        damage_case(fault, scene, list(KINDS)[k % len(KINDS)], where[scene])
    if cases > 20:
        print(f"seed {seed}")
    fault.end(cases > 20)


if __name__ == "__main__":
    main()
