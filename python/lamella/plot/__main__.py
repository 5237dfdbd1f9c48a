"""What `lamella plot` runs: one argument, a JSON object with the file, the options of its picture and where it goes."""
import json
import sys

from .._served import progress, served
from . import draw, fields, save
from .page import check_path


def run(request):
    """Draws, writes, and tells what it has written."""
    path, outputs = request.pop("input"), request.pop("outputs")
    dpi, quiet, silent = (request.pop(name, None) for name in ("dpi", "quiet", "silent"))
    for output in outputs:
        check_path(output)
    drawn = draw(path, **request)
    for output in outputs:
        tell = progress("pages") if isinstance(drawn, list) and not quiet else None
        save(drawn, output, dpi, tell and (lambda done, tell=tell: tell(done, len(drawn))))
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
