"""
Builds that are killed: at every system call of a run, and at random instants; on 1 and 2 ranks, one rank or all, with and
without a SIGTERM before. After each kill nothing is lost, nothing is in the way, and the end is that of an undisturbed build.
    kill.py LAMELLA SHIM CASES STRIDE SEED      random instants; every so many system calls
"""
import os
import random
import signal
import subprocess
import sys
import time

from harness import PATH, SCENES, Fault, Wrong, is_alive, programs, reap, send

KILLS = ["KILL", "TERM, KILL after 0.05 s", "TERM, KILL after 1 s"]


def disturb(fault, command, delay, how, victims):
    """Runs the command and kills it after the delay."""
    with open("out", "wb") as out, open("err", "wb") as err:
        process = subprocess.Popen(command, stdout=out, stderr=err)
        time.sleep(delay)
        ranks = programs(fault.lamella) or [process.pid]
        pids = {"one rank": [random.choice(ranks)], "mpirun": [process.pid], "all": [process.pid, *ranks]}[victims]
        if how != "KILL":
            send(pids, signal.SIGTERM)
            end = time.monotonic() + (1 if "1 s" in how else 0.05)
            while time.monotonic() < end and any(is_alive(p) for p in pids):
                process.poll()
                time.sleep(0.005)
        send(pids, signal.SIGKILL)
        reap(fault.lamella, process)


def random_case(fault, seconds, k):
    scene = random.choice(list(SCENES))
    how = random.choice(KILLS)
    told = []

    def run():
        fault.wanted(scene)
        acknowledged = 0
        for _ in range(random.choice([1, 1, 2, 3])):
            ranks = random.choice([1, 2])
            victims = "all" if ranks == 1 else random.choice(["all", "one rank", "mpirun"])
            delay = random.uniform(0, 0.05) if random.random() < 0.1 else random.uniform(0, 1.1 * seconds[scene, ranks])
            told.append(f"{ranks} ranks, {victims} after {delay:.3f} s")
            disturb(fault, fault.command(scene, PATH, ranks, ["--resume"]), delay, how, victims)
            acknowledged = max(acknowledged, fault.acknowledged("out"))
            fault.check_kept(scene, PATH, acknowledged)
        fault.check_completes(scene, PATH, random.choice([1, 2]))

    what = f"{scene}, {how}"
    fault.case(f"random instant, {how}", f"case {k}: {scene}: {told}", run)


def sweep(fault, scene, stride, do):
    """A kill at every call that a build makes on its file, folder and lock; half: within every write."""
    call = "write" if do == "half" else None
    calls = fault.count(scene, PATH, call)
    for at in range(1 + random.randrange(stride), calls + 1, stride):

        def run():
            fault.run(fault.command(scene, PATH, options=["--resume"]), fault.broken(PATH, call, at, do))
            fault.check_kept(scene, PATH, fault.acknowledged("out"))
            fault.check_completes(scene, PATH)

        fault.case(f"system call, {scene}, {'within it' if do == 'half' else 'before it'}", f"call {at} of {calls}", run)


def measure(fault):
    seconds = {}
    for scene in SCENES:
        for ranks in (1, 2):
            start = time.monotonic()
            status, told = fault.run(fault.command(scene, PATH, ranks))
            if status:
                raise Wrong(f"an undisturbed build ends with {status}: {told}")
            seconds[scene, ranks] = time.monotonic() - start
            fault.clean(PATH)
    return seconds


def main():
    lamella, shim, cases, stride, seed = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:6])
    random.seed(seed)
    fault = Fault(lamella, shim)
    long = cases > 20
    seconds = measure(fault) if long else {(s, r): 1.5 for s in SCENES for r in (1, 2)}
    sweep(fault, "bonded", stride, "kill")
    if long:
        sweep(fault, "contact", 3 * stride, "kill")
    sweep(fault, "bonded", stride, "half")
    for k in range(cases):
        random_case(fault, seconds, k)
    if long:
        print(f"seed {seed}")
    fault.end(long)


if __name__ == "__main__":
    main()
