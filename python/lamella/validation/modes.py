"""How tissue fails: walls or lamella, and when."""
import copy
import math
from typing import Any

import numpy as np

from .. import RVE, scene_dict
from ..measured import read_off
from . import (TISSUES, Experiment, Mode, Row, Scene, band, changed, figures, followed, number_of, pulled, samples,
               tissue)

GAP = 0.381 - 0.161  #: /min, between the rates of lamella and walls of cooked carrot
LIMP = 0.001  #: MPa, a turgor that is none
SEEN = {"rupture": "cells tear", "separation": "cells part"}


def _limit(of: Scene) -> float:
    """The strength of walls over that of the lamella at which both fail at once; above it cells part."""
    def excess(ratio: float) -> float:
        tried = copy.deepcopy(of)
        wall = float(tried["strength"]["wall"].split()[0])
        tried["strength"]["lamella_normal"] = f"{wall / ratio!r} MPa"
        return 1.0 if read_off(tried, failure=True)["mode"] == "separation" else -1.0
    low, high = 1.0, 30.0
    while high / low > 1.02:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if excess(middle) > 0 else (middle, high)
    return math.sqrt(low * high)


def _ratio(of: Scene) -> float:
    return float(of["strength"]["wall"].split()[0]) / float(of["strength"]["lamella_normal"].split()[0])


def de_belie() -> Experiment:
    of = tissue("pear", pulled(1.6, 24), {"wall": "60 MPa", "lamella_normal": "20 MPa"})
    end = followed([scene_dict(str(TISSUES / "pear.yaml"))])[0]
    fresh = number_of(of["rve"]["turgor"]["pressure"])
    firm, soft = changed(of, fresh), changed(of, *(end[name] for name in ("turgor", "walls", "lamella")))
    told = figures([firm, soft], failure=True)
    drawn = samples(of)
    strength = [[t.get("failure.stress", math.nan) for t in figures([changed(each, p) for each in drawn], failure=True)]
                for p in (fresh, LIMP)]
    bath = band(np.divide(strength[1], strength[0]))
    limits = [_limit(each) for each in (firm, soft)]
    harvest = limits[1] * end["lamella"] / end["walls"]
    return Experiment(
        "de-belie", "Pear: ripening and baths",
        "De Belie, Hallett, Harker & De Baerdemaeker, J. Am. Soc. Hort. Sci. 125 (2000)",
        "As firmness falls from 100 to 20 N, cells that tear become cells that part. In hypertonic baths, in which "
        "cells lose their turgor, the strength of firm fruit (0.8 N and more) falls by up to 0.6 N, to 0.25 of what "
        "it was or more.",
        f"Softened: moduli and strength of walls to {end['walls']:.2f}, of the lamella to {end['lamella']:.2f}, "
        f"turgor from 0.12 to {end['turgor']:.3f} MPa, as after ten days by [the page of the tissues](tissues.md). "
        f"Chosen within what follows: walls {_ratio(of):.1f} times as strong as the lamella. Both modes are found "
        f"wherever that ratio, at harvest, is between {harvest:.1f} and {limits[0]:.1f}: this interval is what the "
        "experiment tells of adhesion.",
        "The change of the mode is found. That a bath weakens firm fruit is not: without turgor Lamella's tissue is "
        "as strong as before, since walls that turgor does not stretch any more bear more from outside. What else a "
        "bath does - it leaches, cells shrink from their walls - is not in the model.",
        [Row("strength in the bath over that of turgid fruit, firm", "", 0.25, 1.0, *bath)],
        [Mode("firm fruit", "cells tear", SEEN.get(told[0]["mode"], told[0]["mode"])),
         Mode("soft fruit", "cells part", SEEN.get(told[1]["mode"], told[1]["mode"]))])


def verlinden() -> Experiment:
    of = tissue("carrot", pulled(1.6, 24), {"wall": "100 MPa", "lamella_normal": "40 MPa"})
    minutes = np.array([0, 2, 5, 10, 20])
    walls, lamella = np.exp(-0.161 * minutes), np.exp(-0.381 * minutes)
    raw = changed(of, number_of(of["rve"]["turgor"]["pressure"]))
    cooked = [changed(of, LIMP, w, l) for w, l in zip(walls, lamella)]
    told = figures([raw, *cooked], failure=True)
    limit, turgid = _limit(cooked[0]), _limit(raw)
    change = math.log(limit / _ratio(of)) / GAP
    return Experiment(
        "verlinden", "Carrot: cooking",
        "Verlinden, De Baerdemaeker et al. (1996); rates as Lee, Food Eng. Prog. 21 (2017), has them",
        "Raw carrot breaks through its cells; as the lamella dissolves cells part, and the share of torn cells tells "
        "better than moduli how far it is cooked. At 100 °C the modulus falls at 0.161 /min, the stress of rupture "
        "at 0.381 /min.",
        f"Chosen: walls {_ratio(of):.1f} times as strong as the lamella when raw. Walls fall by the first rate, in "
        "modulus and strength, the lamella by the second; turgor goes at once. Raw carrot tears wherever the ratio "
        f"is below {turgid:.1f}, limp below {limit:.1f}.",
        f"One number was chosen and two modes follow. The ratio of strengths grows by {100 * (math.exp(GAP) - 1):.0f} "
        f"% in a minute at 100 °C, so that raw carrot whose walls are 1 to {turgid:.1f} times as strong as its "
        f"lamella changes its mode after {math.log(limit) / GAP:.1f} to {math.log(limit / turgid) / GAP:.1f} min: the "
        f"ratio chosen after {change:.1f} min, when the modulus still has {100 * math.exp(-0.161 * change):.0f} %. "
        "The share of torn cells then goes from all to none "
        "while the modulus falls by a few per cent, which is why it judges cooking.", [],
        [Mode("raw", "cells tear", SEEN.get(told[0]["mode"], told[0]["mode"])),
         Mode("cooked for 20 min", "cells part", SEEN.get(told[-1]["mode"], told[-1]["mode"]))])


def _strains(of: Scene, pressures: tuple[float, ...]) -> list[float]:
    return [t.get("failure.strain", math.nan) for t in figures([changed(of, p) for p in pressures], failure=True)]


def pitt_chen() -> Experiment:
    of = tissue("apple", pulled(1.5, 20), {"wall": "60 MPa", "lamella_normal": "30 MPa"})
    strain = _strains(of, (0.1, 0.3, 0.5))
    fast, slow = (_at_rate(of, seconds) for seconds in (1.0, 100.0))
    return Experiment(
        "pitt-chen", "Apple and potato: strain at failure against turgor and rate",
        "Pitt & Chen (1983), apple; Haman & Burgess (2000), potato",
        "The strain at failure falls as turgor rises, and as the test is faster (apple); strength and strain fall "
        "with the water potential, read as its rise (potato). Directions, no figures.",
        "Walls that tear at a tension of 60 MPa. For the rate: half of the walls' stress relaxes in 5 s; 1 s and 100 "
        "s to the same strain.",
        "Turgor has stretched the walls before the test: at 0.1, 0.3 and 0.5 MPa they tear at strains of "
        f"{strain[0]:.2f}, "
        f"{strain[1]:.2f} and {strain[2]:.2f}.", [],
        [Mode("strain at failure as turgor rises", "falls", "falls" if strain[0] > strain[1] > strain[2] else "rises"),
         Mode("tension of walls at a strain of 0.1, faster", "higher", "higher" if fast > slow else "lower")])


def _at_rate(of: Scene, seconds: float) -> float:
    """Largest tension of walls at a strain of 0.1 that is reached in this time."""
    wall = of["rve"]["wall"] | {"relaxation": [{"share": 0.5, "time": "5 s"}]}
    cell = {name: value for name, value in of["rve"]["cell"].items() if name != "length"}  # of walls without memory
    relaxing = {"version": 1, "rve": of["rve"] | {"wall": wall, "cell": cell}, "load": pulled(1.1, 10, seconds)}
    return float(RVE(relaxing).solve(derivatives=False).max_wall_tension[-1])


def _energies(of: Scene) -> tuple[float, float]:
    """Energy per volume that is set free when all lamellae of sheared tissue part, kJ/m^3, and what is then open."""
    bonded, apart = (copy.deepcopy(of) for _ in range(2))
    apart["rve"]["interface"] = {"law": "contact", "cohesion": "0 MPa"}
    one, two = (RVE(each).solve(derivatives=False) for each in (bonded, apart))
    freed = (one.energy[-1] - one.energy[0]) - (two.energy[-1] - two.energy[0])
    return 1e-3 * float(freed), float(two.open_fraction[-1])


def paper() -> Experiment:
    def at(fibres: float, turgor: float, shear: float = 0.3) -> dict[str, Any]:
        return {"version": 1, "rve": {
            "cell": {"apothem": "75 um", "wall_thickness": "11.25 um"}, "wall": {
                "law": "fibre_mooney_rivlin", "C1": "0.1 MPa", "C2": "0.01 MPa", "C4": f"{fibres} MPa"},
            "turgor": {"pressure": f"{turgor} MPa"}, "interface": {"law": "bonded"},
            "mesh": {"along": 8, "through": 2}},
            "load": [{"F": [[1, 0], [0, 1]]}, {"ramp": {"to": [[1, shear], [0, 1]], "steps": 6}}]}
    (weak, _), (strong, gaps), (held, closed) = (_energies(at(*of)) for of in ((0.1, 0.002), (1.0, 0.002), (1.0, 0.05)))
    face = 2 / math.sqrt(3) / 75e-6  # area of faces per volume: 6 l / 2 over 2 sqrt(3) a^2
    return Experiment(
        "paper", "The source paper: cells part under shear",
        "Mihai, Safar & Wyatt, J. Eng. Math., doi 10.1007/s10665-016-9894-2",
        "Under shear, cells with fibre-reinforced walls part; the stiffer their fibres, the sooner. Turgor holds them.",
        "Nothing. Hexagons, bonded and in contact without cohesion, sheared by 0.3: what is set free when the "
        "lamella is gone is what can pay for its breaking.",
        f"With fibres of 1 MPa {strong:.3g} kJ/m³ are set free, {1e3 * strong / face:.2g} J/m² of face; with fibres "
        f"of 0.1 MPa {weak:.3g} kJ/m³; under a turgor of 50 instead of 2 kPa {held:.3g} kJ/m³. {100 * gaps:.0f} % of "
        "the faces are "
        f"open, under turgor {100 * closed:.0f} %. [Line by line](paper.md).", [],
        [Mode("sheared cells without cohesion", "part", "part" if gaps > 0.1 else "stay"),
         Mode("with stiffer fibres", "part more easily", "part more easily" if strong > weak else "part less easily"),
         Mode("under turgor", "are held", "are held" if closed < gaps else "part")])
