# slow: The notebooks of docs/notebooks run, and say what they show; LAMELLA_UPDATE_DOCS=1 writes what they say now.
. "$(dirname "$0")/common.sh"

python=/usr/bin/python3
export PYTHONPATH=$source/python LAMELLA_LIBRARY LAMELLA_PROGRAM=$lamella IPYTHONDIR=$work/ipython PYDEVD_DISABLE_FILE_VALIDATION=1
LAMELLA_LIBRARY=$(dirname "$lamella")
"$python" -c 'import ipykernel, nbclient, scipy, h5py, matplotlib, cffi, yaml' 2>/dev/null || { echo "skipped: python3-nbclient, -ipykernel, -scipy are not installed"; exit 77; }
[ -f "$LAMELLA_LIBRARY/liblamella.so" ] || { echo "skipped: no shared library in this build"; exit 77; }
! nm -D "$LAMELLA_LIBRARY/liblamella.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by Python"; exit 77; }
mkdir -p docs/notebooks
ln -s "$source/tests" tests
ln -s "$source/integrations" integrations

"$python" - "$source/docs/notebooks" <<'PYTHON' || fail "notebooks"
import importlib.util
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
import nbformat
from nbclient import NotebookClient

def texts(cell):
    """What a cell says, without pictures; names of objects in memory are no claim."""
    said = []
    for output in cell.get("outputs", ()):
        text = output.get("text") or output.get("data", {}).get("text/plain", "")
        said += [] if " object at 0x" in text or text.startswith("<") else [text]
    return "".join(said)

def run(path):
    book = nbformat.read(path, 4)
    shown = [texts(cell) for cell in book.cells]
    with_figure = [any("image/png" in o.get("data", {}) for o in cell.get("outputs", ())) for cell in book.cells]
    NotebookClient(book, timeout=300, resources={"metadata": {"path": "docs/notebooks"}}).execute()
    if os.environ.get("LAMELLA_UPDATE_DOCS"):
        for cell in book.cells:
            cell.metadata.pop("execution", None)
        nbformat.write(book, path)
        return
    for cell, wanted, figure in zip(book.cells, shown, with_figure):
        assert texts(cell) == wanted, f"{path.name} shows\n{wanted}\nbut says\n{texts(cell)}"
        assert figure == any("image/png" in o.get("data", {}) for o in cell.get("outputs", ())), f"{path.name}: no figure"

books = sorted(Path(sys.argv[1]).glob("*.ipynb"))
assert len(books) == 5
if not importlib.util.find_spec("dolfinx"):
    books = [book for book in books if "fenicsx" not in book.name]
with ThreadPoolExecutor(2) as pool:
    list(pool.map(run, books))
PYTHON

# the first figure takes ten lines at most
"$python" - "$source/docs/notebooks/first-state.ipynb" <<'PYTHON' || fail "lines to the first figure"
import json, sys
lines = 0
for cell in json.load(open(sys.argv[1]))["cells"]:
    if cell["cell_type"] == "code":
        lines += len("".join(cell["source"]).splitlines())
        if any("image/png" in output.get("data", {}) for output in cell["outputs"]):
            break
assert lines <= 10, lines
PYTHON
