"""Several pages: one PDF, or numbered files."""
import io
from pathlib import Path

import matplotlib
from matplotlib.backends.backend_pdf import PdfPages

from .page import IMAGE_DPI, STYLE, write


def save_all(pages, path, dpi=None, progress=None):
    """film.pdf with a page each, or film-0001.png and so on; one page alone has the name as it is."""
    path, tell = Path(path), progress or (lambda done: None)
    if path.suffix.lower() != ".pdf":
        for k, page in enumerate(pages, 1):
            page.save(path if len(pages) == 1 else path.with_name(f"{path.stem}-{k:04d}{path.suffix}"), dpi)
            tell(k)
        return
    whole = io.BytesIO()
    with matplotlib.rc_context(STYLE), PdfPages(whole, metadata={"CreationDate": None}) as book:
        for k, page in enumerate(pages, 1):
            book.savefig(page, dpi=dpi or IMAGE_DPI)
            tell(k)
    write(path, whole.getvalue())
