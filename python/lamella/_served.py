"""How the package's commands end: with an exit status, and what is wrong told in one line."""
import ctypes
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from typing import Any

from ._library import Error, InputError

USAGE, INPUT, UNSOLVED, FILES, FAULT = 1, 2, 3, 4, 70  #: exit statuses (docs/reference/commands.md)
INTERRUPTED = 130
PR_SET_PDEATHSIG = 1  # linux/prctl.h
WIDTH, SILENT = 24, 1.0  # of a bar; s, before and between lines without news
_command = "lamella"  # what `served` serves
_lines: list["_Line"] = []  # what it shows


def served(name: str, run: Callable[[], int | None]) -> int:
    """Exit status of `run`, whose own one is 0 where it returns nothing; errors are told after the command's name."""
    global _command
    _command = name
    try:
        try:
            return run() or 0
        finally:
            for line in _lines:
                line.end()
    except InputError as error:
        status, message = INPUT, str(error)
    except OSError as error:
        status, message = FILES, _words(error)
    except MemoryError:
        status, message = FAULT, "out of memory"
    except Error as error:
        status, message = FAULT, str(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception as error:  # a fault of the package: all else is an InputError
        traceback.print_exc()
        status, message = FAULT, f"internal error: {error!r}"
    print(f"{name}: {message}", file=sys.stderr)
    return status


def _words(error: OSError) -> str:
    """File and reason, without the number that Python's own messages have."""
    return (f"{error.filename}: " if error.filename is not None else "") + (error.strerror or str(error))


class _Line:
    """The line of src/app/console.c: what is done, how much of it, and how long the rest takes."""

    def __init__(self, what: str) -> None:
        self.what, self.start = what, time.monotonic()
        self.done, self.total, self.told = 0, 0, 0.0
        self.lock, self.over = threading.Lock(), threading.Event()
        threading.Thread(target=self.follow, daemon=True).start()

    def follow(self) -> None:
        while not self.over.wait(SILENT):
            self.draw()

    def draw(self) -> None:
        with self.lock:
            if not self.over.is_set():
                print("\r\033[K" + self.text(time.monotonic()), end="", file=sys.stderr, flush=True)

    def text(self, now: float) -> str:
        words = [f"{_command}: {self.what}"]
        if self.total:
            filled = WIDTH * self.done // self.total
            words.append(f"[{'#' * filled}{'.' * (WIDTH - filled)}] {self.done}/{self.total}")
        words.append(_duration(now - self.start))
        if self.done:
            rate = self.done / max(self.told - self.start, 1e-9)
            left = max(0.0, (self.total - self.done) / rate - (now - self.told))
            words.append(f" {rate:.3g}/s  {_duration(left)} left")
        return " ".join(words)

    def tell(self, done: int, total: int) -> None:
        self.done, self.total, self.told = done, total, time.monotonic()
        if done < total:
            self.draw()
        else:
            self.end()

    def end(self) -> None:
        with self.lock:
            if not self.over.is_set():
                print(end="\r\033[K", file=sys.stderr, flush=True)
            self.over.set()


def _duration(seconds: float) -> str:
    minutes, s = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{s:02}" if minutes >= 60 else f"{minutes}:{s:02}"


def progress(what: str) -> Callable[[int, int], None]:
    """Shows on a terminal that this is being done, until the function that it returns is called with done = total;
    elsewhere nothing."""
    if not sys.stderr.isatty():
        return lambda done, total: None
    _lines.append(_Line(what))
    return _lines[-1].tell


def end_with_program() -> None:
    """This process ends with the program that has started it; signals are a KeyboardInterrupt, once."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)


def _interrupt(number: int, _: Any) -> None:
    for signals in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signals, signal.SIG_IGN)  # a terminal sends one, the end of the program that started this another
    raise KeyboardInterrupt
