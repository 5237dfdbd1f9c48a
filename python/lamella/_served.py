"""How the package's commands end: with an exit status, and what is wrong told in one line."""
import sys
from collections.abc import Callable

from ._library import Error, InputError

USAGE, INPUT, UNSOLVED, FILES, FAULT = 1, 2, 3, 4, 70  #: exit statuses (docs/reference/commands.md)
INTERRUPTED = 130


def served(name: str, run: Callable[[], int | None]) -> int:
    """Exit status of `run`, whose own one is 0 where it returns nothing; errors are told after the command's name."""
    try:
        return run() or 0
    except InputError as error:
        status, message = INPUT, str(error)
    except OSError as error:
        status, message = FILES, str(error)
    except MemoryError:
        status, message = FAULT, "out of memory"
    except Error as error:
        status, message = FAULT, str(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    print(f"{name}: {message}", file=sys.stderr)
    return status
