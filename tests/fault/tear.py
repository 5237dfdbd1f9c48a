"""
Tearing bodies that are killed: at random instants, solved directly and with models of their points; `--resume` then gives the
curve and the fields of an undisturbed run, bit for bit but for 1e-12. What is broken is history: a state that is lost or taken
twice shows.
    tear.py LAMELLA SHIM CASES SEED
"""
import random
import signal
import sys
import time

import fe2
from harness import TISSUE, Wrong

LAMELLA = "law: lamella, strength: 0.02 MPa, fracture_energy: 0.4 J/m^2"
SCENE = TISSUE.replace("law: bonded", LAMELLA).replace("0.02 MPa}", "0.01 MPa}")
SCENE = SCENE.replace("along: 4", "along: 3") + """macro:
  mesh: {box: [1 mm, 1 mm], elements: [2, 1]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [0.05 mm, 0.25 mm], history: [[0, 0], [0.5, 0.8], [0.7, 0.3], [1, 1]]}
  inflate: true
  steps: 7
"""
STEPS = 8  # and the inflated state


def command(lamella, response, ranks, resume=True):
    return fe2.command(lamella, "direct", ranks, resume) + ["--response", response]


def case(lamella, response, ranks, seconds, wanted):
    """Some kills, then an undisturbed end."""
    fe2.clean()
    told, done = [], []
    for _ in range(random.choice([1, 2, 3])):
        delay = random.uniform(0.1, 1.05) * seconds
        number = random.choice([signal.SIGKILL] * 3 + [signal.SIGTERM])
        done.append(f"{number.name} after {delay:.3f} s on {ranks}, {response}")
        told += fe2.kill(lamella, command(lamella, response, ranks), delay, number)
    try:
        told += fe2.finish(command(lamella, response, ranks))
        fe2.compare(wanted, fe2.results())
        if set(told) | {STEPS - 1} != set(range(STEPS)):  # the last may be killed behind the file and before it is told
            raise Wrong(f"steps {told} were told")
    except Wrong as wrong:
        raise Wrong(f"{'; '.join(done)}: {wrong}") from None


def main():
    lamella, cases, seed = sys.argv[1], *map(int, sys.argv[3:5])
    random.seed(seed)
    fe2.TOLERANCE = fe2.OF_TANGENT = 1e-12
    with open("block.yaml", "w") as f:
        f.write(SCENE)
    failures, wanted, seconds = 0, {}, {}
    kinds = [(response, ranks) for ranks in ((1, 2) if cases > 10 else (1,)) for response in ("direct", "cache")]
    for kind in kinds:
        fe2.clean()
        start = time.monotonic()
        fe2.finish(command(lamella, *kind, resume=False))
        seconds[kind] = time.monotonic() - start
        wanted[kind] = fe2.results()
        broken = wanted[kind]["curve/broken_fraction"]
        if not broken[-1] > 0.2 or not wanted[kind]["curve/mesh_dependent"][-1]:
            raise SystemExit(f"the body does not tear: {broken}")
    for k in range(cases):
        kind = kinds[k % len(kinds)]
        try:
            case(lamella, *kind, seconds[kind], wanted[kind])
        except Wrong as wrong:
            failures += 1
            print(wrong, flush=True)
    if cases > 10 or failures:
        print(f"{cases} cases, {failures} failed; seed {seed}")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
