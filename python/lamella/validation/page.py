"""The page of the experiments, docs/results/validation.md, and its picture."""
from collections.abc import Sequence

from . import Experiment, Mode, Row

TITLE, WHAT = "# Against measurements", "What was published of fruit and vegetables, and what Lamella finds for it."
MEANS = {True: "yes", False: "**no**"}


def number(value: float) -> str:
    """With three digits."""
    return f"{value:.3g}"


def _range(low: float, high: float) -> str:
    return f"{number(low)} to {number(high)}"


def _found(row: Row) -> str:
    return number(row.predicted) + (f" ({_range(*row.interval)})" if row.interval else "")


def _row(row: Row) -> str:
    kind = ("fitted" if row.fitted else "yes" if row.inside else "by its interval" if row.within
            else f"**no**, by a factor of {number(row.miss)}")
    unit = f", {row.unit}" if row.unit else ""
    return f"| {row.what}{unit} | {_range(row.low, row.high)} | {_found(row)} | {kind} |"


def _mode(mode: Mode) -> str:
    return f"| {mode.what} | {mode.seen} | {mode.found} | {MEANS[mode.right]} |"


def _section(e: Experiment) -> list[str]:
    lines = [f"## {e.title}", "", f"**Source.** {e.source}. {e.read}", "", f"**Chosen or fitted.** {e.chosen}", ""]
    if e.rows:
        lines += ["| figure | measured | Lamella | agrees |", "|---|---|---|---|", *map(_row, e.rows), ""]
    if e.modes:
        lines += ["| which | seen | Lamella | right |", "|---|---|---|---|", *map(_mode, e.modes), ""]
    return [*lines, e.lesson, ""]


def counts(told: Sequence[Experiment]) -> dict[str, int]:
    """How many experiments there are, have predicted figures, all within their scatter; and modes, and right ones."""
    modes = [mode for e in told for mode in e.modes]
    return {"experiments": len(told), "predicted": sum(e.verdict != "none" for e in told),
            "within": sum(e.verdict == "within" for e in told),
            "figures": sum(not row.fitted for e in told for row in e.rows),
            "inside": sum(row.inside and not row.fitted for e in told for row in e.rows),
            "by_interval": sum(row.within and not row.inside and not row.fitted for e in told for row in e.rows),
            "modes": len(modes),
            "right": sum(mode.right for mode in modes)}


def summary(told: Sequence[Experiment]) -> str:
    of = counts(told)
    modes = f". {of['right']} of {of['modes']} modes of failure and trends are right" if of["modes"] else ""
    return (f"{of['experiments']} experiments. Of {of['figures']} predicted figures {of['inside']} are as measured, "
            f"{of['by_interval']} agree by their interval; all do in {of['within']} of the {of['predicted']} "
            f"experiments that have such figures{modes}")


def misses(told: Sequence[Experiment]) -> list[tuple[Experiment, Row]]:
    """Figures that were predicted and do not agree, the worst first."""
    found = [(e, row) for e in told for row in e.rows if not row.fitted and not row.within]
    return sorted(found, key=lambda of: -of[1].miss)


def page(told: Sequence[Experiment]) -> str:
    """Markdown."""
    lines = [
        TITLE, "",
        f"{WHAT} `lamella validate` solves all of it anew and writes this page. Figures are as abstracts and open pages "
        "give them; nothing was measured for this program. Each experiment says what was chosen or fitted; all else "
        "was predicted.", "",
        "An interval behind a prediction holds 95 % of 40 samples of what is not known of the tissue (walls, sizes "
        "of cells: [tissues](tissues.md)); of a mean over tissues it is that of the mean. A figure agrees (*yes*) "
        "where the predicted value was measured, and *by its interval* where that and the measured one have values in "
        "common: the wider an interval, the less that says. Where a source tells no scatter, a tenth is allowed.", "",
        f"**{summary(told)}.**", "", "![Predicted over measured](../figures/validation.png)", "",
        "## What misses, and why", ""]
    missed = misses(told)
    if missed:
        lines += ["| figure | measured | Lamella | factor between the nearest ends |", "|---|---|---|---|"]
        lines += [f"| {e.title}: {row.what} | {_range(row.low, row.high)} | {_found(row)} | "
                  f"{number(row.miss)} |" for e, row in missed]
        lines += ["", "The reasons are told with each experiment below.", ""]
    for e in told:
        lines += _section(e)
    lines += [NOT_SET_UP]
    return "\n".join(_wrapped(lines)) + "\n"


NOT_SET_UP = """## What was not set up

* **Single tomato cells** that are compressed and relax (Li et al. 2016: 2.5 mN at 15 %, 0.48 and 0.033 s): a cell alone
  between plates is a closed shell in space; Lamella has tissue, whose cells fill it.
* **Failure of potato against its water potential** (Haman & Burgess 2000) has a direction, no figure: with apple above.
* **Moduli of walls** (Wang, Wang & Thomas 2004; Zamil et al.) are what tissues are made of, not what is predicted."""


def _wrapped(lines: list[str]) -> list[str]:
    """Paragraphs in lines of 120 characters; tables and headings as they are."""
    import textwrap
    wrapped: list[str] = []
    for line in lines:
        if len(line) <= 120 or line.startswith(("|", "#", "!")) or "\n" in line:
            wrapped.append(line)
        else:
            wrapped += textwrap.wrap(line, 120, break_long_words=False, break_on_hyphens=False)
    return wrapped
