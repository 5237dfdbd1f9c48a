"""
What the scripts here share: builds that are disturbed, and what must hold of their files afterwards. No test.
    lamella, shim, ranks      the program; the library of shim.c; mpirun may be used
"""
import json
import os
import signal
import subprocess
import sys
import time

import h5py

TISSUE = """version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
"""
BONDED = TISSUE + "sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 70}\n"
# nodes in contact start from others
CONTACT = (
    BONDED.replace("law: bonded", "law: contact, cohesion: 0.002 MPa")
    .replace("max: 0.1}", "max: 0.06}")
    .replace("min: 0.01", "min: 0.02")
    .replace("count: 70", "count: 40")
)
SCENES = {"bonded": BONDED, "contact": CONTACT}
PATH = "case.h5"  # where a case has no other
LIMIT = 120  # s, for any one run: none may hang


class Wrong(Exception):
    """What a case has found."""


def content(path):
    """Key -> all members but the time and the checksum over it; the grid."""
    with h5py.File(path, "r") as f:
        records = f["records"][: f["records"].attrs["committed"]]
        grid = f["table/grid"][()] if "table/grid" in f else None
    names = [n for n in records.dtype.names if n not in ("seconds", "checksum")]
    return {int(r["key"]): b"".join(r[n].tobytes() for n in names) for r in records}, grid


def programs(lamella):
    """Processes of the program that work in this folder."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.path.samefile(f"/proc/{pid}/exe", lamella) and os.path.samefile(f"/proc/{pid}/cwd", "."):
                found.append(int(pid))
        except OSError:
            pass
    return found


def reap(lamella, process, limit=LIMIT):
    """Waits until none of a run's processes is alive."""
    end = time.monotonic() + limit
    try:
        process.wait(limit)
    except subprocess.TimeoutExpired:
        send([process.pid, *programs(lamella)], signal.SIGKILL)
        raise Wrong(f"mpirun does not end within {limit} s of the death of a rank")
    while ranks := programs(lamella):
        if time.monotonic() > end:
            send(ranks, signal.SIGKILL)
            raise Wrong("a rank lives on")
        time.sleep(0.01)


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as f:
            return f.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def send(pids, number):
    for pid in pids:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass


class Fault:
    def __init__(self, lamella, shim=None):
        self.lamella, self.shim = lamella, shim
        self.table = []  # rows of name, cases, failures
        self.undisturbed = {}
        for name, text in SCENES.items():
            with open(f"{name}.yaml", "w") as f:
                f.write(text)

    # ---- runs ----

    def command(self, scene, path, ranks=1, options=()):
        mpirun = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        return mpirun + [self.lamella, "build", f"{scene}.yaml", "-d", path, "--json", "--quiet", *options]

    def run(self, command, env=None, **how):
        """Status and what was told on stderr."""
        env = {**os.environ, **(env or {})}
        try:
            with open("out", "wb") as out:
                r = subprocess.run(command, env=env, stdout=how.pop("stdout", out), stderr=subprocess.PIPE, timeout=LIMIT, **how)
        except subprocess.TimeoutExpired:
            raise Wrong(f"no end after {LIMIT} s: {' '.join(command)}")
        return r.returncode, r.stderr.decode(errors="replace")

    def broken(self, path, call, at, do, times=0):
        """Environment in which calls on `path` go wrong, see shim.c."""
        env = {"LD_PRELOAD": self.shim, "FAULT_PATH": path, "FAULT_AT": str(at), "FAULT_DO": str(do), "FAULT_TIMES": str(times)}
        return {**env, "FAULT_CALL": call} if call else env

    def count(self, scene, path, call=None, options=(), command=None):
        """How many calls an undisturbed run makes."""
        self.clean(path)
        env = {**self.broken(path, call, 0, 0), "FAULT_COUNT": os.path.abspath("count")}
        status, told = self.run(command or self.command(scene, path, options=options), env)
        if status:
            raise Wrong(f"an undisturbed run ends with {status}: {told}")
        self.clean(path)
        with open("count") as f:
            return int(f.read())

    def wanted(self, scene):
        if scene not in self.undisturbed:
            path = f"undisturbed-{scene}.h5"
            status, told = self.run(self.command(scene, path))
            if status:
                raise Wrong(f"an undisturbed build ends with {status}: {told}")
            self.undisturbed[scene] = content(path)
        return self.undisturbed[scene]

    # ---- what must hold ----

    def acknowledged(self, out):
        """Records told by whole lines of a run's stdout."""
        with open(out, "rb") as f:
            lines = f.read().split(b"\n")[:-1]
        told = [json.loads(line)["records"] for line in lines if line.startswith(b"{")]
        return max(told, default=0)

    def check_kept(self, scene, path, least):
        """The file is sound and holds at least so many records, all as in an undisturbed build."""
        if not os.path.exists(path):
            if least:
                raise Wrong(f"{least} records were acknowledged, the file is missing")
            return 0
        status, told = self.run([self.lamella, "info", path])
        if status:
            raise Wrong(f"info ends with {status}: {told}")
        kept, grid = content(path)
        wanted, its_grid = self.wanted(scene)
        if len(kept) < least:
            raise Wrong(f"{least} records were acknowledged, {len(kept)} are there")
        if grid != its_grid:
            raise Wrong("the grid differs")
        for key, record in kept.items():
            if wanted.get(key) != record:
                raise Wrong(f"record of key {key} differs" if key in wanted else f"a record of key {key}")
        return len(kept)

    def check_completes(self, scene, path, ranks=1):
        """--resume ends with the content of an undisturbed build and leaves nothing behind."""
        status, told = self.run(self.command(scene, path, ranks, ["--resume"]))
        if status:
            raise Wrong(f"--resume ends with {status}: {told}")
        if self.check_kept(scene, path, len(self.wanted(scene)[0])) != len(self.wanted(scene)[0]):
            raise Wrong("other records than in an undisturbed build")
        for end in (".lock", ".tmp"):
            if os.path.exists(path + end):
                raise Wrong(f"{path}{end} is left behind")

    # ---- cases ----

    def clean(self, path):
        for end in ("", ".lock", ".tmp", ".damaged"):
            if os.path.exists(path + end):
                os.unlink(path + end)

    def case(self, group, what, function):
        """Counts it; tells what it finds."""
        row = next((r for r in self.table if r[0] == group), None)
        if not row:
            self.table.append(row := [group, 0, 0])
        row[1] += 1
        self.clean(PATH)
        try:
            function()
        except Wrong as wrong:
            row[2] += 1
            print(f"{group}: {what}: {wrong}", file=sys.stderr, flush=True)

    def end(self, loud):
        if loud:
            width = max(len(r[0]) for r in self.table)
            print(f"{'':{width}}  cases  failures")
            for name, cases, failures in self.table:
                print(f"{name:{width}}  {cases:5}  {failures:8}")
        sys.exit(any(r[2] for r in self.table))
