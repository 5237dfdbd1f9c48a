"""What `lamella tissue` tells of the tissue that it has made."""
import numpy as np

from .file import Tissue


def _row(label: str, text: str) -> str:
    return f"{label:12s} {text}"


def _of(asked: str, got: str) -> str:
    return f"{got}, asked for {asked}"


def table(tissue: Tissue) -> list[str]:
    """Lines: what was asked, and what the tissue is."""
    asked, got = tissue.made_by["asked"], tissue.made_by["got"]
    unit, (a, b) = tissue.unit, np.array(got["period"])
    mean = got["area_mean"]
    size, apothem = np.sqrt(4 * mean / np.pi), np.sqrt(mean / (2 * np.sqrt(3)))
    lines = [
        _row("cells", f"{got['cells']} in a period of {np.hypot(*a):.5g} x {np.hypot(*b):.5g} {unit}"),
        _row("size", _of(f"{asked['size']:g} {unit}", f"{size:.6g} {unit}") + f": mean area {mean:.6g} "
             f"{unit}^2, that of a hexagon of apothem {apothem:.4g} {unit}"),
        _row("variation", _of(f"{asked['variation']:g}", f"{got['area_variation']:.4f}") + " of the area"),
        _row("elongation", _of(f"{asked['elongation']:g}", f"{got['elongation']:.3f}") +
             (f", at {got['direction']:.1f} deg, asked for {(asked['direction'] + 90) % 180 - 90:g}"
              if asked["elongation"] > 1 else "")),
        _row("porosity", _of(f"{asked['gas']:g}", f"{got['porosity']:.6f}") +
             f": {got['porosity_junctions']:.4f} at junctions, {got['porosity_spaces']:.4f} of "
             f"{got['cells_missing']} missing cells")]
    if got["corner_radius"] > 0:
        lines.append(_row("corners", f"radius {got['corner_radius']:.4g} {unit}, less at "
                          f"{100 * got['corners_limited']:.0f} % of the vertices, whose edges are short"))
    lines += [
        _row("shape", f"4 pi A/P^2 {got['shape_factor']:.3f}, standard deviation {got['shape_factor_deviation']:.3f}"),
        _row("neighbours", f"{got['neighbours']:.3f} of a cell; cells with " +
             ", ".join(f"{k}: {count}" for k, count in got["neighbours_count"].items())),
        _row("edges", f"shortest {got['edge_shortest']:.3g} {unit}, mean {got['edge_mean']:.3g} {unit}; "
                      f"{got['edges_merged']} shorter ones merged into points"),
        _row("angles", f"smallest {got['angle_smallest']:.1f} deg")]
    if "wall_share" in got:
        lines.append(_row("walls", f"{100 * got['wall_share']:.1f} % of the volume, lumens "
                          f"{100 * got['lumen_share']:.1f} %"))
    return lines

