"""How stiff tissue is: turgor, size of the section, air."""
import json
import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .. import program
from ..calibration import Figures, calibrate
from . import Experiment, Mode, Row, Scene, about, band, changed, figures, pulled, samples, tissue

UNIAXIAL = 0.75  #: Young's modulus over the modulus in plane strain, of an incompressible isotropic solid
PLANE = "Lamella's cells are prisms, so that a modulus is one in plane strain; 3/4 of it is compared, as of an isotropic " \
        "incompressible solid."
END_WALLS = "The prisms have no end walls. In a plane section a hexagon changes its shape without stretching a wall, and " \
            "what resists is turgor alone; in a closed cell the walls above and below are sheared, too"


def _potato() -> Scene:
    """Whose cells keep their water in the test."""
    return tissue("potato", pulled(1.01), mode="sealed")


def _moduli(of: Scene, pressures: tuple[float, ...]) -> np.ndarray:
    """Uniaxial moduli, MPa [samples, pressures]."""
    drawn = samples(of)
    told = figures([changed(each, p) for each in drawn for p in pressures])
    return UNIAXIAL * 1e-6 * np.reshape([t.get("modulus", math.nan) for t in told], (len(drawn), -1))


def nilsson() -> Experiment:
    low, high = 0.2, 0.6
    E = _moduli(_potato(), (0.01, low, high))
    slope = (E[:, 2] - E[:, 1]) / (high - low)
    rows = [Row("rise of Young's modulus with turgor", "MPa/MPa", *about(3.6), *band(slope)),
            Row("Young's modulus without turgor", "MPa", *about(2.5), *band(E[:, 0] - slope * 0.01))]
    return Experiment(
        "nilsson", "Potato: stiffness against turgor", "Nilsson, Hertz & Falk, Physiol. Plant. 11 (1958)",
        "Young's modulus E = 3.6 p + 2.5 MPa (as it is cited; the original was not seen). No scatter is told: 10 % is "
        f"allowed. {PLANE}",
        "Nothing. Cells keep their water during the test. Walls, their thickness and the size of cells vary over their "
        "intervals.",
        "The rise is nearly free of material: 6 p in plane strain for walls that do not stretch. " + END_WALLS +
        ": that is the part without turgor, and it takes over some of the turgor's.", rows,
        [Mode("stiffness with turgor", "rises", "rises" if slope[0] > 0 else "falls")])


def niklas() -> Experiment:
    E = _moduli(_potato(), (0.01, 0.4))
    rows = [Row("Young's modulus at -0.4 MPa (turgor 0.4 MPa)", "MPa", *about(19), *band(E[:, 1])),
            Row("Young's modulus at -1.4 MPa (limp)", "MPa", *about(1.2), *band(E[:, 0]))]
    stiff = calibrate({"rve.wall.C1": ("20 MPa", "2000 MPa")},
                      [Figures(changed(_potato(), 0.4), {"modulus (MPa)": (19 / UNIAXIAL, 1.9)})], starts=1)
    return Experiment(
        "niklas", "Potato: stiffness against water potential", "Niklas, Amer. J. Bot. 75 (1988)",
        "1.2 and 19 MPa at water potentials of -1.4 and -0.4 MPa, as the abstract has them; no scatter is told, 10 % is "
        f"allowed. Turgor: osmotic pressure 0.8 MPa less what the potential is below 0, at least none. {PLANE}",
        f"Nothing. A fit of the walls' modulus C1 to 19 MPa ends at {stiff.values[0]:.3g} MPa, "
        f"{stiff.values[0] / 20:.0f} times the estimate, which no wall has.",
        END_WALLS + ": with C1 of 20 to 80 MPa a closed cell's would add some 2 to 10 MPa. Of Niklas's and Nilsson's "
        "moduli at one turgor the former are five times the latter, and were found by vibration.", rows,
        [Mode("stiffness as water is lost", "falls", "falls" if E[0, 1] > E[0, 0] else "rises")])


def _section(radius: float, layer: float) -> Scene:
    """A potato cylinder (mm) whose outer layer has lost its turgor, compressed by 1 % along its axis."""
    of = _potato()
    rve: dict[str, Any] = of["rve"] | {"turgor": {"pressure": "0.3 MPa"}, "mesh": {"along": 4, "through": 1}}
    inner = max(round(6 * (radius - layer) / radius), 1)
    return {"version": 1, "rve": rve, "accuracy": 0.05, "macro": {
        "symmetry": "axisymmetric", "mesh": {"box": [f"{radius} mm", f"{radius} mm"], "elements": [12, 2]},
        "regions": [{"name": "cut", "where": f"x > {radius - layer}", "turgor": {"pressure": "0.005 MPa"}}],
        "boundary": [{"on": "left", "symmetry": True}, {"on": "bottom", "symmetry": True},
                     {"on": "top", "displacement": ["free", f"{-0.01 * radius} mm"]}], "steps": 1}}


def section() -> Experiment:
    areas, seen = (20.0, 250.0), (5.0, 19.0)  # mm^2, MPa
    radii = [math.sqrt(area / math.pi) for area in areas]

    def ratio(layer: float) -> float:
        told = figures([_section(radius, layer) for radius in radii])
        return told[0]["modulus"] / told[1]["modulus"]
    cells = 2 * 0.09
    found = ratio(cells)
    return Experiment(
        "section", "Potato: stiffness against the size of the section", "Niklas, Amer. J. Bot. 75 (1988)",
        "5 and 19 MPa for sections of 0.2 and 2.5 cm², as the abstract has them: a ratio of 0.26. No scatter is told: "
        "10 % is allowed.",
        "Nothing. Cylinders of these sections whose outermost layer of cells, 0.18 mm, is cut open and without turgor.",
        "One layer of cut cells explains a quarter of the effect. To explain all of it, tissue would have to be limp to "
        "a depth of 1.1 mm, six cells: a small section has lost water, or is hurt, farther in.",
        [Row("modulus of the small section over that of the large one", "", *about(seen[0] / seen[1]), found)],
        [Mode("the smaller section", "softer", "softer" if found < 1 else "stiffer")])


def ting() -> Experiment:
    told = []
    with tempfile.TemporaryDirectory() as folder:
        for gas in (0.170, 0.293, 0.298):
            for seed in range(2):
                tissue = Path(folder) / f"{gas}-{seed}.json"
                program.run("tissue", "-o", tissue, "--cells", 30, "--size", "180 um", "--variation", 0.3, "--gas", gas,
                            "--wall-thickness", "1.5 um", "--seed", seed)
                of = _potato()
                rve = {name: block for name, block in of["rve"].items() if name != "cell"} | {"tissue": str(tissue)}
                told.append({"version": 1, "rve": rve, "load": of["load"]})
        E = np.reshape([t["modulus"] for t in figures(json.loads(json.dumps(told)))], (3, 2)).mean(axis=1)
    return Experiment(
        "ting", "Apple: air alone does not tell firmness", "Ting et al. (2013)",
        "Air spaces of 17.0, 29.3 and 29.8 %, firmness of 29.8, 28.4 and 14.2 N: cultivars with the same air differ by a "
        "factor of two. A control: a model that told firmness by air would be wrong.",
        "Nothing. Irregular tissue with these shares of air, all else alike; stiffness stands for firmness.",
        "Air alone changes stiffness by less than the cultivars differ: the remaining factor is one of walls, turgor and "
        "lamella.",
        [Row("29.3 % air against 17.0 %", "", 14.2 / 29.8, 28.4 / 29.8, E[1] / E[0])],
        [Mode("two cultivars with 29.3 and 29.8 % of air", "differ by more than air",
              "differ by more than air" if abs(E[2] / E[1] - 1) < 0.3 else "differ by air")])
