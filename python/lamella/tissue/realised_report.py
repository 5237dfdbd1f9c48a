"""The table of `lamella rve --realisations`."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeAlias

from . import scatter

Object: TypeAlias = dict[str, Any]
MOST_TOLD = 10  #: failed states that are told in words; --json has all


def _number(value: float | None, width: int = 11) -> str:
    return f"{'-':>{width}}" if value is None else f"{value:{width}.3e}"


def _percent(value: float | None) -> str:
    return f"{'-':>9}" if value is None else f"{100 * value:9.3g}"


def _interval(values: list[float] | None, form: str) -> str:
    return "-" if values is None else f"{values[0]:{form}} to {values[1]:{form}}"


def _row(label: str, q: Object, entry: Object) -> str:
    unit = "" if q["unit"] == "1" else q["unit"]
    return (f"{label:>5s} {q['name']:17s} {unit:4s} {entry['cells']:6d} {entry['count']:6d} {_number(entry['mean'])} "
            f"{_number(entry['deviation'])}   {_interval(entry['interval'], '10.3e')}")


def _quantities(told: Object) -> Iterator[str]:
    yield f"{'state':>5s} {'':17s} {'':4s} {'cells':>6s} {'solved':>6s} {'mean':>11s} {'deviation':>11s}   " \
          "95 % interval of the mean"
    groups = [("rest", told["rest"])] + [(str(entry["state"]), entry) for entry in told["states"]]
    groups += [("", told["failure"])] if "failure" in told else []
    for label, group in groups:
        for q in group["quantities"]:
            yield from (_row(label, q, entry) for entry in q["sizes"])


def _scatter_row(label: str, of: Object) -> str:
    fit = of["fit"]
    row = f"{label:>5s} {of['name']:7s}" + "".join(_percent(entry["deviation"]) for entry in of["sizes"])
    if fit is None:
        return row + f"{'-':>9}{'-':>9}"
    row += _percent(fit["s1"]) + f"{of['need']['cells']:9d}"
    if fit["exponent"] is None:
        return row
    return row + f"   {fit['exponent']:5.2f}, {_interval(fit['exponent_interval'], '.2f')}" + \
        ("" if fit["holds"] else ": not -1/2")


def _scatter(told: Object) -> Iterator[str]:
    yield "scatter of one period, %, its fit s1/sqrt(cells), and the cells of one period for the accuracy"
    yield f"{'state':>5s} {'':7s}" + "".join(f"{size['cells']:9d}" for size in told["sizes"]) + \
        f"{'s1':>9s}{'needed':>9s}   exponent of cells, 95 % interval"
    yield from (_scatter_row("rest", of) for of in told["rest"]["moduli"])
    yield from (_scatter_row(str(state["state"]), state["stress"]) for state in told["states"])


def _isotropy(told: Object) -> Iterator[str]:
    yield "isotropy of the tangent at rest"
    yield f"{'cells':>6s} {'A1111 - A2222':>13s}   {'95 % interval, MPa':26s} of isotropic A, %   by scatter, %"
    for entry in told["rest"]["isotropy"]:
        d = entry["difference"]
        yield (f"{entry['cells']:6d} {_number(d['mean'], 13)}   {_interval(d['interval'], '11.3e'):26s} "
               f"{_percent(entry['distance']):>17s}   {_percent(entry['distance_by_scatter']):>13s}")


def _failure(told: Object) -> Iterator[str]:
    for of, peak in zip(told["failure"]["modes"], told["failure"]["peaks"]):
        modes = ", ".join(f"{mode} {count}" for mode, count in sorted(of["modes"].items()))
        yield f"failure of {of['cells']} cells: {modes or 'not known'}; the curve of {peak['passed']} of " \
              f"{peak['count']} has passed its peak"


def _bias(told: Object) -> Iterator[str]:
    """Of moduli at rest and of stresses; --json has all."""
    groups = [("rest", told["rest"])] + [(str(entry["state"]), entry) for entry in told["states"]]
    head = "bias: means beside that of the largest period, where they are apart by more than their intervals"
    for label, group in groups:
        for q in group["quantities"]:
            if not q["bias"] or (label != "rest" and q["name"][0] != "P"):
                continue
            if head:
                yield head
            of, head = {entry["cells"]: entry["mean"] for entry in q["sizes"]}, ""
            last = max(cells for cells, mean in of.items() if mean is not None)
            yield f"{label:>5s} {q['name']:17s} {q['unit']:4s}" + \
                ",".join(f"{of[n]:11.3e} of {n} cells" for n in [*(b["cells"] for b in q["bias"]), last])


def _failed(told: Object) -> Iterator[str]:
    for f in told["failed"][:MOST_TOLD]:
        state = "" if f["state"] is None else " at rest" if f["state"] == 0 else f", state {f['state']}"
        yield f"failed: {f['cells']} cells, realisation {f['realisation']} (seed {f['seed']}){state}: {f['reason']}"
    if len(told["failed"]) > MOST_TOLD:
        yield f"failed: {len(told['failed']) - MOST_TOLD} more, which --json tells"
    if told["failed"]:
        yield "means are those of the others, which may be biased by that"


def _need(told: Object) -> str:
    need = told["need"]
    if need is None:
        return "the scatter of the stress is not known: it is prescribed, or too few are solved"
    (state,) = (entry for entry in told["states"] if entry["state"] == need["state"])
    off = {entry["cells"]: entry["bias"] or 0 for entry in state["stress"]["sizes"]}
    counts = (f"{r['count']} of {r['cells']}" + (f" (whose mean is off by {100 * off[r['cells']]:.2g} %)"
                                                 if off[r["cells"]] > need["accuracy"] else "")
              for r in need["realisations"])
    too_many = f", more than the {scatter.MOST} that a scene takes" if need["cells"] > scatter.MOST else ""
    text = f"for accuracy {100 * need['accuracy']:g} % of the stress with 95 % confidence (state {need['state']}): 1 " \
           f"period of {need['cells']} cells{too_many}, or " + ", or ".join(counts)
    if need["holds"] is None:
        return text + "; that scatter falls as 1/sqrt(cells) is taken for granted: give several sizes by --cells"
    return text if need["holds"] else text + "; not safe, since scatter does not fall as 1/sqrt(cells)"


def table(told: Object) -> list[str]:
    """Lines of the table."""
    mesh, sizes = told["mesh"], told["sizes"]
    made = ", ".join(f"{size['made']} of {size['cells']} cells" for size in sizes)
    lines = [f"tissues like that of {told['scene']}: {made}; mesh {mesh['along']} x {mesh['through']}",
             *_quantities(told), *_scatter(told), *_isotropy(told)]
    if "failure" in told:
        lines += _failure(told)
    return [*lines, *_bias(told), *_failed(told), _need(told)]
