"""Jobs in processes of their own, so that processors are shared and a crash is an exception."""
import contextlib
import os
import pickle
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed, wait
from numbers import Integral
from pathlib import Path
from typing import Any

from . import program
from ._library import Error, InputError
from ._served import end_with_program
from .program import environment

MISTAKE = 2  # exit status of a worker whose input is wrong


def _there(function: Callable[[list[Any]], Iterable[Any]], jobs: list[Any], running: list["subprocess.Popen[bytes]"],
           found: Callable[[], None]) -> list[Any]:
    """Results of jobs in another process, which is added to those that run; found() is called after each."""
    package = str(Path(__file__).resolve().parents[1])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    words = [sys.executable, "-c", "from lamella import parallel; parallel.work()"]
    solved: list[Any] = []
    with tempfile.TemporaryFile() as err, \
         subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=err,
                          env=environment(PYTHONPATH=os.pathsep.join(paths))) as worker:
        running.append(worker)
        assert worker.stdin and worker.stdout
        with contextlib.suppress(EOFError, BrokenPipeError):  # it has ended, and its status says how
            with worker.stdin as jobs_of:
                jobs_of.write(pickle.dumps((function, jobs)))
            for _ in jobs:
                solved.append(pickle.load(worker.stdout))
                found()
        worker.wait()
        err.seek(0)
        message = err.read().decode().strip()
    if worker.returncode == MISTAKE:
        raise InputError(message)
    if worker.returncode:
        raise Error(f"a worker has ended with status {worker.returncode}: {message}")
    return solved


def work() -> None:
    """A worker: a function of this package and its jobs on stdin, their results on stdout as they come, all pickled."""
    end_with_program()
    out, sys.stdout = sys.stdout.buffer, sys.stderr
    try:
        function, jobs = pickle.load(sys.stdin.buffer)
        for result in function(jobs):
            out.write(pickle.dumps(result))
            out.flush()
    except InputError as error:
        print(error, file=sys.stderr)
        sys.exit(MISTAKE)


def count(processes: int | None) -> int:
    """At a time; None: as many as processors. InputError: fewer than one."""
    if processes is not None and (not isinstance(processes, Integral) or processes < 1):
        raise InputError(f"processes: {processes}: a whole number from 1 is wanted, or None for as many as processors")
    return int(processes or len(os.sched_getaffinity(0)))


def each(function: Callable[[list[Any]], Iterable[Any]], jobs: Sequence[Any], processes: int | None = None,
         progress: Callable[[int, int], None] = lambda done, total: None) -> list[Any]:
    """Results of jobs, in their order. function: of this package, takes a list of jobs and yields theirs; processes:
    at a time, default the number of processors; 1: in this process. progress(done, total): after each. Where the whole is
    interrupted, so are they."""
    done, lock = 0, threading.Lock()

    def found() -> None:
        nonlocal done
        with lock:
            done += 1
            progress(done, len(jobs))

    n = min(count(processes), len(jobs))
    if processes == 1 or not jobs:
        solved = []
        for result in function(list(jobs)):
            solved.append(result)
            found()
        return solved
    running: list["subprocess.Popen[bytes]"] = []
    with ThreadPoolExecutor(n) as pool:
        futures = [pool.submit(_there, function, list(jobs[k::n]), running, found) for k in range(n)]
        try:
            parts = [future.result() for future in futures]
        except BaseException:
            for worker in running:
                worker.kill()
            raise
    return [parts[k % n][k // n] for k in range(len(jobs))]


def commands(solve: Callable[[Any], Any], jobs: Sequence[Any], processes: int | None = None,
             progress: Callable[[int, int], None] = lambda done, total: None) -> list[Any]:
    """Results of jobs that run commands of the program (program.run), so many at a time, or the Error of a job that has
    none. Where the whole is interrupted, the commands that run are stopped. progress(done, total): after each."""
    solved: dict[int, Any] = {}
    with ThreadPoolExecutor(count(processes)) as pool:
        futures = {pool.submit(solve, job): k for k, job in enumerate(jobs)}
        try:
            for future in as_completed(futures):
                try:
                    solved[futures[future]] = future.result()
                except Error as error:
                    solved[futures[future]] = error
                progress(len(solved), len(jobs))
        except BaseException:
            running = [future for future in futures if not future.cancel()]
            program.stop()
            while wait(running, timeout=1).not_done:  # s; one may just have started another command
                program.stop()
            raise
    return [solved[k] for k in range(len(jobs))]
