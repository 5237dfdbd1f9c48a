"""What `lamella plot` runs: one argument, a JSON object with the file, the options of its picture and where it goes."""
import json
import sys

from .._served import served
from . import draw, fields, save
from .page import check_path


def _progress(total):
    """A line on the terminal that tells how many pages are written."""
    if not sys.stderr.isatty():
        return None

    def tell(done):
        print(f"\r\033[K{done} of {total} pages" if done < total else "\r\033[K", end="", file=sys.stderr, flush=True)
    return tell


def run(request):
    """Draws, writes, and tells what it has written."""
    path, outputs = request.pop("input"), request.pop("outputs")
    dpi, quiet, silent = (request.pop(name, None) for name in ("dpi", "quiet", "silent"))
    for output in outputs:
        check_path(output)
    drawn = draw(path, **request)
    for output in outputs:
        save(drawn, output, dpi, None if quiet or not isinstance(drawn, list) else _progress(len(drawn)))
        if not silent:
            print(f"wrote {output}", flush=True)


def main(argument):
    """Exit status of a request."""
    if argument == "fields":
        print("\n".join(fields()))
        return 0
    return served("lamella", lambda: run(json.loads(argument)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
