"""
Builds on disks that are full, fail, vanish or cannot be written: the reason is told with status 4, what was committed is
there, and when the trouble is over --resume ends as an undisturbed build does. Wants to mount file systems: run it as
"unshare -m" or "unshare -rm" does.
    disk.py LAMELLA SHIM LEVELS STRIDE SEED      fill levels of the disk; every so many system calls fail
"""
import os
import random
import shutil
import subprocess
import sys
import time

from harness import LIMIT, PATH, SCENES, Fault, Wrong, content

REASONS = {28: "No space left on device", 5: "Input/output error", 122: "Disk quota exceeded"}


def mount(options):
    os.makedirs("disk", exist_ok=True)
    return subprocess.run(["mount", "-t", "tmpfs", "-o", options, "lamella", "disk"], stderr=subprocess.DEVNULL).returncode == 0


def remount(options):
    subprocess.run(["mount", "-o", f"remount,{options}", "disk"], check=True)


def unmount():
    subprocess.run(["umount", "disk"], check=True)


def check_told(status, told, reasons):
    if status != 4:
        raise Wrong(f"status {status} instead of 4: {told}")
    if not any(reason in told for reason in reasons):
        raise Wrong(f"the reason is not told: {told}")


# ---- a full disk ----


def full_case(fault, group, scene, options, more):
    """A build on a file system of that size; more room is made; the build goes on."""
    path = "disk/db.h5"

    def run():
        status, told = fault.run(fault.command(scene, path))
        least = fault.acknowledged("out")
        if status:
            check_told(status, told, ["No space left on device"])
        fault.check_kept(scene, path, least)
        remount(more)
        fault.check_completes(scene, path)

    mount(options)
    try:
        fault.case(group, options, run)
    finally:
        unmount()


def full_cases(fault, levels):
    size = os.path.getsize("undisturbed-bonded.h5") // 1024
    for k in range(levels):
        full_case(fault, "full disk", "bonded", f"size={4 + 4 * (k * 3 * size // levels // 4)}k", "size=10m")
        full_merge(fault, 4 + 4 * (k * size // levels // 4 // 2))
    for inodes in (2, 3):  # the folder is one; then the lock has none, or the file
        full_case(fault, "no inode left", "bonded", f"size=10m,nr_inodes={inodes}", "nr_inodes=100")


def full_merge(fault, size):
    """The union of two databases does not fit."""
    out = "disk/union.h5"
    before = content("undisturbed-bonded.h5")

    def run():
        status, told = fault.run([fault.lamella, "merge", out, "undisturbed-bonded.h5", "undisturbed-bonded.h5"])
        check_told(status, told, ["No space left on device"])
        if os.listdir("disk"):
            raise Wrong(f"left behind: {os.listdir('disk')}")
        remount("size=10m")
        status, told = fault.run([fault.lamella, "merge", out, "undisturbed-bonded.h5"])
        if status or content(out) != before:
            raise Wrong(f"when there is room: status {status}: {told}")

    mount(f"size={size}k")
    try:
        fault.case("full disk, merge", f"{size} kB", run)
    finally:
        unmount()


# ---- calls that fail ----


def failing_calls(fault, stride, times):
    """Each call on file, folder and lock fails, once or from then on."""
    scene, path = "bonded", PATH
    for call in ("write", "length", "sync", "name", "open"):
        calls = fault.count(scene, path, call)
        for at in range(1 + random.randrange(stride), calls + 1, stride):
            error = random.choice(list(REASONS))

            def run():
                status, told = fault.run(fault.command(scene, path), fault.broken(path, call, at, error, times))
                if status:
                    check_told(status, told, [REASONS[error]])
                fault.check_kept(scene, path, fault.acknowledged("out"))
                fault.check_completes(scene, path)

            fault.case(f"failing call, {'once' if times else 'from then on'}", f"{call} {at} of {calls}, {REASONS[error]}", run)


def short_writes(fault, stride):
    """A write that takes half is gone on with."""
    scene, path = "bonded", PATH
    calls = fault.count(scene, path, "write")
    for at in range(1 + random.randrange(stride), calls + 1, stride):

        def run():
            status, told = fault.run(fault.command(scene, path), fault.broken(path, "write", at, "short", 1))
            if status:
                raise Wrong(f"status {status}: {told}")
            fault.check_completes(scene, path)

        fault.case("short write", f"write {at} of {calls}", run)


# ---- what happens to the file while it is written ----


def under_way(fault, group, scene, path, act, check):
    """Acts after the first commit of a build."""

    def run():
        with open("out", "wb") as out, open("err", "wb") as err:
            p = subprocess.Popen(fault.command(scene, path), stdout=out, stderr=err)
            end = time.monotonic() + LIMIT
            while not os.path.getsize("out") and p.poll() is None and time.monotonic() < end:
                time.sleep(0.01)
            act()
            try:
                status = p.wait(LIMIT)
            except subprocess.TimeoutExpired:
                p.kill()
                p.wait()
                raise Wrong("no end")
        with open("err") as err:
            check(status, err.read())

    fault.case(group, path, run)


def moved_files(fault):
    scene = "slow"  # not over before it is disturbed
    with open("slow.yaml", "w") as f:
        f.write(SCENES["bonded"].replace("along: 4", "along: 48"))
    other = "other.h5"
    shutil.copy("undisturbed-contact.h5", other)
    before = content(other)

    def gone(status, told):
        check_told(status, told, ["No such file or directory"])

    def replaced(status, told):
        check_told(status, told, ["another program has changed it"])
        if content("replaced.h5") != before:
            raise Wrong("the file in its place has been changed")

    def remove_folder():
        shutil.rmtree("folder")

    os.makedirs("folder", exist_ok=True)
    under_way(fault, "folder removed under way", scene, "folder/db.h5", remove_folder, gone)
    under_way(fault, "file removed under way", scene, "removed.h5", lambda: os.unlink("removed.h5"), gone)
    under_way(fault, "file replaced under way", scene, "replaced.h5", lambda: os.rename(other, "replaced.h5"), replaced)
    for path in ("removed.h5", "replaced.h5"):
        fault.clean(path)


def read_only(fault):
    scene, path = "bonded", "disk/db.h5"

    def file_system():
        shutil.copy("undisturbed-bonded.h5", path)
        remount("ro")
        status, told = fault.run(fault.command(scene, path, options=["--resume"]))
        check_told(status, told, ["Read-only file system"])
        status, told = fault.run([fault.lamella, "info", path])
        if status:
            raise Wrong(f"info: {told}")

    if mount("size=10m"):
        try:
            fault.case("read-only file system", path, file_system)
        finally:
            unmount()


def permissions(fault):
    """Root may write everywhere, so as another user."""
    scene = "bonded"
    user = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.getuid() == 0 else []
    os.chmod(".", 0o755)
    if subprocess.run([*user, fault.lamella, "--version"], capture_output=True).returncode:
        return
    os.makedirs("closed", exist_ok=True)
    os.makedirs("open", exist_ok=True)
    os.chmod("open", 0o777)
    with open("few.yaml", "w") as f:
        f.write(SCENES[scene].replace("count: 70", "count: 20"))
    fault.run(fault.command("few", "closed/db.h5"))
    shutil.copy("closed/db.h5", "open/db.h5")
    for path in ("closed/db.h5", "open/db.h5"):
        os.chmod(path, 0o444)
    os.chmod("closed", 0o555)

    def refused(path):
        status, told = fault.run([*user, *fault.command(scene, path, options=["--resume"])], {"HOME": "/nonexistent"})
        check_told(status, told, ["Permission denied"])
        fault.check_kept(scene, path, 20)

    fault.case("read-only folder", "--resume", lambda: refused("closed/db.h5"))
    fault.case("read-only file", "--resume", lambda: refused("open/db.h5"))
    os.chmod("closed", 0o755)


def standard_output(fault):
    scene, path = "bonded", PATH

    def output(redirection, reason):
        command = " ".join(fault.command(scene, path)) + redirection
        status, told = fault.run(["bash", "-c", command])
        check_told(status, told, [reason])
        fault.check_kept(scene, path, 1)
        fault.check_completes(scene, path)

    fault.case("stdout full", "/dev/full", lambda: output(" >/dev/full", "No space left on device"))
    fault.case("stdout closed", ">&-", lambda: output(" >&-", "Bad file descriptor"))


def main():
    lamella, shim, levels, stride, seed = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:6])
    random.seed(seed)
    fault = Fault(lamella, shim)
    long = stride == 1
    for scene in ("bonded", "contact") if long else ("bonded",):
        fault.wanted(scene)
    if mount("size=1m"):
        unmount()
        full_cases(fault, levels)
        read_only(fault)
    elif long:
        print("no file system can be mounted here: full disks are left out")
    for times in (0, 1) if long else (0,):
        failing_calls(fault, stride, times)
    short_writes(fault, stride)
    if long:
        moved_files(fault)
        permissions(fault)
    standard_output(fault)
    if long:
        print(f"seed {seed}")
    fault.end(long)


if __name__ == "__main__":
    main()
