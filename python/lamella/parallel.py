"""Jobs in processes of their own, so that processors are shared and a crash is an exception."""
import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed, wait
from pathlib import Path
from typing import Any

from . import program
from ._library import Error, InputError
from .program import environment

MISTAKE = 2  # exit status of a worker whose input is wrong


def _there(function: Callable[[list[Any]], list[Any]], jobs: list[Any]) -> list[Any]:
    """function(jobs) in another process."""
    package = str(Path(__file__).resolve().parents[1])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    done = subprocess.run([sys.executable, "-c", "from lamella import parallel; parallel.work()"],
                          input=pickle.dumps((function, jobs)), capture_output=True, check=False,
                          env=environment(PYTHONPATH=os.pathsep.join(paths)))
    if done.returncode == MISTAKE:
        raise InputError(done.stderr.decode().strip())
    if done.returncode:
        raise RuntimeError(f"a worker has ended with status {done.returncode}: {done.stderr.decode().strip()}")
    return pickle.loads(done.stdout)


def work() -> None:
    """A worker: a function of this package and its jobs on stdin, their results on stdout, all pickled."""
    out, sys.stdout = sys.stdout.buffer, sys.stderr
    try:
        function, jobs = pickle.load(sys.stdin.buffer)
        solved = list(function(jobs))
    except InputError as error:
        print(error, file=sys.stderr)
        sys.exit(MISTAKE)
    out.write(pickle.dumps(solved))


def each(function: Callable[[list[Any]], Any], jobs: Sequence[Any], processes: int | None = None) -> list[Any]:
    """Results of jobs, in their order. function: of this package, takes a list of jobs and returns theirs; processes:
    at a time, default the number of processors; 1: in this process."""
    if processes == 1 or not jobs:
        return list(function(list(jobs)))
    n = min(processes or len(os.sched_getaffinity(0)), len(jobs))
    with ThreadPoolExecutor(n) as pool:
        parts = list(pool.map(lambda k: _there(function, list(jobs[k::n])), range(n)))
    return [parts[k % n][k // n] for k in range(len(jobs))]


def commands(solve: Callable[[Any], Any], jobs: Sequence[Any], processes: int | None = None,
             progress: Callable[[int, int], None] = lambda done, total: None) -> list[Any]:
    """Results of jobs that run commands of the program (program.run), so many at a time, or the Error of a job that has
    none. Where the whole is interrupted, the commands that run are stopped. progress(done, total): after each."""
    solved: dict[int, Any] = {}
    with ThreadPoolExecutor(processes or len(os.sched_getaffinity(0))) as pool:
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
