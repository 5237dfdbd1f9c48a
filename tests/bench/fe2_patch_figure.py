"""Draws the curves of bench_fe2_patch: fe2_patch_figure.py TABLE FIGURE.png|.svg|.pdf"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from lamella.plot.page import DASHES, LINES, WIDTH, Page, legend, settle, styled  # noqa: E402

CURVES = (("bonded, free, sheared", 0), ("contact, free, pulled", 0), ("contact, free, sheared", 1),
          ("contact, affine, pressed", 0))
MARKERS, QUANTITIES, UNITS = "os^D", ("nominal stress $P_{{{}}}$ (MPa)", "opening, share of volume"), ("stress", "opening")


def difference(curve, limit):
    """Largest along the curve, over the largest value of FE2; NaN of a curve that ended before."""
    return np.abs(curve - limit).max() / np.abs(limit).max() if len(curve) == len(limit) else np.nan


@styled
def draw(table):
    cases = list(dict.fromkeys(table["case"]))
    of = lambda case, curve: table[(table["case"] == case) & (table["curve"] == curve)]
    blocks = sorted({int(curve) for curve in table["curve"] if curve != "FE2"})
    page, wide, high = Page(WIDTH, 3 * 190 + 60), WIDTH / 2, 190
    for k, (case, quantity) in enumerate(CURVES):
        axes = page.chart(9 + k % 2 * wide, 8 + k // 2 * (high + 10), wide - 18, high - 8)
        for i, n in enumerate(blocks):
            rows = of(case, str(n))
            axes.plot(rows["load"], rows[UNITS[quantity]], color=LINES[i], marker=MARKERS[i], markerfacecolor="white",
                      linestyle=DASHES, label=f"{n} × {n}")
        rows = of(case, "FE2")
        component = rows["component"][0]
        axes.plot(rows["load"], rows[UNITS[quantity]], "o-", color="black", label="FE²")
        axes.set(xlabel=f"{'shear' if component == 12 else 'stretch'} $F_{{{component}}}$",
                 ylabel=QUANTITIES[quantity].format(component),)
        axes.text(0.98, 0.03, case, transform=axes.transAxes, ha="right")
        legend(page, axes)
    for k, name in enumerate(UNITS):
        axes = page.chart(9 + k * wide, 2 * high + 30, wide - 18, high + 24)
        for i, case in enumerate(cases):
            limit = of(case, "FE2")[name]
            if len(limit) == 0 or (k and case.startswith("bonded")):
                continue
            axes.plot(blocks, [difference(of(case, str(n))[name], limit) for n in blocks], color=LINES[i // 3],
                      marker=MARKERS[i % 3], markerfacecolor="white" if i % 3 == 1 else None,
                      linestyle=DASHES if i % 3 == 2 else "-", label=case)
        axes.set(xscale="log", yscale="log", xlabel="cells in a row $n$", ylabel=f"difference of {name}")
        axes.set_xticks(blocks, map(str, blocks))
        axes.minorticks_off()
        legend(page, axes)
    return settle(page)


if __name__ == "__main__":
    draw(np.genfromtxt(sys.argv[1], delimiter="\t", names=True, dtype=None, encoding="utf-8")).save(sys.argv[2])
