"""How the package's commands end: with an exit status, and what is wrong told in one line."""
import ctypes
import signal
import sys
import traceback
from collections.abc import Callable
from typing import Any

from ._library import Error, InputError

USAGE, INPUT, UNSOLVED, FILES, FAULT = 1, 2, 3, 4, 70  #: exit statuses (docs/reference/commands.md)
INTERRUPTED = 130
PR_SET_PDEATHSIG = 1  # linux/prctl.h


def served(name: str, run: Callable[[], int | None]) -> int:
    """Exit status of `run`, whose own one is 0 where it returns nothing; errors are told after the command's name."""
    try:
        return run() or 0
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


def progress(what: str) -> Callable[[int, int], None]:
    """Tells on a terminal how many are done: "3 of 64 samples"."""
    def told(done: int, total: int) -> None:
        if sys.stderr.isatty():
            print(f"\r\033[K{done} of {total} {what}" if done < total else "\r\033[K", end="", file=sys.stderr,
                  flush=True)
    return told


def end_with_program() -> None:
    """This process ends with the program that has started it; signals are a KeyboardInterrupt, once."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)


def _interrupt(number: int, _: Any) -> None:
    for signals in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signals, signal.SIG_IGN)  # a terminal sends one, the end of the program that started this another
    raise KeyboardInterrupt
