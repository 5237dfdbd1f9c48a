"""
Macroscale runs that are killed: at random instants, on 1 and 2 ranks, direct and from a cache. After each kill `--resume` goes
on, perhaps on another number of ranks; the results are those of an undisturbed run.
    fe2.py LAMELLA SHIM CASES SEED      more than 10 cases: of contact tissue, which takes longer
"""
import json
import os
import random
import signal
import subprocess
import sys
import time

import h5py
import numpy as np

from harness import TISSUE, Wrong, programs, reap, send

SHORT = TISSUE + """macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [0.8 mm, 0.2 mm]}]
  steps: 4
"""
LONG = SHORT.replace("law: bonded", "law: contact, cohesion: 0.005 MPa").replace("[2, 1]", "[2, 2]")
TOLERANCE = 1e-8
OF_TANGENT = 1e-6  # of what follows from tangents, which are as much more sensitive to F as walls are near buckling
LIMIT = 600  # s, for any one run: none may hang


def command(lamella, response, ranks, resume=True):
    mpirun = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    database = ["-d", "db.h5"] if response == "cache" else []
    options = ["--resume"] if resume else []
    return mpirun + [lamella, "fe2", "block.yaml", "-o", "out.h5", "--json", "--quiet", *database, *options]


def kill(lamella, what, delay, number):
    """Starts a run and ends all its processes after the delay; what it has told."""
    with open("told", "wb") as out, open("err", "wb") as err:
        process = subprocess.Popen(what, stdout=out, stderr=err)
        time.sleep(delay)
        send([*programs(lamella)], number)
        if number == signal.SIGKILL:
            send([process.pid], number)
    reap(lamella, process, LIMIT)
    return steps_told(open("told").read())


def steps_told(text):
    lines = text.split("\n")[:-1]  # what follows the last end of a line is half a line
    return [json.loads(line)["step"] for line in lines]


def finish(what):
    try:
        done = subprocess.run(what, capture_output=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise Wrong(f"no end after {LIMIT} s") from None
    if done.returncode:
        raise Wrong(f"ends with {done.returncode}: {done.stderr.decode()}")
    return steps_told(done.stdout.decode())


def results():
    """All numbers that a run writes but times: dataset -> values."""
    found = {}
    with h5py.File("out.h5", "r") as f:
        if f["macro/status"][()] != b"done":
            raise Wrong(f"status {f['macro/status'][()]}")

        def keep(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind in "fi" and "seconds" not in name:
                found[name] = item[()]

        f["macro"].visititems(keep)
    return found


ROUNDING = 1e-12  # MPa, mm, 1: of what vanishes but for rounding, as shear on faces of a body that is inflated alone


def compare(wanted, found):
    if wanted.keys() != found.keys():
        raise Wrong(f"other arrays: {sorted(wanted.keys() ^ found.keys())}")
    for name, values in wanted.items():
        if found[name].shape != values.shape:
            raise Wrong(f"{name}: shape {found[name].shape} instead of {values.shape}")
        size = np.nanmax(np.abs(values), initial=0)
        worst = np.nanmax(np.abs(found[name] - values), initial=0)
        tolerance = OF_TANGENT if "ellipticity" in name or "localisation" in name else TOLERANCE
        if worst > max(tolerance * size, ROUNDING) or (np.isnan(found[name]) != np.isnan(values)).any():
            raise Wrong(f"{name}: differs by {worst} of {size}")


def check_database():
    with h5py.File("db.h5", "r") as f:
        keys = f["records"]["key"][: f["records"].attrs["committed"]]
    if len(set(keys)) != len(keys):
        raise Wrong("the database has records twice")


def clean():
    for name in os.listdir("."):
        if name.split(".")[0] in ("out", "db"):
            os.unlink(name)


def case(lamella, response, seconds, wanted):
    """Some kills, then an undisturbed end; what was done."""
    clean()
    told, done = [], []
    for _ in range(random.choice([1, 1, 2, 3])):
        ranks = random.choice([1, 2])
        delay = random.uniform(0, 1.1) * seconds[response, ranks]
        number = random.choice([signal.SIGKILL] * 3 + [signal.SIGTERM])
        done.append(f"{number.name} after {delay:.3f} s on {ranks}")
        told += kill(lamella, command(lamella, response, ranks), delay, number)
    ranks = random.choice([1, 2])
    done.append(f"end on {ranks}")
    try:
        told += finish(command(lamella, response, ranks))
        compare(wanted[response], results())
        if set(told) - {4} != set(range(5)) - {4}:  # the last may be killed behind the file and before it is told
            raise Wrong(f"steps {told} were told")
        if response == "cache":
            check_database()
        if left := [n for n in os.listdir(".") if n.endswith((".ckpt", ".tmp", ".lock"))]:
            raise Wrong(f"{left} left")
    except Wrong as wrong:
        raise Wrong(f"{response}: {'; '.join(done)}: {wrong}") from None


def main():
    lamella, cases, seed = sys.argv[1], *map(int, sys.argv[3:5])
    random.seed(seed)
    with open("block.yaml", "w") as f:
        f.write(LONG if cases > 10 else SHORT)
    seconds, wanted, failures = {}, {}, []
    for response in ("direct", "cache"):
        for ranks in (2, 1) if cases > 10 else (1,):
            clean()
            start = time.monotonic()
            finish(command(lamella, response, ranks, resume=False))
            seconds[response, ranks] = time.monotonic() - start
        seconds.setdefault((response, 2), seconds[response, 1])
        wanted[response] = results()
    for k in range(cases):
        try:
            case(lamella, ("direct", "cache")[k % 2], seconds, wanted)
        except Wrong as wrong:
            failures.append(str(wrong))
            print(wrong, flush=True)
    if cases > 10 or failures:
        print(f"{cases} cases, {len(failures)} failed; seed {seed}")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
